//! What passes between a long computation and who waits for it: the wish to stop, looked at between
//! chunks of work, and how far the work has come.

use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use crate::error::{Error, Result};

/// Shared by the thread that waits and all that work.
#[derive(Debug, Default)]
pub struct Cancel {
    raised: AtomicBool,
    done: AtomicUsize,
    total: AtomicUsize,
}

impl Cancel {
    /// Nobody wishes to stop, nothing is done.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            raised: AtomicBool::new(false),
            done: AtomicUsize::new(0),
            total: AtomicUsize::new(0),
        }
    }

    /// Ask the computation to stop.
    pub fn raise(&self) {
        self.raised.store(true, Ordering::Relaxed);
    }

    /// Go on, or stop with [`Error::Cancelled`].
    pub fn check(&self) -> Result<()> {
        if self.raised.load(Ordering::Relaxed) { Err(Error::Cancelled) } else { Ok(()) }
    }

    /// There are so many more steps to do.
    pub fn expect(&self, steps: usize) {
        self.total.fetch_add(steps, Ordering::Relaxed);
    }

    /// One more step is done: [`Cancel::check`].
    pub fn step(&self) -> Result<()> {
        self.done.fetch_add(1, Ordering::Relaxed);
        self.check()
    }

    /// So many more steps are done.
    pub fn advance(&self, steps: usize) {
        self.done.fetch_add(steps, Ordering::Relaxed);
    }

    /// Steps done, and how many are known of.
    #[must_use]
    pub fn progress(&self) -> (usize, usize) {
        (self.done.load(Ordering::Relaxed), self.total.load(Ordering::Relaxed))
    }
}

/// Drop what may be gigabytes, which takes most of a second, in a thread of its own.
pub fn give_back<T: Send + 'static>(value: T) {
    // Where no thread is to be had it is dropped here.
    drop(std::thread::Builder::new().spawn(move || drop(value)));
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
}
