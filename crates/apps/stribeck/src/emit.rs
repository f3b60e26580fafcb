//! Scripts by which an existing workflow engine runs the parts of a campaign.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result};

use crate::many_runs::Share;
use crate::out::caution;

/// Engines that a script can be written for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum Engine {
    /// A job array of Slurm, for `sbatch`
    Slurm,
    /// A job array of PBS Pro or OpenPBS, for `qsub`
    Pbs,
    /// An array of HyperQueue, for a shell beside its server
    Hq,
}

/// Arguments of a part.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Part {
    pub(crate) of: u32,
    /// Most runs of a part.
    pub(crate) runs: usize,
    pub(crate) jobs: Option<usize>,
    pub(crate) threads: usize,
    pub(crate) memory_gb: Option<f64>,
}

impl Part {
    /// One of as many parts as are asked for, or 16, and no more than there are runs or an engine takes; with its
    /// threads, or one thread a job.
    pub(crate) fn new(asked: Option<u32>, runs: usize, engine: Engine, share: Share) -> Self {
        let Share { jobs, threads, memory_gb } = share;
        let most = match engine {
            Engine::Slurm => MOST_OF_SLURM,
            Engine::Pbs => MOST_OF_PBS,
            Engine::Hq => u32::MAX,
        };
        let of = asked.unwrap_or(USUAL_PARTS).min(u32::try_from(runs).unwrap_or(u32::MAX)).min(most);
        if let Some(asked) = asked.filter(|asked| *asked > of) {
            let why = if of == most {
                "an array of this engine takes no index above it"
            } else {
                "as many as runs"
            };
            caution!("{of} parts in place of {asked}: {why}");
        }
        let runs = runs.div_ceil(of.max(1) as usize);
        Self { of, runs, jobs, threads: threads.or(jobs).unwrap_or(1), memory_gb }
    }
}

/// Default number of parts.
const USUAL_PARTS: u32 = 16;
/// `MaxArraySize` of Slurm is 1001 where a site has not changed it, and the first index is 1.
const MOST_OF_SLURM: u32 = 1000;
/// `max_array_size` of PBS where a site has not changed it.
const MOST_OF_PBS: u32 = 10_000;

/// The script that runs `command`. It may be submitted again after any loss: completed runs are not repeated.
/// A part that ends before others leaves the tables to them and succeeds; so an engine reports real failures
/// only.
pub(crate) fn script(engine: Engine, command: &str, file: &Path, out: &Path, part: Part) -> Result<String> {
    let absolute = |path: &Path| -> Result<PathBuf> {
        std::path::absolute(path).with_context(|| format!("`{}` has no absolute path", path.display()))
    };
    let Part { of, runs, jobs, threads, memory_gb } = part;
    let program = std::env::current_exe().context("the path of the program is unknown")?;
    let line = |number: &str| -> Result<String> {
        Ok(format!(
            "{} {command} {} --out {} --shard {number}/{of}{} --threads {threads}{}",
            quoted(&program),
            quoted(&absolute(file)?),
            quoted(&absolute(out)?),
            jobs.map_or_else(String::new, |jobs| format!(" --jobs {jobs}")),
            memory_gb.map_or_else(String::new, |gb| format!(" --memory-gb {gb}")),
        ))
    };
    // A cluster kills jobs that exceed their request.
    let memory = |key: &str, end: &str| {
        let mib = memory_gb.map(|gb| (1e9 * gb / 1048576.0).ceil());
        mib.map_or_else(String::new, |mib| format!("{key}{mib:.0}{end}"))
    };
    let limit = format!(
        "# A part makes up to {runs} runs; `stribeck plan` says how long one takes. Where the site demands a limit of \
         time,\n# take one # from the next line.\n"
    );
    Ok(match engine {
        Engine::Slurm => format!(
            "#!/bin/sh\n#SBATCH --job-name=stribeck\n#SBATCH --array=1-{of}\n#SBATCH \
             --cpus-per-task={threads}\n{}#SBATCH --requeue\n{limit}##SBATCH --time=24:00:00\n\
             # Submit with `sbatch`; once more after a loss. The last part that ends makes the tables.\n{}\n",
            memory("#SBATCH --mem=", "M\n"),
            line("$SLURM_ARRAY_TASK_ID")?
        ),
        Engine::Pbs => {
            // An array of one is refused.
            let (array, number) =
                if of > 1 { (format!("#PBS -J 1-{of}\n"), "$PBS_ARRAY_INDEX") } else { (String::new(), "1") };
            format!(
                "#!/bin/sh\n#PBS -N stribeck\n{array}#PBS -l select=1:ncpus={threads}{}\n#PBS -r y\n{limit}\
                 ##PBS -l walltime=24:00:00\n\
                 # Submit with `qsub`; once more after a loss. The last part that ends makes the tables.\n{}\n",
                memory(":mem=", "mb"),
                line(number)?
            )
        }
        Engine::Hq => format!(
            "#!/bin/sh\n# Run it where `hq` finds its server; once more after a loss. The last part that \
             ends makes the tables.\n\
             hq submit --array=1-{of} --cpus={threads} --crash-limit=unlimited --wait -- sh -c '{}'\n",
            line("$HQ_TASK_ID")?.replace('\'', "'\\''")
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
