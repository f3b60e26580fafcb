//! `cargo xtask study reduced`: the reduced bearing beside the full one, scene by scene, with the effects
//! that it leaves out.

mod cases;
mod tables;

use std::path::Path;

use anyhow::{Context, Result, bail, ensure};
use stribeck_analysis::agreement::Agreement;

use crate::{Answer, Flags, Host, Runner, Sheet, Variant};
use cases::{CASES, Case, Model};

/// Flags of `study reduced`.
#[derive(Debug, clap::Args)]
pub struct Options {
    #[command(flatten)]
    flags: Flags,
}

/// A scene of which ledgers are kept for long, and steps of that [µs].
const LONG: &str = "fixtures/scenes/reduced.ron";
const LEDGER_US: [&str; 3] = ["5", "2", "0.5"];
const LEDGER_MS: [&str; 2] = ["1000", "10000"];

/// Result of a case with one reduced model.
struct Compared {
    case: &'static Case,
    /// In words, and the name of its folder.
    words: String,
    name: String,
    agreement: Agreement,
}

pub(crate) fn run(options: &Options, host: &dyn Host) -> Result<Answer> {
    let flags = &options.flags;
    let folder = host.root().join("runs/study/reduced");
    let mut all = Vec::new();
    for case in CASES {
        for model in case.models {
            let name = case.folder(model);
            let out = folder.join(&name);
            if flags.wants(&name) && !flags.runs_nothing() {
                host.say(&format!("{name}: {} starts", case.starts));
                if let Err(error) = validate(case, model, &out, &folder, flags, host) {
                    host.say(&format!("{name}: {error:#}"));
                }
                ensure!(!host.is_interrupted(), "interrupted; the same command goes on from here");
            }
            let Some(agreement) = read(&out)? else { continue };
            if agreement.scene_hash == case.scene(host.root(), model)?.hash()
                && agreement.starts == case.starts
            {
                all.push(Compared { case, words: format!("{}, {}", case.what, model.0), name, agreement });
            } else {
                host.say(&format!(
                    "{name}: what is there is of another scene or number of starts, and is left out"
                ));
            }
        }
    }
    let ledgers: Vec<Variant> = LEDGER_MS
        .iter()
        .flat_map(|ms| LEDGER_US.map(|us| (ms, us)))
        .map(|(ms, us)| {
            Variant::new(format!("ledger-{}us-{ms}ms", us.replace('.', "_")), LONG, &[])
                .with(format!("model.step_us={us}"))
                .with(format!("solver.duration_ms={ms}"))
                .with("output.interval_us=100")
        })
        .collect();
    let ledgers = Runner::new("reduced", flags, host).run(&ledgers)?;

    let mut sheet = Sheet::new(host.root(), "reduced", "The reduced bearing beside the full one");
    sheet.say(
        "How far is the reduced model from the full one, and what does it not keep? Each scene runs by both \
         from the same starts \
         (`stribeck validate`). Differences are reduced less full: means over the starts with half their 95 \
         % intervals, or, of \
         accelerations, one standard error. No number was fitted to any of them, but faults were found on \
         the first scene, with 20 rollers \
         and with oil: these are not unseen. **Bold** is outside its limit by more than chance may be; a \
         limit that so few starts cannot \
         tell is listed below.",
    );
    tables::scenes(&mut sheet, &all);
    tables::forces(&mut sheet, &all);
    tables::accelerations(&mut sheet, &all);
    tables::lines(&mut sheet, &all);
    tables::peaks(&mut sheet, &all);
    tables::outside(&mut sheet, &all);
    tables::balance(&mut sheet, &ledgers);
    tables::values(&mut sheet, &all);
    Ok(Answer::on(sheet.write()?))
}

/// Runs both models from all starts, those that are missing. Models of one scene share the runs of the full
/// model.
///
/// # Errors
/// When a run does not come to its end.
fn validate(
    case: &Case,
    model: &Model,
    out: &Path,
    folder: &Path,
    flags: &Flags,
    host: &dyn Host,
) -> Result<()> {
    let mut command = host.stribeck()?;
    command.arg("validate").arg(host.root().join(case.scene));
    command.args(case.set(model).iter().map(|set| format!("--set={set}")));
    command.arg(format!("--starts={}", case.starts));
    command.arg("--out").arg(out).arg("--full").arg(folder.join(format!("{}-full", case.name)));
    command.args(flags.of_a_command()).stdout(std::process::Stdio::null());
    let status = command.status().context("`stribeck validate` does not start")?;
    ensure!(status.success(), "`{}` did not come to its end", out.display());
    Ok(())
}

/// Result of a validation, if it has been made.
fn read(out: &Path) -> Result<Option<Agreement>> {
    let path = out.join("validation.json");
    let text = match std::fs::read(&path) {
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(None),
        text => text.with_context(|| format!("cannot read {}", path.display()))?,
    };
    match serde_json::from_slice(&text) {
        Ok(agreement) => Ok(Some(agreement)),
        Err(error) => bail!("{}: {error}", path.display()),
    }
}
