//! `cargo xtask study reduced`: the reduced bearing beside the full one, scene by scene, with the effects
//! that it leaves out.

use anyhow::{Context, Result, bail, ensure};
use stribeck_analysis::agreement::{Agreement, BAND_LIMIT_DB};
use stribeck_scene::scene::Scene;

use crate::page::decimals;
use crate::plan::Group;
use crate::{Plan, Rows, Runner, Variant};

/// Limits of the rows that the page shows, in their units, and the decimals of these.
const LIMITS: [(&str, f64, usize); 3] =
    [("forces_percent", 1.0, 2), ("load_percent", 0.1, 4), ("cage_percent", 0.2, 2)];
const EVENT_LIMIT_MS: f64 = 0.05;

pub(crate) fn measure(runner: &Runner<'_>, rows: &mut Rows) -> Result<()> {
    let plan = Plan::read(runner.study)?;
    // Both models from the same starts; the table of these groups is the number of starts.
    for group in plan.groups.iter().filter(|group| group.table != "energy") {
        for variant in plan.variants(group) {
            validate(runner, group, &variant, rows)?;
        }
    }
    for group in plan.groups.iter().filter(|group| group.table == "energy") {
        for run in runner.run(&plan.variants(group))? {
            let energy = run.numbers().map(|summary| &summary.energy);
            let info = run.info.as_ref();
            let values = [
                ("of strain energy", energy.map(|e| e.max_relative_error)),
                ("of heat", energy.and_then(|e| e.share_of_heat)),
                ("processor s/s", info.map(|i| i.loop_cpu_s / i.simulated_s)),
            ];
            rows.values("energy", &run.variant.name, values);
        }
    }
    Ok(())
}

/// Runs both models from all starts, those that are missing, and adds how they agree. Models of one scene
/// share the runs of the full model.
fn validate(runner: &Runner<'_>, group: &Group, variant: &Variant, rows: &mut Rows) -> Result<()> {
    let (host, name) = (runner.host, &variant.name);
    let out = runner.folder.join(name);
    let case = name.rsplit_once('-').map_or(name.as_str(), |(case, _)| case);
    let starts: usize = group.table.parse().context("the table of a group is its number of starts")?;
    if runner.flags.wants(name) && !runner.flags.runs_nothing() {
        host.say(&format!("{name}: {starts} starts"));
        let mut command = host.stribeck()?;
        command.arg("validate").arg(host.root().join(&variant.scene));
        command.args(variant.set.iter().map(|set| format!("--set={set}")));
        command.arg(format!("--starts={starts}"));
        command.arg("--out").arg(&out).arg("--full").arg(runner.folder.join(format!("{case}-full")));
        command.args(runner.flags.of_a_command()).stdout(std::process::Stdio::null());
        let status = command.status().context("`stribeck validate` does not start")?;
        if !status.success() {
            host.say(&format!("`{}` did not come to its end", out.display()));
        }
        ensure!(!host.is_interrupted(), "interrupted; the same command goes on from here");
    }
    let path = out.join("validation.json");
    let agreement: Agreement = match std::fs::read(&path) {
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(()),
        Err(error) => bail!("cannot read {}: {error}", path.display()),
        Ok(text) => serde_json::from_slice(&text).with_context(|| path.display().to_string())?,
    };
    let scene = Scene::read_with(host.root().join(&variant.scene), &variant.set)?;
    if agreement.scene_hash != scene.hash() || agreement.starts != starts {
        host.say(&format!("{name}: what is there is of another scene or number of starts, and is left out"));
        return Ok(());
    }
    put(rows, name, &agreement);
    Ok(())
}

/// Every number of a validation.
fn put(rows: &mut Rows, name: &str, agreement: &Agreement) {
    for row in &agreement.rows {
        let d = &row.difference;
        rows.value("difference", name, &row.name, d.mean);
        rows.value("low", name, &row.name, d.low);
        rows.value("high", name, &row.name, d.high);
    }
    for sensor in &agreement.sensors {
        for (band, hz) in sensor.centres_hz.iter().enumerate() {
            let what = format!("octave_{}_{hz:.0}_hz_db", sensor.sensor);
            rows.value("difference", name, &what, sensor.reduced_db[band] - sensor.full_db[band]);
            rows.value("error", name, &what, sensor.error_db.get(band).copied());
        }
    }
    for peak in &agreement.peaks {
        let (off, error) = peak.difference_percent();
        let what = format!("peak_{}_percent", peak.sensor);
        rows.value("difference", name, &what, off);
        rows.value("error", name, &what, error);
    }
    for c in &agreement.correlations {
        rows.value("difference", name, &format!("correlation_below_{:.0}_hz", c.below_hz), c.value.mean);
    }
    for (which, seconds) in ["full", "reduced"].into_iter().zip(agreement.cpu_s_per_ms) {
        rows.value("processor_s_per_ms", name, which, seconds);
    }
    rows.values("scenes", name, [("starts", agreement.starts as f64), ("ms", agreement.simulated_ms)]);
    let kept = agreement.rows.iter().filter(|row| row.decided && row.within).count();
    let warns = agreement.notes.iter().any(|note| note.contains("the reduced model warns"));
    rows.word("scenes", name, "warns", if warns { "yes" } else { "no" });
    rows.values("scenes", name, [("kept", kept as f64), ("quantities", agreement.rows.len() as f64)]);
}

/// What the page shows of each scene: means with half their intervals, bold where they are outside their
/// limit by more than chance may be, and the third octaves that are.
pub(crate) fn derive(rows: &mut Rows) {
    for name in rows.variants("processor_s_per_ms") {
        let number = |table: &str, what: &str| rows.number(table, &name, what);
        let cell = |what: &str, limit: f64, digits: usize| {
            let mean = number("difference", what)?;
            let half = number("high", what).map(|high| high - mean);
            let bold = if half.is_some_and(|half| mean.abs() - half > limit) { "**" } else { "" };
            let half = half.map_or(String::new(), |half| format!(" ± {}", decimals(half, digits)));
            Some(format!("{bold}{}{half}{bold}", decimals(mean, digits)))
        };
        let mut words: Vec<(String, String)> = Vec::new();
        for (what, limit, digits) in LIMITS {
            words.push((what.to_owned(), cell(what, limit, digits).unwrap_or_default()));
        }
        let quantities = rows.quantities("difference", &name);
        let size = |what: &&String| number("difference", what).map_or(0.0, f64::abs);
        let events = quantities.iter().filter(|what| what.starts_with("roller_"));
        let worst = events.max_by(|a, b| size(a).total_cmp(&size(b)));
        let worst = worst.and_then(|what| cell(what, EVENT_LIMIT_MS, 3));
        words.push(("worst event".into(), worst.unwrap_or_default()));
        let bands: Vec<(&String, f64, f64)> = quantities
            .iter()
            .filter(|what| what.starts_with("octave_"))
            .filter_map(|what| {
                let error = number("error", what).unwrap_or(f64::INFINITY);
                Some((what, number("difference", what)?, error))
            })
            .collect();
        let within = bands.iter().filter(|(_, off, _)| off.abs() <= BAND_LIMIT_DB).count();
        let count = if bands.is_empty() { String::new() } else { format!("{within} of {}", bands.len()) };
        words.push(("bands".into(), count));
        let [least, most] = [f64::min, f64::max].map(|of| bands.iter().map(|band| band.1).reduce(of));
        let range = least.zip(most).map(|(a, b)| format!("{} to {}", decimals(a, 1), decimals(b, 1)));
        words.push(("range".into(), range.unwrap_or_default()));
        let outside = bands.iter().filter(|(_, off, error)| off.abs() - 2.0 * error > BAND_LIMIT_DB);
        let outside = outside.filter_map(|(what, off, error)| {
            let mut parts = what.split('_').skip(1);
            let (sensor, hz) = (parts.next()?, parts.next()?.parse::<f64>().ok()?);
            let [off, error] = [off, error].map(|db| decimals(*db, 1));
            Some(format!("{sensor}, {:.1} kHz: {off} ± {error}", hz / 1e3))
        });
        words.push(("outside".into(), outside.collect::<Vec<_>>().join("; ")));
        words.into_iter().for_each(|(what, word)| rows.word("shown", &name, &what, &word));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn by_hand_a_band_is_outside_where_two_standard_errors_leave_no_other_answer() {
        let mut rows = Rows::default();
        for (what, off, error) in [("6350", -2.9, 0.6), ("8000", -1.9, 0.7), ("500", 0.2, 0.1)] {
            let name = format!("octave_seat_{what}_hz_db");
            rows.value("difference", "a", &name, off);
            rows.value("error", "a", &name, error);
        }
        rows.values("difference", "a", [("forces_percent", 1.5), ("load_percent", 0.1)]);
        rows.values("high", "a", [("forces_percent", 1.54), ("load_percent", 0.11)]);
        rows.value("processor_s_per_ms", "a", "full", 1.0);
        derive(&mut rows);
        let shown = |what: &str| rows.get("shown", "a", what).unwrap_or_default();
        assert_eq!((shown("outside"), shown("bands")), ("seat, 6.3 kHz: −2.9 ± 0.6", "1 of 3"));
        assert_eq!((shown("forces_percent"), shown("load_percent")), ("**1.50 ± 0.04**", "0.1000 ± 0.0100"));
    }
}
