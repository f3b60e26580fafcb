//! Both ends of a shaft with a damaged bearing at one of them: the joint verdict, and which end it names.

use stribeck_analysis::measured::joint::Joint;
use stribeck_analysis::measured::{Analysis, Defect, Machine};
use stribeck_formats::Channel;

use super::records::{Labelled, Part};
use crate::Sheet;

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
pub(super) fn table(sheet: &mut Sheet, ends: &[Ends<'_>], told: &[Option<JointVerdict>]) {
    sheet.heading("Both ends of a shaft");
    sheet.say(
        "The channels of both ends of a shaft, of which one has a damaged bearing, with the geometry of that \
         bearing: the joint verdict of `analyse --together`, and whether it names the right end as the \
         nearest. *Alone* counts the right claims of the channel at the damaged end by itself.",
    );
    let mut rows = Vec::new();
    for (part, what) in [(Part::Chosen, "damage at the drive end"), (Part::Quoted, "damage at the fan end")] {
        let of: Vec<(&Ends<'_>, &JointVerdict)> = ends
            .iter()
            .zip(told)
            .filter(|((r, _), _)| r.part == part)
            .filter_map(|(r, t)| Some((r, t.as_ref()?)))
            .collect();
        let count =
            |asked: &dyn Fn(&Ends<'_>, &JointVerdict) -> bool| of.iter().filter(|(r, t)| asked(r, t)).count();
        let counts = [
            of.len(),
            count(&|_, t| t.alone),
            count(&|(r, _), t| t.claimed.iter().any(|name| Some(*name) == r.truth)),
            count(&|(r, _), t| !t.claimed.is_empty() && t.claimed.iter().all(|name| Some(*name) != r.truth)),
            count(&|_, t| t.nearest_is_right == Some(true)),
            count(&|_, t| t.nearest_is_right == Some(false)),
        ];
        for (name, value) in
            ["n", "alone", "right", "wrong", "nearest right", "nearest wrong"].iter().zip(counts)
        {
            sheet.value("both ends", what, name, Some(value as f64));
        }
        rows.push([what.to_owned()].into_iter().chain(counts.map(|n| n.to_string())).collect());
    }
    sheet.table(
        &["records", "n", "alone", "together, right", "wrong", "the right end nearest", "the other end"],
        &rows,
    );
}
