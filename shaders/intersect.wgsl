// Answers ray queries: what the application, tests and benchmarks ask of the scene's triangles.

import package::geometry::traverse::trace;
import package::layout::intersect_pass::{query_hits, query_rays, QueryHit};

@compute @workgroup_size(64)
fn intersect_rays(@builtin(global_invocation_id) invocation: vec3<u32>) {
    let index = invocation.x;
    if index >= arrayLength(&query_rays) {
        return;
    }
    let ray = query_rays[index];
    let hit = trace(ray.origin, ray.direction, ray.t_max, ray.any_hit != 0u);
    query_hits[index] = QueryHit(hit.triangle, hit.t, hit.barycentric.x, hit.barycentric.y);
}
