//! Records of known parts, and what is found in them.

use std::f64::consts::TAU;

use stribeck_diagnosis::{Analysis, Defect, Family, Machine, MeasuredFindings};
use stribeck_dsp::channel::Channel;
use stribeck_testing::Noise;
use stribeck_theory::catalogue::CatalogueBearing;

pub(crate) const RATE_HZ: f64 = 12_800.0;
pub(crate) const SAMPLES: usize = 65_536;

pub(crate) fn machine(rpm: f64) -> Machine {
    Machine { speed_rpm: Some(rpm), bearing: CatalogueBearing::parse("6205").ok(), ..Machine::default() }
}

/// How an impact rings.
#[derive(Clone, Copy)]
pub(crate) struct Ring {
    /// Samples in a second of the record.
    pub(crate) rate_hz: f64,
    pub(crate) hz: f64,
    pub(crate) decay_s: f64,
    /// After which it is silent.
    pub(crate) samples: usize,
}

/// At 3 kHz, for a millisecond.
pub(crate) const RING: Ring = Ring { rate_hz: RATE_HZ, hz: 3_000.0, decay_s: 1e-3, samples: 150 };

impl Ring {
    /// Adds an impact at a time [s].
    pub(crate) fn add(self, signal: &mut [f64], at: f64, strength: f64) {
        let first = (at * self.rate_hz).ceil().max(0.0) as usize;
        for (n, x) in signal.iter_mut().enumerate().skip(first).take(self.samples) {
            let since = n as f64 / self.rate_hz - at;
            *x += strength * (-since / self.decay_s).exp() * (TAU * self.hz * since).sin();
        }
    }

    /// Adds impacts `hz` times a second, as strong as `strength` says at their time, each late or early by up
    /// to 1 % of a period.
    pub(crate) fn add_all(
        self,
        signal: &mut [f64],
        noise: &mut Noise,
        hz: f64,
        strength: impl Fn(f64) -> f64,
    ) {
        let mut k = 0.0;
        while k / hz < signal.len() as f64 / self.rate_hz {
            let at = (k + 0.01 * noise.uniform()) / hz;
            self.add(signal, at, strength(at));
            k += 1.0;
        }
    }
}

pub(crate) fn gaussian(noise: &mut Noise) -> f64 {
    // Twelve even numbers of variance 1/3: their sum over 2 is close to a unit Gaussian one.
    (0..12).map(|_| noise.uniform()).sum::<f64>() / 2.0
}

/// Noise through a resonance at 3 kHz: a colour with 20 dB in it.
pub(crate) fn coloured(seed: u64, samples: usize) -> Vec<f64> {
    let mut noise = Noise::new(seed);
    let (radius, turn) = (0.93, TAU * 3_000.0 / RATE_HZ);
    let (mut last, mut before) = (0.0, 0.0);
    (0..samples)
        .map(|_| {
            let now = gaussian(&mut noise) + 2.0 * radius * f64::cos(turn) * last - radius * radius * before;
            (before, last) = (last, now);
            now
        })
        .collect()
}

/// Impacts `hz` times a second without noise, as strong as `strength` says at their time.
pub(crate) fn impacts(hz: f64, samples: usize, strength: impl Fn(f64) -> f64) -> Vec<f64> {
    let mut signal = vec![0.0; samples];
    RING.add_all(&mut signal, &mut Noise::new(99), hz, |at| 12.0 * strength(at));
    signal
}

/// The load on a place that turns with the shaft: a third of the turn.
pub(crate) fn under_the_load(shaft_hz: f64) -> impl Fn(f64) -> f64 {
    move |t: f64| ((TAU * shaft_hz * t).cos() - 0.5).max(0.0) / 0.5
}

/// Four lines of a shaft that is out of balance.
pub(crate) fn unbalance(shaft_hz: f64, samples: usize) -> Vec<f64> {
    let turn = |n: usize| TAU * shaft_hz * n as f64 / RATE_HZ;
    (0..samples).map(|n| (1..=4).map(|h| (f64::from(h) * turn(n)).cos()).sum()).collect()
}

/// The sum of signals, each times its factor.
pub(crate) fn sum<const N: usize>(parts: [(f64, Vec<f64>); N]) -> Vec<f64> {
    (0..parts[0].1.len()).map(|n| parts.iter().map(|(factor, part)| factor * part[n]).sum()).collect()
}

pub(crate) fn judged_at(rate_hz: f64, samples: Vec<f64>, machine: &Machine) -> MeasuredFindings {
    Analysis::of(&Channel::held("test", samples), rate_hz, machine).unwrap().findings
}

pub(crate) fn judged(samples: Vec<f64>, machine: &Machine) -> MeasuredFindings {
    judged_at(RATE_HZ, samples, machine)
}

pub(crate) fn analysed(samples: Vec<f64>, rpm: f64) -> MeasuredFindings {
    judged(samples, &machine(rpm))
}

pub(crate) fn claimed(findings: &MeasuredFindings) -> Vec<&'static str> {
    findings.families.iter().filter(|f| f.claimed).map(|f| f.name.name()).collect()
}

pub(crate) fn family(findings: &MeasuredFindings, name: Defect) -> &Family {
    findings.families.iter().find(|f| f.name == name).unwrap()
}

#[track_caller]
pub(crate) fn noted(findings: &MeasuredFindings, words: &str) {
    assert!(findings.notes.iter().any(|note| note.contains(words)), "{words}: {:?}", findings.notes);
}
