//! Values gathered and sorted in parallel, by ranges of what they are sorted by.

use crate::numbers::cancel::Cancel;
use crate::numbers::error::Result;
use crate::numbers::{memory, pool};

/// Values in one range, about, and most ranges.
const RANGE: usize = 1 << 15;
const MOST_RANGES: usize = 512;

/// How many ranges divide this number of values.
pub(super) fn count(values: u128) -> usize {
    (values / RANGE as u128).clamp(1, MOST_RANGES as u128) as usize
}

/// What one task gathers, by range.
pub(super) struct Ranges<T>(Vec<Vec<T>>);

impl<T: Copy + Ord + Send + Sync> Ranges<T> {
    pub(super) fn new(ranges: usize) -> Self {
        Self((0..ranges).map(|_| Vec::new()).collect())
    }

    pub(super) fn push(&mut self, range: usize, value: T) -> Result<()> {
        memory::push(&mut self.0[range], value)
    }

    /// All that the tasks gathered, ascending, and where each range starts and the last ends.
    pub(super) fn sorted(tasks: Vec<Self>, cancel: &Cancel) -> Result<(Vec<T>, Vec<usize>)> {
        let ranges = tasks.first().map_or(0, |task| task.0.len());
        let parts = pool::map(cancel, (0..ranges).collect(), |range| {
            let parts = || tasks.iter().map(|task| &task.0[range]);
            let mut values = memory::with_capacity(parts().map(Vec::len).sum())?;
            parts().for_each(|part| values.extend_from_slice(part));
            values.sort_unstable();
            cancel.step()?;
            Ok(values)
        })?;
        drop(tasks);
        let (mut all, mut starts) =
            (memory::with_capacity(parts.iter().map(Vec::len).sum())?, vec![0]);
        for part in parts {
            cancel.check()?;
            all.extend_from_slice(&part);
            starts.push(all.len());
        }
        Ok((all, starts))
    }
}
