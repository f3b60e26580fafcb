//! The path from the force of a bearing to a sensor: `--path`.

use anyhow::{Context, Result, bail};
use stribeck_diagnosis::AccelerationUnit;
use stribeck_dsp::{Mode, Response};
use stribeck_formats::{Channel, Recording};

/// How modes are written.
const FORM: &str = "\"mass=12, stiffness=2e8, damping=0.02\" in kg, N/m and parts of the critical damping, \
                    several modes with `;` between them";

/// A path to a sensor.
#[derive(Debug, Clone)]
pub(crate) struct Transfer {
    response: Response,
    /// Its description.
    words: String,
}

impl Transfer {
    /// From modes in words.
    pub(crate) fn read(text: &str) -> Result<Self> {
        if !text.contains('=') {
            bail!(
                "`--path {text}` is no mode, and tables of frequency responses are not read. A path is {FORM}"
            );
        }
        Self::of_modes(text).with_context(|| format!("`--path \"{text}\"`"))
    }

    fn of_modes(text: &str) -> Result<Self> {
        let modes =
            text.split(';').filter(|mode| !mode.trim().is_empty()).map(mode).collect::<Result<Vec<_>>>()?;
        let hz: Vec<String> = modes.iter().map(|mode| format!("{:.1}", mode.hz())).collect();
        let words = format!("modes at {} Hz", hz.join(" and "));
        Ok(Self { response: Response::of_modes(modes)?, words })
    }

    /// A run as recorded by a sensor at the end of the path: both directions of the force.
    pub(crate) fn at_sensor(&self, recording: &Recording) -> Result<Vec<Channel>> {
        ["x", "y"].into_iter().map(|axis| self.of_force(recording, axis)).collect()
    }

    /// The same for the direction of one channel, with a description.
    pub(crate) fn of_run(&self, recording: &Recording, channel: &Channel) -> Result<(Channel, String)> {
        let axis = if channel.name.contains(".ax_") { "x" } else { "y" };
        let note = format!(
            "the force of the rolling elements on the outer ring along {axis} went through the path ({}) to a \
             sensor at its end",
            self.words
        );
        Ok((self.of_force(recording, axis)?, note))
    }

    /// The force of the rolling elements on the outer ring, and the acceleration that it makes.
    fn of_force(&self, recording: &Recording, axis: &str) -> Result<Channel> {
        let end = format!(".outer_f{axis}_n");
        let parts: Vec<&Channel> = recording
            .channels
            .iter()
            .filter(|c| c.name.starts_with("roller.") && c.name.ends_with(&end))
            .collect();
        let first = parts.first().with_context(|| {
            format!(
                "`{}` has no contact forces `roller.N{end}`, which the path leads to the sensor: a run that \
                 keeps `all` has them",
                recording.path.display()
            )
        })?;
        let rate_hz = first.rate_hz.context("the run has no sample rate")?;
        let mut force = vec![0.0; usize::try_from(first.len)?];
        for part in parts {
            // Recorded are forces of the raceway on the rolling elements.
            force.iter_mut().zip(part.read()?).for_each(|(sum, of_raceway)| *sum -= of_raceway);
        }
        let samples = self.response.through(&force, rate_hz).context("the path of the force")?;
        let made = Channel::held(format!("path.a{axis}_m_s2"), samples);
        Ok(made.at_rate(Some(rate_hz)).in_unit(Some("m/s^2".to_owned())))
    }

    /// The input of the path, from a channel that a sensor recorded at its end, with a description.
    pub(crate) fn before(&self, channel: &Channel, rate_hz: f64) -> Result<(Channel, String)> {
        let unit = channel.unit.as_deref().and_then(AccelerationUnit::parse);
        let samples = channel.scaled(unit.map_or(1.0, AccelerationUnit::in_m_s2)).read()?;
        let undone = self.response.undo(&samples, rate_hz)?;
        let assumed = if unit.is_some() { "" } else { "; the record does not say its unit: m/s² is taken" };
        let (low, high) = undone.band_hz;
        let note = format!(
            "the path ({}) was divided out: the samples are the force at the bearing, without its mean, from {low:.0} to \
             {high:.0} Hz, of which {:.0} % are given back by nine tenths or more{assumed}",
            self.words,
            100.0 * undone.share
        );
        let made = Channel::held(format!("{} before the path", channel.name), undone.signal);
        Ok((made.at_rate(Some(rate_hz)).in_unit(Some("N".to_owned())), note))
    }
}

fn mode(text: &str) -> Result<Mode> {
    let [mut mass, mut stiffness, mut damping] = [None; 3];
    for part in text.split(',').map(str::trim).filter(|part| !part.is_empty()) {
        let number = part.split_once('=').map(|(key, value)| (key.trim(), value.trim().parse::<f64>()));
        match number {
            Some(("mass", Ok(kg))) => mass = Some(kg),
            Some(("stiffness", Ok(n_m))) => stiffness = Some(n_m),
            Some(("damping", Ok(ratio))) => damping = Some(ratio),
            _ => bail!("`{part}` is none of mass, stiffness and damping with a number: {FORM}"),
        }
    }
    let (Some(mass), Some(stiffness), Some(damping)) = (mass, stiffness, damping) else {
        bail!("a mode has a mass, a stiffness and a damping: {FORM}");
    };
    Ok(Mode::new(mass, stiffness, damping)?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn refuses_modes_that_are_none() {
        for (text, told) in [
            ("mass=12, stiffness=2e8", "a damping"),
            ("mass=-12, stiffness=2e8, damping=0.02", "mass = -12"),
            ("mass=12, stiffness=0, damping=0.02", "stiffness = 0"),
            ("mass=12, stiffness=2e8, damping=2", "below 1"),
            ("mass=12, spring=2e8, damping=0.02", "`spring=2e8`"),
            ("mass=heavy, stiffness=2e8, damping=0.02", "`mass=heavy`"),
            ("mass=1e999, stiffness=2e8, damping=0.02", "mass = inf"),
            (";", "at least 1"),
        ] {
            let why = format!("{:#}", Transfer::of_modes(text).expect_err(text));
            assert!(why.contains(told), "{text}: {why}");
        }
        let two = "mass=12, stiffness=2e8, damping=0.02; mass=3, stiffness=9e8, damping=0.01";
        assert!(Transfer::of_modes(two).expect("two modes").words.contains("649.7 and 2756.6 Hz"));
    }
}
