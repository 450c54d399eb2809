//! Large buffers: allocations that can fail, copies that can be cancelled, and their release.
//!
//! Every allocation whose size follows from the lengths of inputs is made here.

use std::hint::black_box;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

use bytemuck::Zeroable;
use ndarray::{Array, IntoDimension};

use crate::numbers::cancel::Cancel;
use crate::numbers::error::{Error, Result};

/// Numbers copied between two checks for cancellation.
const NUMBERS_PER_CHECK: usize = 1 << 16;

/// Bytes of a small allocation that took the reserve of the caller's allocator; 0 if none has.
static EXHAUSTED: AtomicUsize = AtomicUsize::new(0);

/// Stop every computation with [`Error::OutOfMemory`] at its next check for cancellation, because an
/// allocation of this size took a reserve; with 0, once there is a reserve again, stop none.
pub fn exhausted(bytes: usize) {
    EXHAUSTED.store(bytes, Ordering::Relaxed);
}

/// An error while there is no reserve.
pub fn check() -> Result<()> {
    match EXHAUSTED.load(Ordering::Relaxed) {
        0 => Ok(()),
        bytes => Err(Error::OutOfMemory { bytes }),
    }
}

fn out_of_memory<T>(count: usize) -> Error {
    Error::OutOfMemory { bytes: count.saturating_mul(size_of::<T>()) }
}

/// An empty vector with room for `count` values.
pub fn with_capacity<T>(count: usize) -> Result<Vec<T>> {
    let mut values = Vec::new();
    values.try_reserve_exact(count).map_err(|_| out_of_memory::<T>(count))?;
    Ok(values)
}

/// `count` zeros. The system clears their memory when it is first written to.
pub fn zeros<T: Zeroable>(count: usize) -> Result<Vec<T>> {
    bytemuck::allocation::try_zeroed_vec(count).map_err(|()| out_of_memory::<T>(count))
}

/// Append a value.
pub fn push<T>(to: &mut Vec<T>, value: T) -> Result<()> {
    if to.len() == to.capacity() {
        let more = to.len().max(4);
        to.try_reserve(more).map_err(|_| out_of_memory::<T>(to.len() + more))?;
    }
    to.push(value);
    Ok(())
}

/// Append values of a known number.
pub fn extend<T>(to: &mut Vec<T>, values: impl ExactSizeIterator<Item = T>) -> Result<()> {
    to.try_reserve(values.len()).map_err(|_| out_of_memory::<T>(to.len() + values.len()))?;
    to.extend(values);
    Ok(())
}

/// Collect values of a known number.
pub fn collected<T>(values: impl ExactSizeIterator<Item = T>) -> Result<Vec<T>> {
    let mut found = with_capacity(values.len())?;
    found.extend(values);
    Ok(found)
}

/// Values in memory as an array of this shape, rows first.
pub fn array<T, S: IntoDimension>(
    argument: &str,
    shape: S,
    values: Vec<T>,
) -> Result<Array<T, S::Dim>> {
    let shape = shape.into_dimension();
    let text = format!("{shape:?}");
    Array::from_shape_vec(shape, values)
        .map_err(|error| Error::value(argument, text, error.to_string()))
}

/// A copy of values of any number, gigabytes of which take seconds.
pub fn copied<T: Copy>(values: &[T], cancel: &Cancel) -> Result<Vec<T>> {
    let mut copy = with_capacity(values.len())?;
    for piece in values.chunks(NUMBERS_PER_CHECK) {
        cancel.check()?;
        copy.extend_from_slice(piece);
    }
    Ok(copy)
}

/// Drop a large value on a background thread, because giving memory back takes 0.17 s to 0.25 s a
/// gigabyte (pages of 4 KiB); in the calling thread if no other can be started.
pub fn drop_in_background<T: Send + 'static>(value: T) {
    if is_enough_for(1) {
        drop(thread::Builder::new().spawn(move || drop(value)));
    }
}

/// Whether there is memory to start this number of threads: the C library ends the process where a
/// thread that runs finds none for its own variables.
#[must_use]
pub fn is_enough_for(threads: usize) -> bool {
    /// Stack of a thread, and as much again for what it allocates.
    const EACH: usize = 4 << 20;
    /// Address space that the GNU C library reserves for a thread: blocks up to this size may be in that
    /// of another one.
    const RESERVED: usize = 64 << 20;
    // WebAssembly has no threads, and its memory never shrinks. The compiler leaves out an allocation
    // that nothing sees.
    !cfg!(target_family = "wasm")
        && black_box(with_capacity::<u8>(threads.saturating_mul(EACH).saturating_add(RESERVED)))
            .is_ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_does_not_fit_is_an_error_with_its_size() {
        let count = isize::MAX as usize / 8;
        let expected = Err(Error::OutOfMemory { bytes: 8 * count });
        assert_eq!(with_capacity::<f64>(count).map(drop), expected);
        assert_eq!(zeros::<f64>(count).map(drop), expected);
        assert_eq!(
            zeros::<f64>(usize::MAX).map(drop),
            Err(Error::OutOfMemory { bytes: usize::MAX })
        );
        assert_eq!(zeros::<f64>(3), Ok(vec![0.0; 3]));
    }

    #[test]
    fn a_copy_can_be_cancelled() {
        let values: Vec<f64> = (0..NUMBERS_PER_CHECK + 3).map(|k| k as f64).collect();
        let cancel = Cancel::new();
        assert_eq!(copied(&values, &cancel).as_ref(), Ok(&values));
        cancel.raise();
        assert_eq!(copied(&values, &cancel), Err(Error::Cancelled));
    }
}
