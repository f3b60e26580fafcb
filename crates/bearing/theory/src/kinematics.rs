//! Ideal kinematics: speeds in rolling without slip, times at which rollers cross the defect, and tones of
//! the facets of a mesh.
//!
//! Angles count counter-clockwise from the x axis. An inner ring at a positive speed turns clockwise, so its
//! angular velocity and that of the cage are negative, and that of a roller is positive; at a negative speed
//! all signs are reversed. Frequencies are magnitudes.

use std::f64::consts::TAU;

use crate::bearing::{Dimensions, Ring};

/// Speeds of a bearing whose rollers do not slip.
///
/// Three definitions of the cage's speed differ by one part in ten thousand, because a bearing with clearance
/// has no single pitch circle; each has its own field.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Kinematics {
    /// Shaft frequency f_s, of the inner ring [Hz].
    pub shaft_hz: f64,
    /// Frequency of the outer ring f_o [Hz]; zero for one that stands still.
    pub outer_ring_hz: f64,
    /// Cage frequency in space, the fundamental train frequency [Hz]: (f_s·D_i + f_o·D_o)/(D_i + D_o),
    /// rolling on both raceways with the roller's centre half-way between them.
    pub cage_hz: f64,
    /// The same as seen from the outer ring [Hz], (f_s − f_o)·D_i/(D_i + D_o). Event times use this one.
    pub cage_on_outer_hz: f64,
    /// The same as seen from the inner ring [Hz], (f_s − f_o)·D_o/(D_i + D_o).
    pub cage_on_inner_hz: f64,
    /// Cage frequency by the paper's equation (1), BPFO/N_r [Hz].
    pub cage_equation_1_hz: f64,
    /// Cage frequency of rollers that ride on the outer raceway, as seen from it [Hz]: the centre's path has
    /// the radius (D_o − D_r)/2. The initial velocities use this one.
    pub cage_outer_hz: f64,
    /// Ball (here roller) pass frequency of the outer raceway, the paper's equation (1) [Hz].
    pub bpfo_hz: f64,
    /// Roller pass frequency of the inner raceway [Hz].
    pub bpfi_hz: f64,
    /// Roller spin frequency by the textbook formula, (f_s − f_o)·D_p/(2·D_r)·(1 − (D_r/D_p)²) [Hz].
    pub bsf_hz: f64,
    /// Spin of a roller relative to the cage, f_c·D_o/D_r with [`Kinematics::cage_on_outer_hz`] [Hz].
    pub roller_spin_hz: f64,
    /// Angular velocity of the inner ring [rad/s]; negative, clockwise, at a positive speed.
    pub shaft_rad_s: f64,
    /// Angular velocity of the outer ring [rad/s], counted likewise.
    pub outer_rad_s: f64,
    /// Angular velocity of the cage in space with rollers riding on the outer raceway [rad/s].
    pub cage_rad_s: f64,
    /// Angular velocity of a roller in space, riding on the outer raceway [rad/s].
    pub roller_rad_s: f64,
    /// Angular velocity of a roller seen from the cage, `roller_rad_s − cage_rad_s` [rad/s], positive where
    /// the inner ring turns clockwise against the outer one.
    pub roller_relative_rad_s: f64,
    /// Speed of the contact point along the outer raceway [m/s], positive, with
    /// [`Kinematics::cage_on_outer_hz`].
    pub contact_speed_m_s: f64,
    /// Diameters of the outer and the inner raceway [m].
    raceways_m: [f64; 2],
}

/// A spall on a raceway, as far as rollers cross it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stretch {
    /// Ring on whose raceway it lies.
    pub ring: Ring,
    /// Circumferential length [m].
    pub length: f64,
    /// Angle of its middle at the start [°].
    pub angle_deg: f64,
}

/// Facets of the polygons that a mesh makes of the circles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FacetCounts {
    /// Facets (= vertices) of a roller.
    pub roller: usize,
    /// Effective facets of the outer raceway: 2π divided by the angle of one facet outside the defect, so
    /// that the finer facets of a graded defect do not count.
    pub outer: f64,
    /// Effective facets of the inner raceway, defined likewise.
    pub inner: f64,
}

/// A tone that the facets make.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tone {
    /// Stable name: `roller_vertices`, `outer_race_nodes` or `inner_race_nodes`.
    pub name: &'static str,
    /// Fundamental frequency [Hz].
    pub hz: f64,
}

/// One roller crossing the defect.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Crossing {
    /// Roller, from 1.
    pub roller: usize,
    /// Time at which its centre stands over the leading edge [s].
    pub entry_s: f64,
    /// Time at which its centre stands over the middle of the defect [s].
    pub centre_s: f64,
    /// Time at which its centre stands over the trailing edge [s].
    pub exit_s: f64,
}

/// Distance of a frequency from the nearest multiple of another one, such as that of the shaft, in their unit.
pub fn off_multiple(frequency: f64, of: f64) -> f64 {
    (frequency - (frequency / of).round() * of).abs()
}

impl Kinematics {
    /// Kinematics of `bearing` with the inner ring at `speed_rpm`, clockwise where it is positive, and the
    /// outer one at rest.
    pub fn new(bearing: impl Into<Dimensions>, speed_rpm: f64) -> Self {
        Self::between(bearing, speed_rpm, 0.0)
    }

    /// Kinematics of `bearing` with the inner and the outer ring at these speeds [rpm], clockwise where they
    /// are positive.
    pub fn between(bearing: impl Into<Dimensions>, inner_rpm: f64, outer_rpm: f64) -> Self {
        let Dimensions { outer_race_mm: outer, inner_race_mm: inner, roller_mm: roller, rollers } =
            bearing.into();
        let count = rollers as f64;
        let (shaft, ring) = (inner_rpm / 60.0, outer_rpm / 60.0);
        // Rollers follow the relative speed; the outer ring's rotation is added to their motion in space.
        let clockwise_hz = shaft - ring;
        let relative_hz = clockwise_hz.abs();
        let pitch = (outer + inner) / 2.0;
        let cage_on_outer_hz = relative_hz * inner / (inner + outer);
        let bpfo_hz = relative_hz * count / 2.0 * (1.0 - roller / pitch);
        // Riding on the outer raceway, the roller touches the inner one at radius (D_o − 2 D_r)/2 in the load
        // zone, where the ring has come up by the clearance; the ring's surface speed is that of its own
        // radius.
        let centre_path = (outer - roller) / 2.0;
        let cage_outer_hz = relative_hz * (inner / 2.0) / (2.0 * centre_path);
        let on_outer_rad_s = -TAU * cage_outer_hz.copysign(clockwise_hz);
        let outer_rad_s = -TAU * ring;
        let spin_on_outer = -on_outer_rad_s * centre_path / (roller / 2.0);
        Self {
            shaft_hz: shaft.abs(),
            outer_ring_hz: ring.abs(),
            cage_hz: (ring + cage_on_outer_hz.copysign(clockwise_hz)).abs(),
            cage_on_outer_hz,
            cage_on_inner_hz: relative_hz - cage_on_outer_hz,
            cage_equation_1_hz: bpfo_hz / count,
            cage_outer_hz,
            bpfo_hz,
            bpfi_hz: relative_hz * count / 2.0 * (1.0 + roller / pitch),
            bsf_hz: relative_hz * pitch / (2.0 * roller) * (1.0 - (roller / pitch).powi(2)),
            roller_spin_hz: cage_on_outer_hz * outer / roller,
            shaft_rad_s: -TAU * shaft,
            outer_rad_s,
            cage_rad_s: outer_rad_s + on_outer_rad_s,
            roller_rad_s: outer_rad_s + spin_on_outer,
            roller_relative_rad_s: spin_on_outer - on_outer_rad_s,
            contact_speed_m_s: TAU * cage_on_outer_hz * outer / 2.0 * 1e-3,
            raceways_m: [outer * 1e-3, inner * 1e-3],
        }
    }

    /// 1 for an inner ring that turns clockwise against the outer one or stands, −1 for one that turns
    /// counter-clockwise.
    pub fn sense(&self) -> f64 {
        if self.shaft_rad_s > self.outer_rad_s { -1.0 } else { 1.0 }
    }

    /// Facet-passing tones of a mesh, THEORY §5.
    ///
    /// A roller shows its vertices to both raceways at N_v·f_spin; the nodes of the outer raceway pass a
    /// contact at N_o·f_c, those of the inner one at N_i·(f_s − f_c). Spin is the same number at both
    /// raceways, so the roller has one tone, not two.
    pub fn facet_tones(&self, facets: FacetCounts) -> [Tone; 3] {
        [
            Tone { name: "roller_vertices", hz: facets.roller as f64 * self.roller_spin_hz },
            Tone { name: "outer_race_nodes", hz: facets.outer * self.cage_on_outer_hz },
            Tone { name: "inner_race_nodes", hz: facets.inner * self.cage_on_inner_hz },
        ]
    }

    /// The paper's equation (2) for the outer and the inner raceway [Hz], elements of `element_size` [m]: for
    /// comparison only.
    ///
    /// The value for the inner raceway uses the cage's speed where the speed of the contact relative to the
    /// inner ring belongs, so it stands for no motion in the bearing.
    pub fn paper_noise_hz(&self, element_size: f64) -> (f64, f64) {
        let tone = |diameter_m: f64| TAU * self.cage_on_outer_hz * diameter_m / (2.0 * element_size);
        (tone(self.raceways_m[0]), tone(self.raceways_m[1]))
    }

    /// Rollers that leave `defect` within `duration_s`, in the order of their entry.
    ///
    /// They start at the angles `start_deg`, roller 1 first. As seen from the outer ring all move with the
    /// shaft: clockwise at a positive speed, where the leading edge is the one at the larger angle; as seen
    /// from the inner one, which turns faster, the other way round. A roller that starts inside the defect
    /// has a negative entry time. Empty when the rings stand still against each other.
    pub fn crossings(&self, defect: impl Into<Stretch>, start_deg: &[f64], duration_s: f64) -> Vec<Crossing> {
        let (defect, sense, [outer_m, inner_m]) = (defect.into(), self.sense(), self.raceways_m);
        let (speed, diameter, ahead) = match defect.ring {
            Ring::Outer => (360.0 * self.cage_on_outer_hz, outer_m, sense),
            Ring::Inner => (360.0 * self.cage_on_inner_hz, inner_m, -sense),
        };
        if !(speed > 0.0 && duration_s.is_finite()) {
            return Vec::new();
        }
        let half = (defect.length / diameter).to_degrees();
        let mut crossings = Vec::new();
        for (roller, start) in start_deg.iter().enumerate() {
            let trailing = defect.angle_deg - ahead * half;
            let mut exit_s = (ahead * (*start - trailing)).rem_euclid(360.0) / speed;
            while exit_s <= duration_s {
                let (centre_s, entry_s) = (exit_s - half / speed, exit_s - 2.0 * half / speed);
                crossings.push(Crossing { roller: roller + 1, entry_s, centre_s, exit_s });
                exit_s += 360.0 / speed;
            }
        }
        crossings.sort_by(|a, b| a.entry_s.total_cmp(&b.entry_s));
        crossings
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bearing::singh2014::DIMENSIONS;

    /// The spall of the paper, at the top of the outer raceway.
    const SPALL: Stretch = Stretch { ring: Ring::Outer, length: 1e-3 * 10.0, angle_deg: 90.0 };

    /// Angles of its rollers at the start.
    fn angles() -> Vec<f64> {
        (0..24).map(|i| 94.0 + 360.0 * f64::from(i) / 24.0).collect()
    }

    /// Source: an inner raceway meets every roller (f_s − f_c) N times in N turns of the cage relative to it,
    /// THEORY §5.1.
    #[test]
    fn analytic_rollers_cross_an_inner_defect_at_bpfi() {
        let defect = Stretch { ring: Ring::Inner, ..SPALL };
        let k = paper();
        let crossings = k.crossings(defect, &angles(), 1.0);
        let apart = (crossings[100].centre_s - crossings[0].centre_s) / 100.0;
        // Formulas with the pitch circle share the clearance between the raceways otherwise.
        assert_close(apart, 1.0 / k.bpfi_hz, PRINTED);
        assert_close(apart, 1.0 / (24.0 * (k.shaft_hz - k.cage_hz)), 1e-9);
        // The roller behind the defect in the sense of rotation is never the first: the inner ring runs ahead
        // of it.
        assert_eq!(crossings[0].roller, 24);
        let length_m = k.contact_speed_m_s * (crossings[0].exit_s - crossings[0].entry_s);
        assert_close(length_m, 10e-3, 1e-9);
    }

    /// Source: in a frame that turns with the outer ring it stands still, and speeds add; THEORY §5.1.
    #[test]
    fn analytic_rings_that_turn_against_each_other() {
        let bearing = DIMENSIONS;
        let still = Kinematics::new(bearing, 700.0);
        let both = Kinematics::between(bearing, 500.0, -200.0);
        for (a, b) in [
            (still.bpfo_hz, both.bpfo_hz),
            (still.bpfi_hz, both.bpfi_hz),
            (still.bsf_hz, both.bsf_hz),
            (still.cage_hz, both.cage_on_outer_hz),
            (still.roller_relative_rad_s, both.roller_relative_rad_s),
            (still.cage_rad_s, both.cage_rad_s - both.outer_rad_s),
        ] {
            assert_close(a, b, ROUNDING);
        }
        // Speeds of the contacts, (ω_i D_i + ω_o D_o)/(D_i + D_o), clockwise positive.
        let (d_i, d_o) = (bearing.inner_race_mm, bearing.outer_race_mm);
        assert_close(both.cage_hz, ((500.0 * d_i - 200.0 * d_o) / (60.0 * (d_i + d_o))).abs(), ROUNDING);
        let hub = Kinematics::between(bearing, 0.0, 600.0);
        assert_close(hub.cage_hz, 10.0 * d_o / (d_i + d_o), ROUNDING);
        assert_eq!((hub.shaft_hz, hub.outer_ring_hz, hub.sense()), (0.0, 10.0, -1.0));
        let together = Kinematics::between(bearing, 300.0, 300.0);
        assert_eq!((together.bpfo_hz, together.cage_hz), (0.0, 5.0));
    }

    /// The notes print four or five digits.
    const PRINTED: f64 = 1.5e-4;
    /// Closed forms evaluated twice.
    const ROUNDING: f64 = 1e-12;

    fn paper() -> Kinematics {
        Kinematics::new(DIMENSIONS, 500.0)
    }

    fn assert_close(ours: f64, theirs: f64, relative: f64) {
        assert!((ours - theirs).abs() <= relative * theirs.abs(), "{ours} instead of {theirs}");
    }

    /// Source: Singh et al. 2014, table 1.
    #[test]
    fn analytic_speeds_of_table_1() {
        let k = paper();
        assert_close(k.shaft_hz, 8.333_333, PRINTED);
        assert_close(k.shaft_rad_s, -52.360, PRINTED);
        assert_close(k.cage_equation_1_hz, 3.7545, PRINTED);
        assert_close(k.cage_outer_hz, 3.7537, PRINTED);
        assert_close(360.0 * k.cage_hz, 1_351.467_194_197_164_4, ROUNDING);
        assert_close(k.bpfo_hz, 90.11, PRINTED);
        assert_close(k.bpfi_hz, 200.0 - 90.109, PRINTED);
        assert_close(k.cage_rad_s, -23.585, PRINTED);
        assert_close(k.contact_speed_m_s, 2.358_755_227_143_012_3, ROUNDING);
    }

    /// Source: THEORY §5.1.
    #[test]
    fn analytic_roller_spin_lies_in_the_band_of_the_three_definitions() {
        let k = paper();
        assert!((41.707..=41.718).contains(&k.roller_spin_hz), "{}", k.roller_spin_hz);
        assert!((41.707..=41.718).contains(&k.bsf_hz), "{}", k.bsf_hz);
        assert_close(k.roller_relative_rad_s / TAU, 41.707, PRINTED);
    }

    #[test]
    fn invariant_contact_points_do_not_slip() {
        // Riding on the outer raceway: the roller's outermost point stands still, its innermost one moves
        // with the ring.
        let k = paper();
        let centre = k.cage_rad_s * 91.0e-3;
        assert!((centre + k.roller_rad_s * 9.0e-3).abs() < 1e-12);
        assert_close(centre - k.roller_rad_s * 9.0e-3, k.shaft_rad_s * 81.98e-3, ROUNDING);
        assert!(k.cage_rad_s < 0.0 && k.roller_rad_s > 0.0);
    }

    /// Source: THEORY §5.2.
    #[test]
    fn analytic_facet_tones_of_the_paper_mesh() {
        let facets = FacetCounts { roller: 112, outer: 1257.0, inner: 1030.0 };
        let tones = paper().facet_tones(facets);
        assert_eq!(tones.map(|tone| tone.name), ["roller_vertices", "outer_race_nodes", "inner_race_nodes"]);
        assert_close(tones[0].hz, 4671.5, PRINTED);
        assert_close(tones[1].hz, 4719.0, PRINTED);
        assert_close(tones[2].hz, 4716.0, PRINTED);
    }

    /// Source: Singh et al. 2014, equation (2).
    #[test]
    fn analytic_equation_2_of_the_paper() {
        // The paper rounds its cage frequency to 3.75 Hz and the inner raceway to 164 mm.
        const ROUNDED_INPUT: f64 = 1.5e-3;
        let (outer, inner) = paper().paper_noise_hz(0.5e-3);
        assert_close(outer, 4712.0, ROUNDED_INPUT);
        assert_close(inner, 3864.0, ROUNDED_INPUT);
    }

    /// Source: Singh et al. 2014, table 1, computed apart from this program
    /// (`fixtures/reference/event_times.json`).
    #[test]
    fn analytic_event_times_of_the_reference() {
        let text = include_str!("../../../../fixtures/reference/event_times.json");
        let reference: serde_json::Value = serde_json::from_str(text).expect("valid JSON");
        let crossings = paper().crossings(SPALL, &angles(), 30e-3);
        assert_eq!(crossings.iter().map(|c| c.roller).collect::<Vec<_>>(), [1, 2, 3]);
        for crossing in crossings {
            let expected = &reference[format!("roller{}", crossing.roller)];
            let ms = |key: &str| expected[key].as_f64().expect("a number");
            assert_close(crossing.entry_s * 1e3, ms("lead_edge_ms"), 1e-11);
            assert_close(crossing.centre_s * 1e3, ms("centre_ms"), 1e-11);
            assert_close(crossing.exit_s * 1e3, ms("trail_edge_ms"), 1e-11);
        }
    }

    #[test]
    fn invariant_crossings_repeat_at_bpfo() {
        // One second: exits come at 24 times the cage frequency, whatever the roller's first angle.
        let k = paper();
        let crossings = k.crossings(SPALL, &angles(), 1.0);
        assert_eq!(crossings.len(), 90);
        for pair in crossings.windows(2) {
            assert_close(pair[1].exit_s - pair[0].exit_s, 1.0 / (24.0 * k.cage_hz), 1e-9);
        }
        let inside = k.crossings(SPALL, &[91.0, 106.0], 6e-3);
        assert!(inside[0].entry_s < 0.0 && inside[0].roller == 1);
    }

    /// Rotation in the other direction is the mirror image: frequencies stay, angular velocities change their
    /// sign, and rollers that start at mirrored angles meet a mirrored defect at the same times.
    #[test]
    fn invariant_a_shaft_that_turns_back_is_the_mirror_image() {
        let (there, back) = (paper(), Kinematics::new(DIMENSIONS, -500.0));
        let hz = |k: &Kinematics| [k.shaft_hz, k.cage_hz, k.bpfo_hz, k.bpfi_hz, k.bsf_hz, k.roller_spin_hz];
        assert_eq!(hz(&there), hz(&back));
        assert_eq!(there.contact_speed_m_s, back.contact_speed_m_s);
        let turns = |k: &Kinematics| [k.shaft_rad_s, k.cage_rad_s, k.roller_rad_s, k.roller_relative_rad_s];
        assert_eq!(turns(&there), turns(&back).map(|rate| -rate));
        assert_eq!((there.sense(), back.sense()), (1.0, -1.0));
        let angles = angles();
        let mirrored: Vec<f64> = angles.iter().map(|angle| 180.0 - angle).collect();
        for ring in [Ring::Outer, Ring::Inner] {
            let defect = |angle_deg| Stretch { ring, angle_deg, ..SPALL };
            let ours = there.crossings(defect(70.0), &angles, 1.0);
            let theirs = back.crossings(defect(110.0), &mirrored, 1.0);
            assert!(ours.len() > 80 && ours.len() == theirs.len());
            for (a, b) in ours.iter().zip(&theirs) {
                assert_eq!(a.roller, b.roller);
                let apart = [a.entry_s - b.entry_s, a.centre_s - b.centre_s, a.exit_s - b.exit_s];
                assert!(apart.iter().all(|s| s.abs() < ROUNDING), "{a:?} {b:?}");
            }
        }
    }

    #[test]
    fn behaves_a_standing_shaft_has_no_events() {
        assert_eq!(Kinematics::new(DIMENSIONS, 0.0).crossings(SPALL, &[94.0], 1.0).len(), 0);
    }
}
