//! Scene description for diacaustic: TOML, OBJ, glTF and primitives, validated. No GPU.
//!
//! [`load_scene`] reads a scene file and the meshes and images that it names, [`load_gltf_scene`] a glTF file by itself. A [`Scene`] can be built in code as well;
//! [`Scene::validate`] then checks it the same way.
//!
//! ```
//! use std::path::Path;
//!
//! let text = r#"
//!     [camera]
//!     position = [0, 2, 3]
//!     look_at = [0, 0.2, 0]
//!     vertical_fov = 40
//!
//!     [materials]
//!     glass = { type = "dielectric", ior = 1.5 }
//!     plaster = { type = "diffuse", albedo = 0.8 }
//!
//!     [[lights]]
//!     type = "sphere"
//!     center = [1, 2.5, 0.6]
//!     radius = 0.05
//!     flux = 35
//!
//!     [[objects]]
//!     sphere = { center = [0, 0.3, 0], radius = 0.3 }
//!     material = "glass"
//!
//!     [[objects]]
//!     name = "floor"
//!     rectangle = { center = [0, 0, 0], edge_u = [4, 0, 0], edge_v = [0, 0, -4] }
//!     material = "plaster"
//! "#;
//! let loaded = diacaustic_scene::parse_scene(text, Path::new("."), "ball.toml")?;
//! assert!(loaded.warnings.is_empty());
//! assert_eq!(loaded.scene.objects[1].name, "floor");
//! assert!(loaded.scene.materials[loaded.scene.objects[0].material_of(0)].is_caster());
//!
//! let error = diacaustic_scene::parse_scene(&text.replace("ior", "iro"), Path::new("."), "ball.toml").unwrap_err();
//! assert!(error.to_string().contains("[materials.glass]: unknown key \"iro\"; did you mean \"ior\"?"));
//! # Ok::<(), diacaustic_scene::Error>(())
//! ```

mod camera;
mod dispersion;
mod environment_image;
mod error;
mod folder;
mod gltf;
mod irradiance_cache;
mod layer;
mod light;
mod light_groups;
mod material;
mod media;
mod mesh;
mod mesh_file;
mod mesh_options;
mod metals;
mod obj;
mod paper;
mod ply;
mod polygons;
mod primitives;
mod radiance_map;
mod read_toml;
mod scene;
mod smooth_normals;
mod solid;
mod spectrum;
mod stl;
mod studio;
mod substances;
mod texture;
mod texture_image;
mod validate;

pub use camera::Camera;
pub use dispersion::{Dispersion, STATED_WAVELENGTH};
pub use environment_image::load_environment;
pub use error::{Error, Location, Subject, Warning};
pub use folder::ReadOptions;
pub use gltf::{GltfCamera, GltfFile, GltfObject, GltfOptions, load_gltf, parse_gltf};
pub use layer::Layer;
pub use light::{Light, LightKind};
pub use light_groups::{BACKGROUND_GROUP, DEFAULT_LIGHT_GROUP, LightGroups, MOST_LIGHT_GROUPS};
pub use material::{GLOSSY, Material, MaterialKind, PLASTIC_REFLECTANCE, SMOOTH};
pub use mesh::{Chart, Mesh};
pub use mesh_file::MeshFile;
pub use mesh_options::MeshOptions;
pub use metals::{METALS, Metal, metal};
pub use obj::{ObjFile, load_obj, parse_obj};
pub use paper::{PaperMapSize, PaperProfile, PaperRefraction, PaperSampling, paper_direction_density};
pub use ply::{load_ply, parse_ply};
pub use radiance_map::RadianceMap;
pub use read_toml::{LoadedScene, Override, SceneOptions, load_scene, load_scene_with, parse_scene, parse_scene_with};
pub use scene::{Object, OutputSettings, PixelFilter, RenderSettings, Scene, ToneCurve};
pub use spectrum::{
    LONGEST_WAVELENGTH, SHORTEST_WAVELENGTH, WAVELENGTH_STEPS, WavelengthEntry, number_of_wavelength, wavelength_table,
};
pub use stl::{load_stl, parse_stl};
pub use studio::{StudioOptions, load_gltf_scene};
pub use substances::{SUBSTANCES, Substance, substance};
pub use texture::{NormalMap, Texture, TextureFilter, TextureImage, Textures, Wrap};
pub use texture_image::{ColorSpace, Picture, load_texture};
