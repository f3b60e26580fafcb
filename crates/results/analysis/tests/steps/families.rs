//! Combs of facet lines in made records of the paper's bearing.

use std::f64::consts::TAU;

use stribeck_analysis::families::{
    Candidate, Channel, FamilyFinding, LEAST_LEAD, MOST_PERIODS, RecordedMotion, RollerTrack, Source,
    identify,
};
use stribeck_testing::Noise;

/// The paper's bearing with 24 rollers, cage and spin relative to it [Hz].
const ROLLERS: usize = 24;
const CAGE_HZ: f64 = 3.754;
const SPIN_HZ: f64 = 41.71;
const SHAFT_HZ: f64 = 8.3333;
const INTERVAL_S: f64 = 1e-5;
/// 30 ms, which resolve 33 Hz.
const SAMPLES: usize = 3000;
/// Counts of facets whose carriers lie 5 to 44 Hz apart.
const CANDIDATES: [(&str, Source); 3] = [
    ("roller_vertices", Source::RotatedVertices(112.0)),
    ("outer_race_nodes", Source::OuterNodes(1255.0)),
    ("inner_race_nodes", Source::InnerNodes(1030.0)),
];

/// Strength and frequency of a family in a synthetic record.
#[derive(Clone, Copy)]
struct Sound {
    source: Source,
    /// Moves its lines [Hz].
    detuned_hz: f64,
    /// Amplitude at a sensor by a roller under the largest load [g].
    gain_g: f64,
}

impl Sound {
    fn of(source: Source) -> Self {
        Self { source, detuned_hz: 0.0, gain_g: 10.0 }
    }
}

/// Phase of a roller's facets at its contacts at sample `n` [rad]; the outer ring stands still. THEORY §7.7,
/// equation (7.8).
fn phase(source: Source, motion: &RecordedMotion, roller: &RollerTrack, n: usize) -> f64 {
    let (orbit, spin) = (roller.orbit[n], roller.spin[n]);
    match source {
        Source::RotatedVertices(count) => count * (spin - (orbit - roller.place)),
        Source::TranslatedVertices(count) => count * (spin - orbit),
        Source::OuterNodes(count) => -count * orbit,
        Source::InnerNodes(count) => count * (orbit - motion.shaft_rad_s * n as f64 * motion.interval_s),
    }
}

/// Rollers that share a load by the cosine, without a defect. Loaded rollers turn `slip` slower than rolling,
/// each by a little of its own.
fn silent(samples: usize, slip: f64) -> RecordedMotion {
    let rollers = (0..ROLLERS).map(|number| {
        let start = 94f64.to_radians() - TAU * number as f64 / ROLLERS as f64;
        let spin_hz = SPIN_HZ * (1.0 - slip) * (1.0 + 1e-3 * (number as f64).sin()) - CAGE_HZ;
        let times = || (0..samples).map(|n| n as f64 * INTERVAL_S);
        let orbit: Vec<f64> = times().map(|t| start - TAU * CAGE_HZ * t).collect();
        RollerTrack {
            place: start,
            spin: times().map(|t| TAU * spin_hz * t).collect(),
            load_n: orbit.iter().map(|a| 12e3 * a.sin().max(0.0)).collect(),
            orbit,
        }
    });
    RecordedMotion {
        interval_s: INTERVAL_S,
        shaft_rad_s: -TAU * SHAFT_HZ,
        outer_rad_s: 0.0,
        bpfo_hz: CAGE_HZ * ROLLERS as f64,
        rollers: rollers.collect(),
    }
}

/// Puts sounds and `noise_g` on four accelerations, each with a transfer of its own that depends on the place
/// of the roller, and a thousandth of the load for each g on the force of every roller.
fn sounding(
    mut motion: RecordedMotion,
    sounds: &[Sound],
    noise_g: f64,
    seed: u64,
) -> (RecordedMotion, Vec<Channel>) {
    let samples = motion.rollers[0].orbit.len();
    let mut noise = Noise::new(seed);
    let heard = |roller: &RollerTrack, n: usize, of_place: &dyn Fn(f64) -> (f64, f64)| -> f64 {
        let (gain, lag) = of_place(roller.orbit[n].rem_euclid(TAU));
        let one = |s: &Sound| {
            let phase = phase(s.source, &motion, roller, n) + TAU * s.detuned_hz * n as f64 * INTERVAL_S;
            s.gain_g * gain * roller.load_n[n] / 12e3 * (phase + lag).cos()
        };
        sounds.iter().map(one).sum()
    };
    let mut accelerations = Vec::new();
    for number in 0..4 {
        let at = |place: f64| ((number as f64 * 1.1 + 1.7 * place).cos(), number as f64 + 0.8 * place);
        let value = |n: usize| {
            motion.rollers.iter().map(|roller| heard(roller, n, &at)).sum::<f64>() + noise_g * noise.uniform()
        };
        accelerations.push(Channel {
            sensor: format!("s{}", number / 2),
            component: ["ay", "ax"][number % 2].into(),
            values: (0..samples).map(value).collect(),
        });
    }
    let ripples: Vec<Vec<f64>> = motion
        .rollers
        .iter()
        .map(|roller| {
            let at = |place: f64| (1.0, 0.8 * place);
            (0..samples)
                .map(|n| heard(roller, n, &at) + noise_g * noise.uniform() * roller.load_n[n] / 12e3)
                .collect()
        })
        .collect();
    for (roller, ripple) in motion.rollers.iter_mut().zip(&ripples) {
        roller.load_n.iter_mut().zip(ripple).for_each(|(load, ripple)| *load += 12.0 * ripple);
    }
    (motion, accelerations)
}

/// The motion from sample `from` on.
fn late(motion: &RecordedMotion, from: usize) -> RecordedMotion {
    let track = |roller: &RollerTrack| RollerTrack {
        place: roller.place,
        orbit: roller.orbit[from..].to_vec(),
        spin: roller.spin[from..].to_vec(),
        load_n: roller.load_n[from..].to_vec(),
    };
    RecordedMotion { rollers: motion.rollers.iter().map(track).collect(), ..motion.clone() }
}

fn judged(
    candidates: &[(&str, Source)],
    (motion, accelerations): &(RecordedMotion, Vec<Channel>),
) -> Vec<FamilyFinding> {
    let candidates: Vec<Candidate> =
        candidates.iter().map(|(name, source)| Candidate { name: (*name).into(), source: *source }).collect();
    identify(motion, &candidates, accelerations).unwrap()
}

fn found(families: &[FamilyFinding]) -> Vec<&str> {
    families.iter().filter(|f| f.found).map(|f| f.name.as_str()).collect()
}

#[test]
fn behaves_of_a_long_record_the_last_part_is_judged() {
    let periods = |samples: usize| samples as f64 * INTERVAL_S * CAGE_HZ * ROLLERS as f64;
    let samples = (1.25 * MOST_PERIODS / periods(1)) as usize;
    let record = sounding(silent(samples, 0.0), &[Sound::of(CANDIDATES[0].1)], 8.0, 5);
    let families = judged(&CANDIDATES, &record);
    assert_eq!(found(&families), [CANDIDATES[0].0], "{families:#?}");
    // Copies that are turned with the pattern have a line at the rate itself, whatever the place of each
    // roller was when the part began. That part by itself has the same line, and another one once it is a
    // sample shorter.
    let from = samples - (MOST_PERIODS / periods(1)) as usize;
    assert!((periods(samples - from) - MOST_PERIODS).abs() < 0.1);
    let line_hz = |motion: RecordedMotion| judged(&CANDIDATES[..1], &(motion, Vec::new()))[0].predicted_hz;
    let whole = line_hz(record.0.clone());
    assert!(whole.is_some() && line_hz(late(&record.0, from)) == whole, "{whole:?}");
    assert_ne!(line_hz(late(&record.0, from + 1)), whole);
}

#[test]
fn planted_each_family_is_distinguished_from_its_neighbours() {
    for (name, source) in CANDIDATES {
        let families = judged(&CANDIDATES, &sounding(silent(SAMPLES, 0.0), &[Sound::of(source)], 8.0, 5));
        assert_eq!(found(&families), [name], "{families:#?}");
        let family = families.iter().find(|f| f.found).unwrap();
        assert!(family.offset_resolutions.unwrap().abs() <= 0.5, "{family:?}");
        assert!(family.lines.iter().any(|l| l.measured_hz.is_some()), "{family:?}");
        assert_eq!(family.lines.len(), 4 * 7);
    }
}

#[test]
fn planted_two_combs_of_one_motion_are_not_distinguished() {
    // A fiftieth of a facet is 0.08 Hz, and three degrees of phase from one end of the load zone to the
    // other.
    let twins = [CANDIDATES[1], ("other_race_nodes", Source::OuterNodes(1255.02)), CANDIDATES[0]];
    let families = judged(&twins, &sounding(silent(SAMPLES, 0.0), &[Sound::of(CANDIDATES[1].1)], 8.0, 5));
    assert_eq!(found(&families), [""; 0], "{families:#?}");
    for (one, other) in [(0, 1), (1, 0)] {
        assert_eq!(families[one].not_told_apart_from, [twins[other].0]);
        assert!(families[one].carrier_hz.is_some() && !families[one].lines.is_empty());
        assert!(families[one].verdict.starts_with("not distinguishable"), "{families:#?}");
    }
    assert!(families[2].carrier_hz.is_none() && families[2].not_told_apart_from.is_empty(), "{families:#?}");
}

#[test]
fn planted_two_families_are_both_found() {
    let both = [("roller_vertices", Source::RotatedVertices(98.0)), CANDIDATES[1], CANDIDATES[2]];
    let sounds = [Sound::of(both[0].1), Sound { gain_g: 5.0, ..Sound::of(both[1].1) }];
    let families = judged(&both, &sounding(silent(SAMPLES, 0.0), &sounds, 4.0, 5));
    assert_eq!(found(&families), ["roller_vertices", "outer_race_nodes"], "{families:#?}");
}

#[test]
fn planted_slip_moves_the_prediction_with_the_line() {
    // Two per cent of slip are 93 Hz, three resolutions: without the recorded motion nothing would stand
    // where it should.
    let families =
        judged(&CANDIDATES, &sounding(silent(SAMPLES, 0.02), &[Sound::of(CANDIDATES[0].1)], 8.0, 5));
    assert_eq!(found(&families), ["roller_vertices"], "{families:#?}");
    let without_slip_hz = 112.0 * SPIN_HZ;
    let carrier_hz = families[0].carrier_hz.unwrap();
    assert!((carrier_hz - 0.98 * without_slip_hz).abs() < 15.0, "{carrier_hz}");
}

#[test]
fn planted_the_carrier_is_a_line_of_the_comb() {
    // 1255 nodes over 24 rollers are 52.29 a roller spacing: the outer raceway sounds at whole multiples of
    // BPFO, here 52, not at 1255 times the cage. Copies of 112 facets in one orientation are a third of a
    // facet out of step.
    let motion = silent(SAMPLES, 0.0);
    let bpfo_hz = motion.bpfo_hz;
    let motion = (motion, Vec::new());
    let line_hz = |source: Source| judged(&[("", source)], &motion)[0].predicted_hz.unwrap();
    let resolution_hz = 1.0 / (SAMPLES as f64 * INTERVAL_S);
    for (source, expected_hz) in [
        (Source::RotatedVertices(112.0), 112.0 * SPIN_HZ),
        (Source::TranslatedVertices(112.0), 112.0 * SPIN_HZ + bpfo_hz / 3.0),
        (Source::OuterNodes(1255.0), 52.0 * bpfo_hz),
        (Source::InnerNodes(1030.0), 1030.0 * SHAFT_HZ - 43.0 * bpfo_hz),
    ] {
        // Three periods of BPFO leave neighbouring lines to lean on each other by some tenths of a
        // resolution.
        assert!(
            (line_hz(source) - expected_hz).abs() < 0.3 * resolution_hz,
            "{source:?} {} {expected_hz}",
            line_hz(source)
        );
    }
}

#[test]
fn planted_ten_records_of_noise_hold_no_family() {
    // White noise stands 9 dB above its median within half a resolution of a place in 0.8 % of channels, two
    // independent values of 2^−7.9 each. One of these thirty verdicts on four channels is expected to stay
    // open; more than three have odds of 2 % (Poisson).
    let mut open = 0;
    for seed in 1..=10 {
        let families = judged(&CANDIDATES, &sounding(silent(SAMPLES, 0.0), &[], 8.0, seed * 7919));
        assert_eq!(found(&families), [""; 0], "{families:#?}");
        assert!(families.iter().all(|f| f.carrier_hz.is_none() && f.level_g.is_none() && f.lines.is_empty()));
        assert!(families.iter().all(|f| f.is_open() || f.verdict.starts_with("absent")), "{families:#?}");
        open += families.iter().filter(|f| f.is_open()).count();
    }
    assert!(open <= 3, "{open}");
}

#[test]
fn planted_a_comb_in_the_wrong_place_has_no_name() {
    // Laid over each other, the three combs have lines at −14, 0 and 24 Hz from a multiple of BPFO. These are
    // at 50 Hz, 26 Hz or 0.8 resolutions from the nearest.
    let sound = Sound { detuned_hz: 64.0, ..Sound::of(CANDIDATES[0].1) };
    let families = judged(&CANDIDATES, &sounding(silent(SAMPLES, 0.0), &[sound], 1.0, 5));
    assert_eq!(found(&families), [""; 0], "{families:#?}");
    assert!(families.iter().all(|f| f.carrier_hz.is_none()), "{families:#?}");
}

/// A reduced bearing with 99 facets on its rollers had a line 16 dB above its surroundings where the nodes of
/// its inner raceway have their carrier, and the family was called absent.
#[test]
fn issue_a_family_with_a_line_at_its_place_is_not_called_absent() {
    let (motion, mut accelerations) = sounding(silent(SAMPLES, 0.0), &[], 8.0, 5);
    let quiet = judged(&CANDIDATES, &(motion.clone(), accelerations.clone()));
    assert!(quiet.iter().all(|f| !f.is_open()), "{quiet:#?}");
    // At one sensor alone: too little for a comb.
    let hz = quiet[2].predicted_hz.unwrap();
    for (n, value) in accelerations[1].values.iter_mut().enumerate() {
        *value += 1.5 * (TAU * hz * n as f64 * INTERVAL_S).sin();
    }
    let families = judged(&CANDIDATES, &(motion, accelerations));
    assert_eq!(found(&families), [""; 0], "{families:#?}");
    let open: Vec<bool> = families.iter().map(FamilyFinding::is_open).collect();
    assert_eq!(open, [false, false, true], "{families:#?}");
    assert!(families[2].standing_db > Some(12.0) && families[2].carrier_hz.is_none(), "{families:#?}");
    assert!(families[2].verdict.starts_with("open: a line stands"), "{families:#?}");
}

#[test]
fn behaves_a_short_record_is_not_judged() {
    let families = judged(&CANDIDATES, &sounding(silent(600, 0.0), &[Sound::of(CANDIDATES[0].1)], 1.0, 5));
    assert_eq!(found(&families), [""; 0]);
    assert!(families.iter().all(|f| f.verdict.contains("0.5 periods of BPFO")), "{families:#?}");
    let nobody = RecordedMotion { rollers: Vec::new(), ..silent(SAMPLES, 0.0) };
    assert_eq!(found(&judged(&CANDIDATES, &(nobody, Vec::new()))), [""; 0]);
}

/// The message on 99 facets was that their comb explains as much as one at any other place, beside a lead
/// of 0.50: it fitted best 0.55 resolutions off.
#[test]
fn issue_a_comb_that_leads_off_its_place_is_named_with_its_distance() {
    let sound = Sound { detuned_hz: 22.0, ..Sound::of(CANDIDATES[0].1) };
    let families = judged(&CANDIDATES[..1], &sounding(silent(SAMPLES, 0.0), &[sound], 1.0, 5));
    let [vertices] = &families[..] else { panic!("{families:#?}") };
    assert!(!vertices.found && vertices.lead.is_some_and(|lead| lead >= LEAST_LEAD), "{vertices:#?}");
    let off = vertices.offset_resolutions.unwrap().abs();
    assert!(off > 0.5 && off < 1.0, "{vertices:#?}");
    let told = format!("fits best {off:.2} resolutions from where the recorded motion puts it");
    assert!(vertices.verdict.contains(&told), "{vertices:#?}");
    assert!(!vertices.verdict.contains("no more than"), "{vertices:#?}");
}
