//! What a run records about the machine and the program: clocks, names, versions. The crates are told, never look.

use std::path::Path;
use std::process::Command;
use std::time::Instant;

use stribeck_bearing::simulation::Host;

use crate::workspace;

/// Ticks per second in `/proc/self/stat`; Linux promises this number to programs on every architecture.
const TICKS_PER_SECOND: f64 = 100.0;

/// Calls `work` with a [`Host`] that describes this process; its clocks begin now.
pub(crate) fn with<T>(threads: usize, work: impl FnOnce(&Host<'_>) -> T) -> T {
    let (start, before) = (Instant::now(), cpu_s());
    work(&Host {
        threads,
        version: env!("CARGO_PKG_VERSION").to_owned(),
        commit: commit(&workspace::root()),
        machine: machine(),
        wall_s: &|| start.elapsed().as_secs_f64(),
        cpu_s: &|| cpu_s() - before,
    })
}

/// Commit of the checkout, with a mark when its files have been changed since; `unknown` outside a checkout.
fn commit(root: &Path) -> String {
    let git = |arguments: &[&str]| -> Option<String> {
        let output = Command::new("git").arg("-C").arg(root).args(arguments).output().ok()?;
        let text = String::from_utf8(output.stdout).ok()?;
        output.status.success().then(|| text.trim().to_owned())
    };
    let Some(commit) = git(&["rev-parse", "--short=12", "HEAD"]).filter(|commit| !commit.is_empty()) else {
        return "unknown".to_owned();
    };
    let changed =
        git(&["status", "--porcelain", "--untracked-files=no"]).is_some_and(|files| !files.is_empty());
    if changed { commit + " with changes" } else { commit }
}

/// Processor, cores and system, in words.
fn machine() -> String {
    let cpuinfo = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let processor = processor_name(&cpuinfo).unwrap_or("unknown processor");
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    format!("{processor}, {cores} cores, {} {}", std::env::consts::OS, std::env::consts::ARCH)
}

fn processor_name(cpuinfo: &str) -> Option<&str> {
    let line = cpuinfo.lines().find(|line| line.starts_with("model name"))?;
    Some(line.split_once(':')?.1.trim())
}

/// Processor time of this process, all threads [s]; 0 where the system has no `/proc`.
fn cpu_s() -> f64 {
    std::fs::read_to_string("/proc/self/stat").ok().and_then(|stat| cpu_of(&stat)).unwrap_or(0.0)
}

/// Most memory that this process has had so far [MiB]; `None` where the system has no `/proc`.
pub(crate) fn peak_memory_mib() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM:"))?;
    let kib: f64 = line.split_whitespace().nth(1)?.parse().ok()?;
    Some(kib / 1024.0)
}

/// User and system time [s] of a line of `/proc/<pid>/stat`, fields 14 and 15.
fn cpu_of(stat: &str) -> Option<f64> {
    // The second field, the program's name, may contain spaces and brackets; the last bracket ends it.
    let (_, rest) = stat.rsplit_once(')')?;
    let mut fields = rest.split_whitespace().skip(11);
    let user: f64 = fields.next()?.parse().ok()?;
    let system: f64 = fields.next()?.parse().ok()?;
    Some((user + system) / TICKS_PER_SECOND)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn example_processor_time_of_a_stat_line() {
        let stat = "42 (a ) name) S 1 42 42 0 -1 4194304 100 0 0 0 250 50 0 0 20 0 2 0 1 1 1";
        assert_eq!(cpu_of(stat), Some(3.0));
        assert_eq!(cpu_of("nonsense"), None);
    }

    #[test]
    fn example_processor_name_of_cpuinfo() {
        assert_eq!(
            processor_name("processor\t: 0\nmodel name\t: Some CPU @ 2 GHz\n"),
            Some("Some CPU @ 2 GHz")
        );
        assert_eq!(processor_name(""), None);
    }
}
