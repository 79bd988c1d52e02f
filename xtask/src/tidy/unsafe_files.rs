//! `unsafe` is for SIMD kernels, the processor's clock, huge pages, others' libraries and settings that only the C library has: each file that holds any
//! is listed with the test that compares a kernel with its scalar twin, or that sees what the code does.

use super::Finding;
use super::rust_lines::split;
use super::tree::Tree;

/// A file that may hold `unsafe` code.
struct Kernel {
    path: &'static str,
    /// File and function of the test that compares it with the scalar code, or sees its effect.
    twin_test: (&'static str, &'static str),
}

const GRID_TWIN_TEST: (&str, &str) =
    ("crates/photons/src/searches/grid/tests.rs", "vector_kernels_equal_the_scalar_kernel_bit_for_bit");

/// The wide tree's kernels answer the same rays, bits and counts.
const WIDE_TWIN_TEST: (&str, &str) =
    ("crates/accel/src/structures/wide_bvh/tests.rs", "all_kernels_give_the_same_bits_and_the_same_work");

/// So do those of brute force.
const BRUTE_TWIN_TEST: (&str, &str) =
    ("crates/accel/src/structures/brute_force/tests.rs", "all_kernels_give_the_same_bits_and_the_same_work");

/// What another's library reads and writes lies where its headers say.
const EMBREE_TEST: (&str, &str) = ("benches/peers/rays/src/engines/embree.rs", "records_lie_as_in_the_headers");

/// The same of the shim around a C++ library.
const NANOFLANN_TEST: (&str, &str) = ("benches/peers/photons/src/engines/nanoflann.rs", "records_lie_as_in_the_shim");

/// Without the setting memory grows from pass to pass.
const ALLOCATOR_TEST: (&str, &str) = ("crates/cli/tests/memory.rs", "memory_stays_as_predicted_over_many_passes");

/// Arrays hold what was written to them.
const HUGE_TEST: (&str, &str) = ("crates/memory/src/huge_array.rs", "arrays_hold_what_they_were_given");

/// The sieve's kernels find the same runs.
const SIEVE_TWIN_TEST: (&str, &str) =
    ("crates/photons/src/searches/brute_blocked/tests.rs", "all_kernels_find_the_same");

const KERNELS: &[Kernel] = &[
    Kernel { path: "crates/memory/src/huge_array.rs", twin_test: HUGE_TEST },
    Kernel { path: "benches/peers/rays/src/engines/embree.rs", twin_test: EMBREE_TEST },
    Kernel { path: "benches/peers/photons/src/engines/nanoflann.rs", twin_test: NANOFLANN_TEST },
    Kernel { path: "crates/cli/src/allocator.rs", twin_test: ALLOCATOR_TEST },
    Kernel { path: "crates/photons/src/searches/brute_blocked/kernels.rs", twin_test: SIEVE_TWIN_TEST },
    Kernel { path: "crates/photons/src/searches/grid/avx2.rs", twin_test: GRID_TWIN_TEST },
    Kernel { path: "crates/photons/src/searches/grid/avx512.rs", twin_test: GRID_TWIN_TEST },
    Kernel { path: "crates/photons/src/searches/grid/shared/avx2.rs", twin_test: GRID_TWIN_TEST },
    Kernel { path: "crates/photons/src/searches/grid/shared/avx512.rs", twin_test: GRID_TWIN_TEST },
    Kernel { path: "crates/accel/src/structures/brute_force/kernels/avx2.rs", twin_test: BRUTE_TWIN_TEST },
    Kernel { path: "crates/accel/src/structures/brute_force/kernels/avx512.rs", twin_test: BRUTE_TWIN_TEST },
    Kernel { path: "crates/accel/src/structures/wide_bvh/kernels/avx2.rs", twin_test: WIDE_TWIN_TEST },
    Kernel { path: "crates/accel/src/structures/wide_bvh/kernels/avx512.rs", twin_test: WIDE_TWIN_TEST },
    Kernel { path: "crates/accel/src/structures/wide_bvh/kernels/eight.rs", twin_test: WIDE_TWIN_TEST },
    Kernel { path: "crates/accel/src/structures/wide_bvh/kernels/four.rs", twin_test: WIDE_TWIN_TEST },
    Kernel { path: "crates/accel/src/structures/wide_bvh/kernels/sixteen/avx2.rs", twin_test: WIDE_TWIN_TEST },
    Kernel { path: "crates/accel/src/structures/wide_bvh/kernels/sixteen/avx512.rs", twin_test: WIDE_TWIN_TEST },
    Kernel {
        path: "crates/profile/src/ticks.rs",
        twin_test: ("crates/profile/src/ticks.rs", "ticks_run_as_fast_as_the_clock"),
    },
];

/// Checks the list against the sources, both ways.
pub fn check(tree: &Tree) -> Vec<Finding> {
    check_against(tree, KERNELS)
}

fn check_against(tree: &Tree, kernels: &[Kernel]) -> Vec<Finding> {
    let mut findings = Vec::new();
    for file in tree.rust() {
        let first = split(&file.text).iter().position(|line| has_unsafe(&line.code));
        if let Some(line) = first
            && !kernels.iter().any(|kernel| kernel.path == file.path)
        {
            findings.push(Finding::new(&file.path, line + 1, "`unsafe` in a file that is not in KERNELS"));
        }
    }
    for kernel in kernels {
        let has_any = tree.file(kernel.path).is_some_and(|file| split(&file.text).iter().any(|l| has_unsafe(&l.code)));
        if !has_any {
            findings.push(Finding::new(kernel.path, 0, "in KERNELS, without `unsafe` code: take it off"));
        }
        let (path, test) = kernel.twin_test;
        let declared = format!("fn {test}(");
        let exists = tree.file(path).is_some_and(|file| split(&file.text).iter().any(|l| l.code.contains(&declared)));
        if !exists {
            findings.push(Finding::new(kernel.path, 0, format!("its twin test {path}: {test} does not exist")));
        }
    }
    findings
}

/// Whether code holds the word, as something other than a lint's name.
fn has_unsafe(code: &str) -> bool {
    code.match_indices("unsafe").any(|(at, word)| {
        let part_of_name = |c: char| c.is_alphanumeric() || c == '_';
        !code[..at].ends_with(part_of_name) && !code[at + word.len()..].starts_with(part_of_name)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const KERNEL: &[Kernel] = &[Kernel { path: "k.rs", twin_test: ("t.rs", "same_bits") }];
    const CODE: (&str, &str) = ("k.rs", "fn f() { unsafe { g() } }\n");
    const TEST: (&str, &str) = ("t.rs", "#[test]\nfn same_bits() {}\n");

    fn count(files: &[(&str, &str)], kernels: &[Kernel]) -> usize {
        check_against(&Tree::of(files), kernels).len()
    }

    #[test]
    fn the_list_and_the_sources_must_agree() {
        assert_eq!(count(&[CODE, TEST], KERNEL), 0);
        assert_eq!(count(&[CODE, TEST], &[]), 1, "unlisted");
        assert_eq!(count(&[CODE], KERNEL), 1, "no twin test");
        assert_eq!(count(&[("k.rs", "fn f() {}\n"), TEST], KERNEL), 1, "nothing unsafe left");
        assert_eq!(count(&[("a.rs", "#![forbid(unsafe_code)]\n// unsafe\n")], &[]), 0, "words only");
    }
}
