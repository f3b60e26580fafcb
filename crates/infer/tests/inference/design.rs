//! Sobol points.

use stribeck_infer::{Error, sobol};

/// The first 2ᵐ points have one in each of 2ᵐ equal intervals of every dimension, and the first two
/// dimensions one in each cell of every division into 2ᵐ equal boxes: a (0, m, 2)-net (Sobol 1967;
/// Owen scrambling keeps it).
#[test]
fn invariant_every_interval_and_every_box_has_its_point() {
    const M: u32 = 6;
    for seed in [0, 1, 77, u64::MAX] {
        let points = sobol(seed, 12, 0, 1 << M).unwrap();
        for axis in 0..12 {
            let mut cells: Vec<usize> = points.iter().map(|point| (point[axis] * 64.0) as usize).collect();
            cells.sort_unstable();
            assert!(cells.iter().copied().eq(0..64), "dimension {axis}, seed {seed}");
        }
        for split in 0..=M {
            let [wide, high] = [1 << split, 1 << (M - split)].map(f64::from);
            let cell =
                |point: &Vec<f64>| (point[0] * wide) as usize + ((point[1] * high) as usize * (1 << split));
            let mut cells: Vec<usize> = points.iter().map(cell).collect();
            cells.sort_unstable();
            assert!(cells.iter().copied().eq(0..64), "boxes 1/{wide} by 1/{high}, seed {seed}");
        }
    }
}

#[test]
fn invariant_a_design_is_extended_by_its_own_points() {
    let whole = sobol(3, 5, 0, 96).unwrap();
    assert_eq!(whole[..40], sobol(3, 5, 0, 40).unwrap());
    assert_eq!(whole[40..], sobol(3, 5, 40, 56).unwrap());
    assert_ne!(whole, sobol(4, 5, 0, 96).unwrap());
    assert!(whole.iter().flatten().all(|x| (0.0..1.0).contains(x)));
}

#[test]
fn refuses_points_beyond_the_sequence() {
    let text = |result: Result<_, Error>| result.unwrap_err().to_string();
    assert!(text(sobol(0, 2, 65_000, 1000)).contains("points = 66000: must be at most 65536"));
    assert!(text(sobol(0, 300, 0, 1)).contains("dimensions = 300: must be at most 256"));
}
