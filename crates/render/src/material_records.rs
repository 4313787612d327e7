//! Materials as the device knows them; docs/materials.md.

use diacaustic_scene::{Material, MaterialKind, SMOOTH, Scene, Textures};
use diacaustic_shaders as shaders;
use diacaustic_shaders::material_kind as kinds;
use glam::Vec3;

use crate::{
    lights::medium_key,
    paper,
    spectra_records::{colored_index, row_of},
};

/// Steps of the quadrature over angles of incidence.
const FRESNEL_STEPS: usize = 4096;

/// The record of a material of the scene, without what it is blended with; `colored` says whether it is on a mesh with vertex colours.
pub(crate) fn material(scene: &Scene, index: usize, colored: bool) -> shaders::Material {
    let source = &scene.materials[index];
    let mut record = part(source, colored);
    record.medium = medium_key(scene, index);
    if let MaterialKind::Dielectric { .. } = source.kind {
        record.specular = [row_of(scene, index).map_or(-1.0, |row| row as f32), 0.0, 0.0];
    }
    if let (Some(profile), MaterialKind::Dielectric { .. }) = (&scene.settings.paper, &source.kind) {
        paper::color_dielectric(profile, scene.ambient, &mut record);
    }
    record
}

/// The record of what a material is blended with, beside the material's own record.
pub(crate) fn rest(rest: &Material, own: &shaders::Material, colored: bool) -> shaders::Material {
    let record = part(rest, colored);
    let group = own.kind >> kinds::GROUP_SHIFT << kinds::GROUP_SHIFT;
    let kind = record.kind | group;
    shaders::Material { kind, emission: own.emission, emission_pdf_area: own.emission_pdf_area, ..record }
}

/// What each blended material of the scene is in part, with the material's index; the emission's picture is that of the whole.
pub(crate) fn rests(scene: &Scene) -> Vec<(usize, Material)> {
    let with_emission = |material: &Material| {
        let rest = material.rest()?;
        let textures = Textures { emission: material.textures.emission.clone(), ..rest.textures.clone() };
        Some(Material { textures, ..rest.clone() })
    };
    let materials = scene.materials.iter().enumerate();
    materials.filter_map(|(index, material)| Some((index, with_emission(material)?))).collect()
}

fn part(source: &Material, colored: bool) -> shaders::Material {
    let kind = &source.kind;
    let caster = if source.is_caster_alone() { kinds::CASTER } else { 0 };
    let receiver = if source.is_receiver_alone() { kinds::RECEIVER } else { 0 };
    let is_textured = source.textures.any() || colored;
    let textured = if is_textured { kinds::TEXTURED } else { 0 };
    let scattering = if is_textured { before_pictures(kind) } else { scattering(kind) };
    shaders::Material {
        kind: scattering.kind | caster | receiver | textured,
        emission: source.emission.into(),
        ..scattering
    }
}

/// What a material does to light, without its roles.
fn scattering(kind: &MaterialKind) -> shaders::Material {
    let blank = shaders::Material { tint: [1.0; 3], ior: 1.0, ..Default::default() };
    match *kind {
        MaterialKind::Diffuse { albedo } => shaders::Material { kind: kinds::DIFFUSE, base: albedo.into(), ..blank },
        MaterialKind::Phong { ambient, diffuse, specular, shininess } => shaders::Material {
            kind: kinds::PHONG,
            base: diffuse.into(),
            specular: specular.into(),
            tint: ambient.into(),
            ior: shininess,
            ..blank
        },
        MaterialKind::Mirror { reflectance } => {
            shaders::Material { kind: kinds::MIRROR, specular: reflectance.into(), ..blank }
        }
        MaterialKind::Conductor { eta, k, roughness } => shaders::Material {
            kind: kinds::CONDUCTOR,
            specular: eta.into(),
            extinction: k.into(),
            gloss: width(roughness),
            ..blank
        },
        MaterialKind::Dielectric { ior, dispersion, tint, absorption, roughness, .. } => shaders::Material {
            kind: kinds::DIELECTRIC,
            base: colored_index(ior, dispersion).into(),
            ior,
            tint: tint.into(),
            extinction: absorption.into(),
            gloss: width(roughness),
            ..blank
        },
        MaterialKind::ThinWalled { ior, tint, roughness } => {
            shaders::Material { kind: kinds::THIN_WALLED, ior, tint: tint.into(), gloss: width(roughness), ..blank }
        }
        MaterialKind::Coated { albedo, ior, roughness } => shaders::Material {
            kind: kinds::COATED,
            base: under_coat(albedo, ior).into(),
            ior,
            extinction: [reflectance_from_within(f64::from(ior)) as f32; 3],
            gloss: width(roughness),
            ..blank
        },
        MaterialKind::MetallicRoughness { base_color, reflectance, metallic, roughness } => {
            let f0 = reflectance.lerp(base_color, metallic);
            let average = f0 + (Vec3::ONE - f0) / 21.0;
            // A white metal has no base, and would divide 0 by 0.
            let base = (1.0 - metallic) * base_color / (Vec3::ONE - average).max(Vec3::splat(f32::MIN_POSITIVE));
            shaders::Material {
                kind: kinds::METALLIC_ROUGHNESS,
                base: base.into(),
                specular: f0.into(),
                gloss: width(roughness),
                ..blank
            }
        }
    }
}

/// What `shaders/texture/surface.wgsl` derives the rest from at every point: colour, roughness and share of metal as they are.
fn before_pictures(kind: &MaterialKind) -> shaders::Material {
    let derived = scattering(kind);
    match *kind {
        MaterialKind::Conductor { roughness, .. }
        | MaterialKind::Dielectric { roughness, .. }
        | MaterialKind::ThinWalled { roughness, .. } => shaders::Material { gloss: roughness, ..derived },
        MaterialKind::Coated { albedo, roughness, .. } => {
            shaders::Material { base: albedo.into(), gloss: roughness, ..derived }
        }
        MaterialKind::MetallicRoughness { base_color, reflectance, metallic, roughness } => shaders::Material {
            base: base_color.into(),
            specular: reflectance.into(),
            extinction: [metallic; 3],
            gloss: roughness,
            ..derived
        },
        MaterialKind::Diffuse { .. } | MaterialKind::Phong { .. } | MaterialKind::Mirror { .. } => derived,
    }
}

/// Width α of the microfacets' distribution; 0 for a smooth surface.
fn width(roughness: f32) -> f32 {
    if roughness < SMOOTH { 0.0 } else { roughness * roughness }
}

/// ρ* of a base of albedo ρ under a coat: ρ/(n²(1 − ρF_in)).
pub(crate) fn under_coat(albedo: Vec3, ior: f32) -> Vec3 {
    let inside = reflectance_from_within(f64::from(ior)) as f32;
    albedo / (ior * ior * (Vec3::ONE - albedo * inside))
}

/// F_in: what a coat of index n reflects of the light that its base sends out.
fn reflectance_from_within(n: f64) -> f64 {
    1.0 - (1.0 - mean_reflectance(n)) / (n * n)
}

/// 2∫F(μ)μ dμ over 0 … 1: the reflectance from outside for light from everywhere.
pub(crate) fn mean_reflectance(n: f64) -> f64 {
    let step = 1.0 / FRESNEL_STEPS as f64;
    (0..FRESNEL_STEPS)
        .map(|i| {
            let mu = (i as f64 + 0.5) * step;
            2.0 * reflectance(mu, n) * mu * step
        })
        .sum()
}

/// Fresnel reflectance from outside at cosine `mu`.
pub(crate) fn reflectance(mu: f64, n: f64) -> f64 {
    let cos_t = (1.0 - (1.0 - mu * mu) / (n * n)).sqrt();
    let r_s = (mu - n * cos_t) / (mu + n * cos_t);
    let r_p = (n * mu - cos_t) / (n * mu + cos_t);
    0.5 * (r_s * r_s + r_p * r_p)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn textured_surfaces_have_the_constants_of_plain_ones() {
        let after = diacaustic_shaders::CAMERA.source.split("const SMOOTH: f32 = ").nth(1);
        let written = after.and_then(|text| text.split(';').next()).expect("the kernel's constant");
        assert_eq!(written.trim_end_matches('f').parse::<f32>().unwrap(), SMOOTH);
    }

    #[test]
    fn mean_reflectance_of_glass() {
        // 0.0918 for n = 1.5 (Walsh 1926).
        assert!((mean_reflectance(1.5) - 0.0918).abs() < 1e-4, "{}", mean_reflectance(1.5));
        assert!(mean_reflectance(1.0) < 1e-12);
    }

    #[test]
    fn coat_of_index_one_leaves_the_base_alone() {
        assert!(under_coat(Vec3::new(0.2, 0.5, 0.9), 1.0).abs_diff_eq(Vec3::new(0.2, 0.5, 0.9), 1e-6));
    }
}
