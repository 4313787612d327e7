// Equation 2 of the profile `paper`: how much of a ray's energy each of the four nearest texels keeps; docs/paper.md.

/// The weights of the four texels, (x − d)/(3x) with the distance d to each and the sum x of all four, from the bilinear weights there.
fn weights_by_equation_2(bilinear: vec4<f32>) -> vec4<f32> {
    let right = bilinear.y + bilinear.w;
    let below = bilinear.z + bilinear.w;
    let distances = vec4<f32>(
        length(vec2<f32>(right, below)), length(vec2<f32>(1.0 - right, below)), length(vec2<f32>(right, 1.0 - below)),
        length(vec2<f32>(1.0 - right, 1.0 - below)),
    );
    let sum = dot(distances, vec4<f32>(1.0));
    return (sum - distances) / (3.0 * sum);
}
