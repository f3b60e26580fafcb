//! Figures by themselves, as SVG.

use stribeck_report::plot::{Axis, Band, Colour, Figure, Mark, Series};
use stribeck_testing::assert_has;

#[test]
fn behaves_everything_asked_for_is_in_the_picture() {
    let y = (0..3000).map(|n| 100.0 * (0.3 * n as f64).sin()).collect();
    let mut figure = Figure::new("a", "Acceleration <raw>", Axis::si("Time", "s"), Axis::plain("a_y", "g"))
        .with(Series::sampled("side", Colour::Blue, 0.0, 1e-5, y));
    figure.marks.push(Mark { x: 5.08e-3, label: "exit 1".into(), colour: Colour::Orange, dashed: true });
    figure.bands.push(Band { from: 0.0, to: 7e-3, label: "transient".into() });
    let svg = figure.to_svg().unwrap();
    assert_has(
        &svg,
        &["&lt;raw&gt;", "Time", "a_y [g]", "5 ms", "25 ms", "exit 1", "transient", "side", "−100"],
    );
    assert!(svg.len() < 200_000, "{} bytes", svg.len());
}

#[test]
fn behaves_an_empty_figure_still_draws_its_frame() {
    let figure = Figure::new("e", "Empty", Axis::si("Time", "s"), Axis::plain("a", "g"));
    assert!(figure.to_svg().unwrap().contains("Empty"));
}
