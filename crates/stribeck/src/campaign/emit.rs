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

/// The script. It may be submitted again after any loss: what is done is not done twice.
pub(super) fn script(engine: Engine, file: &Path, out: &Path, shards: u32) -> Result<String> {
    let absolute = |path: &Path| -> Result<PathBuf> {
        std::path::absolute(path).with_context(|| format!("`{}` has no absolute path", path.display()))
    };
    let program = std::env::current_exe().context("the program does not know its own path")?;
    let command = |part: &str| -> Result<String> {
        Ok(format!(
            "{} campaign {} --out {} --shard {part}/{shards}",
            quoted(&program),
            quoted(&absolute(file)?),
            quoted(&absolute(out)?)
        ))
    };
    // A part that ends before others leaves the tables to them, which is no failure of its own.
    Ok(match engine {
        Engine::Slurm => format!(
            "#!/bin/sh\n#SBATCH --job-name=stribeck\n#SBATCH --array=1-{shards}\n#SBATCH --cpus-per-task=1\n#SBATCH --requeue\n\
             # Submit with `sbatch`; once more after a loss. The last part that ends makes the tables.\n{} --threads 1 || true\n",
            command("$SLURM_ARRAY_TASK_ID")?
        ),
        Engine::Hq => format!(
            "#!/bin/sh\n# Run it where `hq` finds its server; once more after a loss. The last part that ends makes the tables.\n\
             hq submit --array=1-{shards} --cpus=1 --crash-limit=unlimited --wait -- sh -c '{} --threads 1 || true'\n",
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
        format!("\"{}\"", text.replace('\\', "\\\\").replace('"', "\\\"").replace('$', "\\$"))
    }
}
