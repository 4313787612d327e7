// What the data layers keep of the first surface that a path meets; docs/layers.md.

import package::bsdf::albedo::albedo;
import package::film::layers::add_to_data_layers;
import package::layout::path_pass::{data_layers, path_params};
import package::layout::scene::Triangle;
import package::path::state::Path;
import package::path::vertex::Vertex;

/// Keeps the first surface that a path meets.
fn keep_first_surface(path: ptr<function, Path>, position: vec3<f32>, normal: vec3<f32>, albedo: vec3<f32>) {
    let depth = dot(position - path_params.position, path_params.forward);
    add_to_data_layers((*path).pixel, position, depth, normal, albedo);
    (*path).has_first_surface = true;
}

/// Keeps a vertex, if it is the path's first, and of the pixel's first sample what it is of.
fn keep_first_vertex(path: ptr<function, Path>, vertex: Vertex, triangle: Triangle) {
    if (*path).has_first_surface {
        return;
    }
    let cosine = -dot((*path).direction, vertex.point.n_s);
    keep_first_surface(path, vertex.point.position, vertex.point.n_s, albedo(vertex.material, cosine, vertex.sides));
    if path_params.sample_index == 0u {
        data_layers[(*path).pixel].object = triangle.object + 1u;
        data_layers[(*path).pixel].material = triangle.material + 1u;
    }
}
