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
const RESERVE: Layout = Layout::new::<[Line; 1 << 17]>();

/// Largest alignment of what is made from it: that of values of one thread beside those of others.
#[repr(align(128))]
struct Line(#[expect(dead_code, reason = "its size counts")] [u8; 128]);

/// Largest allocation that is made from it: larger ones go through `memory`.
const LARGEST: usize = 2 << 20;

/// Smallest part that it is divided into; all are powers of two.
const SMALLEST: usize = 16;

/// How many sizes of parts there are.
const SIZES: usize = (LARGEST / SMALLEST).ilog2() as usize + 1;

/// Start of the reserve; null before it is allocated.
static START: AtomicPtr<u8> = AtomicPtr::new(ptr::null_mut());
static STATE: Mutex<State> = Mutex::new(State::EMPTY);

struct State {
    /// Bytes from the start that were given away.
    used: usize,
    /// Allocations that are not given back. When the last one is, all of the reserve is free again.
    live: usize,
    /// By size, the last part that was given back, by its place: it holds the place of the one before.
    free: [Option<usize>; SIZES],
}

impl State {
    const EMPTY: Self = Self { used: 0, live: 0, free: [None; SIZES] };
}

fn state() -> MutexGuard<'static, State> {
    STATE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Place of a size among [`SIZES`], and the size of those parts.
fn part(layout: Layout) -> (usize, usize) {
    let size = layout.size().max(layout.align()).max(SMALLEST).next_power_of_two();
    ((size / SMALLEST).ilog2() as usize, size)
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
            give_back(old, layout);
        } else {
            // SAFETY: as the caller ensures.
            unsafe { System.dealloc(old, layout) }
        }
    }
}

/// A part of the reserve; null if it has no room.
fn carve(layout: Layout) -> *mut u8 {
    let start = START.load(Ordering::Relaxed);
    if start.is_null() || layout.align() > RESERVE.align() || layout.size() > LARGEST {
        return ptr::null_mut();
    }
    let (kind, size) = part(layout);
    let mut state = state();
    let place = if let Some(place) = state.free[kind] {
        // SAFETY: `give_back` wrote it there, within the reserve.
        state.free[kind] = unsafe { start.add(place).cast::<Option<usize>>().read_unaligned() };
        place
    } else {
        let place = state.used.next_multiple_of(size.min(RESERVE.align()));
        if place + size > RESERVE.size() {
            return ptr::null_mut();
        }
        state.used = place + size;
        place
    };
    state.live += 1;
    memory::exhausted(layout.size());
    start.wrapping_add(place)
}

/// Keep a part of the reserve for the next allocation of its size.
fn give_back(old: *mut u8, layout: Layout) {
    let start = START.load(Ordering::Relaxed);
    let mut state = state();
    state.live -= 1;
    if state.live == 0 {
        *state = State::EMPTY;
        return;
    }
    let (kind, _) = part(layout);
    // SAFETY: the part is the reserve's again, and has room for that.
    unsafe { old.cast::<Option<usize>>().write_unaligned(state.free[kind]) };
    state.free[kind] = Some(old.addr() - start.addr());
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
