//! `diacaustic inspect`: what a scene holds.

use diacaustic::{
    Renderer, SceneReport,
    glam::Vec3,
    scene::{LightKind, LoadedScene, Material, MaterialKind, Object, Scene},
    wgpu::AdapterInfo,
};
use diacaustic_headless::adapters;

use crate::{Error, device::DeviceArguments, print, progress::Metric, scene_arguments::SceneArguments};

/// What `inspect` takes.
#[derive(Clone, Debug, PartialEq, clap::Args)]
pub struct InspectArguments {
    /// The scene.
    #[command(flatten)]
    pub scene: SceneArguments,

    /// The device.
    #[command(flatten)]
    pub device: DeviceArguments,
}

/// Prints on the standard output what the scene holds, what it needs on a device and which devices there are. Needs none.
///
/// # Errors
/// If the scene cannot be read or the text cannot be written.
pub fn run(arguments: &InspectArguments) -> Result<(), Error> {
    let LoadedScene { scene, warnings } = arguments.scene.load()?;
    let mut text = describe(&scene);
    text.extend(describe_needs(&scene, &Renderer::dry_run(&scene, &arguments.device.renderer_options())?));
    text.extend(describe_adapters());
    for warning in &warnings {
        text.push(format!("warning: {warning}"));
    }
    print((text.join("\n") + "\n").as_bytes())
}

fn describe(scene: &Scene) -> Vec<String> {
    let settings = &scene.settings;
    let mut lines = vec![
        format!(
            "picture: {} × {}, {} samples, {} photons, target error {}, seed {}",
            settings.width,
            settings.height,
            settings.samples.map_or("open".to_owned(), |samples| samples.to_string()),
            settings.photons.map_or("open".to_owned(), |photons| photons.to_string()),
            settings.target_error,
            settings.seed
        ),
        format!(
            "objects: {}, with {} triangles",
            scene.objects.len(),
            scene.objects.iter().map(triangles).sum::<usize>()
        ),
    ];
    lines.extend(scene.objects.iter().map(|object| describe_object(scene, object)));
    lines.push(format!("materials: {}", scene.materials.len()));
    lines.extend(scene.materials.iter().map(describe_material));
    lines.push(format!("lights: {}", scene.lights.len()));
    lines.extend(scene.lights.iter().map(|light| format!("  {}: {}", light.name, describe_light(&light.kind))));
    lines
}

/// What the scene would take on a device.
fn describe_needs(scene: &Scene, built: &SceneReport) -> Vec<String> {
    let maps = built.maps.iter().map(|map| {
        let object = &scene.objects[map.object];
        let size = match object.map_size.or(scene.settings.map_size) {
            Some(_) => format!("{} × {} texels", map.width, map.height),
            None => "texels as fine as the camera sees them".to_owned(),
        };
        let sides = if map.layers > 1 { ", both sides" } else { "" };
        format!("  {}: {size}{sides}", object.name)
    });
    let is_open = built.maps.iter().any(|map| scene.objects[map.object].map_size.or(scene.settings.map_size).is_none());
    let most = if is_open { " at most" } else { "" };
    let bytes = Metric(built.device_bytes as f64);
    let plural = if built.maps.len() == 1 { "" } else { "s" };
    let counts = format!("{} nodes of a hierarchy, {} energy map{plural}", built.bvh_nodes, built.maps.len());
    [format!("on a device: {bytes}B{most}, {counts}")].into_iter().chain(maps).collect()
}

fn describe_adapters() -> Vec<String> {
    let found = adapters();
    let adapter = |(number, info): (usize, &AdapterInfo)| {
        format!("  {number}: {} ({}, {})", info.name, info.backend.to_str(), info.driver_info)
    };
    [format!("adapters: {}", found.len())].into_iter().chain(found.iter().enumerate().map(adapter)).collect()
}

fn triangles(object: &Object) -> usize {
    object.mesh.triangles.len()
}

fn describe_object(scene: &Scene, object: &Object) -> String {
    let [low, high] = extent(object);
    let size = high - low;
    let edges = match object.mesh.open_edges() {
        0 => "closed".to_owned(),
        1 => "1 open edge".to_owned(),
        count => format!("{count} open edges"),
    };
    let materials: Vec<_> = object.materials.iter().map(|&index| scene.materials[index].name.as_str()).collect();
    let count = triangles(object);
    format!(
        "  {}: {count} triangles, {edges}, {:.4} × {:.4} × {:.4} m around [{:.4}, {:.4}, {:.4}]; {}",
        object.name,
        size.x,
        size.y,
        size.z,
        0.5 * (low.x + high.x),
        0.5 * (low.y + high.y),
        0.5 * (low.z + high.z),
        materials.join(", ")
    )
}

/// The corners of the box around an object, world frame.
fn extent(object: &Object) -> [Vec3; 2] {
    let world = object.mesh.positions.iter().map(|&position| object.world_from_object.transform_point3(position));
    world.fold([Vec3::INFINITY, Vec3::NEG_INFINITY], |[low, high], point| [low.min(point), high.max(point)])
}

fn describe_material(material: &Material) -> String {
    let kind = match &material.kind {
        MaterialKind::Diffuse { .. } => "diffuse".to_owned(),
        MaterialKind::Phong { .. } => "phong".to_owned(),
        MaterialKind::Mirror { .. } => "mirror".to_owned(),
        MaterialKind::Conductor { .. } => "conductor".to_owned(),
        MaterialKind::Dielectric { ior, .. } => format!("dielectric, index {ior}"),
        MaterialKind::ThinWalled { ior, .. } => format!("thin-walled, index {ior}"),
        MaterialKind::Coated { ior, .. } => format!("coated, index {ior}"),
        MaterialKind::MetallicRoughness { .. } => "metallic_roughness".to_owned(),
    };
    let role = match (material.is_caster(), material.is_receiver()) {
        (true, true) => "casts light on and receives it",
        (true, false) => "casts light on",
        (false, _) => "receives light",
    };
    let shines = if material.is_emissive() { ", shines" } else { "" };
    let blend = if material.blend.is_some() { ", in part another material" } else { "" };
    format!("  {}: {kind}{blend}; {role}{shines}", material.name)
}

fn describe_light(kind: &LightKind) -> String {
    let [r, g, b] = kind.strength().to_array();
    match kind {
        LightKind::Sphere { radius, flux, .. } => format!("sphere of radius {radius} m, {flux} W"),
        LightKind::Rectangle { edge_u, edge_v, flux, .. } => {
            format!("rectangle of {} × {} m, {flux} W", edge_u.length(), edge_v.length())
        }
        LightKind::Disk { radius, flux, .. } => format!("disk of radius {radius} m, {flux} W"),
        LightKind::Point { flux, .. } => format!("point, {flux} W"),
        LightKind::Spot { inner_angle, outer_angle, flux, .. } => {
            format!("spot from {inner_angle}° to {outer_angle}°, {flux} W")
        }
        LightKind::Distant { angular_radius, irradiance, .. } if *angular_radius > 0.0 => {
            format!("disc in the sky of radius {angular_radius}°, {irradiance} W/m²")
        }
        LightKind::Distant { irradiance, .. } => format!("parallel light, {irradiance} W/m²"),
        LightKind::Environment { .. } => format!("environment, scaled by [{r}, {g}, {b}]"),
    }
}
