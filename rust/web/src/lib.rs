//! The core as a WebAssembly module without imports, for `site/core.mjs`; README.md lists the calls.
//!
//! A call is a text of JSON, `{"call": …, "with": {…}}`. Its answer is one too, `{"result": …}` or
//! `{"error": …}`. Beside either is a block of doubles, to which columns of numbers in the text point.

mod answer;
mod arguments;
mod balance;
mod balancing;
mod build;
mod calls;
mod engine;
mod figures;
mod mounts;
mod readings;
mod typed;
mod warnings;
mod words;

use std::cell::RefCell;

thread_local! {
    /// Text of the call.
    static REQUEST: RefCell<Vec<u8>> = const { RefCell::new(Vec::new()) };
    /// Doubles of the call.
    static GIVEN: RefCell<Vec<f64>> = const { RefCell::new(Vec::new()) };
    /// Text of the answer.
    static TEXT: RefCell<String> = const { RefCell::new(String::new()) };
    /// Doubles of the answer.
    static NUMBERS: RefCell<Vec<f64>> = const { RefCell::new(Vec::new()) };
}

/// Make room for a call of this number of bytes, and return where to write it.
#[unsafe(no_mangle)]
pub extern "C" fn request(bytes: usize) -> *mut u8 {
    REQUEST.with_borrow_mut(|request| {
        *request = vec![0; bytes];
        request.as_mut_ptr()
    })
}

/// Make room for this number of doubles of a call, and return where to write them.
#[unsafe(no_mangle)]
pub extern "C" fn given(count: usize) -> *mut f64 {
    GIVEN.with_borrow_mut(|given| {
        *given = vec![0.0; count];
        given.as_mut_ptr()
    })
}

/// Compute the answer of the call that was written.
#[unsafe(no_mangle)]
pub extern "C" fn compute() {
    let (request, given) = (REQUEST.take(), GIVEN.take());
    // What was answered before goes first: memory never has to hold two answers.
    TEXT.take();
    NUMBERS.take();
    let (text, numbers) = calls::answer(&request, given);
    TEXT.set(text);
    NUMBERS.set(numbers);
}

/// Where the text of the answer is.
#[unsafe(no_mangle)]
pub extern "C" fn text() -> *const u8 {
    TEXT.with_borrow(|text| text.as_ptr())
}

/// Bytes of the text.
#[unsafe(no_mangle)]
pub extern "C" fn text_bytes() -> usize {
    TEXT.with_borrow(String::len)
}

/// Where the doubles of the answer are.
#[unsafe(no_mangle)]
pub extern "C" fn numbers() -> *const f64 {
    NUMBERS.with_borrow(Vec::as_ptr)
}

/// How many there are.
#[unsafe(no_mangle)]
pub extern "C" fn numbers_count() -> usize {
    NUMBERS.with_borrow(Vec::len)
}
