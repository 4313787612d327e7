//! KHR_animation_pointer: animations of numbers anywhere in the file, which are set in its JSON before that is read.

use std::collections::BTreeMap;

use gltf_json::{Root, accessor::Type};
use serde_json::{Map, Value, json};

use super::{
    animations::chosen,
    buffers::Buffers,
    curves::{CurveReader, KeysLeft},
    fault::{Fault, Result, entry, place, shortened},
    options::GltfOptions,
};

pub(super) const EXTENSION: &str = "KHR_animation_pointer";

/// Ranges of numbers, to which splines are held that swing beyond.
const ANY: [f32; 2] = [f32::MIN, f32::MAX];
const POSITIVE: [f32; 2] = [0.0, f32::MAX];
const SHARE: [f32; 2] = [0.0, 1.0];

/// What can be animated: a pointer, where a star is any index, how many numbers it has (0 for any number of them), and their range.
const PROPERTIES: [(&str, usize, [f32; 2]); 29] = [
    ("/nodes/*/translation", 3, ANY),
    ("/nodes/*/rotation", 4, ANY),
    ("/nodes/*/scale", 3, ANY),
    ("/nodes/*/weights", 0, ANY),
    ("/meshes/*/weights", 0, ANY),
    ("/cameras/*/perspective/yfov", 1, POSITIVE),
    ("/cameras/*/perspective/aspectRatio", 1, POSITIVE),
    ("/extensions/KHR_lights_punctual/lights/*/color", 3, POSITIVE),
    ("/extensions/KHR_lights_punctual/lights/*/intensity", 1, POSITIVE),
    ("/extensions/KHR_lights_punctual/lights/*/spot/innerConeAngle", 1, POSITIVE),
    ("/extensions/KHR_lights_punctual/lights/*/spot/outerConeAngle", 1, POSITIVE),
    ("/materials/*/alphaCutoff", 1, POSITIVE),
    ("/materials/*/emissiveFactor", 3, POSITIVE),
    ("/materials/*/normalTexture/scale", 1, ANY),
    ("/materials/*/pbrMetallicRoughness/baseColorFactor", 4, SHARE),
    ("/materials/*/pbrMetallicRoughness/metallicFactor", 1, SHARE),
    ("/materials/*/pbrMetallicRoughness/roughnessFactor", 1, SHARE),
    ("/materials/*/extensions/KHR_materials_emissive_strength/emissiveStrength", 1, POSITIVE),
    ("/materials/*/extensions/KHR_materials_ior/ior", 1, POSITIVE),
    ("/materials/*/extensions/KHR_materials_transmission/transmissionFactor", 1, SHARE),
    ("/materials/*/extensions/KHR_materials_volume/thicknessFactor", 1, POSITIVE),
    ("/materials/*/extensions/KHR_materials_volume/attenuationDistance", 1, POSITIVE),
    ("/materials/*/extensions/KHR_materials_volume/attenuationColor", 3, SHARE),
    ("/materials/*/extensions/KHR_materials_dispersion/dispersion", 1, POSITIVE),
    ("/materials/*/extensions/KHR_materials_clearcoat/clearcoatFactor", 1, SHARE),
    ("/materials/*/extensions/KHR_materials_clearcoat/clearcoatRoughnessFactor", 1, SHARE),
    ("/materials/*/extensions/KHR_materials_specular/specularFactor", 1, SHARE),
    ("/materials/*/extensions/KHR_materials_specular/specularColorFactor", 3, POSITIVE),
    ("/materials/*/occlusionTexture/strength", 1, ANY),
];

/// The same of the transform of any picture of a material.
const TRANSFORMS: [(&str, usize, [f32; 2]); 3] = [
    ("/extensions/KHR_texture_transform/offset", 2, ANY),
    ("/extensions/KHR_texture_transform/scale", 2, ANY),
    ("/extensions/KHR_texture_transform/rotation", 1, ANY),
];

/// The channels of a file's animations that have pointers for targets.
#[derive(Default)]
pub(super) struct Pointers {
    /// The file's JSON; null without such channels.
    document: Value,
    /// The pointers, by the numbers of their animations and channels.
    channels: BTreeMap<(usize, usize), String>,
}

impl Pointers {
    /// Finds the channels, and gives them targets that the format without the extension allows; returns the JSON with those.
    pub(super) fn take(json: &[u8]) -> Option<(Self, Vec<u8>)> {
        let text = std::str::from_utf8(json).ok().filter(|text| text.contains(EXTENSION))?;
        let mut document: Value = serde_json::from_str(text).ok()?;
        let mut channels = BTreeMap::new();
        let animations = document.get_mut("animations").and_then(Value::as_array_mut);
        for (animation, entry) in animations.into_iter().flatten().enumerate() {
            let list = entry.get_mut("channels").and_then(Value::as_array_mut);
            for (channel, entry) in list.into_iter().flatten().enumerate() {
                let Some(target) = entry.get_mut("target").filter(|target| target["path"] == "pointer") else {
                    continue;
                };
                let pointer = target["extensions"][EXTENSION]["pointer"].as_str().unwrap_or_default().to_owned();
                channels.insert((animation, channel), pointer);
                *target = json!({ "node": 0, "path": "pointer" });
            }
        }
        let json = document.to_string().into_bytes();
        Some((Self { document, channels }, json))
    }

    /// Whether a channel has a pointer for a target.
    pub(super) fn has(&self, animation: usize, channel: usize) -> bool {
        self.channels.contains_key(&(animation, channel))
    }

    /// The file's lists with what pointers set at the time that the options name, with what they cannot set; none at rest.
    pub(super) fn posed(
        &self,
        root: &Root,
        buffers: &Buffers<'_>,
        options: &GltfOptions,
    ) -> Result<Option<(Root, Vec<Fault>)>> {
        if self.channels.is_empty() {
            return Ok(None);
        }
        let Some((index, animation, time)) = chosen(root, options)? else { return Ok(None) };
        let mut document = self.document.clone();
        let mut warnings = Vec::new();
        let mut keys_left = KeysLeft::all();
        let animation_place = place("animations", index, animation.name.as_deref());
        for ((_, channel), pointer) in self.channels.range((index, 0)..(index + 1, 0)) {
            let place = format!("{animation_place}.channels[{channel}]");
            let Some((count, range)) = property(pointer) else {
                let pointer = shortened(pointer);
                warnings.push(Fault::new(
                    place,
                    format!("animates {pointer:?}, which is not supported; it stays as it is"),
                ));
                continue;
            };
            let source = entry(&animation.channels, "channels", *channel, &place)?;
            let sampler = entry(&animation.samplers, "samplers", source.sampler.value(), &place)?;
            keys_left.take(root, sampler, &place)?;
            let curves = CurveReader { root, buffers, sampler, place: &place };
            let numbers = value(&curves, pointer, count, range, time)?;
            if !set(&mut document, pointer, numbers) {
                let pointer = shortened(pointer);
                warnings.push(Fault::new(
                    place,
                    format!("animates {pointer:?}, which the file does not have or which is fixed"),
                ));
            }
        }
        let posed = Root::from_slice(document.to_string().as_bytes());
        let posed =
            posed.map_err(|error| Fault::new(animation_place, format!("does not leave valid glTF: {error}")))?;
        Ok(Some((posed, warnings)))
    }
}

/// How many numbers a pointer names, and their range.
fn property(pointer: &str) -> Option<(usize, [f32; 2])> {
    let matches = |pattern: &str| {
        let mut segments = pointer.split('/');
        let is_index = |segment: &str| !segment.is_empty() && segment.bytes().all(|byte| byte.is_ascii_digit());
        let alike = pattern.split('/').all(|wanted| {
            segments.next().is_some_and(|segment| if wanted == "*" { is_index(segment) } else { segment == wanted })
        });
        alike && segments.next().is_none()
    };
    let of_material = pointer.starts_with("/materials/");
    let plain = PROPERTIES.iter().find(|(pattern, ..)| matches(pattern));
    let found = plain.or_else(|| TRANSFORMS.iter().find(|(end, ..)| of_material && pointer.ends_with(end)));
    found.map(|(_, count, range)| (*count, *range))
}

/// What is to stand at a pointer at a time.
fn value(curves: &CurveReader<'_, '_>, pointer: &str, count: usize, range: [f32; 2], time: f32) -> Result<Value> {
    let kind = match count {
        2 => Type::Vec2,
        3 => Type::Vec3,
        4 => Type::Vec4,
        _ => Type::Scalar,
    };
    let curve = curves.curve(kind)?;
    if pointer.ends_with("/rotation") && count == 4 {
        return Ok(json!(curve.rotation(time)?.to_array()));
    }
    let numbers: Vec<_> = curve.numbers(time)?.iter().map(|number| number.clamp(range[0], range[1])).collect();
    match (count, numbers.as_slice()) {
        (1, [number]) => Ok(json!(number)),
        (1, _) => Err(Fault::new(curves.place, format!("has {} values a key frame for one number", numbers.len()))),
        _ => Ok(json!(numbers)),
    }
}

/// Sets a value at a pointer; objects on the way to it that an entry of a list leaves out are made. False if there is no such place.
fn set(document: &mut Value, pointer: &str, value: Value) -> bool {
    let Some((way, key)) = pointer.trim_start_matches('/').rsplit_once('/') else { return false };
    let mut place = document;
    let mut is_in_entry = false;
    for segment in way.split('/') {
        place = match place {
            Value::Array(list) => {
                is_in_entry = true;
                let Some(entry) = segment.parse().ok().and_then(|index: usize| list.get_mut(index)) else {
                    return false;
                };
                entry
            }
            // A picture that a material does not have cannot be moved.
            Value::Object(object)
                if !object.contains_key(segment) && (!is_in_entry || segment.ends_with("Texture")) =>
            {
                return false;
            }
            Value::Object(object) => object.entry(segment).or_insert_with(|| Value::Object(Map::new())),
            _ => return false,
        };
    }
    let Value::Object(object) = place else { return false };
    // A matrix stands for all of a node's transform.
    if way.starts_with("nodes/") && key != "weights" && object.contains_key("matrix") {
        return false;
    }
    object.insert(key.to_owned(), value);
    true
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pointers_name_what_is_known() {
        assert_eq!(property("/nodes/12/rotation"), Some((4, ANY)));
        assert_eq!(property("/materials/0/pbrMetallicRoughness/baseColorFactor"), Some((4, SHARE)));
        let transform = "/materials/0/pbrMetallicRoughness/baseColorTexture/extensions/KHR_texture_transform/offset";
        assert_eq!(property(transform), Some((2, ANY)));
        for unknown in ["", "/", "/nodes/x/rotation", "/nodes/0/rotation/0", "/nodes/0/children", "/nodes//rotation"] {
            assert_eq!(property(unknown), None, "{unknown}");
        }
    }

    #[test]
    fn values_are_set_where_there_is_a_place() {
        let mut document = json!({ "materials": [{}], "nodes": [{ "matrix": [] }, {}] });
        assert!(set(&mut document, "/materials/0/extensions/KHR_materials_ior/ior", json!(1.4)));
        assert_eq!(document["materials"][0]["extensions"]["KHR_materials_ior"]["ior"], 1.4);
        assert!(set(&mut document, "/nodes/1/scale", json!([1, 1, 1])));
        for nowhere in
            ["/nodes/0/scale", "/nodes/2/scale", "/materials/0/normalTexture/scale", "/materials/x/ior", "/cameras/0/a"]
        {
            assert!(!set(&mut document, nowhere, json!(1)), "{nowhere}");
        }
    }
}
