//! All processes that were started together.

use std::sync::Arc;

use mpi::{
    Count, Threading,
    datatype::PartitionMut,
    environment::Universe,
    request::multiple_scope,
    topology::SimpleCommunicator,
    traits::{Communicator, CommunicatorCollectives, Destination, Source},
};
use stribeck_solver::ranks::Ranks;

/// Variables that starters of MPI programs set: Open MPI's mpirun, MPICH's, and Slurm's srun.
const STARTED_BY: [&str; 3] = ["OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "PMIX_RANK"];

/// Most bytes of one message of unknown length: MPI counts in 32 bits.
const PIECE: usize = 1 << 28;

/// MPI, from when it is begun until it is dropped.
pub struct Mpi(Universe);

impl std::fmt::Debug for Mpi {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_tuple("Mpi").finish()
    }
}

impl Mpi {
    /// Begins where a starter of MPI programs has started this process; once a process, on the main thread.
    pub fn begin() -> Option<Self> {
        STARTED_BY.iter().find(|name| std::env::var_os(name).is_some())?;
        mpi::initialize_with_threading(Threading::Funneled).map(|(universe, _)| Self(universe))
    }

    /// The processes, if there are several.
    pub fn ranks(&self) -> Option<Arc<dyn Ranks>> {
        let world = self.0.world();
        let (rank, count) = (world.rank() as usize, world.size() as usize);
        (count > 1).then(|| Arc::new(World { rank, count }) as Arc<dyn Ranks>)
    }

    /// Ends all processes at once.
    pub fn abort(&self, code: u8) -> ! {
        self.0.world().abort(i32::from(code))
    }
}

/// The processes that were started together.
#[derive(Debug)]
pub struct World {
    rank: usize,
    count: usize,
}

fn world() -> SimpleCommunicator {
    SimpleCommunicator::world()
}

/// Where each part begins.
fn begins(lengths: &[Count]) -> Vec<Count> {
    let mut end = 0;
    let begin = |length: &Count| {
        end += length;
        end - length
    };
    lengths.iter().map(begin).collect()
}

impl Ranks for World {
    fn rank(&self) -> usize {
        self.rank
    }

    fn count(&self) -> usize {
        self.count
    }

    fn exchange(&self, outgoing: &[Vec<f64>], incoming: &mut [Vec<f64>], meanwhile: &mut dyn FnMut()) {
        let world = world();
        multiple_scope(2 * self.count, |scope, requests| {
            let from = incoming.iter_mut().enumerate().filter(|(_, numbers)| !numbers.is_empty());
            for (rank, numbers) in from {
                requests
                    .add(world.process_at_rank(rank as i32).immediate_receive_into(scope, &mut numbers[..]));
            }
            let to = outgoing.iter().enumerate().filter(|(_, numbers)| !numbers.is_empty());
            for (rank, numbers) in to {
                requests.add(world.process_at_rank(rank as i32).immediate_send(scope, &numbers[..]));
            }
            meanwhile();
            requests.wait_all(&mut Vec::new());
        });
    }

    fn all_gather(&self, own: &[f64], lengths: &[usize], all: &mut [f64]) {
        let lengths: Vec<Count> = lengths.iter().map(|&length| length as Count).collect();
        let begins = begins(&lengths);
        world().all_gather_varcount_into(own, &mut PartitionMut::new(all, lengths, begins));
    }

    fn all_gather_bytes(&self, own: &[u8]) -> Vec<Vec<u8>> {
        let mut lengths = vec![0_u64; self.count];
        world().all_gather_into(&(own.len() as u64), &mut lengths[..]);
        let mut parts: Vec<Vec<u8>> = lengths.iter().map(|_| Vec::new()).collect();
        let mut sent = 0;
        // In pieces that MPI can count.
        while lengths.iter().any(|&length| length as usize > sent) {
            let piece = |length: usize| length.saturating_sub(sent).min(PIECE / self.count);
            let counts: Vec<Count> = lengths.iter().map(|&length| piece(length as usize) as Count).collect();
            let begins = begins(&counts);
            let mut all = vec![0_u8; counts.iter().sum::<Count>() as usize];
            let from = sent.min(own.len());
            let own = &own[from..from + piece(own.len())];
            world().all_gather_varcount_into(
                own,
                &mut PartitionMut::new(&mut all[..], &counts[..], &begins[..]),
            );
            for ((part, &count), &first) in parts.iter_mut().zip(&counts).zip(&begins) {
                part.extend_from_slice(&all[first as usize..(first + count) as usize]);
            }
            sent += PIECE / self.count;
        }
        parts
    }
}
