//! Deviations from round that a mesh can follow: as long as several facets, and no steeper than its cells can
//! lean.

use std::f64::consts::PI;

use super::geometry::MAX_DEFECT_DEPTH_RATIO;
use super::ring_meshes;
use crate::deviation::{
    DeviationScene, Edge, FormScene, HOLLOW_FACETS, PointScene, RollingSurface, SpallScene,
};
use crate::faults::rolling_circle;
use crate::field::wording::{number, round_down, round_up};
use crate::reading::finding::{Finding, Remedy};
use crate::scene::Scene;

/// Steepest slope of a surface: cells under it lean as much, and keep nine tenths of their time step.
const STEEPEST: f64 = 0.4;

/// Steepest slope under an oil film; by steeper ones runs with oil end in a wrong balance of energy.
const GENTLE: f64 = 0.08;

/// Facets that a wave needs at least.
const WAVE_FACETS: f64 = 6.0;

/// Longest part of a surface that one of them takes: half a raceway, a quarter of a roller.
const OF_RACEWAY: f64 = 0.5;
const OF_ROLLER: f64 = 0.25;

/// Facets between two spalls, between a groove and any defect, and between two grooves, whose walls take
/// facets too.
const BESIDE_SPALL: f64 = 2.0;
const BESIDE_GROOVE: f64 = 10.0;
const BETWEEN_GROOVES: f64 = 20.0;

/// Deepest, over the thickness of a ring or the radius of a roller.
const OF_THICKNESS: f64 = 0.3;
const OF_RADIUS: f64 = 0.15;

/// Steepest part of the dent's hollow and of its rim, in depths over half its length and heights over the
/// same.
const HOLLOW_SLOPE: f64 = 1.54;
const RIM_SLOPE: f64 = 3.08;

/// A profile that is proposed.
const NOTCH: &str =
    "[(at_mm: -1.0, depth_um: 0.0), (at_mm: 0.0, depth_um: 20.0), (at_mm: 1.0, depth_um: 0.0)]";

/// Deviations that no mesh can follow, in a scene whose numbers are in range.
pub(crate) fn findings(scene: &Scene) -> Vec<Finding> {
    let each = scene.defects.iter().enumerate();
    each.flat_map(|(i, deviation)| Checked::new(scene, i, deviation).findings()).collect()
}

struct Checked<'a> {
    scene: &'a Scene,
    index: usize,
    deviation: &'a DeviationScene,
    /// Circumference and facet of the surface [mm].
    around: f64,
    facet: f64,
}

impl<'a> Checked<'a> {
    fn new(scene: &'a Scene, index: usize, deviation: &'a DeviationScene) -> Self {
        let [diameter, facet] = rolling_circle(scene, deviation.on);
        Self { scene, index, deviation, around: PI * diameter, facet }
    }

    fn path(&self, name: &str) -> String {
        format!("defects[{}].{name}", self.index)
    }

    fn on_roller(&self) -> bool {
        matches!(self.deviation.on, RollingSurface::Roller(_))
    }

    fn surface(&self) -> String {
        self.deviation.on.spoken()
    }

    /// A finer mesh of the surface.
    fn finer(&self, facet: f64) -> Remedy {
        if self.on_roller() {
            let count = 4.0 * (self.around / facet / 4.0).ceil();
            Remedy::new("mesh.roller_facets", format!("at least {}", number(count)))
        } else {
            Remedy::new("mesh.size_mm", format!("at most {} mm", number(facet)))
        }
    }

    fn findings(&self) -> Vec<Finding> {
        let found = match &self.deviation.form {
            FormScene::Spall(spall) => {
                let edge = if spall.edge_mm > 0.0 { spall.edge_mm } else { self.facet };
                let slope = match spall.edge {
                    Edge::Sloped => spall.depth_mm / edge,
                    Edge::Rounded => 0.5 * PI * spall.depth_mm / edge,
                    Edge::Rectangular => 0.0,
                };
                // The floor of a groove of a raceway has two facets, however short it is.
                let sloped = spall.edge != Edge::Rectangular;
                vec![
                    (sloped || self.on_roller()).then(|| self.short(spall.length_mm)).flatten(),
                    self.long(spall.length_mm),
                    self.upright(spall),
                    sloped.then(|| self.edge(spall.edge_mm, spall.length_mm)).flatten(),
                    self.steep(slope, "form.depth_mm", spall.depth_mm, "mm"),
                    self.deep(),
                ]
            }
            FormScene::Dent(dent) => {
                let half = 0.5 * dent.length_mm;
                vec![
                    self.short(dent.length_mm),
                    self.long(dent.length_mm),
                    self.steep(HOLLOW_SLOPE * dent.depth_mm / half, "form.depth_mm", dent.depth_mm, "mm"),
                    self.steep(1e-3 * RIM_SLOPE * dent.rim_um / half, "form.rim_um", dent.rim_um, "µm"),
                    self.deep(),
                ]
            }
            FormScene::Profile(profile) => vec![self.points(&profile.points), self.deep()],
            FormScene::Waviness(waviness) => {
                let slope = 2.0 * PI * waviness.order as f64 * 1e-3 * waviness.amplitude_um / self.around;
                vec![
                    self.order(waviness.order as f64),
                    self.steep(slope, "form.amplitude_um", waviness.amplitude_um, "µm"),
                    self.deep(),
                ]
            }
            FormScene::Roughness(roughness) => {
                let slope = 2.0 * PI * 1e-3 * roughness.rq_um / roughness.shortest_mm;
                vec![
                    self.band(roughness.shortest_mm, roughness.longest_mm),
                    self.steep(slope, "form.rq_um", roughness.rq_um, "µm"),
                ]
            }
            FormScene::Diameter(_) => vec![self.of_roller("its diameter is a field of `bearing`")],
            FormScene::Missing => {
                vec![self.of_roller("it cannot be missing"), self.gap(), self.of_nothing()]
            }
        };
        let beside = [self.meets_defect(), self.meets_spall(), self.in_oil()];
        found.into_iter().chain(beside).flatten().collect()
    }

    fn short(&self, length: f64) -> Option<Finding> {
        let least = HOLLOW_FACETS * self.facet;
        if length >= least {
            return None;
        }
        let path = self.path("form.length_mm");
        let message = format!(
            "`{path}` is {}, and facets of {} are {:.3} mm long: {} at least make a hollow",
            number(length),
            self.surface(),
            self.facet,
            number(HOLLOW_FACETS)
        );
        let long = Remedy::new(path, format!("at least {} mm", number(round_up(least, 3))));
        Some(Finding::new(message, vec![long, self.finer(length / HOLLOW_FACETS)]))
    }

    fn long(&self, length: f64) -> Option<Finding> {
        let most = self.around * if self.on_roller() { OF_ROLLER } else { OF_RACEWAY };
        if length <= most {
            return None;
        }
        let path = self.path("form.length_mm");
        let message = format!(
            "`{path}` is {}: {} measures {:.1} mm around",
            number(length),
            self.surface(),
            self.around
        );
        let most = round_down(most, 3);
        Some(Finding::new(message, vec![Remedy::new(path, format!("at most {} mm", number(most)))]))
    }

    fn edge(&self, edge: f64, length: f64) -> Option<Finding> {
        // A length written with few digits may be a little short of a facet.
        let (least, most) = (0.99 * self.facet, 0.5 * length);
        if edge == 0.0 || (least..=most).contains(&edge) {
            return None;
        }
        let path = self.path("form.edge_mm");
        let message = format!(
            "`{path}` is {}: an edge takes a facet of {:.3} mm at least, and half of the spall at most",
            number(edge),
            self.facet
        );
        let remedy = Remedy::new(
            path,
            format!("0 for one facet, or {} to {} mm", number(round_up(least, 3)), number(most)),
        );
        let mut remedies = vec![remedy.value("0.0", "one facet")];
        if edge < least {
            remedies.push(self.finer(edge));
        } else {
            let path = self.path("form.length_mm");
            remedies.push(Remedy::new(path, format!("at least {} mm", number(2.0 * edge))));
        }
        Some(Finding::new(message, remedies))
    }

    /// Walls at right angles are cut into the mesh, and take no length.
    fn upright(&self, spall: &SpallScene) -> Option<Finding> {
        if spall.edge != Edge::Rectangular {
            return None;
        }
        let path = self.path("form.edge_mm");
        (spall.edge_mm != 0.0).then(|| {
            let message =
                format!("`{path}` is {}, and rectangular edges take no length", number(spall.edge_mm));
            let sloped = Remedy::new(self.path("form.edge"), "`sloped` or `rounded`").value("sloped", "");
            Finding::new(message, vec![Remedy::new(path, "0").value("0.0", ""), sloped])
        })
    }

    /// `field` in proportion makes the slope.
    fn steep(&self, slope: f64, field: &str, value: f64, unit: &str) -> Option<Finding> {
        if slope <= STEEPEST {
            return None;
        }
        let path = self.path(field);
        let mut message = format!(
            "`{path}` is {}: the surface would slope by {:.0}°, and cells of a mesh lean by {:.0}° at most",
            number(value),
            slope.atan().to_degrees(),
            STEEPEST.atan().to_degrees()
        );
        message += ". Steep walls have spalls with `edge: rectangular`";
        let most = round_down(value * STEEPEST / slope, 3);
        let mut remedies = vec![Remedy::new(path, format!("at most {} {unit}", number(most)))];
        if let FormScene::Spall(spall) = &self.deviation.form {
            let edge = if spall.edge_mm > 0.0 { spall.edge_mm } else { self.facet };
            let longer = round_up(edge * slope / STEEPEST, 3);
            remedies.push(Remedy::new(self.path("form.edge_mm"), format!("at least {} mm", number(longer))));
            let upright = Remedy::new(self.path("form.edge"), "`rectangular`, with `edge_mm: 0`");
            remedies.push(upright.value("rectangular", "walls that stand upright"));
        }
        Some(Finding::new(message, remedies))
    }

    fn deep(&self) -> Option<Finding> {
        let b = &self.scene.bearing;
        let part = if self.deviation.groove().is_some() { MAX_DEFECT_DEPTH_RATIO } else { OF_THICKNESS };
        let (most, of) = match self.deviation.on {
            RollingSurface::Outer => (part * b.outer_ring_thickness_mm, "ring"),
            RollingSurface::Inner => (part * b.inner_ring_thickness_mm, "ring"),
            RollingSurface::Roller(_) => (OF_RADIUS * 0.5 * b.roller_diameter_mm, "roller"),
        };
        let depth = self.deviation.form.depth_mm();
        if depth <= most {
            return None;
        }
        let path = self.path("form");
        let message = format!(
            "`{path}` is {} mm deep, too deep for a {of} whose cells make room for {} mm",
            number(depth),
            number(round_down(most, 3))
        );
        Some(Finding::new(
            message,
            vec![Remedy::new(path, format!("at most {} mm deep", number(round_down(most, 3))))],
        ))
    }

    fn points(&self, points: &[PointScene]) -> Option<Finding> {
        let path = self.path("form.points");
        let allowed = "two or more places along the surface [mm], ascending, with depths [µm]";
        if points.len() < 2 {
            let message = format!("`{path}` has {} points: a profile needs two", points.len());
            let remedy = Remedy::new(path, allowed).value(NOTCH, "a notch");
            return Some(Finding::new(message, vec![remedy]));
        }
        let most = self.around * if self.on_roller() { OF_ROLLER } else { OF_RACEWAY };
        let (first, last) = (points[0], points[points.len() - 1]);
        let wrong = if first.depth_um != 0.0 || last.depth_um != 0.0 {
            Some("begins and ends on the circle, with depths of 0 µm".to_owned())
        } else if last.at_mm > first.at_mm && last.at_mm - first.at_mm < HOLLOW_FACETS * self.facet {
            Some(format!("is as long as {} facets of {:.3} mm at least", number(HOLLOW_FACETS), self.facet))
        } else if first.at_mm < -0.5 * self.around || last.at_mm > 0.5 * self.around {
            Some(format!("lies on {}, within {:.1} mm of its middle", self.surface(), 0.5 * self.around))
        } else {
            None
        };
        if let Some(wrong) = wrong {
            let message = format!("no mesh can follow `{path}`: a profile {wrong}");
            return Some(Finding::new(message, vec![Remedy::new(path, allowed).value(NOTCH, "a notch")]));
        }
        for (k, pair) in points.windows(2).enumerate() {
            let [(a, from), (b, to)] = [pair[0], pair[1]].map(|point| (point.at_mm, point.depth_um));
            let slope = 1e-3 * (to - from).abs() / (b - a);
            let wrong = if b <= a {
                format!("lies at {} mm, not beyond the one before", number(b))
            } else if slope > STEEPEST {
                format!(
                    "is {:.0}° from the one before: cells of a mesh lean by {:.0}° at most",
                    slope.atan().to_degrees(),
                    STEEPEST.atan().to_degrees()
                )
            } else if b - points[0].at_mm > most {
                format!(
                    "ends a profile of {} mm: {} has room for {:.1} mm",
                    number(b - points[0].at_mm),
                    self.surface(),
                    most
                )
            } else {
                continue;
            };
            let message = format!("`{path}[{}]` {wrong}", k + 1);
            return Some(Finding::new(message, vec![Remedy::new(path, allowed)]));
        }
        None
    }

    fn order(&self, order: f64) -> Option<Finding> {
        let most = (self.around / (WAVE_FACETS * self.facet)).floor();
        if order <= most {
            return None;
        }
        let path = self.path("form.order");
        let message = format!(
            "`{path}` is {}: a wave would have {:.1} facets of {}, and needs {}",
            number(order),
            self.around / (order * self.facet),
            self.surface(),
            number(WAVE_FACETS)
        );
        let remedy = Remedy::new(path, format!("at most {}", number(most)));
        Some(Finding::new(message, vec![remedy, self.finer(self.around / (WAVE_FACETS * order))]))
    }

    fn band(&self, shortest: f64, longest: f64) -> Option<Finding> {
        let least = HOLLOW_FACETS * self.facet;
        let (short, long) = (self.path("form.shortest_mm"), self.path("form.longest_mm"));
        if shortest < least {
            let message = format!(
                "`{short}` is {}, less than {} facets of {}",
                number(shortest),
                number(HOLLOW_FACETS),
                self.surface()
            );
            let up = round_up(least, 3);
            let remedy = Remedy::new(short, format!("at least {} mm", number(up)));
            return Some(Finding::new(message, vec![remedy, self.finer(shortest / HOLLOW_FACETS)]));
        }
        // One order of waves must lie within.
        let waves = |mm: f64| self.around / mm;
        if waves(longest).ceil() <= waves(shortest).floor() {
            return None;
        }
        let message = format!(
            "no whole number of waves of {} to {} mm fits {}",
            number(shortest),
            number(longest),
            self.surface()
        );
        Some(Finding::new(
            message,
            vec![
                Remedy::new(long, format!("more than {} mm", number(shortest))),
                Remedy::new(short, format!("less than {} mm", number(longest))),
            ],
        ))
    }

    fn of_roller(&self, why: &str) -> Option<Finding> {
        if self.on_roller() {
            return None;
        }
        let path = self.path("on");
        let message = format!("`{path}` is a raceway: {why}");
        Some(Finding::new(message, vec![Remedy::new(path, "`roller(1)` and so on").value("roller(1)", "")]))
    }

    /// A ring falls through half a turn without rollers.
    fn gap(&self) -> Option<Finding> {
        let (all, left) = (self.scene.bearing.rollers, self.scene.rollers_in_place().collect::<Vec<_>>());
        let around = left.iter().zip(left.iter().cycle().skip(1));
        // A single roller is its own neighbour, a turn away.
        let gap = |(from, to): (&usize, &usize)| if to > from { to - from } else { to + all - from };
        let widest = 360.0 * around.map(gap).max().unwrap_or(all) as f64 / all as f64;
        let path = self.path("form");
        (widest >= 180.0).then(|| {
            let message = format!(
                "`{path}` is `missing`: the {} rollers that are left leave {widest:.0}° without one, and a \
                 ring falls through 180°",
                left.len()
            );
            Finding::new(message, vec![Remedy::new("defects", "fewer neighbours that are missing")])
        })
    }

    /// A missing roller has no further deviation.
    fn of_nothing(&self) -> Option<Finding> {
        if !self.on_roller() {
            return None;
        }
        let same = |(other, deviation): &(usize, &DeviationScene)| {
            *other != self.index && deviation.on == self.deviation.on
        };
        let (other, _) = self.scene.defects.iter().enumerate().find(same)?;
        let message =
            format!("`{}` is `missing`, and `defects[{other}]` is on the same roller", self.path("form"));
        Some(Finding::new(message, vec![Remedy::new(format!("defects[{other}].on"), "another roller")]))
    }

    /// Corners of two spalls would need the same nodes, and around a groove the mesh is cut.
    fn meets_spall(&self) -> Option<Finding> {
        let own = self.deviation.form.length_mm()?;
        let is_spall = |deviation: &DeviationScene| matches!(deviation.form, FormScene::Spall(_));
        let earlier = self.scene.defects[..self.index].iter().enumerate();
        for (other, deviation) in earlier.filter(|(_, deviation)| deviation.on == self.deviation.on) {
            let Some(length) = deviation.form.length_mm() else { continue };
            let facets = match [self.deviation, deviation].map(DeviationScene::is_cut) {
                [true, true] => BETWEEN_GROOVES,
                [false, false] if !(is_spall(self.deviation) && is_spall(deviation)) => continue,
                [false, false] => BESIDE_SPALL,
                _ => BESIDE_GROOVE,
            };
            let apart = (self.deviation.angle_deg - deviation.angle_deg + 180.0).rem_euclid(360.0) - 180.0;
            let apart = apart.abs() / 360.0 * self.around;
            let needed = 0.5 * (own + length) + facets * self.facet;
            if apart >= needed {
                continue;
            }
            let path = self.path("angle_deg");
            let message = format!(
                "`defects[{}]` lies {apart:.2} mm from `defects[{other}]`, middle to middle, and needs \
                 {needed:.2} mm: lengths and {} facets",
                self.index,
                number(facets)
            );
            let remedy = Remedy::new(path, format!("{needed:.2} mm or more away"));
            return Some(Finding::new(message, vec![remedy]));
        }
        None
    }

    /// An oil film assumes the curvature of a whole roller, and raceways of small curvature changes.
    fn in_oil(&self) -> Option<Finding> {
        let gentle = match &self.deviation.form {
            FormScene::Spall(spall) => {
                spall.edge == Edge::Rectangular
                    || spall.edge == Edge::Rounded && 0.5 * PI * spall.depth_mm <= GENTLE * spall.edge_mm
            }
            FormScene::Dent(dent) => {
                HOLLOW_SLOPE * dent.depth_mm.max(2e-3 * dent.rim_um) <= 0.5 * GENTLE * dent.length_mm
            }
            FormScene::Profile(_) => false,
            _ => return None,
        };
        if self.scene.film.is_none() || gentle && !self.on_roller() {
            return None;
        }
        let message = format!(
            "`film` is there, and `defects[{}]` lies on {}: oil needs round rollers, and raceways that slope \
             by {:.0}° at most without kinks, but for walls at right angles{}",
            self.index,
            self.surface(),
            GENTLE.atan().to_degrees(),
            if self.could_stand_upright() {
                ". With `edge: rectangular` this spall may lie in oil"
            } else {
                ""
            }
        );
        let form = Remedy::new(self.path("form"), "a gentle dent, a rounded spall, or waves, on a raceway");
        let dry = Remedy::new("film", "`None`").value("None", "dry");
        Some(Finding::new(message, vec![dry, form]))
    }

    /// Whether the same spall is allowed once its walls are at right angles.
    fn could_stand_upright(&self) -> bool {
        let mut scene = self.scene.clone();
        let deviation = &mut scene.defects[self.index];
        let FormScene::Spall(spall) = &mut deviation.form else { return false };
        if spall.edge == Edge::Rectangular {
            return false;
        }
        (spall.edge, spall.edge_mm) = (Edge::Rectangular, 0.0);
        let upright = Checked::new(&scene, self.index, &scene.defects[self.index]);
        upright.findings().is_empty() && ring_meshes::findings(&scene).is_empty()
    }

    /// Walls of a groove and nodes that move do not go together.
    fn meets_defect(&self) -> Option<Finding> {
        let defect = self.scene.defect.as_ref()?;
        let ring = self.deviation.on.ring()?;
        let length = self.deviation.form.length_mm()?;
        let apart = (self.deviation.angle_deg - defect.angle_deg + 180.0).rem_euclid(360.0) - 180.0;
        let apart = apart.abs() / 360.0 * self.around;
        let facets = if self.deviation.groove().is_some() { BETWEEN_GROOVES } else { BESIDE_GROOVE };
        let needed = 0.5 * (length + defect.length_mm) + facets * self.facet;
        if ring != defect.ring || apart >= needed {
            return None;
        }
        let path = self.path("angle_deg");
        let message = format!(
            "`defects[{}]` lies {:.2} mm from `defect`, middle to middle, and needs {:.2} mm: lengths and {} \
             facets",
            self.index,
            apart,
            needed,
            number(facets)
        );
        Some(Finding::new(
            message,
            vec![
                Remedy::new(path, format!("{:.2} mm or more away", needed)),
                Remedy::new("defect", "`None`").value("None", ""),
            ],
        ))
    }
}
