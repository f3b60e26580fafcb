//! Machine code of kernels: operations of vectors are instructions, not functions.
#![cfg(all(target_arch = "x86_64", not(debug_assertions)))]

/// What names of functions hold that are the processor's operations, and of those the ones on numbers of
/// double precision.
const OPERATION: &[u8] = b"core_arch3x86";
const ON_NUMBERS: [&[u8]; 2] = [b"_mm512_", b"_mm256_"];
const PRECISION: &[u8] = b"_pd";

/// A closure over an array had been compiled without the instruction set of the vectors in it: each product
/// was a function that was called, and a second of the reduced bearing took 7.6 s instead of 3.1. Only the
/// clock had shown it.
#[test]
fn issue_no_operation_on_a_vector_is_a_function() {
    let program = std::fs::read(env!("CARGO_BIN_EXE_stribeck")).expect("it has been built");
    let holds = |name: &[u8], part: &[u8]| name.windows(part.len()).any(|here| here == part);
    let mut found: Vec<String> = Vec::new();
    for (at, here) in program.windows(OPERATION.len()).enumerate() {
        if here == OPERATION {
            let letters = program[at..].iter().take_while(|c| c.is_ascii_alphanumeric() || **c == b'_');
            let name: Vec<u8> = letters.copied().collect();
            if ON_NUMBERS.iter().any(|of| holds(&name, of)) && holds(&name, PRECISION) {
                found.push(String::from_utf8_lossy(&name).into_owned());
            }
        }
    }
    assert!(found.is_empty(), "functions of their own: {found:?}");
}
