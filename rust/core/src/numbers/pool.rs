//! Threads of parallel computations: pools that belong to one process.
//!
//! rayon's global pool has no threads in a forked child, where a parallel computation would wait for
//! ever. Here each process makes its own pools, and each computation has one to itself, so that none
//! waits for, or runs inside, another one that a second thread has started.

use std::cell::Cell;
use std::mem;
use std::num::NonZero;
use std::process;
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::sync::{Mutex, MutexGuard, PoisonError, TryLockError};
use std::thread;

use rayon::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};

use crate::numbers::cancel::{Cancel, PERIOD};
use crate::numbers::error::Result;
use crate::numbers::memory;

/// Pools of a process.
struct Pools {
    process: u32,
    /// Threads of the first pool; 0 before it is made.
    threads: usize,
    /// Pools made, busy ones included.
    made: usize,
    idle: Vec<ThreadPool>,
}

static POOLS: Mutex<Pools> = Mutex::new(Pools::of(0));

impl Pools {
    /// Those of a process that has made none.
    const fn of(process: u32) -> Self {
        Self { process, threads: 0, made: 0, idle: Vec::new() }
    }
}

thread_local! {
    /// Whether this thread computes alone because no other thread could be started.
    static ALONE: Cell<bool> = const { Cell::new(false) };
}

/// True if this number of values, each the result of some ten operations, are worth waking other threads for:
/// that takes 30 µs, as long as one thread takes for these.
#[must_use]
pub const fn is_worth_parallel(numbers: usize) -> bool {
    numbers >= 1 << 15
}

/// Run a parallel computation in a pool while the calling thread polls `cancel`. Inside a pool, or
/// where no thread can be started, run it in the calling thread.
///
/// Every use of rayon goes through here.
pub fn run<T: Send>(cancel: &Cancel, work: impl FnOnce() -> T + Send) -> T {
    // WebAssembly has neither threads nor processes.
    if cfg!(target_family = "wasm") || (rayon::current_thread_index().is_some() && !ALONE.get()) {
        return work();
    }
    let Some(lease) = Lease::take() else {
        become_pool_of_one();
        return work();
    };
    let result = lease.pool().in_place_scope(|scope| {
        let (sender, receiver) = channel();
        // The receiver lives until the result is there.
        scope.spawn(move |_| drop(sender.send(work())));
        loop {
            match receiver.recv_timeout(PERIOD) {
                Ok(result) => {
                    // A row of short computations would not be interrupted by waiting alone.
                    drop(cancel.poll());
                    break Some(result);
                }
                // The flag that this may raise is read by the work, which then returns.
                Err(RecvTimeoutError::Timeout) => drop(cancel.poll()),
                Err(RecvTimeoutError::Disconnected) => break None,
            }
        }
    });
    drop(lease);
    result.unwrap_or_else(|| unreachable!("the scope passes a panic of the work on"))
}

/// Apply a function to each item, in parallel if there are several; results are in the order of the
/// items.
pub fn map<I: Send, T: Send>(
    cancel: &Cancel,
    items: Vec<I>,
    function: impl Fn(I) -> Result<T> + Send + Sync,
) -> Result<Vec<T>> {
    map_if(true, cancel, items, function)
}

/// [`map`] in the calling thread alone unless the work is worth waking others for.
pub fn map_if<I: Send, T: Send>(
    is_worth: bool,
    cancel: &Cancel,
    items: Vec<I>,
    function: impl Fn(I) -> Result<T> + Send + Sync,
) -> Result<Vec<T>> {
    if is_worth && items.len() > 1 && cfg!(not(target_family = "wasm")) {
        return run(cancel, || items.into_par_iter().map(function).collect());
    }
    items.into_iter().map(function).collect()
}

/// Do some work for each item, in parallel where the `numbers`, counted as for [`is_worth_parallel`], are worth it.
pub fn each<I: Send>(
    cancel: &Cancel,
    items: Vec<I>,
    numbers: usize,
    work: impl Fn(I) -> Result<()> + Send + Sync,
) -> Result<()> {
    map_if(is_worth_parallel(numbers), cancel, items, work).map(drop)
}

/// Make the calling thread the only worker of a pool, so that rayon starts no threads for it.
fn become_pool_of_one() {
    if !ALONE.replace(true)
        && let Ok(pool) = ThreadPoolBuilder::new().num_threads(1).use_current_thread().build()
    {
        // The thread stays its worker.
        mem::forget(pool);
    }
}

/// Use of a pool by one computation.
struct Lease {
    process: u32,
    pool: Option<ThreadPool>,
}

impl Lease {
    /// An idle pool of this process, or a new one: the n-th has 1/n of the threads of the first, for
    /// the others are busy. None if no thread can be started.
    fn take() -> Option<Self> {
        let process = process::id();
        let threads = {
            let mut pools = lock()?;
            if pools.process != process {
                let old = mem::replace(&mut *pools, Pools::of(process));
                // Their threads exist in the parent alone: dropping them would wait for these.
                mem::forget(old);
            }
            let largest =
                (0..pools.idle.len()).max_by_key(|&k| pools.idle[k].current_num_threads());
            if let Some(k) = largest {
                return Some(Self { process, pool: Some(pools.idle.swap_remove(k)) });
            }
            pools.made += 1;
            pools.threads.div_ceil(pools.made)
        };
        // 0 threads are as many as RAYON_NUM_THREADS says, or as there are cores.
        let cores = || thread::available_parallelism().map_or(1, NonZero::get);
        let is_enough = memory::is_enough_for(if threads == 0 { cores() } else { threads });
        let build = || ThreadPoolBuilder::new().num_threads(threads).build().ok();
        let built = if is_enough { build() } else { None };
        let mut pools = lock()?;
        if let Some(pool) = built {
            pools.threads = pools.threads.max(pool.current_num_threads());
            return Some(Self { process, pool: Some(pool) });
        }
        pools.made -= 1;
        None
    }

    fn pool(&self) -> &ThreadPool {
        self.pool.as_ref().unwrap_or_else(|| unreachable!("a lease has its pool until it ends"))
    }
}

impl Drop for Lease {
    fn drop(&mut self) {
        let Some(pool) = self.pool.take() else { return };
        match lock() {
            Some(mut pools) if pools.process == self.process => pools.idle.push(pool),
            // Of another process, or unreachable: its threads end, or do not exist.
            _ => mem::forget(pool),
        }
    }
}

/// The pools, unless they stay locked: a child may have been forked while a thread that it does not
/// have held the lock, which otherwise lasts well below a microsecond.
fn lock() -> Option<MutexGuard<'static, Pools>> {
    const TRIALS: usize = 10_000;
    for _ in 0..TRIALS {
        match POOLS.try_lock() {
            Ok(pools) => return Some(pools),
            Err(TryLockError::Poisoned(poisoned)) => {
                return Some(PoisonError::into_inner(poisoned));
            }
            Err(TryLockError::WouldBlock) => thread::yield_now(),
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use std::sync::Barrier;

    use super::*;
    use crate::numbers::error::Error;

    fn sum(cancel: &Cancel) -> u64 {
        run(cancel, || (0..1000_u64).into_par_iter().map(|k| k * k).sum())
    }

    #[test]
    fn run_computes_in_a_pool_and_stays_in_it() {
        let cancel = Cancel::new();
        assert_eq!(sum(&cancel), 332_833_500);
        let inside = run(&cancel, || {
            let thread = thread::current().id();
            (
                rayon::current_thread_index().is_some(),
                run(&cancel, || thread::current().id()) == thread,
            )
        });
        assert_eq!((inside, rayon::current_thread_index()), ((true, true), None));
    }

    #[test]
    fn run_gives_computations_of_several_threads_pools_of_their_own() {
        // Every one waits for all others: no two may share a pool's only thread.
        let (all, cancel) = (Barrier::new(5), Cancel::new());
        thread::scope(|scope| {
            for _ in 0..5 {
                scope.spawn(|| run(&cancel, || all.wait()));
            }
        });
    }

    #[test]
    fn run_polls_from_the_calling_thread_and_stops() {
        let cancel = Cancel::polling(|_| true);
        let stopped = run(&cancel, || {
            loop {
                if let Err(error) = cancel.check() {
                    break error;
                }
            }
        });
        assert_eq!(stopped, Error::Cancelled);
    }

    #[test]
    fn a_row_of_short_runs_polls() {
        let cancel = Cancel::polling(|_| true);
        thread::sleep(PERIOD);
        // Of sixteen checks a time the calling thread's is never the eighth of any.
        assert_eq!(cancel.check(), Ok(()));
        let stopped = (0..100).any(|_| {
            run(&cancel, || (0..15).for_each(|_| drop(cancel.check())));
            cancel.check().is_err()
        });
        assert!(stopped);
    }

    #[test]
    fn run_passes_a_panic_on_and_works_afterwards() {
        let cancel = Cancel::new();
        let result = std::panic::catch_unwind(|| run(&Cancel::new(), || panic!("on purpose")));
        assert!(result.is_err());
        assert_eq!(sum(&cancel), 332_833_500);
    }

    #[test]
    fn a_pool_of_one_computes_in_the_calling_thread() {
        let computed = thread::spawn(|| {
            become_pool_of_one();
            let here = thread::current().id();
            let threads = (0..100).into_par_iter().map(|_| thread::current().id());
            threads.all(|thread| thread == here)
        });
        assert!(computed.join().unwrap());
    }
}
