//! What can be wrong with a scene.

use std::{fmt, io, path::PathBuf, sync::Arc};

/// A place in a text file, or an override.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Location {
    /// The file's name, as the caller gave it; of an override what it says.
    pub file: Arc<str>,
    /// The line, from 1; 0 of an override.
    pub line: u32,
    /// The column in characters, from 1; 0 of an override.
    pub column: u32,
}

impl fmt::Display for Location {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.line {
            0 => f.write_str(&self.file),
            line => write!(f, "{}:{line}:{}", self.file, self.column),
        }
    }
}

/// The part of a scene that an error is about.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Subject {
    /// The scene as a whole.
    Scene,
    /// The camera.
    Camera,
    /// The render settings.
    Render,
    /// The output settings.
    Output,
    /// The settings of the profile `paper`.
    Paper,
    /// A material.
    Material {
        /// Its place in [`Scene::materials`](crate::Scene::materials).
        index: usize,
        /// Its name.
        name: String,
    },
    /// A light.
    Light {
        /// Its place in [`Scene::lights`](crate::Scene::lights).
        index: usize,
        /// Its name.
        name: String,
    },
    /// An object.
    Object {
        /// Its place in [`Scene::objects`](crate::Scene::objects).
        index: usize,
        /// Its name.
        name: String,
    },
}

impl fmt::Display for Subject {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Scene => f.write_str("scene"),
            Self::Camera => f.write_str("camera"),
            Self::Render => f.write_str("render"),
            Self::Output => f.write_str("output"),
            Self::Paper => f.write_str("paper"),
            Self::Material { name, .. } => write!(f, "material {name:?}"),
            Self::Light { name, .. } => write!(f, "light {name:?}"),
            Self::Object { name, .. } => write!(f, "object {name:?}"),
        }
    }
}

/// Why there is no scene. Each message names the file, object or key at fault and what would be right.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A file cannot be read.
    #[error("{}: the file cannot be read: {cause}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// What the system says.
        cause: io::Error,
    },
    /// The scene file is not TOML.
    #[error("{at}: not valid TOML: {problem}")]
    Syntax {
        /// Where the reader stopped.
        at: Location,
        /// What it says.
        problem: String,
    },
    /// An override makes no sense, or leads to no place in the scene file.
    #[error("the override {path}: {problem}")]
    Override {
        /// Its keys, or all of it.
        path: String,
        /// What is wrong and what would be right.
        problem: String,
    },
    /// A table of the scene file has a key that means nothing there.
    #[error("{at}: {table}: unknown key {key:?}; {help}")]
    UnknownKey {
        /// Where the key stands.
        at: Location,
        /// The table.
        table: String,
        /// The key.
        key: String,
        /// The nearest known key, if one is near, and all known keys.
        help: String,
    },
    /// A name in the scene file is none of those that may stand there.
    #[error("{at}: {place}: there is no {what} {name:?}; {help}")]
    UnknownName {
        /// Where the name stands.
        at: Location,
        /// The table and the key.
        place: String,
        /// What the name should be one of.
        what: &'static str,
        /// The name.
        name: String,
        /// The nearest known name, if one is near, and all known names.
        help: String,
    },
    /// A table of the scene file lacks a key.
    #[error("{at}: {table}: the key {key:?} is missing; it takes {expected}")]
    MissingKey {
        /// Where the table begins.
        at: Location,
        /// The table.
        table: String,
        /// The key.
        key: &'static str,
        /// What to give.
        expected: &'static str,
    },
    /// A value in the scene file has the wrong type.
    #[error("{at}: {place}: expected {expected}, found {found}")]
    WrongType {
        /// Where the value stands.
        at: Location,
        /// The table and the key.
        place: String,
        /// What to give.
        expected: &'static str,
        /// What is there.
        found: String,
    },
    /// A value in the scene file, or a combination of keys, makes no sense.
    #[error("{at}: {table}: {problem}")]
    BadValue {
        /// Where it stands.
        at: Location,
        /// The table.
        table: String,
        /// What is wrong and what would be right.
        problem: String,
    },
    /// A mesh or an image that the scene file names cannot be used.
    #[error("{at}: {place}: {cause}")]
    File {
        /// Where the scene file names the file.
        at: Location,
        /// The table and the key.
        place: String,
        /// What is wrong with the file.
        cause: Box<Error>,
    },
    /// A picture of a surface or of an environment cannot be used.
    #[error("{}: the image {problem}", path.display())]
    Image {
        /// The file.
        path: PathBuf,
        /// What is wrong and what would be right.
        problem: String,
    },
    /// An OBJ or MTL file makes no sense.
    #[error("{}{}: {problem}", path.display(), line.map(|line| format!(":{line}")).unwrap_or_default())]
    Obj {
        /// The file.
        path: PathBuf,
        /// The line, from 1, if one is at fault.
        line: Option<usize>,
        /// What is wrong and what would be right.
        problem: String,
    },
    /// A PLY or STL file makes no sense.
    #[error("{}: the file {problem}", path.display())]
    Mesh {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        problem: String,
    },
    /// A glTF file makes no sense, or asks for what is not read.
    #[error("{}: {}{problem}", path.display(), place.as_ref().map(|place| format!("{place}: ")).unwrap_or_default())]
    Gltf {
        /// The file.
        path: PathBuf,
        /// The entry of the file at fault, such as `meshes[3] "Cup"`, if one is.
        place: Option<String>,
        /// What is wrong and what would be right.
        problem: String,
    },
    /// [`Scene::validate`](crate::Scene::validate) refuses the scene.
    #[error("{}{subject}: {key} {problem}", at.as_ref().map(|at| format!("{at}: ")).unwrap_or_default())]
    Invalid {
        /// Where the scene file sets the key, if the scene comes from one.
        at: Option<Location>,
        /// The part of the scene at fault.
        subject: Subject,
        /// The field at fault, under the name that both the scene file and the Rust type give it.
        key: &'static str,
        /// What is wrong and what would be right.
        problem: String,
    },
}

/// Something in a scene that can be rendered but is hardly meant.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Warning {
    /// A dielectric's surface encloses no volume.
    #[error(
        "object {object:?}: its material is a dielectric, but its surface is not closed ({open_edges} open edges): \
         light that enters through a hole is refracted wrongly; close the mesh, or give a sheet of glass the \
         material type \"thin_walled\""
    )]
    OpenDielectric {
        /// The object.
        object: String,
        /// Edges that do not join exactly two triangles of opposite direction.
        open_edges: usize,
    },
    /// A closed dielectric's triangles are clockwise seen from outside.
    #[error(
        "object {object:?}: its triangles face inwards, so that inside and outside of the dielectric are swapped; \
         reverse their winding"
    )]
    InsideOutDielectric {
        /// The object.
        object: String,
    },
    /// Some triangles have no area.
    #[error("object {object:?}: {count} of its triangles have zero area and meet no light")]
    DegenerateTriangles {
        /// The object.
        object: String,
        /// How many.
        count: usize,
    },
    /// The camera is inside a light's sphere.
    #[error("the camera lies inside the light {light:?} and sees nothing but its surface; move one of them")]
    CameraInsideLight {
        /// The light.
        light: String,
    },
    /// No object sends light on along one direction or a narrow lobe.
    #[error("no caustic can form: no object has glass, a mirror, metal or a clear coat, which could focus light")]
    NoCaster,
    /// No object can show light.
    #[error(
        "no caustic can form: every object is of glass, a mirror or of metal; add one with a diffuse share to catch light"
    )]
    NoReceiver,
    /// No light and no surface emits, but the background or the ambient light shows.
    #[error(
        "no caustic can form: no light and no surface emits anything; only the background and the ambient light will show"
    )]
    NoLight,
    /// Nothing emits, and background and ambient light are black.
    #[error(
        "no caustic can form and the picture will be black: no light and no surface emits anything, and the background \
         and the ambient light are black too; add a light"
    )]
    Dark,
    /// Some corners of an OBJ file have no normal or one of length zero.
    #[error("{}: {count} corners have no usable normal; the facet's normal stands in", path.display())]
    ReplacedNormals {
        /// The file.
        path: PathBuf,
        /// How many.
        count: usize,
    },
    /// Some corners of an OBJ file have texture coordinates and some have none.
    #[error(
        "{}: {count} of {corners} corners have no texture coordinates, so those of the others are not used",
        path.display()
    )]
    PartialTexcoords {
        /// The file.
        path: PathBuf,
        /// Corners without.
        count: usize,
        /// Corners in all.
        corners: usize,
    },
    /// Some faces of an OBJ file have fewer than three corners.
    #[error("{}: {count} faces have fewer than 3 corners and are left out", path.display())]
    SkippedFaces {
        /// The file.
        path: PathBuf,
        /// How many.
        count: usize,
    },
    /// A material library that an OBJ file names cannot be used.
    #[error("{}: its material library is not used: {problem}", path.display())]
    MaterialLibrary {
        /// The OBJ file.
        path: PathBuf,
        /// What is wrong with the library.
        problem: String,
    },
    /// A picture of a material from an MTL file cannot be shown.
    #[error("material {material:?}: {problem}; it shows without")]
    UnreadPicture {
        /// The material.
        material: String,
        /// What is wrong with the picture.
        problem: String,
    },
    /// Glass from an MTL file is on a surface that encloses no volume.
    #[error(
        "{}: the material {material:?} is glass on a surface that is not closed; there it has no thickness (thin_walled)",
        path.display()
    )]
    OpenGlass {
        /// The OBJ file.
        path: PathBuf,
        /// The material.
        material: String,
    },
    /// Something in a glTF file is not shown as it is meant.
    #[error("{}: {}{problem}", path.display(), place.as_ref().map(|place| format!("{place}: ")).unwrap_or_default())]
    Gltf {
        /// The file.
        path: PathBuf,
        /// The entry of the file, such as `materials[3] "Cup"`, if one is concerned.
        place: Option<String>,
        /// What is not shown.
        problem: String,
    },
    /// A material from an MTL file has pictures of kinds that are not read.
    #[error("material {material:?}: its pictures ({maps}) are of kinds that are not read; it shows without them")]
    IgnoredTextures {
        /// The material.
        material: String,
        /// The MTL keywords, such as `map_Kd`.
        maps: String,
    },
}

/// The known name nearest to a mistyped one, if one is near enough to be what was meant: one of whose words it is, or
/// that differs in about a third of the letters at most.
pub(crate) fn nearest<'k>(name: &str, known: &[&'k str]) -> Option<&'k str> {
    let normal = |s: &str| s.to_lowercase().replace('-', "_");
    let name = normal(name);
    if let Some(whole) = known.iter().find(|candidate| normal(candidate).split('_').any(|word| word == name)) {
        return Some(whole);
    }
    let allowed = name.chars().count().div_ceil(3);
    known
        .iter()
        .map(|candidate| (strsim::osa_distance(&name, &normal(candidate)), *candidate))
        .min_by_key(|(distance, _)| *distance)
        .filter(|(distance, _)| *distance <= allowed)
        .map(|(_, candidate)| candidate)
}

/// The end of a message about an unknown name: what was probably meant, and what there is.
pub(crate) fn suggestion(name: &str, known: &[&str], plural: &str) -> String {
    let nearest = nearest(name, known).map(|near| format!("did you mean {near:?}? ")).unwrap_or_default();
    match known {
        [] => format!("there are no {plural}"),
        _ => {
            let mut list = format!("known {plural}: {}", known.join(", "));
            if !nearest.is_empty() {
                list.replace_range(..1, "K");
            }
            nearest + &list
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nearest_is_near() {
        let known = ["type", "ior", "tint", "absorption"];
        assert_eq!(nearest("iro", &known), Some("ior"));
        assert_eq!(nearest("Absorbtion", &known), Some("absorption"));
        assert_eq!(nearest("albedo", &known), None);
        assert_eq!(nearest("fov", &["vertical_fov", "up"]), Some("vertical_fov"));
        assert_eq!(nearest("x", &[]), None);
    }

    #[test]
    fn suggestion_reads_as_a_sentence() {
        assert_eq!(suggestion("iro", &["ior", "tint"], "keys"), "did you mean \"ior\"? Known keys: ior, tint");
        assert_eq!(suggestion("colour", &["ior", "tint"], "keys"), "known keys: ior, tint");
        assert_eq!(suggestion("glass", &[], "materials"), "there are no materials");
    }
}
