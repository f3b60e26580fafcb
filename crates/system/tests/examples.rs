//! The examples keep what they promise: closed forms, in fewer than forty lines each.

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

#[test]
fn analytic_bars_part_after_two_transits() {
    // The law is a spring in series with the bars, as long as one cell on each side: 2 of 400 cells.
    assert_small(bar_impact::error(), 0.01);
}
