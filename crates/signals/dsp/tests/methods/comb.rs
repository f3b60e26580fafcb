//! Families of harmonics, and how often noise is taken for one.

use stribeck_dsp::{CombTest, Error, Whitened};
use stribeck_testing::Noise;

/// Unit exponential numbers.
struct Exponential(Noise);

impl Exponential {
    fn exponential(&mut self) -> f64 {
        -(self.0.share() + 0.5 * f64::EPSILON).ln()
    }

    /// A coloured spectrum of averaged segments.
    fn spectrum(&mut self, lines: usize, segments: usize) -> Vec<f64> {
        (0..lines)
            .map(|n| {
                let colour = 1.0 + 30.0 * (-(n as f64 - 700.0).powi(2) / 9e4).exp();
                colour * (0..segments).map(|_| self.exponential()).sum::<f64>() / segments as f64
            })
            .collect()
    }
}

#[test]
fn invariant_false_alarms_are_no_more_frequent_than_stated() {
    const RECORDS: usize = 2_000;
    let mut noise = Exponential(Noise::new(17));
    for segments in [1, 8] {
        let mut alarms = [0_usize; 2];
        for _ in 0..RECORDS {
            let values = noise.spectrum(2_000, segments);
            let whitened = Whitened::new(&values, 0.2, segments).unwrap();
            let found = CombTest::FOUR_OF_FIVE.search(&whitened, 49.0, 51.0).unwrap();
            alarms[0] += usize::from(found.p_value < 0.1);
            alarms[1] += usize::from(found.p_value < 0.01);
        }
        // Three standard deviations of a binomial above the stated rates; and the test is not idle.
        assert!(alarms[0] <= 200 + 40, "{segments}: {alarms:?}");
        assert!(alarms[1] <= 20 + 14, "{segments}: {alarms:?}");
        assert!(alarms[0] >= 10, "{segments}: {alarms:?}");
    }
}

#[test]
fn planted_four_harmonics_are_a_family_and_one_line_is_none() {
    let mut noise = Exponential(Noise::new(3));
    let mut values = noise.spectrum(2_000, 1);
    let plain = CombTest::FOUR_OF_FIVE.search(&Whitened::new(&values, 0.2, 1).unwrap(), 49.0, 51.0).unwrap();
    assert!(plain.p_value > 0.01, "{plain:?}");
    values[250] *= 1e4;
    let line = CombTest::FOUR_OF_FIVE.search(&Whitened::new(&values, 0.2, 1).unwrap(), 49.0, 51.0).unwrap();
    assert!(line.p_value > 0.01, "{line:?}");
    for h in [1, 2, 4, 5] {
        values[(h as f64 * 50.12 / 0.2).round() as usize] = 1e3;
    }
    let family = CombTest::FOUR_OF_FIVE.search(&Whitened::new(&values, 0.2, 1).unwrap(), 49.0, 51.0).unwrap();
    assert!(family.p_value < 1e-6 && (family.fundamental_hz - 50.12).abs() < 0.05, "{family:?}");
}

#[test]
fn refuses_what_it_cannot_search() {
    let whitened = Whitened::new(&vec![1.0; 300], 1.0, 1).unwrap();
    assert!(matches!(CombTest::FOUR_OF_FIVE.search(&whitened, 80.0, 90.0), Err(Error::Band { .. })));
    assert!(matches!(Whitened::new(&[1.0; 20], 1.0, 1), Err(Error::TooShort { .. })));
    assert!(matches!(Whitened::new(&[0.0; 200], 1.0, 1), Err(Error::Undefined { .. })));
}
