//! One verdict of several channels.

use stribeck_diagnosis::joint::Joint;
use stribeck_diagnosis::{Analysis, Defect};
use stribeck_dsp::channel::Channel;
use stribeck_theory::catalogue::CatalogueBearing;

use crate::signals::*;

#[test]
fn planted_channels_together_name_the_nearest() {
    let of = |samples| Analysis::of(&Channel::held("a", samples), RATE_HZ, &machine(1200.0)).unwrap();
    let heard = |seed, part: f64| -> Vec<f64> {
        let order = CatalogueBearing::parse("6205").unwrap().orders().unwrap().bpfo;
        let impacts = impacts(order * 20.0, SAMPLES, |_| part);
        sum([(1.0, coloured(seed, SAMPLES)), (1.0, impacts)])
    };
    let (near, far, deaf) = (of(heard(1, 1.0)), of(heard(2, 0.5)), of(coloured(3, SAMPLES)));
    let named = |all: &[&'static str], analyses: [&Analysis; 2]| {
        let channels: Vec<_> = all.iter().map(|name| (*name).to_owned()).zip(analyses).collect();
        Joint::of(&channels).unwrap()
    };
    for (other, analysis) in [("far", &far), ("deaf", &deaf)] {
        let joint = named(&[other, "near"], [analysis, &near]);
        let family = &joint.families[0];
        assert!(family.claimed && family.name == Defect::Bpfo, "{joint:?}");
        assert_eq!(family.nearest.as_deref(), Some("near"), "{joint:?}");
        let shares: f64 = family.channels.iter().filter_map(|heard| heard.share).sum();
        assert!((shares - 1.0).abs() < 1e-12, "{joint:?}");
        // Bonferroni: twice the smaller of both.
        let smaller = family.channels.iter().map(|heard| heard.p_value).fold(1.0, f64::min);
        assert_eq!(family.p_value, 2.0 * smaller);
        assert!(joint.families.iter().skip(1).all(|family| !family.claimed), "{joint:?}");
    }
    let joint = named(&["a", "b"], [&deaf, &deaf]);
    assert!(joint.families.iter().all(|family| !family.claimed), "{joint:?}");
    assert!(joint.verdict.contains("No defect of a raceway whose"), "{}", joint.verdict);
    assert!(Joint::of(&[("a".to_owned(), &near)]).is_none());
}
