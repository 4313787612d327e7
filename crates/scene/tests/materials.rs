//! Materials read from TOML, and the substances and metals that have names.

use std::{collections::HashSet, fs, path::Path};

use diacaustic_scene::{
    Dispersion, METALS, Material, MaterialKind, PLASTIC_REFLECTANCE, SUBSTANCES, metal, parse_scene, substance,
};
use glam::Vec3;

fn scene(material: &str) -> String {
    format!(
        "[camera]\nposition = [0, 2, 3]\nlook_at = [0, 0, 0]\nvertical_fov = 40\n\
         [[objects]]\nbox = {{ min = [0, 0, 0], max = [1, 1, 1] }}\nmaterial = 'm'\n\
         [materials.m]\n{material}\n"
    )
}

fn material(keys: &str) -> Material {
    let loaded = parse_scene(&scene(keys), Path::new("."), "x.toml").unwrap();
    loaded.scene.materials[0].clone()
}

/// The message about a material, without its place; it must be within the material's table.
fn error(keys: &str) -> String {
    let message = parse_scene(&scene(keys), Path::new("."), "x.toml").unwrap_err().to_string();
    let (place, message) = message.split_once(": ").unwrap();
    let line: usize = place.split(':').nth(1).unwrap().parse().unwrap();
    assert!(line >= 8, "{place}: {message}");
    message.to_owned()
}

#[test]
fn every_type_is_read_with_all_keys() {
    let (color, roughness) = (Vec3::new(0.2, 0.4, 0.6), 0.5);
    let cases = [
        ("type = 'diffuse'\nalbedo = [0.2, 0.4, 0.6]", MaterialKind::Diffuse { albedo: color }),
        (
            "type = 'phong'\nambient = 0\ndiffuse = [0.2, 0.4, 0.6]\nspecular = 1\nshininess = 5",
            MaterialKind::Phong { ambient: Vec3::ZERO, diffuse: color, specular: Vec3::ONE, shininess: 5.0 },
        ),
        ("type = 'mirror'\nreflectance = [0.2, 0.4, 0.6]", MaterialKind::Mirror { reflectance: color }),
        (
            "type = 'conductor'\neta = [0.2, 0.4, 0.6]\nk = 3\nroughness = 0.5",
            MaterialKind::Conductor { eta: color, k: Vec3::splat(3.0), roughness },
        ),
        (
            "type = 'coated'\nalbedo = [0.2, 0.4, 0.6]\nior = 1.4\nroughness = 0.5",
            MaterialKind::Coated { albedo: color, ior: 1.4, roughness },
        ),
        (
            "type = 'metallic_roughness'\nbase_color = [0.2, 0.4, 0.6]\nmetallic = 0.25\nroughness = 0.5",
            MaterialKind::MetallicRoughness {
                base_color: color,
                reflectance: PLASTIC_REFLECTANCE,
                metallic: 0.25,
                roughness,
            },
        ),
    ];
    for (keys, kind) in cases {
        let read = material(&format!("{keys}\nemission = [7, 8, 9]"));
        assert_eq!(read, Material { emission: Vec3::new(7.0, 8.0, 9.0), ..Material::new("m", kind) });
    }
    let dielectric =
        "type = 'dielectric'\nior = 1.4\ntint = [0.2, 0.4, 0.6]\nabsorption = 2\nroughness = 0.5\npriority = -3";
    assert_eq!(
        material(dielectric).kind,
        MaterialKind::Dielectric {
            ior: 1.4,
            dispersion: Dispersion::None,
            tint: color,
            absorption: Vec3::splat(2.0),
            roughness,
            priority: -3
        }
    );
    let thin_walled = "type = 'thin_walled'\nior = 1.4\ntint = [0.2, 0.4, 0.6]\nroughness = 0.25";
    assert_eq!(material(thin_walled).kind, MaterialKind::ThinWalled { ior: 1.4, tint: color, roughness: 0.25 });
}

#[test]
fn omitted_keys_have_defaults() {
    let cases = [
        (
            "type = 'conductor'\neta = 1\nk = 3",
            MaterialKind::Conductor { eta: Vec3::ONE, k: Vec3::splat(3.0), roughness: 0.0 },
        ),
        (
            "type = 'dielectric'\nior = 2",
            MaterialKind::Dielectric {
                ior: 2.0,
                dispersion: Dispersion::None,
                tint: Vec3::ONE,
                absorption: Vec3::ZERO,
                roughness: 0.0,
                priority: 0,
            },
        ),
        ("type = 'thin_walled'", MaterialKind::ThinWalled { ior: 1.5, tint: Vec3::ONE, roughness: 0.0 }),
        ("type = 'coated'\nalbedo = 1", MaterialKind::Coated { albedo: Vec3::ONE, ior: 1.5, roughness: 0.0 }),
        (
            "type = 'metallic_roughness'",
            MaterialKind::MetallicRoughness {
                base_color: Vec3::ONE,
                reflectance: PLASTIC_REFLECTANCE,
                metallic: 1.0,
                roughness: 1.0,
            },
        ),
    ];
    for (keys, kind) in cases {
        assert_eq!(material(keys), Material::new("m", kind));
    }
}

#[test]
fn names_stand_for_measured_data() {
    let dielectric = |ior, dispersion, absorption| MaterialKind::Dielectric {
        ior,
        dispersion,
        tint: Vec3::ONE,
        absorption,
        roughness: 0.0,
        priority: 0,
    };
    for known in SUBSTANCES {
        let read = material(&format!("type = 'dielectric'\nsubstance = '{}'", known.name)).kind;
        assert_eq!(read, dielectric(known.ior, known.dispersion, known.absorption));
    }
    let amber = substance("amber").unwrap();
    assert!(amber.absorption.cmpgt(Vec3::ZERO).all());
    assert_eq!(
        material("type = 'dielectric'\nsubstance = 'amber'\nabsorption = 0").kind,
        dielectric(amber.ior, amber.dispersion, Vec3::ZERO)
    );
    assert_eq!(
        material("type = 'thin_walled'\nsubstance = 'amber'").kind,
        MaterialKind::ThinWalled { ior: amber.ior, tint: Vec3::ONE, roughness: 0.0 }
    );
    for known in METALS {
        let read = material(&format!("type = 'conductor'\nmetal = '{}'", known.name)).kind;
        assert_eq!(read, MaterialKind::Conductor { eta: known.eta, k: known.k, roughness: 0.0 });
    }
    assert_eq!((substance("unobtainium"), metal("unobtainium")), (None, None));
}

#[test]
fn names_are_unique_and_documented() {
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/scene-file.md");
    let page = fs::read_to_string(page).unwrap();
    let names = SUBSTANCES.map(|substance| substance.name).into_iter().chain(METALS.map(|metal| metal.name));
    let mut seen = HashSet::new();
    for name in names {
        assert!(seen.insert(name), "{name} stands twice");
        assert!(page.contains(&format!("`\"{name}\"`")), "docs/scene-file.md must list {name}");
    }
}

#[test]
fn a_material_may_be_another_in_part() {
    let own = "type = 'thin_walled'\nshare = 0.25\nrest = 'n'";
    let found = material(&format!("{own}\n[materials.n]\ntype = 'diffuse'\nalbedo = 0.5"));
    let blend = found.blend.as_ref().unwrap();
    assert_eq!((blend.share, &blend.texture, blend.rest.name.as_str()), (0.25, &None, "n"));
    assert_eq!(blend.rest.kind, MaterialKind::Diffuse { albedo: Vec3::splat(0.5) });
    assert!(found.is_caster() && found.is_receiver() && !found.is_receiver_alone());
}

#[test]
fn faults_are_named() {
    let cases = [
        (
            "type = 'dielectric'\nior = 1.5\nsubstance = 'water'",
            "[materials.m]: substance is set, and so is ior; leave one of them out",
        ),
        (
            "type = 'thin_walled'\nior = 1.5\nsubstance = 'water'",
            "[materials.m]: substance is set, and so is ior; leave one of them out",
        ),
        (
            "type = 'dielectric'\nsubstance = 'watr'",
            "[materials.m]: substance: there is no substance \"watr\"; did you mean \"water\"? Known substances: ",
        ),
        (
            "type = 'dielectric'\nsubstance = 'quarz'",
            "[materials.m]: substance: there is no substance \"quarz\"; did you mean \"quartz\"? Known substances: ",
        ),
        (
            "type = 'dielectric'\nsubstance = 1.5",
            "[materials.m]: substance: expected the name of a substance, found the number 1.5",
        ),
        (
            "type = 'dielectric'\nior = 1.5\npriority = 0.5",
            "[materials.m]: priority: expected a whole number, found the number 0.5",
        ),
        (
            "type = 'dielectric'\nior = 1.5\npriority = 3_000_000_000",
            "[materials.m]: priority is 3000000000; it must be from -2147483648 to 2147483647",
        ),
        (
            "type = 'dielectric'\nior = 1.5\nemission = 0",
            "[materials.m]: emission is set, but glass takes no emission; leave it out, or use another material type",
        ),
        (
            "type = 'thin_walled'\nemission = 1",
            "[materials.m]: emission is set, but glass takes no emission; leave it out, or use another material type",
        ),
        ("type = 'thin_walled'\nroughness = 1.5", "material \"m\": roughness is 1.5; it must be from 0 to 1"),
        (
            "type = 'mirror'\nreflectance = 1\nshare = 0.5",
            "[materials.m]: the key \"rest\" is missing; it takes the name of the material that the rest of the light meets",
        ),
        (
            "type = 'mirror'\nreflectance = 1\nrest = 'n'",
            "[materials.m]: the key \"share\" is missing; it takes the share of the light, from 0 to 1, that meets this material",
        ),
        (
            "type = 'mirror'\nreflectance = 1\nshare = 0.5\nrest = 'n'",
            "[materials.m]: rest: there is no material \"n\"",
        ),
        (
            "type = 'mirror'\nreflectance = 1\nshare = 2\nrest = 'n'\n[materials.n]\ntype = 'diffuse'\nalbedo = 1",
            "material \"m\": share is 2; it must be from 0 to 1",
        ),
        (
            "type = 'mirror'\nreflectance = 1\nshare = 0.5\nrest = 'n'\n[materials.n]\ntype = 'dielectric'\nior = 1.5",
            "material \"m\": rest is the material \"n\", which is a dielectric",
        ),
        (
            "type = 'thin_walled'\nshare = 0.5\nrest = 'n'\n[materials.n]\ntype = 'diffuse'\nalbedo = 1\nemission = 1",
            "material \"m\": rest is the material \"n\", which has an emission",
        ),
        (
            "type = 'thin_walled'\nshare = 0.5\nrest = 'n'\n[materials.n]\ntype = 'diffuse'\nalbedo = 1\nopacity = 0.5",
            "material \"m\": rest is the material \"n\", which has an opacity",
        ),
        (
            "type = 'conductor'",
            "[materials.m]: the key \"eta\" is missing; it takes a colour, the real part of the index, or \"metal\", a name such \
             as \"gold\"",
        ),
        (
            "type = 'conductor'\neta = 1",
            "[materials.m]: the key \"k\" is missing; it takes a colour, the imaginary part of the index of refraction",
        ),
        (
            "type = 'conductor'\neta = 1\nmetal = 'gold'",
            "[materials.m]: eta is set, and so is metal; leave one of them out",
        ),
        (
            "type = 'conductor'\nk = 1\nmetal = 'gold'",
            "[materials.m]: k is set, and so is metal; leave one of them out",
        ),
        (
            "type = 'conductor'\nmetal = 'cooper'",
            "[materials.m]: metal: there is no metal \"cooper\"; did you mean \"copper\"? Known metals: ",
        ),
        ("type = 'conductor'\nmetal = 'gold'\nroughness = 2", "material \"m\": roughness is 2; it must be from 0 to 1"),
        ("type = 'coated'\nalbedo = 1\nior = 0.5", "material \"m\": ior is 0.5; it must be 1 or greater and finite"),
        (
            "type = 'diffuse'\nalbedo = 1\nemission = -1",
            "material \"m\": emission is [-1, -1, -1]; each channel must be 0 or greater (W/(m² sr))",
        ),
    ];
    for (keys, message) in cases {
        let found = error(keys);
        assert!(found.starts_with(message), "{found}\nmust start with\n{message}");
    }
}

#[test]
fn indices_over_the_wavelength_are_read() {
    let of = |keys: &str| {
        let MaterialKind::Dielectric { ior, dispersion, .. } = material(&format!("type = 'dielectric'\n{keys}")).kind
        else {
            panic!("{keys}: not a dielectric");
        };
        (ior, dispersion)
    };
    assert_eq!(of("ior = 1.5"), (1.5, Dispersion::None));
    assert_eq!(of("ior = 1.5\nabbe = 40"), (1.5, Dispersion::Abbe(40.0)));
    assert_eq!(of("ior = 1.5\nabbe = 40\ndispersion = false"), (1.5, Dispersion::None));
    let (ior, dispersion) = of("cauchy = [1.5, 0.01]");
    assert!((ior - (1.5 + 0.01 / 0.587_561_8f32.powi(2))).abs() < 1e-6);
    assert_eq!(dispersion, Dispersion::Cauchy([0.01, 0.0]));
    assert_eq!(of("cauchy = [1.5, 0.01, 0.001]").1, Dispersion::Cauchy([0.01, 0.001]));
    let (ior, dispersion) = of("sellmeier = [[1.2, 0.01]]");
    assert!((ior - (1.0 + 1.2 / (1.0 - 0.01 / 0.587_561_8f32.powi(2))).sqrt()).abs() < 1e-6);
    assert_eq!(dispersion, Dispersion::Sellmeier([[1.2, 0.01], [0.0; 2], [0.0; 2], [0.0; 2]]));
    let bk7 = substance("bk7").unwrap();
    assert_eq!(of("substance = 'bk7'"), (bk7.ior, bk7.dispersion));
    assert!(!bk7.dispersion.is_none());
    assert_eq!(of("substance = 'bk7'\ndispersion = false"), (bk7.ior, Dispersion::None));
}

#[test]
fn faults_of_indices_are_named() {
    let of = |keys: &str| error(&format!("type = 'dielectric'\n{keys}"));
    for (keys, message) in [
        ("ior = 1.5\ncauchy = [1.5, 0.01]", "and so is ior; leave one of them out"),
        ("sellmeier = [[1, 0.01]]\nsubstance = 'water'", "and so is substance; leave one of them out"),
        ("substance = 'water'\nabbe = 50", "and so is substance, which has its dispersion; leave one out"),
        ("ior = 1.5\nabbe = -1", "abbe is -1; it must be finite and greater than 0"),
        ("cauchy = [1.5]", "has 1 numbers; it must be [A, B] or [A, B, C], in µm² and µm⁴"),
        ("sellmeier = []", "has 0 pairs; it must be one to four pairs [B, C], C in µm²"),
        ("sellmeier = [[1, 0.2]]", "nm; it must be finite and greater than 0"),
        ("ior = 1.5\nabbe = 40\ndispersion = 1", "expected true or false, found the whole number 1"),
        ("abbe = 40", "the index of refraction, or \"substance\""),
    ] {
        let found = of(keys);
        assert!(found.contains(message), "{keys}: {found}");
    }
}
