//! Von Mises stress: under a loaded roller and at the exit edge.

use stribeck_store::frames::{Frame, Window};
use stribeck_store::mesh_file::RunMesh;

use crate::Error;
use crate::plot::{Anchor, Picture, Sheet, shade_rgb};
use stribeck_analysis::findings::Findings;
use stribeck_analysis::record::Record;
use stribeck_analysis::stress::{Cell, cells, elastic};
use stribeck_diagnosis::words::numbers::{kilonewtons, pascals};
use stribeck_theory::contact_law::ContactLawKind;

/// Part of the cells whose stress the scale leaves above its end: single corners would take all colours.
const ABOVE: f64 = 0.002;
/// Half the side of the picture of a moment [m].
const HALF: f64 = 3e-3;

/// A moment: its title, its cells, and the focus, in the axes of the picture [m].
struct Moment {
    title: String,
    /// Place of the focus, in words.
    at: &'static str,
    time_s: f64,
    cells: Vec<Cell>,
    focus: [f64; 2],
    /// Hertzian pressure of the contact at the focus [Pa]; `None` at an edge, and of balls, whose points are not in the
    /// plane.
    hertz: Option<f64>,
}

/// Highest von Mises stress under a line contact over its largest pressure, for ν = 0.3: yield begins at p₀ =
/// 1.79 Y (Johnson 1985, §6.1).
const VON_MISES_OF_PRESSURE: f64 = 1.0 / 1.79;

/// The stress that Hertz's `pressure` [Pa] makes beside the highest one of the picture.
fn beside_hertz(pressure: f64, von_mises: f64) -> String {
    let expected = VON_MISES_OF_PRESSURE * pressure;
    format!(
        "Hertz has a pressure of {:.2} GPa under this load, and a highest von Mises stress of {:.2} GPa below it: the \
         picture shows {:.0} % of that.",
        1e-9 * pressure,
        1e-9 * expected,
        100.0 * von_mises / expected
    )
}

pub(super) fn pictures(
    record: &Record<'_>,
    findings: &Findings,
    mesh: &RunMesh,
    window: &Window,
    frames: &[Frame],
) -> Result<Vec<Picture>, Error> {
    let scene = &record.run().scene;
    let material = elastic(&scene.material);
    let all: Vec<(f64, Vec<Cell>)> = frames.iter().map(|f| (f.time_s, cells(mesh, f, &material))).collect();
    let mut pictures = Vec::new();
    let moments = moments(record, findings, window, &all)?;
    if moments.iter().any(|moment| moment.cells.iter().any(|cell| is_near(moment, cell, window))) {
        pictures.push(still(&moments, window));
    }
    Ok(pictures)
}

/// The first frame with the roller that crosses first, at its contact with the outer raceway, and the frame
/// with the highest stress near the trailing edge while the roller climbs out.
fn moments(
    record: &Record<'_>,
    findings: &Findings,
    window: &Window,
    all: &[(f64, Vec<Cell>)],
) -> Result<Vec<Moment>, Error> {
    let scene = &record.run().scene;
    let radius = scene.outer_race_radius;
    let on_race = |deg: f64| window.place(radius * deg.to_radians().cos(), radius * deg.to_radians().sin());
    let mut moments = Vec::new();
    let number = findings.summary.events.first().map(|event| event.roller);
    let sample =
        |time: f64| record.time_s().partition_point(|t| *t < time).min(record.len().saturating_sub(1));
    let [from, to] = [all.first(), all.last()].map(|frame| frame.map_or(0, |(time, _)| sample(*time)));
    let rollers = record.with_rollers(&number.into_iter().collect::<Vec<_>>(), from..to + 1)?;
    let roller = number.and_then(|number| rollers.roller(number));
    let loaded = roller.and_then(|roller| {
        let normal = roller.outer_normal();
        all.iter().find_map(|(time, cells)| {
            let n = sample(*time) - from;
            let focus = on_race(roller.y.get(n)?.atan2(*roller.x.get(n)?).to_degrees());
            // Frames may be over before a roller comes.
            if focus.iter().any(|away| away.abs() > window.half) {
                return None;
            }
            let force = *normal.get(n)?;
            Some(Moment {
                title: format!("roller {} carries {}", roller.number, kilonewtons(force)),
                at: "the contact",
                time_s: *time,
                cells: cells.clone(),
                focus,
                hertz: (force > 0.0 && scene.law_of_elements() != ContactLawKind::Ball)
                    .then(|| scene.pressure_pa(force)[0]),
            })
        })
    });
    moments.extend(loaded);
    let exit = findings
        .prediction
        .standing()
        .zip(findings.summary.first_passages().first().copied())
        .and_then(|(edges, event)| {
            let focus = on_race(edges.trailing_deg);
            let exit_s = 1e-3 * event.exit_ms?;
            let half_ms = 0.5e-3;
            let near = |cell: &&Cell| distance(centre(cell, window), focus) < 2e-3;
            let highest = |cells: &[Cell]| cells.iter().filter(near).map(|c| c.von_mises).fold(0.0, f64::max);
            let about = all.iter().filter(|f| (f.0 - exit_s).abs() <= half_ms);
            let (time_s, cells) = about.max_by(|a, b| highest(&a.1).total_cmp(&highest(&b.1)))?;
            let title = format!("roller {} at the exit edge", event.roller);
            Some(Moment { title, at: "the edge", time_s: *time_s, cells: cells.clone(), focus, hertz: None })
        });
    moments.extend(exit);
    Ok(moments)
}

fn centre(cell: &Cell, window: &Window) -> [f64; 2] {
    let count = cell.corners.len() as f64;
    let sum = cell.corners.iter().fold([0.0; 2], |s, c| [s[0] + c[0], s[1] + c[1]]);
    window.place(sum[0] / count, sum[1] / count)
}

fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

/// Stress that all but a few cells stay below [Pa].
fn end_of_scale<'a>(cells: impl Iterator<Item = &'a Cell>) -> f64 {
    let mut stress: Vec<f64> = cells.map(|c| c.von_mises).collect();
    stress.sort_unstable_by(f64::total_cmp);
    let at = ((1.0 - ABOVE) * stress.len() as f64) as usize;
    stress.get(at.min(stress.len().saturating_sub(1))).copied().unwrap_or(1.0).max(1.0)
}

/// Whether a picture of the moment shows a cell.
fn is_near(moment: &Moment, cell: &Cell, window: &Window) -> bool {
    let at = centre(cell, window);
    (0..2).all(|axis| (at[axis] - moment.focus[axis]).abs() < 1.2 * HALF)
}

fn still(moments: &[Moment], window: &Window) -> Picture {
    let (side, half, top) = (430.0, HALF, 34.0);
    let near = |m: &Moment, c: &Cell| is_near(m, c, window);
    let shown = moments.iter().flat_map(|m| m.cells.iter().filter(move |c| near(m, c)));
    let end = end_of_scale(shown);
    let mut sheet = Sheet::new(20.0 + (side + 10.0) * moments.len() as f64, side + top + 60.0);
    for (n, moment) in moments.iter().enumerate() {
        let left = 10.0 + (side + 10.0) * n as f64;
        let scale = 0.5 * side / half;
        let place = |c: &[f64; 2]| {
            let [x, y] = window.place(c[0], c[1]);
            [
                left + 0.5 * side + scale * (x - moment.focus[0]),
                top + 0.5 * side - scale * (y - moment.focus[1]),
            ]
        };
        let words = format!("{:.2} ms: {}", 1e3 * moment.time_s, moment.title);
        sheet.text([left, 22.0], 14.0, Anchor::Start, "#000", &words);
        sheet.clipped(&format!("stress-{n}"), [left, top], [side, side], |sheet| {
            for cell in moment.cells.iter().filter(|c| near(moment, c)) {
                let corners: Vec<[f64; 2]> = cell.corners.iter().map(place).collect();
                let [r, g, b] = shade_rgb(cell.von_mises / end);
                sheet.path(
                    &corners,
                    true,
                    &format!("fill:#{r:02x}{g:02x}{b:02x};stroke:#fff;stroke-width:0.3"),
                );
            }
        });
        super::scale_bar(&mut sheet, [left + 8.0, top + side - 12.0], 1e-3, scale, "1 mm");
    }
    scale_of_colours(&mut sheet, [10.0, side + top + 14.0], end);
    let mut picture = Picture::new("stress", "Stress under a roller and at the exit edge", sheet);
    // Position of each moment's highest stress from its focus, and the Hertzian value.
    let mut places = Vec::new();
    let mut hertz = String::new();
    for m in moments {
        let cells = m.cells.iter().filter(|c| near(m, c));
        let Some(cell) = cells.max_by(|a, b| a.von_mises.total_cmp(&b.von_mises)) else { continue };
        let away = distance(centre(cell, window), m.focus);
        places.push(format!(
            "{} at {:.2} ms, {:.2} mm from {}",
            pascals(cell.von_mises),
            1e3 * m.time_s,
            1e3 * away,
            m.at
        ));
        hertz.extend(m.hertz.map(|h| format!(" {}", beside_hertz(h, cell.von_mises))));
    }
    picture.caption = format!("The highest stress is {}.{hertz}", places.join(" and "));
    picture.note = "Von Mises stress at the centre of each element, linear elastic: nothing yields in this \
        model. A penalty softer than the material and elements wider than the contact spread the pressure; a \
        sharp edge has as much stress as its elements resolve."
        .into();
    picture
}

/// A strip of the scale with its ends in words.
fn scale_of_colours(sheet: &mut Sheet, at: [f64; 2], end: f64) {
    for n in 0..60 {
        let [r, g, b] = shade_rgb(f64::from(n) / 59.0);
        let x = at[0] + 4.0 * f64::from(n);
        let cell = [[x, at[1]], [x + 4.3, at[1]], [x + 4.3, at[1] + 12.0], [x, at[1] + 12.0]];
        sheet.path(&cell, true, &format!("fill:#{r:02x}{g:02x}{b:02x}"));
    }
    sheet.text([at[0], at[1] + 27.0], 12.0, Anchor::Start, "#000", "0");
    let words = format!("{} and more, von Mises", pascals(end));
    sheet.text([at[0] + 246.0, at[1] + 11.0], 12.0, Anchor::Start, "#000", &words);
}
