//! Cancellation flag and progress counter shared by a computation and its caller.

use std::fmt;
use std::sync::atomic::{AtomicBool, AtomicU32, AtomicU64, AtomicUsize, Ordering};
use std::thread::{self, ThreadId};
use std::time::{Duration, Instant};

use crate::numbers::error::{Error, Result};
use crate::numbers::memory;

/// How often the caller's function is called while a computation runs.
pub const PERIOD: Duration = Duration::from_millis(20);

/// Shared by the calling thread and all threads that compute for it.
///
/// ```
/// use crankpin_core::{Cancel, Error};
///
/// let cancel = Cancel::new();
/// cancel.raise(); // from another thread, or a signal handler
/// assert_eq!(cancel.check(), Err(Error::Cancelled));
/// ```
#[derive(Debug, Default)]
pub struct Cancel {
    raised: AtomicBool,
    done: AtomicUsize,
    total: AtomicUsize,
    poll: Option<Poll>,
}

/// A function of the calling thread, called about every [`PERIOD`], and when it was called last.
struct Poll {
    /// Takes the progress; true asks the computation to stop.
    stop: Box<dyn Fn((usize, usize)) -> bool + Send + Sync>,
    caller: ThreadId,
    started: Instant,
    /// Nanoseconds from `started`.
    last: AtomicU64,
    /// Calls of [`Cancel::check`], by any thread.
    calls: AtomicU32,
}

impl fmt::Debug for Poll {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.debug_struct("Poll").field("last", &self.last).finish_non_exhaustive()
    }
}

impl Cancel {
    /// Not cancelled; no steps done.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Like [`Cancel::new`], but calls `stop` in the calling thread about every [`PERIOD`], whichever
    /// thread computes, with the progress so far; the computation is cancelled once it returns true.
    #[must_use]
    pub fn polling(stop: impl Fn((usize, usize)) -> bool + Send + Sync + 'static) -> Self {
        let poll = Poll {
            stop: Box::new(stop),
            caller: thread::current().id(),
            started: Instant::now(),
            last: AtomicU64::new(0),
            calls: AtomicU32::new(0),
        };
        Self { poll: Some(poll), ..Self::new() }
    }

    /// Ask the computation to stop.
    pub fn raise(&self) {
        self.raised.store(true, Ordering::Relaxed);
    }

    /// Return [`Error::Cancelled`] once the computation is to stop, or [`Error::OutOfMemory`] once a
    /// reserve of memory is used up. Call it at least every few
    /// milliseconds: every eighth call of all threads is a [`Cancel::poll`], which only the calling
    /// thread makes any use of.
    pub fn check(&self) -> Result<()> {
        /// Reading the clock takes as long as an order of a cylinder.
        const CALLS: u32 = 8;
        if let Some(poll) = &self.poll {
            let calls = poll.calls.load(Ordering::Relaxed).wrapping_add(1);
            poll.calls.store(calls, Ordering::Relaxed);
            if calls.is_multiple_of(CALLS) {
                return self.poll();
            }
        }
        if self.raised.load(Ordering::Relaxed) { Err(Error::Cancelled) } else { memory::check() }
    }

    /// Like [`Cancel::check`], and call the caller's function if this is the calling thread and it
    /// is due.
    pub fn poll(&self) -> Result<()> {
        if let Some(poll) = &self.poll
            && thread::current().id() == poll.caller
        {
            let elapsed = poll.started.elapsed().as_nanos() as u64;
            if elapsed - poll.last.load(Ordering::Relaxed) >= PERIOD.as_nanos() as u64
                && !self.raised.load(Ordering::Relaxed)
            {
                if (poll.stop)(self.progress()) {
                    self.raise();
                }
                let elapsed = poll.started.elapsed().as_nanos() as u64;
                poll.last.store(elapsed, Ordering::Relaxed);
            }
        }
        if self.raised.load(Ordering::Relaxed) { Err(Error::Cancelled) } else { memory::check() }
    }

    /// Add `steps` to the number of steps to do.
    pub fn expect(&self, steps: usize) {
        self.total.fetch_add(steps, Ordering::Relaxed);
    }

    /// Count one more step as done, then [`Cancel::check`].
    pub fn step(&self) -> Result<()> {
        self.done.fetch_add(1, Ordering::Relaxed);
        self.check()
    }

    /// Count some more steps as done.
    pub fn advance(&self, steps: usize) {
        self.done.fetch_add(steps, Ordering::Relaxed);
    }

    /// Number of calls of [`Cancel::check`] where a function is called.
    #[cfg(test)]
    pub(crate) fn calls(&self) -> Option<u32> {
        self.poll.as_ref().map(|poll| poll.calls.load(Ordering::Relaxed))
    }

    /// Steps done, and steps known of.
    #[must_use]
    pub fn progress(&self) -> (usize, usize) {
        (self.done.load(Ordering::Relaxed), self.total.load(Ordering::Relaxed))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_are_counted_and_stop_when_asked() {
        let cancel = Cancel::new();
        cancel.expect(3);
        cancel.expect(4);
        assert_eq!((cancel.step(), cancel.step()), (Ok(()), Ok(())));
        assert_eq!(cancel.progress(), (2, 7));
        cancel.raise();
        assert_eq!((cancel.check(), cancel.step()), (Err(Error::Cancelled), Err(Error::Cancelled)));
        assert_eq!(cancel.progress(), (3, 7));
    }

    #[test]
    fn the_callers_function_is_called_in_the_calling_thread_alone_and_not_more_often_than_asked() {
        let caller = thread::current().id();
        let cancel = Cancel::polling(move |(done, _)| {
            assert_eq!(thread::current().id(), caller);
            done >= 1
        });
        assert_eq!(cancel.poll(), Ok(()));
        thread::sleep(PERIOD);
        thread::scope(|scope| {
            scope.spawn(|| assert_eq!((cancel.step(), cancel.poll()), (Ok(()), Ok(()))));
        });
        let calls = (1..=8).find(|_| cancel.check() == Err(Error::Cancelled));
        assert!(calls.is_some());
        thread::scope(|scope| {
            scope.spawn(|| assert_eq!(cancel.check(), Err(Error::Cancelled)));
        });
    }
}
