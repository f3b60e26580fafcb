//! Both ends of a shaft with a damaged bearing at one of them: the joint verdict, and which end it names.

use stribeck_diagnosis::joint::Joint;
use stribeck_diagnosis::{Analysis, Defect, Machine};
use stribeck_formats::Channel;

use super::records::{Labelled, Part};
use crate::Rows;

/// A damaged record and the channel at the other end.
pub(super) type Ends<'a> = (&'a Labelled, &'a Labelled);

/// All records of which both ends are there.
pub(super) fn pairs(records: &[Labelled]) -> Vec<Ends<'_>> {
    let stem = |record: &Labelled| record.name.rsplit_once(' ').map(|(stem, _)| stem.to_owned());
    let damaged = records.iter().filter(|r| r.truth.is_some());
    let other = |r: &Labelled| records.iter().find(|o| o.beside && stem(o).is_some() && stem(o) == stem(r));
    damaged.filter_map(|record| Some((record, other(record)?))).collect()
}

/// Joint verdict of both channels.
#[derive(Debug, Clone)]
pub(super) struct JointVerdict {
    pub(super) claimed: Vec<Defect>,
    /// Whether the end of the damage is named as the nearest; `None` where none is named.
    pub(super) nearest_is_right: Option<bool>,
    /// Whether the channel at the damaged end alone claims the defect.
    pub(super) alone: bool,
}

/// The bearing of the damaged end, looked for at both.
pub(super) fn judge((damaged, other): &Ends<'_>) -> Option<JointVerdict> {
    let machine = Machine {
        speed_rpm: Some(damaged.speed_rpm),
        bearing: Some(damaged.bearing.clone()),
        load_n: damaged.load_n,
        ..Machine::default()
    };
    let of = |record: &Labelled| {
        let channel = Channel::held(record.name.clone(), record.samples.clone());
        Analysis::of(&channel, record.rate_hz, &machine).ok()
    };
    let (here, there) = (of(damaged)?, of(other)?);
    // The channel of the damage is not always the first.
    let mut both = [(damaged.name.clone(), &here), (other.name.clone(), &there)];
    both.sort_by(|a, b| a.0.cmp(&b.0));
    let joint = Joint::of(&both)?;
    let claimed = joint.families.iter().filter(|f| f.claimed);
    let nearest = claimed.clone().find_map(|f| f.nearest.clone());
    Some(JointVerdict {
        claimed: claimed.map(|f| f.name).collect(),
        nearest_is_right: nearest.map(|name| name == damaged.name),
        alone: here.findings.families.iter().any(|f| f.claimed && Some(f.name) == damaged.truth),
    })
}

/// Both ends of a shaft together.
pub(super) fn count(rows: &mut Rows, ends: &[Ends<'_>], judged: &[Option<JointVerdict>]) {
    for (part, what) in [(Part::Chosen, "damage at the drive end"), (Part::Quoted, "damage at the fan end")] {
        let of = ends.iter().zip(judged).filter(|((r, _), _)| r.part == part);
        let of: Vec<_> = of.filter_map(|((r, _), verdict)| Some((r.truth, verdict.as_ref()?))).collect();
        let is_right = |truth: Option<Defect>, v: &JointVerdict| v.claimed.iter().any(|d| Some(*d) == truth);
        let count = |asked: &dyn Fn(Option<Defect>, &JointVerdict) -> bool| {
            of.iter().filter(|(truth, verdict)| asked(*truth, verdict)).count() as f64
        };
        let values = [
            ("n", of.len() as f64),
            ("alone", count(&|_, v| v.alone)),
            ("right", count(&is_right)),
            ("wrong", count(&|truth, v| !v.claimed.is_empty() && !is_right(truth, v))),
            ("nearest right", count(&|_, v| v.nearest_is_right == Some(true))),
            ("nearest wrong", count(&|_, v| v.nearest_is_right == Some(false))),
        ];
        rows.values("both ends", what, values);
    }
}
