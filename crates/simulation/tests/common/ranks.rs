//! Ranks that are threads of one process and talk through channels.

use std::sync::{
    Arc, Mutex,
    mpsc::{Receiver, Sender, channel},
};

use stribeck_simulation::run::ranks::Ranks;

/// One of them. What each sends to each goes through a channel of its own, in order.
#[derive(Debug)]
struct Thread {
    rank: usize,
    to: Vec<Mutex<Sender<Vec<u8>>>>,
    from: Vec<Mutex<Receiver<Vec<u8>>>>,
}

/// Ranks that are threads of this process.
fn threads(count: usize) -> Vec<Arc<dyn Ranks>> {
    let mut to: Vec<Vec<_>> = (0..count).map(|_| Vec::new()).collect();
    let mut from: Vec<Vec<_>> = (0..count).map(|_| Vec::new()).collect();
    for sender in &mut to {
        for receiver in &mut from {
            let (send, receive) = channel();
            sender.push(Mutex::new(send));
            receiver.push(Mutex::new(receive));
        }
    }
    let ends = to.into_iter().zip(from).enumerate();
    ends.map(|(rank, (to, from))| Arc::new(Thread { rank, to, from }) as Arc<dyn Ranks>).collect()
}

impl Thread {
    fn send(&self, to: usize, bytes: Vec<u8>) {
        self.to[to].lock().expect("no rank fails while it sends").send(bytes).expect("the other rank lives");
    }

    fn receive(&self, from: usize) -> Vec<u8> {
        self.from[from].lock().expect("no rank fails while it receives").recv().expect("the other rank lives")
    }
}

fn bytes(numbers: &[f64]) -> Vec<u8> {
    numbers.iter().flat_map(|n| n.to_le_bytes()).collect()
}

fn read(bytes: &[u8], to: &mut [f64]) {
    assert_eq!(bytes.len(), 8 * to.len(), "both sides know how much is sent");
    for (to, bytes) in to.iter_mut().zip(bytes.chunks_exact(8)) {
        *to = f64::from_le_bytes(bytes.try_into().expect("eight bytes"));
    }
}

impl Ranks for Thread {
    fn rank(&self) -> usize {
        self.rank
    }

    fn count(&self) -> usize {
        self.to.len()
    }

    fn exchange(&self, outgoing: &[Vec<f64>], incoming: &mut [Vec<f64>], meanwhile: &mut dyn FnMut()) {
        for (rank, numbers) in outgoing.iter().enumerate().filter(|(_, numbers)| !numbers.is_empty()) {
            self.send(rank, bytes(numbers));
        }
        meanwhile();
        for (rank, numbers) in incoming.iter_mut().enumerate().filter(|(_, numbers)| !numbers.is_empty()) {
            read(&self.receive(rank), numbers);
        }
    }

    fn all_gather(&self, own: &[f64], lengths: &[usize], all: &mut [f64]) {
        let mut rest = all;
        for (length, part) in lengths.iter().zip(self.all_gather_bytes(&bytes(own))) {
            let (to, further) = rest.split_at_mut(*length);
            read(&part, to);
            rest = further;
        }
    }

    fn all_gather_bytes(&self, own: &[u8]) -> Vec<Vec<u8>> {
        (0..self.count()).for_each(|rank| self.send(rank, own.to_vec()));
        (0..self.count()).map(|rank| self.receive(rank)).collect()
    }
}

/// Calls `lead` on the first of `count` ranks, and `follow` on all others.
pub(crate) fn together<T>(
    count: usize,
    lead: impl FnOnce(Arc<dyn Ranks>) -> T,
    follow: impl Fn(Arc<dyn Ranks>) + Sync,
) -> T {
    let mut ranks = threads(count).into_iter();
    let first = ranks.next().expect("at least one rank");
    std::thread::scope(|scope| {
        let follow = &follow;
        ranks.for_each(|rank| {
            scope.spawn(move || follow(rank));
        });
        lead(first)
    })
}
