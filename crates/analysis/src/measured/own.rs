//! Lines that a sound machine has, whatever its bearing: multiples of the shaft, and of a cage that stands.

/// Multiples of the shaft and of the cage.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct OwnLines {
    /// Turns of the shaft [Hz].
    pub(super) shaft_hz: f64,
    /// Turns of the cage [Hz], where its comb stands.
    pub(super) cage_hz: Option<f64>,
    /// Rolling elements: this multiple of the cage is BPFO.
    pub(super) elements: f64,
    /// Frequencies nearer than this to one another are one [Hz].
    pub(super) width_hz: f64,
}

impl OwnLines {
    /// Whether `hz` is a multiple of the shaft, or of a cage that stands but for BPFO.
    pub(super) fn holds(&self, hz: f64) -> bool {
        self.is_of_shaft(hz) || self.is_of_cage(hz)
    }

    /// Whether `hz` is a multiple of the shaft's frequency.
    pub(super) fn is_of_shaft(&self, hz: f64) -> bool {
        self.is_multiple(hz, self.shaft_hz, f64::NAN)
    }

    /// Whether `hz` is a multiple of the frequency of a cage that stands, but for that of all elements.
    pub(super) fn is_of_cage(&self, hz: f64) -> bool {
        self.cage_hz.is_some_and(|cage_hz| self.is_multiple(hz, cage_hz, self.elements))
    }

    fn is_multiple(&self, hz: f64, of_hz: f64, but: f64) -> bool {
        let times = (hz / of_hz).round();
        times >= 1.0 && times != but && (hz - times * of_hz).abs() < self.width_hz
    }

    /// What is left of a range of fundamentals [Hz] without the multiples of the shaft, and of the cage but
    /// for that of all elements.
    pub(super) fn ranges_without(&self, low_hz: f64, high_hz: f64) -> Vec<(f64, f64)> {
        let multiples = |of_hz: f64, but: f64| {
            let first = ((low_hz - self.width_hz) / of_hz).ceil().max(1.0) as u32;
            let last = ((high_hz + self.width_hz) / of_hz).floor().max(0.0) as u32;
            (first..=last).map(f64::from).filter(move |n| *n != but).map(move |n| n * of_hz)
        };
        let cage = self.cage_hz.map(|cage_hz| multiples(cage_hz, self.elements));
        let mut taken: Vec<f64> =
            multiples(self.shaft_hz, f64::NAN).chain(cage.into_iter().flatten()).collect();
        taken.sort_by(f64::total_cmp);
        let (mut left, mut from) = (Vec::new(), low_hz);
        for hz in taken {
            if hz - self.width_hz > from {
                left.push((from, (hz - self.width_hz).min(high_hz)));
            }
            from = from.max(hz + self.width_hz);
        }
        if from < high_hz {
            left.push((from, high_hz));
        }
        left
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const OWN: OwnLines = OwnLines { shaft_hz: 30.0, cage_hz: None, elements: 8.0, width_hz: 0.2 };

    #[test]
    fn example_the_search_passes_over_multiples_of_the_shaft() {
        assert_eq!(OWN.ranges_without(89.0, 92.0), [(89.0, 89.8), (90.2, 92.0)]);
        assert_eq!(OWN.ranges_without(89.9, 92.0), [(90.2, 92.0)]);
        assert_eq!(OWN.ranges_without(91.0, 92.0), [(91.0, 92.0)]);
        assert!(OWN.ranges_without(89.9, 90.1).is_empty());
        assert!(OWN.holds(90.1) && !OWN.holds(91.0));
    }

    #[test]
    fn example_the_multiple_of_a_cage_that_is_its_raceway_is_kept() {
        let own = OwnLines { cage_hz: Some(11.45), ..OWN };
        assert!(own.holds(4.0 * 11.45) && !own.holds(8.0 * 11.45));
        assert_eq!(own.ranges_without(91.0, 92.0), [(91.0, 92.0)]);
    }
}
