//! The threads that steps run on.

use crate::error::Error;

/// Rounds of waiting until a thread that has nothing to do goes to sleep: about a millisecond.
const SPINS_BEFORE_SLEEP: usize = 20_000;

/// Threads that wait awake between two forks, which are some ten microseconds apart: put to sleep, they would
/// come back too late for every one of them. The thread that calls is one of them.
pub struct Workers(Option<micropool::ThreadPool>);

impl std::fmt::Debug for Workers {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_tuple("Workers").field(&self.0.is_some()).finish()
    }
}

impl Workers {
    /// A pool of this many threads, the caller among them; none for one.
    ///
    /// # Errors
    /// When the operating system gives fewer.
    pub fn new(threads: usize) -> Result<Self, Error> {
        if threads < 2 {
            return Ok(Self(None));
        }
        try_threads(threads - 1).map_err(|source| Error::Threads { threads, source })?;
        let pool = micropool::ThreadPoolBuilder::default().num_threads(threads - 1);
        Ok(Self(Some(pool.idle_spin_cycles(SPINS_BEFORE_SLEEP).build())))
    }

    /// Runs work inside the pool: many steps at once, because a fork from outside costs much more than one
    /// within.
    pub fn run<T: Send>(&self, work: impl FnOnce() -> T + Send) -> T {
        match &self.0 {
            Some(pool) => pool.install(work),
            None => work(),
        }
    }
}

/// Starts and ends this number of threads, because a pool does not report that it got fewer.
fn try_threads(threads: usize) -> std::io::Result<()> {
    let gate = std::sync::Arc::new(std::sync::RwLock::new(()));
    let closed = gate.write();
    let started: Vec<_> = (0..threads)
        .map(|_| {
            let gate = gate.clone();
            std::thread::Builder::new().spawn(move || drop(gate.read()))
        })
        .collect();
    drop(closed);
    started.into_iter().try_for_each(|thread| {
        // A thread that only waits for a gate cannot fail.
        let _ = thread?.join();
        Ok(())
    })
}
