//! Several records: a series of one machine in the order of time, with one page.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Context, Result, ensure};
use stribeck_diagnosis::MeasuredFindings;
use stribeck_diagnosis::pool::{Pool, Pooled};
use stribeck_diagnosis::record::alarm::{Limit, Quantity, State};
use stribeck_diagnosis::series::Series;
use stribeck_report::{SeriesFindings, SeriesRecord, write_series, write_series_brief};
use stribeck_store::run_dir::{check_folder, write_atomic};

use super::{Asked, Options, Reading, analyse, baseline, passed, print_sheet, remove_sheet};
use crate::causes;
use crate::interrupt::Interrupted;
use crate::out::{say, tell};
use crate::place::{Place, shown};

/// The findings, by which a folder is known as one of a series.
const FINDINGS: &str = "findings.json";
/// Records of which each has a page of its own; of more, every second or every third and so on.
const PAGES: usize = 60;

/// The files that are meant: those of a folder that is no run's stand in the order of their names, numbers by
/// their value.
pub(super) fn files(asked: &[PathBuf], place: &Place) -> Result<Vec<PathBuf>> {
    let mut files = Vec::new();
    for path in asked {
        let folder = place.locate(path);
        if !folder.is_dir() || folder.join("scene.ron").exists() || folder.join("ensemble.json").exists() {
            files.push(path.clone());
            continue;
        }
        let mut inside = inside(&folder)?;
        ensure!(!inside.is_empty(), "`{}` is neither a run nor a folder of files of signals", shown(path));
        inside.sort_by_cached_key(|file| by_numbers(file));
        files.append(&mut inside);
    }
    Ok(files)
}

/// The files of a folder, but for hidden ones and notes.
fn inside(folder: &Path) -> Result<Vec<PathBuf>> {
    let cannot = || format!("cannot read `{}`", shown(folder));
    let mut files = Vec::new();
    for entry in std::fs::read_dir(folder).with_context(cannot)? {
        let path = entry.with_context(cannot)?.path();
        let name = path.file_name().map(|name| name.to_string_lossy().to_lowercase()).unwrap_or_default();
        let is_note = [".md", ".pdf", ".html", ".json"].iter().any(|end| name.ends_with(end));
        if path.is_file() && !name.starts_with('.') && !name.starts_with("readme") && !is_note {
            files.push(path);
        }
    }
    Ok(files)
}

/// A name as texts and numbers in turn: `acc_2` stands before `acc_10`.
fn by_numbers(file: &Path) -> Vec<(u64, String)> {
    let name = file.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    let mut parts: Vec<(u64, String)> = vec![(0, String::new())];
    for letter in name.chars() {
        let digit = letter.to_digit(10).map(u64::from);
        match (digit, parts.last_mut()) {
            (Some(digit), Some((number, text))) if text.is_empty() => {
                *number = number.saturating_mul(10).saturating_add(digit);
            }
            (Some(digit), _) => parts.push((digit, String::new())),
            (None, Some((_, text))) => text.push(letter),
            (None, None) => {}
        }
    }
    parts
}

pub(super) fn run(files: &[PathBuf], asked: &Asked<'_>, mut reading: Reading) -> Result<ExitCode> {
    let options = asked.options;
    let out = options.out.clone().unwrap_or_else(|| PathBuf::from("series-analysis"));
    check_folder(&out, &[FINDINGS])?;
    // The findings are written last; until then an empty list marks the folder as this command's.
    if !out.join(FINDINGS).exists() {
        std::fs::create_dir_all(&out).with_context(|| format!("cannot make `{}`", shown(&out)))?;
        write_atomic(&out.join(FINDINGS), b"[]")?;
    }
    let (mut records, pooled) = analysed(files, &out, asked, &mut reading)?;
    let limits = limits(options, &records);
    judge(&mut records, &limits);
    let sound = options.reference.unwrap_or(0);
    let findings: Vec<Option<&MeasuredFindings>> = records.iter().map(|r| r.findings.as_ref()).collect();
    let alarms: Vec<(usize, &str)> =
        records.iter().enumerate().flat_map(|(at, r)| alarms(at + 1, r)).collect();
    let series = Series::of(&findings, sound, &pooled).alarmed(&alarms);
    let all = SeriesFindings { series, records };
    remove_sheet(&out)?;
    write_series(&out, &all, &limits)?;
    if options.pdf {
        write_series_brief(&out, &all)?;
    }
    if options.json {
        say!("{}", serde_json::to_string_pretty(&all)?);
    } else {
        say!("{}", all.series.verdict);
        for record in &all.records {
            let verdict = record.findings.as_ref().map(|findings| &findings.verdict);
            say!("  {}: {}", record.file, verdict.or(record.error.as_ref()).map_or("", String::as_str));
            let passing = record.alarms.iter().filter(|judged| judged.state != State::Good);
            passing.for_each(|judged| say!("    {}", passed(judged)));
        }
        say!("report: {}", shown(&out.join("report.html")));
    }
    print_sheet(options, &out)?;
    let failed = all.records.iter().filter(|record| record.findings.is_none()).count();
    ensure!(failed == 0, "{failed} of {} records could not be analysed", all.records.len());
    Ok(ExitCode::SUCCESS)
}

/// Each record by itself; those of the healthy machine calibrate the verdict on the others.
fn analysed(
    files: &[PathBuf],
    out: &Path,
    asked: &Asked<'_>,
    reading: &mut Reading,
) -> Result<(Vec<SeriesRecord>, Vec<Pooled>)> {
    let options = asked.options;
    let every = files.len().div_ceil(PAGES).max(1);
    let (mut records, mut of_reference) = (Vec::new(), Vec::new());
    let mut pool = Pool::new(files.len(), options.reference.unwrap_or(0));
    for (at, (file, folder)) in files.iter().zip(folders(files)).enumerate() {
        let folder = (at.is_multiple_of(every) || at + 1 == files.len()).then_some(folder);
        let page = folder.as_ref().map(|folder| out.join(folder));
        let (findings, error) = match analyse(file, page.as_deref(), asked, reading) {
            Ok(analysis) => {
                pool.add(at, &analysis);
                if options.reference.is_some_and(|count| at < count) {
                    match baseline::claim(&analysis) {
                        Some(claim) => tell!("note: `{}` is left out of the reference: {claim}", shown(file)),
                        None => of_reference.extend(analysis.findings.score_db),
                    }
                }
                (Some(analysis.findings), None)
            }
            Err(why) if why.is::<Interrupted>() => return Err(why),
            Err(why) => (None, Some([vec![why.to_string()], causes(&why)].concat().join(": "))),
        };
        let file = file.display().to_string();
        records.push(SeriesRecord { file, folder, findings, error, alarms: Vec::new() });
        // Not by one another: what they scatter by is what the others are judged by.
        if options.reference == Some(at + 1) {
            reading.sound_db.append(&mut of_reference);
        }
    }
    Ok((records, pool.judged()))
}

/// The levels of a record that pass their alarm, with its number.
fn alarms(number: usize, record: &SeriesRecord) -> impl Iterator<Item = (usize, &str)> {
    let alarms = record.alarms.iter().filter(|judged| judged.state == State::Alarm);
    alarms.map(move |judged| (number, judged.limit.quantity.name()))
}

/// How the levels of each record stand to the limits.
fn judge(records: &mut [SeriesRecord], limits: &[Limit]) {
    for limit in limits {
        let mut all = records.iter().filter_map(|record| record.findings.as_ref()).peekable();
        let why = all.peek().map(|first| limit.quantity.missing(first));
        if let (Some(why), false) = (why, all.any(|findings| limit.judge(findings).is_some())) {
            tell!("note: no record has a level for the limit of {}: {why}", limit.quantity.name());
        }
    }
    for record in records {
        let Some(findings) = &record.findings else { continue };
        record.alarms = limits.iter().filter_map(|limit| limit.judge(findings)).collect();
    }
}

/// A folder for each of several files: those of one name in several places keep apart.
fn folders(files: &[PathBuf]) -> Vec<String> {
    let digits = files.len().to_string().len();
    let name = |(at, file): (usize, &PathBuf)| {
        let stem = file.file_stem().map_or_else(|| "record".into(), |n| n.to_string_lossy());
        format!("{:0digits$}-{stem}", at + 1)
    };
    files.iter().enumerate().map(name).collect()
}

/// Limits that were given, and those that follow from the reference records.
fn limits(options: &Options, records: &[SeriesRecord]) -> Vec<Limit> {
    let mut limits = options.alarms.clone();
    let reference = &records[..options.reference.unwrap_or(0)];
    for quantity in Quantity::ALL {
        if limits.iter().any(|limit| limit.quantity == quantity) {
            continue;
        }
        let values: Vec<f64> = reference.iter().filter_map(|e| quantity.of(e.findings.as_ref()?)).collect();
        limits.extend(Limit::from_reference(quantity, &values));
    }
    limits
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn by_hand_names_are_ordered_by_their_numbers() {
        let mut names: Vec<PathBuf> =
            ["acc_10.csv", "acc_2.csv", "2004.02.12.10.42.39", "2004.02.12.9.2.39", "acc_2b.csv"]
                .map(PathBuf::from)
                .into();
        names.sort_by_cached_key(|file| by_numbers(file));
        let ordered: Vec<String> = names.iter().map(|name| name.display().to_string()).collect();
        assert_eq!(
            ordered,
            ["acc_2.csv", "acc_2b.csv", "acc_10.csv", "2004.02.12.9.2.39", "2004.02.12.10.42.39"]
        );
    }
}
