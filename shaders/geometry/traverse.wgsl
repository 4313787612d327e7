// Rays against the scene's triangles: eight-wide compressed BVH (Ylitie, Karras and Laine 2017).

import package::layout::features::has_holes;
import package::layout::records::{load_node, load_triangle};
import package::layout::scene::{BvhNode, NONE, TRIANGLE_HAS_HOLES};
import package::texture::opacity::{passes, ray_seed};

/// Entries of the traversal stack; the host refuses a deeper tree.
const STACK_SIZE: u32 = 24u;
/// Bits of a group that stand for inner children still to visit.
const INNER_BITS: u32 = 0xff000000u;

/// Groups to come back to. Not local to `trace`, where it would be cleared for every ray.
var<private> stack: array<vec2<u32>, STACK_SIZE>;

/// The nearest triangle along a ray.
struct Hit {
    /// Index of the triangle, or NONE.
    triangle: u32,
    /// Distance along the ray, metres.
    t: f32,
    /// Barycentric weights of the second and third corner.
    barycentric: vec2<f32>,
}

/// A ray as the box tests need it.
struct BoxRay {
    origin: vec3<f32>,
    /// 1 / direction, finite.
    inverse: vec3<f32>,
    /// 7 − the ray's octant, in each of four bytes: the order in which children are visited.
    octant: u32,
}

fn box_ray(origin: vec3<f32>, direction: vec3<f32>) -> BoxRay {
    let tiny = select(vec3<f32>(1e-20), vec3<f32>(-1e-20), direction < vec3<f32>(0.0));
    let safe = select(direction, tiny, abs(direction) < vec3<f32>(1e-20));
    let backward = safe < vec3<f32>(0.0);
    let octant = select(0x04040404u, 0u, backward.x) | select(0x02020202u, 0u, backward.y) | select(0x01010101u, 0u, backward.z);
    return BoxRay(origin, 1.0 / safe, octant);
}

/// Near and far planes of four children along one axis.
struct Planes {
    near: vec4<f32>,
    far: vec4<f32>,
}

fn planes(low: u32, high: u32, scale: f32, offset: f32) -> Planes {
    let backward = scale < 0.0;
    // Signed, for processors convert signed integers in one instruction.
    let near = vec4<f32>(vec4<i32>(unpack4xU8(select(low, high, backward))));
    let far = vec4<f32>(vec4<i32>(unpack4xU8(select(high, low, backward))));
    return Planes(near * scale + offset, far * scale + offset);
}

/// Units in the last place by which a box's exit is put off.
const ROUNDING: i32 = 6;

/// Floats as integers of the same order, where they are not negative.
fn order(value: vec4<f32>) -> vec4<i32> {
    return bitcast<vec4<i32>>(value);
}

/// Which of four children the ray meets before `t_max`, as bits of a node's hit mask.
fn meet_four(x: Planes, y: Planes, z: Planes, descriptions: u32, octant: u32, t_max: f32) -> u32 {
    // The bits of floats that are not negative order like integers, and integers have minima and maxima that need no care for
    // NaN. A negative entry becomes 0; a negative exit stays negative, which misses.
    let enter = max(max(order(x.near), order(y.near)), max(order(z.near), vec4<i32>(0)));
    // Some units in the last place cover the rounding of the planes' distances, so that no ray slips between two boxes.
    let leave = min(min(order(x.far), order(y.far)), min(order(z.far), order(vec4<f32>(t_max)))) + ROUNDING;
    let inner = (descriptions & (descriptions << 1u)) & 0x10101010u;
    let inner_mask = (inner >> 4u) * 0xffu;
    let places = unpack4xU8((descriptions ^ (octant & inner_mask)) & 0x1f1f1f1fu);
    let bits = unpack4xU8((descriptions >> 5u) & 0x07070707u);
    let met = select(vec4<u32>(0u), bits << places, enter <= leave);
    return met.x | met.y | met.z | met.w;
}

/// Hit mask of a node's eight children: inner ones in the high byte, nearest first, triangles in the low three.
fn meet_children(node: BvhNode, ray: BoxRay, t_max: f32) -> u32 {
    let exponents = vec3<u32>(node.grid.w, node.grid.w >> 8u, node.grid.w >> 16u) & vec3<u32>(0xffu);
    let scale = bitcast<vec3<f32>>(exponents << vec3<u32>(23u)) * ray.inverse;
    let offset = (bitcast<vec3<f32>>(node.grid.xyz) - ray.origin) * ray.inverse;
    let first = meet_four(
        planes(node.planes_x.x, node.planes_x.z, scale.x, offset.x),
        planes(node.planes_y.x, node.planes_y.z, scale.y, offset.y),
        planes(node.planes_z.x, node.planes_z.z, scale.z, offset.z),
        node.children.z, ray.octant, t_max,
    );
    let second = meet_four(
        planes(node.planes_x.y, node.planes_x.w, scale.x, offset.x),
        planes(node.planes_y.y, node.planes_y.w, scale.y, offset.y),
        planes(node.planes_z.y, node.planes_z.w, scale.z, offset.z),
        node.children.w, ray.octant, t_max,
    );
    return first | second;
}

/// A triangle against a ray (Möller and Trumbore 1997); `nearest` if it is missed or farther. `seed` decides about holes.
fn meet_triangle(index: u32, origin: vec3<f32>, direction: vec3<f32>, seed: u32, nearest: Hit) -> Hit {
    let triangle = load_triangle(index);
    let p = cross(direction, triangle.edge_2);
    let inverse = 1.0 / dot(triangle.edge_1, p);
    let s = origin - triangle.corner;
    let u = dot(s, p) * inverse;
    let q = cross(s, triangle.edge_1);
    let v = dot(direction, q) * inverse;
    let t = dot(triangle.edge_2, q) * inverse;
    let is_nearer = u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t > 0.0 && t < nearest.t;
    if has_holes && is_nearer && (triangle.flags & TRIANGLE_HAS_HOLES) != 0u {
        if passes(seed, index, triangle.material, vec2<f32>(u, v)) {
            return nearest;
        }
    }
    if is_nearer {
        return Hit(index, t, vec2<f32>(u, v));
    }
    return nearest;
}

/// The nearest triangle before `t_max`, or with `any_hit` the first one found.
fn trace(origin: vec3<f32>, direction: vec3<f32>, t_max: f32, any_hit: bool) -> Hit {
    let ray = box_ray(origin, direction);
    var hit = Hit(NONE, t_max, vec2<f32>(0.0));
    var seed = 0u;
    if has_holes {
        seed = ray_seed(origin, direction);
    }
    var depth = 0u;
    // Inner children to visit (first child, hit bits and inner mask), and triangles to test (first triangle, hit bits).
    var group = vec2<u32>(0u, 0x80000000u);
    loop {
        var leaves = vec2<u32>(0u);
        if group.y >= 0x01000000u {
            let bit = firstLeadingBit(group.y);
            let slot = (bit - 24u) ^ (ray.octant & 0xffu);
            let place = countOneBits(group.y & ((1u << slot) - 1u));
            group.y &= ~(1u << bit);
            let child = group.x + place;
            if group.y >= 0x01000000u {
                stack[depth] = group;
                depth += 1u;
            }
            let node = load_node(child);
            let met = meet_children(node, ray, hit.t);
            group = vec2<u32>(node.children.x, (met & INNER_BITS) | (node.grid.w >> 24u));
            leaves = vec2<u32>(node.children.y, met & ~INNER_BITS);
        }
        while leaves.y != 0u {
            let bit = firstTrailingBit(leaves.y);
            leaves.y &= leaves.y - 1u;
            hit = meet_triangle(leaves.x + bit, origin, direction, seed, hit);
        }
        if any_hit && hit.triangle != NONE {
            break;
        }
        if group.y < 0x01000000u {
            if depth == 0u {
                break;
            }
            depth -= 1u;
            group = stack[depth];
        }
    }
    return hit;
}
