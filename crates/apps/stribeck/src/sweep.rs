//! `stribeck sweep`: many runs of a scene, with tables and a page: a few values of a few fields, each with every
//! other, by flags, or the campaign of a file.

use std::collections::BTreeSet;
use std::path::{Component, Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Context, Result, bail, ensure};
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use stribeck_scene::catalogue;
use stribeck_scene::scene::{ModelScene, Scene};
use stribeck_scene::scene_file::readable;
use stribeck_store::campaign::Campaign;
use stribeck_store::run_dir::{Keep, check_folder};

use crate::campaign::{self, CAMPAIGN, MARKS, SCENES, announce, carry_out};
use crate::many_runs::Share;
use crate::out::{say, tell};
use crate::place::{Place, shown};

/// Flags of `sweep`.
#[derive(Debug, clap::Args)]
pub struct Options {
    /// Scene file, whose fields `--set` varies [default: the run of the paper, fixtures/scenes/singh2014.ron]; or,
    /// without `--set`, a campaign file, such as fixtures/campaigns/quick64.ron
    file: Option<PathBuf>,
    /// A field and its values, for example --set operation.load_n=1000,2000,4000; with one value the same for
    /// all runs. Several fields run every combination
    #[arg(long = "set", value_name = "FIELD=V1,V2,…")]
    set: Vec<String>,
    /// Starts of each combination, drawn from the seed: they show the scatter of the results [default: 1]
    #[arg(long, value_name = "N", requires = "set", value_parser = clap::value_parser!(u16).range(1..=10_000))]
    starts: Option<u16>,
    /// Seed of the starts [default: 1]
    #[arg(long, value_name = "SEED", requires = "set")]
    seed: Option<u64>,
    /// Files kept of each run once its summary exists [default: signals of the reduced model, whose runs are made
    /// again in seconds, and all of the full one; in a folder of a sweep what that kept; of a campaign file what it
    /// says]
    #[arg(long, value_parser = keep())]
    keep: Option<Keep>,
    /// Folder [default: runs/NAME-by-FIELD, or runs/NAME of a campaign file]; the same command continues; with other
    /// values its tables are theirs, and runs that are there are used where they occur again
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    #[command(flatten)]
    share: Share,
    /// Runs nothing: prints the campaign's file, to be sent to a file and extended
    #[arg(long, requires = "set")]
    print: bool,
    #[command(flatten)]
    of_file: campaign::OfFile,
}

/// The values of `--keep`.
fn keep() -> impl TypedValueParser<Value = Keep> {
    let about = ["Everything", "Of the samples those of the sensors", "No samples"];
    let words = Keep::ALL.iter().zip(about).map(|(keep, about)| PossibleValue::new(keep.word()).help(about));
    let of = |word: String| Keep::ALL.into_iter().find(|keep| keep.word() == word);
    PossibleValuesParser::new(words).map(move |word| of(word).unwrap_or(Keep::All))
}

/// What is kept where nobody says.
fn usual(scene: &Scene) -> Keep {
    if scene.model == ModelScene::Full { Keep::All } else { Keep::Signals }
}

/// The first words of a file that this command wrote, which it may replace.
const WRITTEN_BY: &str = "// Written by `stribeck sweep`";

/// Most runs of a sweep; a campaign may have more.
const MOST_RUNS: usize = 10_000;

/// One argument of `--set`.
#[derive(Debug, PartialEq)]
struct Assigned {
    field: String,
    values: Vec<String>,
}

pub(crate) fn run(options: &Options, place: &Place) -> Result<ExitCode> {
    match &options.file {
        Some(file) if options.set.is_empty() => {
            let file = place.locate(file);
            ensure!(
                readable(Some(&file), &[] as &[&str]).is_err(),
                "`{0}` is a scene: say which of its fields varies, as in `{1} sweep {0} --set \
                 operation.load_n=1000,2000,4000`. A single run is `{1} simulate {0}`",
                shown(&file),
                place.program
            );
            campaign::run(&file, options.keep, options.out.clone(), options.share, &options.of_file, place)
        }
        None if options.set.is_empty() => bail!(
            "nothing varies: `{0} sweep SCENE.ron --set operation.load_n=1000,2000,4000` runs a scene with some \
             values of a field, `{0} sweep CAMPAIGN.ron` the campaign of a file",
            place.program
        ),
        _ => vary(options, place),
    }
}

/// Runs a scene with the values of `--set`.
fn vary(options: &Options, place: &Place) -> Result<ExitCode> {
    let starts = options.starts.unwrap_or(1);
    let assigned = options.set.iter().map(|text| Assigned::parse(text)).collect::<Result<Vec<_>>>()?;
    let (swept, fixed): (Vec<&Assigned>, Vec<&Assigned>) = assigned.iter().partition(|a| a.values.len() > 1);
    let Some(first) = swept.first() else {
        let Assigned { field, values } = &assigned[0];
        bail!(
            "no field has several values: write `--set {field}={0},…`, as in `--set \
             operation.load_n=1000,2000,4000`. A single run is `{1} simulate`",
            values.first().map_or("1", String::as_str),
            place.program
        );
    };
    let twice =
        assigned.iter().enumerate().find(|(at, a)| assigned[..*at].iter().any(|b| b.field == a.field));
    if let Some((_, twice)) = twice {
        bail!("`{0}` is set twice: give all its values at once, `--set {0}=V1,V2,…`", twice.field);
    }
    let count = swept.iter().map(|a| a.values.len()).product::<usize>() * usize::from(starts);
    ensure!(
        count <= MOST_RUNS,
        "{count} runs: a sweep makes {MOST_RUNS} at most. Take fewer values or starts, or a campaign with a \
         design: `sobol` and `latin_hypercube` fill many fields with few runs"
    );
    let scene = read_each(options, place, &swept, &fixed)?;
    // Another bearing brings its own name.
    let stem = options.file.as_deref().and_then(Path::file_stem).map(|stem| stem.to_string_lossy());
    let of_bearing = swept.iter().any(|a| a.field == "bearing");
    let name = name(stem.filter(|_| of_bearing).as_deref().unwrap_or(&scene.name), &swept);
    let out = options.out.clone().unwrap_or_else(|| place.runs().join(&name));
    let keep = options.keep.or_else(|| kept_in(&out)).unwrap_or(usual(&scene));
    let base = options.file.as_deref().map(|scene| place.locate(scene));
    if options.print {
        // To be sent to a file in the working folder.
        let text = text(options, keep, &name, base.as_deref(), Path::new("."), (&swept, &fixed))?;
        announce(&Campaign::parse(&text, CAMPAIGN, Path::new(""))?);
        say!("{}", text.trim_end());
        return Ok(ExitCode::SUCCESS);
    }
    let text = text(options, keep, &name, base.as_deref(), &out, (&swept, &fixed))?;
    let campaign = parse(&text, &out)?;
    tell!(
        "{} of {}{}: {} runs",
        first.values.len(),
        first.field,
        swept[1..].iter().map(|a| format!(" × {} of {}", a.values.len(), a.field)).collect::<String>(),
        campaign.runs.len()
    );
    make_way(&out, keep)?;
    carry_out(&campaign, out, options.share, None)
}

/// The campaign of a text in the folder that it is for, which is made: paths lead through it.
fn parse(text: &str, out: &Path) -> Result<Campaign> {
    check_folder(out, &MARKS)?;
    std::fs::create_dir_all(out).with_context(|| format!("cannot make `{}`", shown(out)))?;
    Campaign::parse(text, &shown(&out.join(CAMPAIGN)), out).map_err(|why| {
        // Only where nothing lies in it.
        std::fs::remove_dir(out).ok();
        why.into()
    })
}

/// Reads the scene under each value of each field separately, so that mistakes are reported in the words of
/// the command line; returns the first. Assumed dimensions are reported once for all values.
fn read_each(options: &Options, place: &Place, swept: &[&Assigned], fixed: &[&Assigned]) -> Result<Scene> {
    let file = options.file.as_deref();
    let argument = |a: &Assigned, value: &str| format!("{}={value}", a.field);
    let common: Vec<String> = fixed.iter().map(|a| argument(a, &a.values[0])).collect();
    let firsts: Vec<String> = swept.iter().map(|a| argument(a, &a.values[0])).collect();
    let mut sets = vec![[common.as_slice(), &firsts].concat()];
    for (at, a) in swept.iter().enumerate() {
        for value in &a.values[1..] {
            let mut set = firsts.clone();
            set[at] = argument(a, value);
            sets.push([common.as_slice(), &set].concat());
        }
    }
    let (mut notes, mut first) = (BTreeSet::new(), None);
    for set in &sets {
        let scene = place.scene_quietly(file, set)?;
        if !scene.bearing.assumed.is_empty() {
            notes.extend(catalogue::assumptions(&scene.bearing));
        }
        first.get_or_insert(scene);
    }
    for note in notes {
        tell!("note: {note}");
    }
    first.context("no value to run")
}

/// The name of the folder: that of the scene with the last words of the fields.
fn name(scene: &str, swept: &[&Assigned]) -> String {
    let last = |a: &&Assigned| a.field.rsplit('.').next().unwrap_or(&a.field).to_owned();
    let fields = swept.iter().map(last).collect::<Vec<_>>().join("-");
    let name = format!("{scene}-by-{fields}");
    name.replace(|c: char| !(c.is_ascii_alphanumeric() || "-_".contains(c)), "-")
}

fn text(
    options: &Options,
    keep: Keep,
    name: &str,
    base: Option<&Path>,
    out: &Path,
    (swept, fixed): (&[&Assigned], &[&Assigned]),
) -> Result<String> {
    let mut text = format!(
        "{WRITTEN_BY}. `stribeck sweep {CAMPAIGN} --out .` in this folder goes on with it;\n// a copy \
         elsewhere can be extended.\n(\n    name: {name:?},\n"
    );
    if let Some(base) = base {
        text += &format!("    scene: {:?},\n", relative(base, out)?.display().to_string());
    }
    let common: Vec<String> =
        fixed.iter().map(|a| format!("{:?}", format!("{}={}", a.field, a.values[0]))).collect();
    if !common.is_empty() {
        text += &format!("    set: [{}],\n", common.join(", "));
    }
    text +=
        &format!("    seed: {},\n    starts: {},\n", options.seed.unwrap_or(1), options.starts.unwrap_or(1));
    text += &format!("    keep: {},\n    variants: grid([\n", keep.word());
    for a in swept {
        let values: Vec<String> = a.values.iter().map(|value| as_ron(&a.field, value)).collect();
        text += &format!("        (field: {:?}, values: [{}]),\n", a.field, values.join(", "));
    }
    Ok(text + "    ]),\n)\n")
}

/// A value as a scene has it: names of bearings and other texts get their quotes.
fn as_ron(field: &str, value: &str) -> String {
    let quoted = value.starts_with(['"', '(', '[', '{']);
    let word = value.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
        || value.split_once('(').is_some_and(|(name, rest)| {
            rest.ends_with(')') && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
        });
    let number = value.parse::<f64>().is_ok();
    // `6205` is no number where it names a bearing.
    let plain = quoted || (field != "bearing" && (word || number));
    if plain { value.to_owned() } else { format!("{value:?}") }
}

/// The way from a folder to a file, so that both can be moved together.
pub(crate) fn relative(file: &Path, folder: &Path) -> Result<PathBuf> {
    let absolute = |path: &Path| {
        std::path::absolute(path).with_context(|| format!("`{}` has no absolute path", path.display()))
    };
    let (file, folder) = (absolute(file)?, absolute(folder)?);
    let (to, from): (Vec<Component<'_>>, Vec<Component<'_>>) =
        (file.components().collect(), folder.components().collect());
    // `..` in a path that links lead through is not the way back.
    if to.contains(&Component::ParentDir) || from.contains(&Component::ParentDir) {
        return Ok(file);
    }
    let common = to.iter().zip(&from).take_while(|(a, b)| a == b).count();
    if common < 2 {
        return Ok(file);
    }
    let up = from[common..].iter().map(|_| Component::ParentDir);
    Ok(up.chain(to[common..].iter().copied()).collect())
}

/// What the sweep in this folder keeps, if there is one.
fn kept_in(out: &Path) -> Option<Keep> {
    let text =
        std::fs::read_to_string(out.join(CAMPAIGN)).ok().filter(|text| text.starts_with(WRITTEN_BY))?;
    Keep::ALL.into_iter().find(|kept| text.contains(&format!("keep: {},", kept.word())))
}

/// Removes the tables of an earlier sweep in this folder; its runs stay and are used where their scenes occur
/// again.
fn make_way(out: &Path, keep: Keep) -> Result<()> {
    let text = std::fs::read_to_string(out.join(CAMPAIGN)).unwrap_or_default();
    if text.starts_with(WRITTEN_BY) {
        if let Some(before) = kept_in(out).filter(|before| *before > keep) {
            bail!(
                "runs in `{}` were made with `--keep {}`, and what `--keep {}` asks for besides was \
                 not kept: give the same `--keep`, or another `--out`",
                shown(out),
                before.word(),
                keep.word()
            );
        }
        for file in [CAMPAIGN, SCENES] {
            match std::fs::remove_file(out.join(file)) {
                Err(why) if why.kind() != std::io::ErrorKind::NotFound => {
                    return Err(why).with_context(|| format!("cannot remove `{}`", shown(&out.join(file))));
                }
                _ => {}
            }
        }
    }
    Ok(())
}

impl Assigned {
    /// A field and its values from `FIELD=V1,V2,…`.
    fn parse(text: &str) -> Result<Self> {
        let (field, values) = text.split_once('=').with_context(|| {
            format!("`--set {text}` has no `=`: write FIELD=V1,V2, such as operation.load_n=1000,2000")
        })?;
        let field = field.trim().to_owned();
        let values = split(values);
        ensure!(
            !field.is_empty() && values.iter().all(|value| !value.is_empty()),
            "`--set {text}`: {} empty; write FIELD=V1,V2, such as operation.load_n=1000,2000",
            if field.is_empty() { "the field is" } else { "a value is" }
        );
        if let Some(at) = (1..values.len()).find(|at| values[..*at].contains(&values[*at])) {
            bail!(
                "`--set {text}`: the value {} stands there twice; each is run once, give it once",
                values[at]
            );
        }
        Ok(Self { field, values })
    }
}

/// Parts between commas outside of brackets and quotes; a part that assigns something, as in `NU 205,
/// elements=13`, belongs to the one before it.
fn split(text: &str) -> Vec<String> {
    let (mut parts, mut depth, mut quoted) = (vec![String::new()], 0_i32, false);
    for c in text.chars() {
        match c {
            '"' => quoted = !quoted,
            '(' | '[' | '{' if !quoted => depth += 1,
            ')' | ']' | '}' if !quoted => depth -= 1,
            _ => {}
        }
        if c == ',' && depth == 0 && !quoted {
            parts.push(String::new());
        } else if let Some(part) = parts.last_mut() {
            part.push(c);
        }
    }
    let mut values: Vec<String> = Vec::new();
    for part in parts {
        let assigns = part.split_once('=').is_some_and(|(name, _)| {
            !name.trim().is_empty() && name.trim().chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
        });
        match values.last_mut() {
            Some(before) if assigns => *before += &format!(", {}", part.trim()),
            _ => values.push(part.trim().to_owned()),
        }
    }
    values
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn behaves_values_between_commas() {
        for (text, values) in [
            ("1,2, 4", vec!["1", "2", "4"]),
            ("(a: 1, b: 2),None", vec!["(a: 1, b: 2)", "None"]),
            ("NU 205,NU 206, elements=13", vec!["NU 205", "NU 206, elements=13"]),
            ("\"a, b\",c", vec!["\"a, b\"", "c"]),
            ("[(x: 1)],[]", vec!["[(x: 1)]", "[]"]),
        ] {
            assert_eq!(split(text), values, "{text}");
        }
    }

    #[test]
    fn behaves_texts_get_their_quotes_and_words_none() {
        assert_eq!(as_ron("operation.load_n", "1e3"), "1e3");
        assert_eq!(as_ron("defect.ring", "inner"), "inner");
        assert_eq!(as_ron("model", "reduced(modes_khz: 20)"), "reduced(modes_khz: 20)");
        assert_eq!(as_ron("bearing", "NU 205"), "\"NU 205\"");
        assert_eq!(as_ron("bearing", "6205"), "\"6205\"");
        assert_eq!(as_ron("bearing", "(rollers: 9)"), "(rollers: 9)");
    }

    #[test]
    fn behaves_a_scene_is_found_from_its_folder() {
        assert_eq!(
            relative(Path::new("/a/b/x.ron"), Path::new("/a/b/runs/y")).unwrap(),
            Path::new("../../x.ron")
        );
        assert_eq!(relative(Path::new("/a/x.ron"), Path::new("/b/y")).unwrap(), Path::new("/a/x.ron"));
    }

    #[test]
    fn refuses_what_is_no_sweep() {
        for (text, says) in [
            ("load", "has no `=`"),
            ("=1,2", "the field is empty"),
            ("a=1,,2", "a value is empty"),
            ("a=1,2,1", "twice"),
        ] {
            let why = Assigned::parse(text).expect_err(text).to_string();
            assert!(why.contains(says), "{why}");
        }
    }
}
