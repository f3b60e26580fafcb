//! Clocks, names and versions that a run records about computer and program. The crates are given them and
//! never read them.

use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

use stribeck_simulation::run::host::Host;

/// Ticks per second in `/proc/self/stat`; Linux promises this number to programs on every architecture.
const TICKS_PER_SECOND: f64 = 100.0;

/// Version of the program, with the commit that it was built from.
pub const VERSION: &str = concat!(env!("CARGO_PKG_VERSION"), " (", env!("STRIBECK_COMMIT"), ")");

/// Commit that the program was built from, with a mark when files had been changed since; `unknown` outside a
/// checkout.
pub const COMMIT: &str = env!("STRIBECK_COMMIT");

/// Calls `work` with a [`Host`] that describes this process; its clocks begin now.
pub fn with<T>(threads: usize, work: impl FnOnce(&Host<'_>) -> T) -> T {
    let before = cpu_s();
    with_clock(threads, &|| cpu_s() - before, work)
}

/// As [`with`], with another count of processor time.
fn with_clock<T>(threads: usize, cpu_s: &dyn Fn() -> f64, work: impl FnOnce(&Host<'_>) -> T) -> T {
    let start = Instant::now();
    work(&Host {
        threads,
        version: env!("CARGO_PKG_VERSION").to_owned(),
        commit: COMMIT.to_owned(),
        machine: machine(),
        wall_s: &|| start.elapsed().as_secs_f64(),
        cpu_s,
    })
}

/// Processor time of several runs side by side: the system counts that of the whole process, and each run
/// that is going gets an equal part.
#[derive(Debug, Default)]
pub struct SharedClock(Mutex<Shares>);

#[derive(Debug, Default)]
struct Shares {
    /// Processor time of the process at its last distribution [s].
    dealt_s: f64,
    /// Processor time assigned to each active run so far [s].
    going: BTreeMap<usize, f64>,
}

impl SharedClock {
    /// Calls `work` of run `number` as [`with`] does.
    pub fn with<T>(&self, threads: usize, number: usize, work: impl FnOnce(&Host<'_>) -> T) -> T {
        let deal = |change: fn(&mut BTreeMap<usize, f64>, usize)| -> f64 {
            let mut shares = self.0.lock().unwrap_or_else(PoisonError::into_inner);
            shares.deal(cpu_s());
            change(&mut shares.going, number);
            shares.going.get(&number).copied().unwrap_or(0.0)
        };
        deal(|going, number| {
            going.insert(number, 0.0);
        });
        let done = with_clock(threads, &|| deal(|_, _| {}), work);
        deal(|going, number| {
            going.remove(&number);
        });
        done
    }
}

impl Shares {
    fn deal(&mut self, now_s: f64) {
        let part = (now_s - self.dealt_s) / self.going.len().max(1) as f64;
        self.going.values_mut().for_each(|share| *share += part);
        self.dealt_s = now_s;
    }
}

/// Cores that this process may use.
pub fn cores() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

/// Processor, cores and system, in words.
pub fn machine() -> String {
    let cpuinfo = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let processor = processor_name(&cpuinfo).unwrap_or("unknown processor");
    let cores = cores();
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
    fn by_hand_runs_side_by_side_share_the_processor_time() {
        let mut shares = Shares::default();
        shares.deal(5.0);
        shares.going.insert(1, 0.0);
        shares.deal(7.0);
        shares.going.insert(2, 0.0);
        shares.deal(11.0);
        assert_eq!(shares.going, BTreeMap::from([(1, 4.0), (2, 2.0)]));
    }

    #[test]
    fn by_hand_processor_time_of_a_stat_line() {
        let stat = "42 (a ) name) S 1 42 42 0 -1 4194304 100 0 0 0 250 50 0 0 20 0 2 0 1 1 1";
        assert_eq!(cpu_of(stat), Some(3.0));
        assert_eq!(cpu_of("nonsense"), None);
    }

    #[test]
    fn by_hand_processor_name_of_cpuinfo() {
        assert_eq!(
            processor_name("processor\t: 0\nmodel name\t: Some CPU @ 2 GHz\n"),
            Some("Some CPU @ 2 GHz")
        );
        assert_eq!(processor_name(""), None);
    }
}
