//! Figures by themselves, as SVG and as pixels.

use stribeck_report::plot::{Axis, Band, Colour, Figure, Mark, Series, png};
use stribeck_testing::{assert_has, assert_refused};

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

#[test]
fn behaves_letters_leave_ink() {
    let drawing = |words: &str| {
        let svg = format!(
            "<svg width=\"60\" height=\"20\" xmlns=\"http://www.w3.org/2000/svg\"><rect width=\"60\" \
             height=\"20\" fill=\"#fff\"/>\
             <text x=\"2\" y=\"15\" font-family=\"sans-serif\" font-size=\"14\">{words}</text></svg>"
        );
        png("letters", &svg).unwrap()
    };
    assert!(drawing("")[1..4] == *b"PNG");
    assert!(drawing("µ g²/Hz").len() > drawing("").len() + 100);
    assert_refused(png("bad", "<svg"), "figure `bad` cannot be drawn");
}
