//! Scripts that have an existing engine run the parts of a campaign.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result};

/// Engines that a script can be written for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub(super) enum Engine {
    /// A job array of Slurm, for `sbatch`
    Slurm,
    /// An array of HyperQueue, for a shell beside its server
    Hq,
}

/// What a part is told.
#[derive(Debug, Clone, Copy)]
pub(super) struct Part {
    pub(super) of: u32,
    pub(super) jobs: Option<usize>,
    pub(super) threads: usize,
    pub(super) memory_gb: Option<f64>,
}

impl Part {
    /// As many threads as it may have, or one a job, and one part a run up to some.
    pub(super) fn of(options: &super::Options, runs: usize) -> Self {
        Self {
            of: options.shards.unwrap_or(MOST_PARTS.min(u32::try_from(runs).unwrap_or(MOST_PARTS))),
            jobs: options.jobs,
            threads: options.threads.or(options.jobs).unwrap_or(1),
            memory_gb: options.memory_gb,
        }
    }
}

/// Parts of a campaign for which nobody has said how many.
const MOST_PARTS: u32 = 16;

/// The script. It may be submitted again after any loss: what is done is not done twice. A part that ends
/// before others leaves the tables to them and has done its work; so an engine that reports a failure has one
/// to report.
pub(super) fn script(engine: Engine, file: &Path, out: &Path, part: Part) -> Result<String> {
    let absolute = |path: &Path| -> Result<PathBuf> {
        std::path::absolute(path).with_context(|| format!("`{}` has no absolute path", path.display()))
    };
    let Part { of, jobs, threads, memory_gb } = part;
    let program = std::env::current_exe().context("the program does not know its own path")?;
    let command = |number: &str| -> Result<String> {
        Ok(format!(
            "{} campaign {} --out {} --shard {number}/{of}{} --threads {threads}{}",
            quoted(&program),
            quoted(&absolute(file)?),
            quoted(&absolute(out)?),
            jobs.map_or_else(String::new, |jobs| format!(" --jobs {jobs}")),
            memory_gb.map_or_else(String::new, |gb| format!(" --memory-gb {gb}")),
        ))
    };
    // A cluster ends what takes more than it asked for.
    let memory = memory_gb
        .map_or_else(String::new, |gb| format!("#SBATCH --mem={:.0}M\n", (1e9 * gb / 1048576.0).ceil()));
    Ok(match engine {
        Engine::Slurm => format!(
            "#!/bin/sh\n#SBATCH --job-name=stribeck\n#SBATCH --array=1-{of}\n#SBATCH \
             --cpus-per-task={threads}\n{memory}#SBATCH --requeue\n\
             # Submit with `sbatch`; once more after a loss. The last part that ends makes the tables.\n{}\n",
            command("$SLURM_ARRAY_TASK_ID")?
        ),
        Engine::Hq => format!(
            "#!/bin/sh\n# Run it where `hq` finds its server; once more after a loss. The last part that \
             ends makes the tables.\n\
             hq submit --array=1-{of} --cpus={threads} --crash-limit=unlimited --wait -- sh -c '{}'\n",
            command("$HQ_TASK_ID")?.replace('\'', "'\\''")
        ),
    })
}

/// A path as a word of a shell.
fn quoted(path: &Path) -> String {
    let text = path.display().to_string();
    let plain = text.chars().all(|c| c.is_ascii_alphanumeric() || "/._-+".contains(c));
    if plain {
        text
    } else {
        // Nothing means anything between single quotes but their end.
        format!("'{}'", text.replace('\'', "'\\''"))
    }
}
