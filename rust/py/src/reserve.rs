//! A reserve for small allocations that the system refuses, so that a computation can stop with an error.
//!
//! Allocations whose lengths come from the user return an error (`crankpin_core::memory`). Any other one
//! that failed would end the process: it is made from the reserve in place, and [`memory::exhausted`]
//! stops computations at their next check for cancellation.

use std::alloc::{GlobalAlloc, Layout, System};
use std::ptr;
use std::sync::atomic::{AtomicPtr, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

use crankpin_core::memory;
use pyo3::exceptions::PyMemoryError;
use pyo3::prelude::*;

/// More than what is allocated outside of `memory` between two checks for cancellation; pages of it that
/// are never written to take no memory.
const RESERVE: Layout = Layout::new::<[u128; 1 << 20]>();

/// Largest allocation that is made from it: larger ones go through `memory`.
const LARGEST: usize = 2 << 20;

/// Start of the reserve; null before it is allocated.
static START: AtomicPtr<u8> = AtomicPtr::new(ptr::null_mut());
static STATE: Mutex<State> = Mutex::new(State { used: 0, live: 0 });

struct State {
    /// Bytes from the start that are given away.
    used: usize,
    /// Allocations that are not given back. When the last one is, all of the reserve is free again.
    live: usize,
}

fn state() -> MutexGuard<'static, State> {
    STATE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The system's allocator with a reserve.
pub struct Allocator;

// SAFETY: memory is the system's, or a part of the reserve that `carve` gives away once until it is back.
unsafe impl GlobalAlloc for Allocator {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        // SAFETY: as the caller ensures.
        let found = unsafe { System.alloc(layout) };
        if found.is_null() { carve(layout) } else { found }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        // SAFETY: as the caller ensures.
        let found = unsafe { System.alloc_zeroed(layout) };
        if !found.is_null() {
            return found;
        }
        let found = carve(layout);
        if !found.is_null() {
            // SAFETY: it has this size.
            unsafe { found.write_bytes(0, layout.size()) };
        }
        found
    }

    unsafe fn realloc(&self, old: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        if !is_reserved(old) {
            // SAFETY: as the caller ensures.
            let found = unsafe { System.realloc(old, layout, size) };
            if !found.is_null() {
                return found;
            }
        }
        // SAFETY: the caller ensures that the new size is no less valid than the old one, and that the
        // old memory has the old one; it stays as it is where there is no new memory.
        unsafe {
            let found = self.alloc(Layout::from_size_align_unchecked(size, layout.align()));
            if !found.is_null() {
                ptr::copy_nonoverlapping(old, found, size.min(layout.size()));
                self.dealloc(old, layout);
            }
            found
        }
    }

    unsafe fn dealloc(&self, old: *mut u8, layout: Layout) {
        if is_reserved(old) {
            let mut state = state();
            state.live -= 1;
            state.used = if state.live == 0 { 0 } else { state.used };
        } else {
            // SAFETY: as the caller ensures.
            unsafe { System.dealloc(old, layout) }
        }
    }
}

/// A part of the reserve; null if it has no room.
fn carve(layout: Layout) -> *mut u8 {
    let start = START.load(Ordering::Relaxed);
    let mut state = state();
    let from = state.used.next_multiple_of(layout.align());
    let room = RESERVE.size().saturating_sub(from).min(LARGEST);
    if start.is_null() || layout.align() > RESERVE.align() || layout.size() > room {
        return ptr::null_mut();
    }
    (state.used, state.live) = (from + layout.size(), state.live + 1);
    memory::exhausted(layout.size());
    start.wrapping_add(from)
}

fn is_reserved(memory: *mut u8) -> bool {
    let start = START.load(Ordering::Relaxed);
    (start..start.wrapping_add(RESERVE.size())).contains(&memory) && !start.is_null()
}

/// Allocate the reserve.
pub fn allocate() {
    // SAFETY: the layout has a size.
    START.store(unsafe { System.alloc(RESERVE) }, Ordering::Relaxed);
}

/// An error if the reserve was needed, and the system still refuses memory.
pub fn ensure() -> PyResult<()> {
    if memory::check().is_ok() {
        return Ok(());
    }
    // SAFETY: the layout has a size, and the memory is given back with the same one.
    let enough = unsafe {
        let probe = System.alloc(RESERVE);
        if !probe.is_null() {
            System.dealloc(probe, RESERVE);
        }
        !probe.is_null()
    };
    if !enough {
        return Err(PyMemoryError::new_err("out of memory"));
    }
    memory::exhausted(0);
    Ok(())
}
