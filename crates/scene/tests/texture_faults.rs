//! Pictures on surfaces: what is refused.

mod picture_folder;

use std::sync::Arc;

use diacaustic_scene::{Dispersion, Material, MaterialKind, NormalMap, Texture, TextureImage};
use glam::{Affine2, Vec2, Vec3};
use half::f16;
use picture_folder::Folder;

#[test]
fn faults_in_scene_files_are_named() {
    let folder = Folder::new();
    let diffuse = |keys: &str| format!("type = 'diffuse'\nalbedo = {keys}");
    let rough = |keys: &str| format!("type = 'coated'\nalbedo = 0\nroughness = {keys}");
    let matt = |keys: &str| format!("type = 'diffuse'\nalbedo = 0\n{keys}");
    let takes = "takes no picture; these keys do";
    let cases = [
        (
            diffuse("{ factor = 1 }"),
            "[materials.m]: albedo: the key \"image\" is missing; it takes the path of a picture (.png, .jpg, .hdr or .exr), relative \
             to the scene file"
                .to_owned(),
        ),
        (
            diffuse("'rgb.png'"),
            "[materials.m]: albedo: expected a colour: 3 numbers [r, g, b], one number for gray or a picture { image = \"FILE\" }, found \
             the string \"rgb.png\""
                .to_owned(),
        ),
        (
            rough("'rgb.png'"),
            "[materials.m]: roughness: expected a number or a picture { image = \"FILE\" }, found the string \"rgb.png\"".to_owned(),
        ),
        (
            diffuse("{ image = 'rgb.png', channel = 'r' }"),
            "[materials.m]: albedo: unknown key \"channel\"; known keys: image, wrap, filter, scale, rotate, offset, factor, color_space"
                .to_owned(),
        ),
        (
            rough("{ image = 'rgb.png', chanel = 'r' }"),
            "[materials.m]: roughness: unknown key \"chanel\"; did you mean \"channel\"? Known keys: image, wrap".to_owned(),
        ),
        (
            matt("normal = { image = 'rgb.png', color_space = 'linear' }"),
            "[materials.m]: normal: unknown key \"color_space\"; known keys: image, wrap, filter, scale, rotate, offset, strength"
                .to_owned(),
        ),
        (
            matt("normal = 1"),
            "[materials.m]: normal: expected a picture's table: { image = \"FILE\", ... }, found the whole number 1".to_owned(),
        ),
        (
            diffuse("{ image = 'none.png' }"),
            "[materials.m]: albedo: image: none.png: the file cannot be read: No such file or directory (os error 2)".to_owned(),
        ),
        (
            diffuse("{ image = 'x.toml' }"),
            "[materials.m]: albedo: image: x.toml: the image is of a kind that is not read; pictures end in .png, .jpg, .jpeg, .hdr or \
             .exr"
                .to_owned(),
        ),
        (
            diffuse("{ image = 'light.hdr', color_space = 'srgb' }"),
            "[materials.m]: albedo: image: light.hdr: the image holds linear numbers, as every .hdr and .exr file does; its color_space \
             must be \"linear\""
                .to_owned(),
        ),
        (
            diffuse("{ image = 'rgb.png', color_space = 'sRGB' }"),
            "[materials.m]: albedo: color_space: there is no colour space \"sRGB\"; did you mean \"srgb\"? Known names: srgb, linear"
                .to_owned(),
        ),
        (
            diffuse("{ image = 'rgb.png', wrap = 'tile' }"),
            "[materials.m]: albedo: wrap: there is no wrap \"tile\"; known names: repeat, mirror, clamp".to_owned(),
        ),
        (
            diffuse("{ image = 'rgb.png', wrap = ['clamp', 'mirrored'] }"),
            "[materials.m]: albedo: wrap[1]: there is no wrap \"mirrored\"; did you mean \"mirror\"?".to_owned(),
        ),
        (
            diffuse("{ image = 'rgb.png', wrap = ['clamp'] }"),
            "[materials.m]: albedo: wrap has 1 elements; it must have 2, [u, v], or be one name".to_owned(),
        ),
        (
            diffuse("{ image = 'rgb.png', filter = 'cubic' }"),
            "[materials.m]: albedo: filter: there is no filter \"cubic\"; known names: linear, nearest".to_owned(),
        ),
        (
            diffuse("{ image = 'rgb.png', scale = [1, 0] }"),
            "[materials.m]: albedo: scale is zero along an axis; a scale must not be 0".to_owned(),
        ),
        (
            diffuse("{ image = 'rgb.png', scale = [1, 2, 3] }"),
            "[materials.m]: albedo: scale: expected one number or 2 numbers [u, v], found an array of 3".to_owned(),
        ),
        (
            diffuse("{ image = 'rgb.png', offset = 1 }"),
            "[materials.m]: albedo: offset: expected 2 numbers [u, v], found the whole number 1".to_owned(),
        ),
        (
            rough("{ image = 'rgb.png', channel = 'red' }"),
            "[materials.m]: roughness: channel: there is no channel \"red\"; known names: r, g, b, a".to_owned(),
        ),
        (
            rough("{ image = 'rgb.png', channel = 'a' }"),
            "[materials.m]: roughness: channel is \"a\", which the picture does not have; take \"r\", \"g\" or \"b\"".to_owned(),
        ),
        (
            "type = 'dielectric'\nior = 1.5\nopacity = 0.5".to_owned(),
            "[materials.m]: opacity is set, but a dielectric bounds a volume, which has no holes; leave it out, or use the material \
             type \"thin_walled\""
                .to_owned(),
        ),
        (
            "type = 'thin_walled'\nemission = { image = 'rgb.png' }".to_owned(),
            "[materials.m]: emission is set, but glass takes no emission".to_owned(),
        ),
        (
            "type = 'thin_walled'\nior = { image = 'rgb.png' }".to_owned(),
            format!("[materials.m]: ior {takes}: tint, roughness, normal, opacity"),
        ),
        (
            "type = 'conductor'\nk = 1\neta = { image = 'rgb.png' }".to_owned(),
            format!("[materials.m]: eta {takes}: roughness, emission, normal, opacity"),
        ),
        (
            "type = 'conductor'\neta = 1\nk = { image = 'rgb.png' }".to_owned(),
            format!("[materials.m]: k {takes}: roughness, emission, normal, opacity"),
        ),
        (
            "type = 'dielectric'\nior = 1\nabsorption = { image = 'rgb.png' }".to_owned(),
            format!("[materials.m]: absorption {takes}: tint, roughness, normal"),
        ),
        (
            "type = 'phong'\nambient = { image = 'rgb.png' }".to_owned(),
            format!("[materials.m]: ambient {takes}: diffuse, emission, normal, opacity"),
        ),
        ("type = 'phong'\nspecular = { image = 'rgb.png' }".to_owned(), format!("[materials.m]: specular {takes}")),
        ("type = 'phong'\nshininess = { image = 'rgb.png' }".to_owned(), format!("[materials.m]: shininess {takes}")),
        (
            diffuse("{ image = 'rgb.png', factor = 2 }"),
            "material \"m\": albedo is [2, 2, 2]; each channel must be from 0 to 1".to_owned(),
        ),
        (
            diffuse("{ image = 'light.exr' }"),
            "material \"m\": albedo is [4, 1, 2] at the greatest numbers of its picture, times the factor; each channel must be from \
             0 to 1"
                .to_owned(),
        ),
        (
            "type = 'phong'\nspecular = 0\nshininess = 1\nambient = 0.5\ndiffuse = { image = 'light.exr', factor = 0.25 }".to_owned(),
            "material \"m\": ambient is [2, 0.5, 1] at the greatest numbers of its picture".to_owned(),
        ),
        (
            rough("{ image = 'light.exr', channel = 'r' }"),
            "material \"m\": roughness is 4 at the greatest number of its picture, times the factor; it must be from 0 to 1".to_owned(),
        ),
        (
            "type = 'metallic_roughness'\nmetallic = { image = 'light.exr' }".to_owned(),
            "material \"m\": metallic is 2 at the greatest number of its picture".to_owned(),
        ),
        (
            matt("opacity = { image = 'light.exr' }"),
            "material \"m\": opacity is 4 at the greatest number of its picture".to_owned(),
        ),
        (matt("opacity = 1.5"), "material \"m\": opacity is 1.5; it must be from 0 to 1".to_owned()),
        (
            matt("opacity = { image = 'rgb.png', cutoff = 2 }"),
            "material \"m\": opacity has the cutoff 2; it must be from 0 to 1".to_owned(),
        ),
        (
            matt("emission = { image = 'rgb.png', factor = -1 }"),
            "material \"m\": emission is [-1, -1, -1]; each channel must be 0 or greater (W/(m² sr))".to_owned(),
        ),
        (
            matt("emission = { image = 'light.exr', factor = 1e38 }"),
            "material \"m\": emission is [inf, ".to_owned(),
        ),
    ];
    for (keys, message) in cases {
        let found = folder.error(&keys);
        assert!(found.starts_with(&message), "{found}\nmust start with\n{message}");
    }
}

#[test]
fn negative_pictures_are_refused() {
    let folder = Folder::new();
    folder.write_exr("negative.exr", &[[0.5, -0.25, 0.5]]);
    let message = folder.error("type = 'diffuse'\nalbedo = { image = 'negative.exr', factor = 0.5 }");
    assert!(message.starts_with("material \"m\": albedo is [0.25, -0.125, 0.25] at the least numbers of its picture"));
    let message = folder.error("type = 'diffuse'\nalbedo = 0\nemission = { image = 'negative.exr' }");
    assert!(message.starts_with("material \"m\": emission is [0.5, -0.25, 0.5] at the least numbers of its picture"));
    let normal = "type = 'diffuse'\nalbedo = 0\nnormal = { image = 'negative.exr' }";
    assert!(folder.material(normal).textures.normal.is_some(), "a normal map's numbers may be any");
}

/// A picture of one texel.
fn picture(texel: [f32; 4]) -> Texture {
    Texture::new(Arc::new(TextureImage::new(1, 1, vec![texel.map(f16::from_f32)]).unwrap()))
}

/// The message about a box's material that was built in code.
fn code_error(kind: MaterialKind, change: impl FnOnce(&mut Material)) -> String {
    let folder = Folder::new();
    let mut scene = folder.scene("type = 'diffuse'\nalbedo = 0.5");
    scene.materials[0].kind = kind;
    change(&mut scene.materials[0]);
    scene.validate().unwrap_err().to_string()
}

#[test]
fn pictures_that_a_kind_does_not_have_are_refused() {
    let diffuse = || MaterialKind::Diffuse { albedo: Vec3::ONE };
    let conductor = || MaterialKind::Conductor { eta: Vec3::ONE, k: Vec3::ONE, roughness: 0.5 };
    let glass = || MaterialKind::ThinWalled { ior: 1.5, tint: Vec3::ONE, roughness: 0.0 };
    let mirror = || MaterialKind::Mirror { reflectance: Vec3::ONE };
    let dielectric = || MaterialKind::Dielectric {
        ior: 1.5,
        dispersion: Dispersion::None,
        tint: Vec3::ONE,
        absorption: Vec3::ZERO,
        roughness: 0.0,
        priority: 0,
    };
    let one = || Some(picture([1.0; 4]));
    let refused = |key: &str, what: &str| {
        format!("material \"m\": textures.{key} is set, but a material of this kind has no {what}; it must be none")
    };
    assert_eq!(code_error(conductor(), |m| m.textures.color = one()), refused("color", "colour"));
    assert_eq!(code_error(mirror(), |m| m.textures.roughness = one()), refused("roughness", "roughness"));
    assert_eq!(code_error(diffuse(), |m| m.textures.metallic = one()), refused("metallic", "share of metal"));
    assert_eq!(code_error(glass(), |m| m.textures.emission = one()), refused("emission", "emission"));
    let closed = "material \"m\": opacity is set, but a dielectric bounds a volume, which has no holes; it must be 1 without picture \
                  and cutoff (a sheet of glass is thin-walled)";
    assert_eq!(code_error(dielectric(), |m| m.opacity = 0.5), closed);
    assert_eq!(code_error(dielectric(), |m| m.opacity_cutoff = Some(0.5)), closed);
    assert_eq!(code_error(dielectric(), |m| m.textures.opacity = one()), closed);
}

#[test]
fn numbers_of_textures_out_of_range_are_refused() {
    let error = |change: fn(&mut Material)| code_error(MaterialKind::Diffuse { albedo: Vec3::ONE }, change);
    assert_eq!(
        error(|m| m.textures.normal = Some(NormalMap { texture: picture([0.5; 4]), strength: f32::NAN })),
        "material \"m\": normal has the strength NaN; it must be a finite number"
    );
    let turned = Affine2::from_scale(Vec2::new(f32::INFINITY, 1.0));
    let message = code_error(MaterialKind::Diffuse { albedo: Vec3::ONE }, |m| {
        m.textures.color = Some(Texture { picture_from_uv: turned, ..picture([1.0; 4]) });
    });
    assert!(message.starts_with("material \"m\": albedo has the picture_from_uv "), "{message}");
    assert!(message.ends_with("; each number must be finite"), "{message}");
    assert_eq!(
        error(|m| m.textures.opacity = Some(Texture { channel: 4, ..picture([1.0; 4]) })),
        "material \"m\": opacity is of the channel 4 of its picture; it must be from 0 to 3"
    );
    assert_eq!(error(|m| m.opacity = f32::NAN), "material \"m\": opacity is NaN; it must be from 0 to 1");
    assert_eq!(
        error(|m| m.opacity_cutoff = Some(f32::NAN)),
        "material \"m\": opacity has the cutoff NaN; it must be from 0 to 1"
    );
}

#[test]
fn a_mesh_without_texture_coordinates_shows_no_picture() {
    let folder = Folder::new();
    folder.write("plain.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    let other = "[[objects]]\nname = 'sail'\nmesh = 'plain.obj'\nmaterial = 'n'\n[materials.n]\ntype = 'diffuse'\n";
    let with = |keys: &str| folder.load_with("type = 'mirror'\nreflectance = 1", &format!("{other}{keys}"));
    assert!(with("albedo = 0.5").is_ok());
    let expected = "x.toml:13:1: object \"sail\": mesh has no texture coordinates, which the pictures of the material \"n\" need; give \
                    it some (vt in an OBJ file), or choose a material without pictures";
    assert_eq!(with("albedo = { image = 'rgb.png' }").unwrap_err(), expected);
    assert_eq!(with("albedo = 0.5\nnormal = { image = 'rgb.png' }").unwrap_err(), expected);
    folder.write("plain.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n");
    assert!(with("albedo = { image = 'rgb.png' }").is_ok());
}
