// Bind groups 1 and 2 of the pass that answers ray queries.

/// A ray asked about.
struct QueryRay {
    /// Origin, metres, world frame.
    origin: vec3<f32>,
    /// How far it goes, metres.
    t_max: f32,
    /// Unit direction.
    direction: vec3<f32>,
    /// 1 if any triangle will do, 0 for the nearest.
    any_hit: u32,
}

/// What a ray met.
struct QueryHit {
    /// Index of the triangle in the order of the hierarchy's leaves, or NONE.
    triangle: u32,
    /// Distance along the ray, metres.
    t: f32,
    /// Barycentric weight of the second corner.
    barycentric_1: f32,
    /// Barycentric weight of the third corner.
    barycentric_2: f32,
}

@group(1) @binding(0) var<storage, read> query_rays: array<QueryRay>;
@group(2) @binding(0) var<storage, read_write> query_hits: array<QueryHit>;
