//! What a fit on the shaft and the warmth of running take of a bearing's clearance.

/// Largest bore [mm], and the mean interference [µm] of a shaft to k5 (ISO 286-2) in a bore of normal tolerance
/// (ISO 492), the usual fit of an inner ring that turns under a load that stands.
const K5: [(f64, f64); 9] = [
    (10.0, 8.0),
    (18.0, 9.0),
    (30.0, 11.5),
    (50.0, 13.5),
    (80.0, 16.0),
    (120.0, 20.5),
    (180.0, 24.5),
    (250.0, 29.0),
    (315.0, 33.0),
];

/// What the peaks of ground surfaces lose of an interference [µm] as they are pressed together (DIN 7190-1, for
/// a mean peak-to-valley height of 2.5 µm in all).
const SMOOTHED_UM: f64 = 2.0;

/// By how much the inner ring is usually warmer than the outer one [K].
const WARMER_K: f64 = 5.0;

/// Linear expansion of bearing steel [1/K].
const EXPANSION_PER_K: f64 = 11.7e-6;

/// Change of the diametral clearance [µm], below 0, of a bearing of this bore, inner raceway and pitch diameter
/// [mm] on a solid shaft to k5, in a housing with a loose fit, whose inner ring is 5 K warmer than the outer one.
///
/// The raceway grows by the interference times the bore over the raceway, by Lamé's equations for a solid shaft
/// of the ring's material (Harris and Kotzalas 2006, *Essential Concepts of Bearing Technology*, chapter 3).
pub fn mounted_clearance_change_um(bore_mm: f64, raceway_mm: f64, pitch_mm: f64) -> f64 {
    let found = K5.iter().find(|(largest, _)| bore_mm <= *largest).or(K5.last());
    let interference = found.map_or(0.0, |(_, um)| um - SMOOTHED_UM);
    -(interference * bore_mm / raceway_mm + 1e3 * EXPANSION_PER_K * WARMER_K * pitch_mm)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::catalogue::{Element, normal_clearance_mm};

    #[test]
    fn by_hand_a_6205_on_its_shaft() {
        // 9.5 µm · 25/31.1 + 11.7e-6/K · 5 K · 39.04 mm.
        assert!((mounted_clearance_change_um(25.0, 31.1, 39.04) + 7.637 + 2.284).abs() < 1e-3);
    }

    /// A bearing of the normal group on a usual shaft runs with little clearance, and is not jammed.
    #[test]
    fn behaves_the_normal_group_is_left_with_little_clearance() {
        // Bore, inner raceway and pitch diameter of 6000, 6205, 6310, 6220.
        for (bore, raceway, pitch) in
            [(10.0, 13.2, 18.0), (25.0, 31.1, 39.04), (50.0, 61.0, 80.0), (100.0, 122.0, 140.0)]
        {
            let left = 1e3 * normal_clearance_mm(Element::Ball, bore)
                + mounted_clearance_change_um(bore, raceway, pitch);
            assert!((0.0..6.0).contains(&left), "{bore}: {left}");
        }
    }
}
