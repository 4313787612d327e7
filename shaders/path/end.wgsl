// Where a path ends: on a sphere that shines, or beyond the scene.

import package::emitter::sky::{light_probability, sky_light_radiance, sky_radiance};
import package::emitter::sphere::SphereHit;
import package::film::layers::{add_to_group, add_to_layer, add_to_no_group};
import package::layout::features::{has_data_layers, has_distant_lights, has_light_layers, light_group_count};
import package::layout::path_pass::{path_params, LAYER_EMISSION};
import package::layout::records::{load_light, load_light_group};
import package::medium::media::transmittance;
import package::path::first_surface::keep_first_surface;
import package::path::state::{add_light, layer_at_receiver, Path};
import package::sampling::warp::{cone_height, PI};
import package::spectrum::wavelength::at_wavelength;

/// Lets a path end on a sphere that shines.
fn meet_sphere(path: ptr<function, Path>, sphere: SphereHit) {
    (*path).goes_on = false;
    let light = load_light(sphere.light);
    let solid_angle = 2.0 * PI * cone_height(light.extent / distance((*path).origin, light.position));
    let pdf = (*path).lobe_pdf;
    let weight = select(1.0, pdf / (pdf + light_probability(sphere.light) / solid_angle), pdf > 0.0);
    let strength = at_wavelength(light.strength, (*path).wavelength);
    let seen = (*path).beta * transmittance((*path).media, sphere.t, (*path).wavelength) * strength * weight;
    add_light(path, load_light_group(sphere.light), select(seen, vec3<f32>(0.0), (*path).lights_counted));
    if has_data_layers && !(*path).has_first_surface {
        let position = (*path).origin + sphere.t * (*path).direction;
        keep_first_surface(path, position, normalize(position - light.position), vec3<f32>(0.0));
    }
}

/// Adds what lights that are infinitely far send to their groups.
fn add_sky_of_groups(path: ptr<function, Path>) {
    let end = select(0u, path_params.light_count, light_group_count > 0u && has_distant_lights);
    for (var i = path_params.first_sky_light; i < end; i++) {
        let radiance = sky_light_radiance(i, (*path).direction, (*path).lobe_pdf);
        add_to_group((*path).pixel, load_light_group(i), (*path).beta * at_wavelength(radiance, (*path).wavelength));
    }
}

/// Lets a path leave the scene.
fn meet_sky(path: ptr<function, Path>) {
    (*path).goes_on = false;
    var beyond = path_params.background;
    var sky = vec3<f32>(0.0);
    if !(*path).lights_counted {
        sky = sky_radiance(path_params.first_sky_light, path_params.light_count, (*path).direction, (*path).lobe_pdf);
        beyond += sky;
        add_sky_of_groups(path);
    }
    (*path).radiance += (*path).beta * at_wavelength(beyond, (*path).wavelength);
    add_to_no_group((*path).pixel, (*path).beta * at_wavelength(path_params.background, (*path).wavelength));
    if has_light_layers {
        // Next-event estimation knows nothing of the background, which lights receivers as what bounces does.
        let of_background = layer_at_receiver(path, LAYER_EMISSION);
        add_to_layer((*path).pixel, of_background, (*path).beta * at_wavelength(path_params.background, (*path).wavelength));
        add_to_layer((*path).pixel, (*path).layer, (*path).beta * at_wavelength(sky, (*path).wavelength));
    }
}
