//! Lines that a healthy machine has, whatever its bearing: multiples of its shafts, of a cage that stands, and
//! of meshes of gears with their sidebands.

/// Multiples of the shaft and of the cage.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct OwnLines {
    /// Turns of the shaft [Hz].
    pub(crate) shaft_hz: f64,
    /// Whether its multiples are its own: in a record so short that they cover the places of all families, where they
    /// stand only.
    pub(crate) shaft_counts: bool,
    /// Turns of the cage [Hz], where its comb stands.
    pub(crate) cage_hz: Option<f64>,
    /// Rolling elements: this multiple of the cage is BPFO.
    pub(crate) elements: f64,
    /// Frequencies nearer than this to one another are one [Hz].
    pub(crate) width_hz: f64,
    /// Other shafts of the machine [Hz].
    pub(crate) shafts_hz: Vec<f64>,
    /// Meshes of gears [Hz], with sidebands of all shafts.
    pub(crate) meshes_hz: Vec<f64>,
}

/// Sidebands of a mesh that are its own, either way.
const BESIDE_MESH: i32 = 3;

impl OwnLines {
    /// Whether `hz` is a multiple of the shaft, or of a cage that stands but for BPFO.
    pub(crate) fn holds(&self, hz: f64) -> bool {
        self.is_of_shaft(hz) || self.is_of_cage(hz) || self.is_of_mesh(hz)
    }

    /// Whether `hz` is a multiple of the frequency of a shaft.
    pub(crate) fn is_of_shaft(&self, hz: f64) -> bool {
        self.turning().any(|shaft_hz| self.is_multiple(hz, shaft_hz, f64::NAN))
    }

    /// All shafts [Hz], the bearing's own first.
    fn turning(&self) -> impl Iterator<Item = f64> {
        let own = Some(self.shaft_hz).filter(|_| self.shaft_counts);
        own.into_iter().chain(self.shafts_hz.iter().copied())
    }

    /// Whether `hz` is a multiple of a mesh or a sideband of one.
    fn is_of_mesh(&self, hz: f64) -> bool {
        self.meshes_hz.iter().any(|mesh_hz| {
            let mut beside = self.beside_mesh();
            beside.any(|by_hz| hz > by_hz && self.is_multiple(hz - by_hz, *mesh_hz, f64::NAN))
        })
    }

    /// Distances of a mesh's sidebands from it [Hz], and none at all.
    fn beside_mesh(&self) -> impl Iterator<Item = f64> {
        let each = (-BESIDE_MESH..=BESIDE_MESH).filter(|k| *k != 0);
        let sidebands = self.turning().flat_map(move |hz| each.clone().map(move |k| f64::from(k) * hz));
        std::iter::once(0.0).chain(sidebands)
    }

    /// Whether `hz` is a multiple of the frequency of a cage that stands, but for that of all elements.
    pub(crate) fn is_of_cage(&self, hz: f64) -> bool {
        self.cage_hz.is_some_and(|cage_hz| self.is_multiple(hz, cage_hz, self.elements))
    }

    fn is_multiple(&self, hz: f64, of_hz: f64, but: f64) -> bool {
        let times = (hz / of_hz).round();
        times >= 1.0 && times != but && (hz - times * of_hz).abs() < self.width_hz
    }

    /// Parts of a range of fundamentals [Hz] without the multiples of the shaft, and of the cage but for that
    /// of all elements.
    pub(crate) fn ranges_without(&self, low_hz: f64, high_hz: f64) -> Vec<(f64, f64)> {
        let multiples = |of_hz: f64, but: f64| {
            let first = ((low_hz - self.width_hz) / of_hz).ceil().max(1.0) as u32;
            let last = ((high_hz + self.width_hz) / of_hz).floor().max(0.0) as u32;
            (first..=last).map(f64::from).filter(move |n| *n != but).map(move |n| n * of_hz)
        };
        let cage = self.cage_hz.map(|cage_hz| multiples(cage_hz, self.elements));
        let shafts = self.turning().flat_map(|shaft_hz| multiples(shaft_hz, f64::NAN));
        let mut taken: Vec<f64> = shafts.chain(cage.into_iter().flatten()).collect();
        for mesh_hz in &self.meshes_hz {
            let reach = BESIDE_MESH as f64 * self.turning().fold(0.0, f64::max) + self.width_hz;
            let first = ((low_hz - reach) / mesh_hz).ceil().max(1.0) as u32;
            let last = ((high_hz + reach) / mesh_hz).floor().max(0.0) as u32;
            for n in first..=last {
                taken.extend(self.beside_mesh().map(|by_hz| f64::from(n) * mesh_hz + by_hz));
            }
        }
        taken.sort_by(f64::total_cmp);
        let (mut left, mut from) = (Vec::new(), low_hz);
        for hz in taken {
            let to = (hz - self.width_hz).min(high_hz);
            if to > from {
                left.push((from, to));
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
    use stribeck_theory::kinematics::off_multiple;

    use super::*;

    const OWN: OwnLines = OwnLines {
        shaft_hz: 30.0,
        shaft_counts: true,
        cage_hz: None,
        elements: 8.0,
        width_hz: 0.2,
        shafts_hz: Vec::new(),
        meshes_hz: Vec::new(),
    };

    #[test]
    fn by_hand_the_search_passes_over_multiples_of_the_shaft() {
        assert_eq!(OWN.ranges_without(89.0, 92.0), [(89.0, 89.8), (90.2, 92.0)]);
        assert_eq!(OWN.ranges_without(89.9, 92.0), [(90.2, 92.0)]);
        assert_eq!(OWN.ranges_without(91.0, 92.0), [(91.0, 92.0)]);
        assert!(OWN.ranges_without(89.9, 90.1).is_empty());
        assert!(
            OWN.holds(90.1) && !OWN.holds(91.0) && (off_multiple(89.5, OWN.shaft_hz) - 0.5).abs() < 1e-12
        );
    }

    #[test]
    fn by_hand_other_shafts_and_gears_are_the_machines_own() {
        let own = OwnLines { shafts_hz: vec![12.0], meshes_hz: vec![230.0], ..OWN };
        // 2 · 230 − 3 · 12; 230 + 2 · 30 and 7 · 12 are multiples of nothing of OWN's.
        for hz in [84.0, 230.0, 290.0, 424.0] {
            assert!(own.holds(hz), "{hz}");
        }
        assert!(!OWN.holds(84.0) && !OWN.holds(424.0) && !own.holds(91.0));
        assert_eq!(own.ranges_without(83.0, 85.0), [(83.0, 83.8), (84.2, 85.0)]);
        assert_eq!(own.ranges_without(423.5, 424.5), [(423.5, 423.8), (424.2, 424.5)]);
    }

    #[test]
    fn by_hand_the_multiple_of_a_cage_that_is_its_raceway_is_kept() {
        let own = OwnLines { cage_hz: Some(11.45), ..OWN };
        assert!(own.holds(4.0 * 11.45) && !own.holds(8.0 * 11.45));
        assert_eq!(own.ranges_without(91.0, 92.0), [(91.0, 92.0)]);
    }
}
