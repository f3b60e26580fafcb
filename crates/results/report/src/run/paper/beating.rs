//! The paper's Fig. 5: the sum of two cosines at the frequencies of its equation (2).

use std::f64::consts::TAU;

use crate::plot::{Axis, Colour, Figure, Series};
use stribeck_analysis::paper::{CURSOR_HZ, EQUATION_2_HZ};
use stribeck_analysis::reading;

/// Sample rate of the paper's output [Hz], and the length of its record [samples].
const SAMPLE_RATE_HZ: f64 = 1e5;
const SAMPLES: usize = 3000;

/// Figs. 5a and 5b. They follow from two numbers of the paper and from nothing of the run.
pub(super) fn figures() -> [Figure; 2] {
    let (outer, inner) = EQUATION_2_HZ;
    let sum = reading::equation_3(outer, inner, SAMPLE_RATE_HZ, SAMPLES);
    let gaps = reading::gaps(&sum, SAMPLE_RATE_HZ);
    let step = 1.0 / SAMPLE_RATE_HZ;
    let chart = |id: &str, title: &str| {
        Figure::new(id, title, Axis::si("Time", "s"), Axis::plain("Sum of two unit cosines", ""))
            .with(Series::sampled("equation (3)", Colour::Blue, 0.0, step, sum.clone()))
    };
    let whole = chart("beat", "Fig. 5a: the paper's two tones added")
        .caption(format!("{outer:.0} and {inner:.0} Hz swell and fade {:.0} times a second.", outer - inner))
        .note(
            "Equation (3) with A₁ = A₂ = 1 and φ = 0. Of these two frequencies only the first is in the \
            model: vertices pass the inner raceway as often as the outer one.",
        );
    let envelope: Vec<f64> =
        (0..SAMPLES).map(|n| 2.0 * (0.5 * TAU * (outer - inner) * n as f64 * step).cos().abs()).collect();
    let reads = |samples: usize| SAMPLE_RATE_HZ / samples as f64;
    let share = |samples: usize| gaps.as_ref().map_or(0.0, |g| 100.0 * g.share_of(samples));
    let mut zoom = chart("beat-zoom", "Fig. 5b: the same from 10 to 15 ms, with its envelope")
        .with(Series::sampled("envelope", Colour::Orange, 0.0, step, envelope))
        .caption(format!(
            "Two neighbouring peaks are a whole number of samples apart: 22 read {:.0} Hz ({:.0} % of them), \
             23 read {:.0} Hz ({:.0} %). Within a swell they follow the mean of the two tones, {:.0} Hz.",
            reads(22),
            share(22),
            reads(23),
            share(23),
            0.5 * (outer + inner)
        ))
        .note(format!(
            "The paper reads {CURSOR_HZ:.0} Hz from one such pair and finds it again in its acceleration. A \
             pure tone of 4671 Hz sampled at 100 kHz shows the same pair of cursors in two periods of five, \
             without any second tone."
        ));
    zoom.x.range = Some((0.010, 0.015));
    [whole.tabbed("beat", "Fig. 5a"), zoom.tabbed("beat", "Fig. 5b")]
}
