use super::*;

/// The paper's bearing: 24 rollers, cage and spin relative to it [Hz].
const ROLLERS: usize = 24;
const CAGE_HZ: f64 = 3.754;
const SPIN_HZ: f64 = 41.71;
const SHAFT_HZ: f64 = 8.3333;
const INTERVAL_S: f64 = 1e-5;
/// Counts of facets whose carriers lie 20 to 60 Hz apart, less than two resolutions of 33 Hz.
const CANDIDATES: [(&str, Source); 3] = [
    ("roller_vertices", Source::RotatedVertices(112.0)),
    ("outer_race_nodes", Source::OuterNodes(1255.0)),
    ("inner_race_nodes", Source::InnerNodes(1030.0)),
];

fn candidates() -> Vec<Candidate> {
    CANDIDATES.map(|(name, source)| Candidate { name: name.into(), source }).to_vec()
}

/// Rollers that share a load by the cosine, a defect-free 30 ms. Loaded rollers turn `slip` slower than rolling, each by a
/// little of its own.
fn motion(samples: usize, slip: f64) -> Motion {
    let rollers = (0..ROLLERS).map(|number| {
        let start = 94f64.to_radians() - TAU * number as f64 / ROLLERS as f64;
        let spin_hz = SPIN_HZ * (1.0 - slip) * (1.0 + 1e-3 * (number as f64).sin()) - CAGE_HZ;
        let times = || (0..samples).map(|n| n as f64 * INTERVAL_S);
        let orbit: Vec<f64> = times().map(|t| start - TAU * CAGE_HZ * t).collect();
        RollerTrack {
            spin: times().map(|t| TAU * spin_hz * t).collect(),
            load_n: orbit.iter().map(|a| 12e3 * a.sin().max(0.0)).collect(),
            orbit,
        }
    });
    Motion {
        interval_s: INTERVAL_S,
        shaft_rad_s: -TAU * SHAFT_HZ,
        bpfo_hz: CAGE_HZ * ROLLERS as f64,
        rollers: rollers.collect(),
    }
}

/// Four accelerations and two forces: `gain` [g] of what each roller does by its load, a transfer of its own for each
/// channel, and `noise` [g] that is the same on every machine.
fn channels(
    motion: &Motion,
    source: Option<Source>,
    detuned_hz: f64,
    gain: f64,
    noise: f64,
) -> [Vec<Channel>; 2] {
    seeded(motion, source, detuned_hz, gain, noise, 5)
}

fn seeded(
    motion: &Motion,
    source: Option<Source>,
    detuned_hz: f64,
    gain: f64,
    noise: f64,
    mut seed: u64,
) -> [Vec<Channel>; 2] {
    let samples = motion.samples();
    let mut channel = |number: usize| {
        let values = (0..samples).map(|n| {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            let random = 2.0 * ((seed >> 40) as f64 / (1u64 << 24) as f64) - 1.0;
            let heard = |source: Source| -> f64 {
                let one = |r: &RollerTrack| {
                    let place = number as f64 * 1.1 + 1.7 * r.orbit[n].rem_euclid(TAU);
                    let extra = TAU * detuned_hz * n as f64 * INTERVAL_S;
                    r.load_n[n] / 12e3
                        * place.cos()
                        * (source.phase(motion, r, n) + extra + number as f64).cos()
                };
                motion.rollers.iter().map(one).sum()
            };
            gain * source.map_or(0.0, heard) + noise * random
        });
        Channel {
            sensor: format!("s{}", number / 2),
            component: ["ay", "ax"][number % 2].into(),
            values: values.collect(),
        }
    };
    [(0..4).map(&mut channel).collect(), (4..6).map(&mut channel).collect()]
}

fn judged(motion: &Motion, [accelerations, forces]: &[Vec<Channel>; 2]) -> Vec<FamilyFinding> {
    identify(motion, &candidates(), accelerations, forces).unwrap()
}

fn found(families: &[FamilyFinding]) -> Vec<&str> {
    families.iter().filter(|f| f.found).map(|f| f.name.as_str()).collect()
}

#[test]
fn example_each_family_is_told_from_its_neighbours() {
    let motion = motion(3000, 0.0);
    for (name, source) in CANDIDATES {
        let families = judged(&motion, &channels(&motion, Some(source), 0.0, 40.0, 8.0));
        assert_eq!(found(&families), [name], "{families:#?}");
        let family = families.iter().find(|f| f.found).unwrap();
        assert!(family.offset_resolutions.unwrap().abs() <= 0.5, "{family:?}");
        assert!(
            family.lines.iter().any(|l| l.measured_hz.is_some()) && family.level_g > Some(1.0),
            "{family:?}"
        );
        assert_eq!(family.lines.len(), 4 * 7);
    }
}

#[test]
fn example_slip_moves_the_prediction_with_the_line() {
    // Two per cent of slip are 93 Hz, three resolutions: without the recorded motion nothing would stand where it should.
    let motion = motion(3000, 0.02);
    let families = judged(&motion, &channels(&motion, Some(CANDIDATES[0].1), 0.0, 10.0, 8.0));
    assert_eq!(found(&families), ["roller_vertices"], "{families:#?}");
    let without_slip_hz = 112.0 * SPIN_HZ;
    let carrier_hz = families[0].carrier_hz.unwrap();
    assert!((carrier_hz - 0.98 * without_slip_hz).abs() < 15.0, "{carrier_hz}");
}

#[test]
fn example_ten_records_of_noise_hold_no_family() {
    let motion = motion(3000, 0.0);
    for seed in 1..=10 {
        let families = judged(&motion, &seeded(&motion, None, 0.0, 0.0, 8.0, seed * 7919));
        assert_eq!(found(&families), [""; 0], "{families:#?}");
        assert!(families.iter().all(|f| f.carrier_hz.is_none() && f.level_g.is_none() && f.lines.is_empty()));
        assert!(families.iter().all(|f| f.verdict.starts_with("absent")), "{families:#?}");
    }
}

#[test]
fn example_a_comb_in_the_wrong_place_has_no_name() {
    // 150 Hz above the vertices, 89 to 139 Hz from the others: neither a family's place nor that of its sidebands.
    let motion = motion(3000, 0.0);
    let families = judged(&motion, &channels(&motion, Some(CANDIDATES[0].1), 135.0, 10.0, 1.0));
    assert_eq!(found(&families), [""; 0], "{families:#?}");
}

#[test]
fn example_a_short_record_is_not_judged() {
    let motion = motion(600, 0.0);
    let families = judged(&motion, &channels(&motion, Some(CANDIDATES[0].1), 0.0, 10.0, 1.0));
    assert_eq!(found(&families), [""; 0]);
    assert!(families.iter().all(|f| f.verdict.contains("0.5 periods of BPFO")), "{families:#?}");
    let nobody = Motion { rollers: Vec::new(), ..motion };
    assert_eq!(found(&judged(&nobody, &[Vec::new(), Vec::new()])), [""; 0]);
}

#[test]
fn example_subtracting_a_comb_leaves_the_noise() {
    let motion = motion(3000, 0.0);
    let [accelerations, forces] = channels(&motion, Some(CANDIDATES[0].1), 0.0, 10.0, 0.0);
    let mut signals = Signals::of(&accelerations, &forces);
    let power = |signals: &Signals| signals.values.iter().flatten().map(|v| v * v).sum::<f64>();
    let before = power(&signals);
    let comb = Comb::of(&motion, CANDIDATES[0].1).unwrap();
    signals.subtract(&motion, &comb, 0.0);
    // The transfer is 1.7 times the place, which the even multiples of it match in the load zone to some per cent.
    assert!(power(&signals) < 0.05 * before, "{}", power(&signals) / before);
}
