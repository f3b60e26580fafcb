//! The examples keep what they promise: closed forms, in fewer than forty lines of code each.

#[path = "../examples/bar_impact.rs"]
#[allow(dead_code, reason = "its `main` prints what is tested here")]
mod bar_impact;
#[path = "../examples/hertz_disc.rs"]
#[allow(dead_code, reason = "its `main` prints what is tested here")]
mod hertz_disc;
#[path = "../examples/ring_mode.rs"]
#[allow(dead_code, reason = "its `main` prints what is tested here")]
mod ring_mode;
#[path = "../examples/sliding_block.rs"]
#[allow(dead_code, reason = "its `main` prints what is tested here")]
mod sliding_block;

fn assert_small(error: Result<f64, Box<dyn std::error::Error>>, tolerance: f64) {
    let error = error.expect("the example runs");
    assert!(error.abs() < tolerance, "off by {error:+.2e}, allowed {tolerance:.1e}");
}

/// Goldsmith 1960, §2.2. Contact is a spring as stiff as one cell, which both bars share: two transits of one
/// of 400 cells, and the wave's front is as wide as some.
#[test]
fn analytic_bars_part_after_two_transits() {
    assert_small(bar_impact::error(), 0.02);
}

/// Johnson 1985, §5.6, for strains that vanish; here the half-width is 2.5 % of the radius, and three facets.
#[test]
fn analytic_disc_between_plates() {
    assert_small(hertz_disc::error(), 0.02);
}

/// Coulomb 1785 (Persson 2000, §1): v²/(2µg). The normal force swings about the weight, and with it friction;
/// their mean is what counts.
#[test]
fn analytic_block_slides_to_rest() {
    assert_small(sliding_block::error(), 0.005);
}

/// Love 1927, §293. Shear and rotary inertia, left out there, lower it by about n² (h/R)²/3 = 0.2 %.
#[test]
fn analytic_ring_bends() {
    assert_small(ring_mode::error(), 0.01);
}

/// Lines between the module's documentation and `main`'s end: blank ones and comments count too.
#[test]
fn invariant_examples_have_fewer_than_forty_lines() {
    let examples = [
        include_str!("../examples/bar_impact.rs"),
        include_str!("../examples/hertz_disc.rs"),
        include_str!("../examples/ring_mode.rs"),
        include_str!("../examples/sliding_block.rs"),
    ];
    for text in examples {
        let lines = text.lines().filter(|line| !line.starts_with("//!")).count();
        assert!(lines < 40, "{lines} lines: {:?}", text.lines().next());
    }
}
