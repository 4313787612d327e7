// Start-up self-test: does the adapter run a loop to its end? Some drivers cut loops short without an error.

/// Iterations to run, then those that ran.
@group(0) @binding(0) var<storage, read_write> iterations: array<u32, 2>;

@compute @workgroup_size(1)
fn count_iterations() {
    var state = 1u;
    var count = 0u;
    while count < iterations[0] {
        // A generator step keeps compilers from replacing the loop by its result.
        state = state * 1664525u + 1013904223u;
        count += 1u + (state >> 31u) - (state >> 31u);
    }
    iterations[1] = count;
}
