//! The program around a run: identity, threads, clocks, and the progress that it reports.

/// The program around a run: its identity, its threads and clocks.
pub struct Host<'a> {
    /// Worker threads.
    pub threads: usize,
    /// Program version.
    pub version: String,
    /// Commit the program was built from.
    pub commit: String,
    /// Processor and operating system, in words.
    pub machine: String,
    /// Wall-clock time since an arbitrary moment [s].
    pub wall_s: &'a dyn Fn() -> f64,
    /// Processor time of this process so far, all threads [s].
    pub cpu_s: &'a dyn Fn() -> f64,
}

impl<'a> Host<'a> {
    /// The same program with one thread, for models whose step is too short to share.
    pub fn on_one_thread(&self) -> Host<'a> {
        let Host { version, commit, machine, wall_s, cpu_s, .. } = self;
        Host {
            threads: 1,
            version: version.clone(),
            commit: commit.clone(),
            machine: machine.clone(),
            wall_s: *wall_s,
            cpu_s: *cpu_s,
        }
    }
}

/// How far a run is.
#[derive(Debug, Clone, Copy)]
pub struct Progress {
    /// Phase of the run: `mesh`, `preload`, `run`.
    pub phase: &'static str,
    /// Steps taken.
    pub step: u64,
    /// Steps planned.
    pub steps: u64,
    /// Simulated time [s].
    pub time_s: f64,
    /// Elements that take part in a step; 0 for a reduced model.
    pub elements: usize,
}

impl Progress {
    /// At the very beginning.
    pub fn begin() -> Self {
        Self { phase: "mesh", step: 0, steps: 0, time_s: 0.0, elements: 0 }
    }
}
