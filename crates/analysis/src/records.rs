//! Signatures of a run's force as a machine's sensor would record it: behind an unknown path, in noise.

use serde::{Deserialize, Serialize};
use stribeck_dsp::{PASSAGES, Path, Rhythm, Signature, statistics};
use stribeck_scene::dice::Dice;
use stribeck_scene::scene::{DefectRing, Scene};

use crate::Error;
use stribeck_diagnosis::SHORTEST_S;
use stribeck_diagnosis::quantities;

/// Longest distance of two events over the time between passages, at which the correlation within one ends.
const LONGEST: f64 = 0.45;

quantities! {
    /// One record: the signature of its passages, and the noise that was added.
    #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
    pub struct RecordFinding {
        /// Power of the noise over that of the rest [dB].
        pub noise_db: f64,
        /// Level of the record of the scene's machine, the same for every noise [m/s²]; `None` without a machine.
        pub level_m_s2: Option<f64>,
        /// Numbers that a path does not change.
        #[serde(flatten)]
        pub signature: PassageSignature,
    }
}

quantities! {
    /// Signature of passages over a spall, which does not depend on the path. Times are parts of the period
    /// of the passages.
    #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
    pub struct PassageSignature = of(signature: &Signature) {
        /// Time between the two events of a passage; `None` where no second one shows.
        pub spacing: Option<f64> = signature.spacing,
        /// Time from which on a second event would have shown; `None` where one shows, or nothing is known.
        pub clear_from: Option<f64> = signature.clear_from,
        /// Energy of the first event over that of the second [dB].
        pub first_over_second_db: Option<f64> = signature.first_over_second_db,
        /// Correlation of the power within a passage, at 24 lags from 0.03 to 0.45 of its period: a second
        /// event is a hump at its distance.
        pub within: Vec<f64> = signature.within.to_vec(),
        /// Correlation of the power with that one passage later.
        pub repeats: f64 = signature.repeats,
        /// The same ten passages later.
        pub repeats_later: f64 = signature.repeats_later,
        /// Sidebands of the shaft beside the first line of the passages, over that line [dB].
        pub by_shaft_db: f64 = signature.sidebands_db[0],
        /// The same of the cage [dB].
        pub by_cage_db: f64 = signature.sidebands_db[1],
        /// How far the power swings with the passages, over its mean.
        pub swing: f64 = signature.swing,
    }
}

/// The rhythm in which elements pass a spall.
pub fn rhythm(passing_hz: f64, shaft_hz: f64, cage_hz: f64) -> Rhythm {
    Rhythm { passing_hz, modulating_hz: [shaft_hz, cage_hz], shortest_s: SHORTEST_S, longest: LONGEST }
}

/// The rhythm of a scene with one spall and one speed; `None` for another one.
pub fn rhythm_of(scene: &Scene) -> Option<Rhythm> {
    let spall = scene.leading_spall().filter(|_| !scene.operation.speed_varies())?;
    let kinematics = scene.kinematics();
    let passing_hz = match spall.ring {
        DefectRing::Outer => kinematics.bpfo_hz,
        DefectRing::Inner => kinematics.bpfi_hz,
    };
    Some(rhythm(passing_hz, kinematics.shaft_hz, kinematics.cage_hz))
}

/// Duration of a run that has the passages of one record, and some before them [s].
pub fn duration_s(rhythm: Rhythm) -> f64 {
    (PASSAGES + BEFORE) / rhythm.passing_hz
}

/// Passages before a record begins: from the start until a bearing has settled.
const BEFORE: f64 = 5.0;

/// The records that a scene asks for, by the force of all rolling elements on the outer ring [N], sampled
/// `rate_hz` times a second, and the level of that of its machine; none where the force is too short, or the scene
/// has no rhythm, with a note.
pub(crate) fn of(
    scene: &Scene,
    force_n: &[f64],
    rate_hz: f64,
    level_m_s2: Option<f64>,
    notes: &mut Vec<String>,
) -> Result<Vec<RecordFinding>, Error> {
    let Some(asked) = &scene.output.records else { return Ok(Vec::new()) };
    let Some(rhythm) = rhythm_of(scene) else {
        notes.push("no records: a scene of one spall and one speed has a rhythm of passages".to_owned());
        return Ok(Vec::new());
    };
    let needed = (PASSAGES / rhythm.passing_hz * rate_hz).ceil() as usize + 2;
    let Some(from) = force_n.len().checked_sub(needed) else {
        notes.push(format!(
            "no records: the run holds {:.0} passages, and {PASSAGES} are needed; `solver.duration_ms` of \
             {:.0} is enough",
            force_n.len() as f64 / rate_hz * rhythm.passing_hz,
            1e3 * duration_s(rhythm)
        ));
        return Ok(Vec::new());
    };
    let mut dice = Dice::new(u64::from_str_radix(&scene.hash(), 16).unwrap_or_default());
    let path = Path::drawn(0.5 * asked.rate_hz, || dice.share());
    let plain = path.through(&force_n[from..], rate_hz, asked.rate_hz).map_err(Error::Signal)?;
    let rms = statistics::rms(&plain).map_err(Error::Signal)?;
    let one = |&noise_db: &f64| {
        let noise = rms * 10_f64.powf(noise_db / 20.0);
        let record: Vec<f64> = plain.iter().map(|x| x + noise * normal(&mut dice)).collect();
        let signature = Signature::of(&record, asked.rate_hz, rhythm).map_err(Error::Signal)?;
        Ok(RecordFinding { noise_db, level_m_s2, signature: PassageSignature::of(&signature) })
    };
    asked.noise_db.iter().map(one).collect()
}

/// Normally distributed with a variance of 1: G. E. P. Box and M. E. Muller, Ann. Math. Stat. 29 (1958) 610.
pub fn normal(dice: &mut Dice) -> f64 {
    let (length, turn) = (1.0 - dice.share(), dice.share());
    (-2.0 * length.ln()).sqrt() * (std::f64::consts::TAU * turn).cos()
}

#[cfg(test)]
mod tests {
    use super::*;
    use stribeck_scene::scene::RecordsScene;

    /// A 6205 at 900 rpm whose elements unload and strike at the ends of a spall of 2 mm.
    fn scene() -> Scene {
        let set = [
            "bearing=6205",
            "operation.speed_rpm=900",
            "operation.load_n=100",
            "output.records=(rate_hz: 51200, noise_db: [-20, 20])",
        ];
        Scene::singh2014().with_overrides(&set.map(str::to_owned)).expect("a scene")
    }

    fn force(scene: &Scene, spacing_s: f64, duration_s: f64) -> Vec<f64> {
        let rhythm = rhythm_of(scene).expect("a spall");
        let mut dice = Dice::new(4);
        let mut force = vec![100.0; (1e5 * duration_s) as usize];
        let mut at = 0.01;
        while at + spacing_s + 0.001 < duration_s {
            for (strikes_s, newtons) in [(at, 40.0), (at + spacing_s, -70.0)] {
                let first = (1e5 * strikes_s) as usize;
                (first..first + 20).for_each(|n| force[n] += newtons * (1.0 - (n - first) as f64 / 20.0));
            }
            at += (1.0 + 0.02 * (dice.share() - 0.5)) / rhythm.passing_hz;
        }
        force
    }

    #[test]
    fn planted_a_record_behind_a_random_path_tells_the_spacing_until_noise_hides_it() {
        let scene = scene();
        let rhythm = rhythm_of(&scene).expect("a spall");
        assert!((rhythm.passing_hz / 53.77 - 1.0).abs() < 0.01, "{rhythm:?}");
        let mut notes = Vec::new();
        let force = force(&scene, 2.5e-3, duration_s(rhythm));
        let found = of(&scene, &force, 1e5, Some(0.3), &mut notes).expect("records");
        assert!(notes.is_empty(), "{notes:?}");
        let [quiet, loud] = &found[..] else { panic!("{found:?}") };
        assert_eq!([quiet.level_m_s2, loud.level_m_s2], [Some(0.3); 2]);
        let expected = 2.5e-3 * rhythm.passing_hz;
        assert!((quiet.signature.spacing.expect("two events") / expected - 1.0).abs() < 0.03, "{quiet:?}");
        assert!(
            loud.signature.spacing.is_none() && loud.signature.repeats < quiet.signature.repeats,
            "{loud:?}"
        );
    }

    #[test]
    fn refuses_records_of_runs_that_are_too_short_with_a_note() {
        let mut scene = scene();
        let mut notes = Vec::new();
        let found = of(&scene, &force(&scene, 2.5e-3, 0.3), 1e5, None, &mut notes).expect("a note");
        assert!(found.is_empty() && notes[0].contains("16 passages"), "{notes:?}");
        scene.output.records = None::<RecordsScene>;
        assert!(of(&scene, &[], 1e5, None, &mut notes).expect("nothing").is_empty() && notes.len() == 1);
    }
}
