//! What messages cost between the processes of this machine: `mpirun -n 2 ping`. The constants of
//! PERFORMANCE, section 9.

use std::time::Instant;

use stribeck_mpi::Mpi;

/// Rounds of each measurement.
const ROUNDS: usize = 2000;

/// Least time of one call over eight series [µs].
fn microseconds(mut call: impl FnMut()) -> f64 {
    let series = (0..8).map(|_| {
        let began = Instant::now();
        (0..ROUNDS / 8).for_each(|_| call());
        began.elapsed().as_secs_f64() * 1e6 / (ROUNDS / 8) as f64
    });
    series.fold(f64::INFINITY, f64::min)
}

fn main() {
    let Some(mpi) = Mpi::begin() else { return eprintln!("start it with mpirun") };
    let Some(ranks) = mpi.ranks() else { return eprintln!("start at least two") };
    let (rank, count) = (ranks.rank(), ranks.count());
    for numbers in [1, 10, 100, 1000, 10_000, 100_000] {
        let next = (rank + 1) % count;
        let before = (rank + count - 1) % count;
        let (mut to, mut from) = (vec![Vec::new(); count], vec![Vec::new(); count]);
        (to[next], from[before]) = (vec![1.0; numbers], vec![0.0; numbers]);
        let exchange = microseconds(|| ranks.exchange(&to, &mut from, &mut || {}));
        let (own, lengths) = (vec![1.0; numbers], vec![numbers; count]);
        let mut all = vec![0.0; numbers * count];
        let gather = microseconds(|| ranks.all_gather(&own, &lengths, &mut all));
        if rank == 0 {
            println!("{:8} bytes: exchange {exchange:8.2} µs, all_gather {gather:8.2} µs", 8 * numbers);
        }
    }
}
