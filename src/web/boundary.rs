//! Functions that a WebAssembly host calls.
//!
//! The host writes to and reads from buffers of this module. Each buffer is a vector that this module owns, and the functions below return its
//! address and length. No function takes a pointer, so there is nothing to trust and no `unsafe` block: the lint is lifted for the exported names
//! only. WebAssembly has a single thread here.
//!
//! A panic ends the call with a trap. Its message is left in the answer, which the host can read before it starts a new instance.
#![allow(unsafe_code, reason = "exported names are unsafe attributes; nothing else here is")]
#![allow(unreachable_pub, reason = "the host reaches them")]

use std::cell::RefCell;
use std::sync::Once;

use serde_json::json;

use crate::Session;

/// Buffers that the host and the module exchange.
#[derive(Default)]
struct Buffers {
    request: Vec<u8>,
    file: Vec<u8>,
    answer: Vec<u8>,
}

thread_local! {
    static BUFFERS: RefCell<Buffers> = RefCell::default();
    static SESSION: RefCell<Session> = RefCell::default();
}

/// Allocates the request buffer of `length` bytes. Returns its address.
#[unsafe(no_mangle)]
pub extern "C" fn ninebit_request(length: usize) -> *mut u8 {
    BUFFERS.with_borrow_mut(|buffers| room(&mut buffers.request, length))
}

/// Allocates the file buffer of `length` bytes. Returns its address. The next request consumes the file.
#[unsafe(no_mangle)]
pub extern "C" fn ninebit_file(length: usize) -> *mut u8 {
    BUFFERS.with_borrow_mut(|buffers| room(&mut buffers.file, length))
}

fn room(buffer: &mut Vec<u8>, length: usize) -> *mut u8 {
    buffer.clear();
    buffer.resize(length, 0);
    buffer.as_mut_ptr()
}

/// Answers the request in the buffer. Returns the length of the answer in bytes.
#[unsafe(no_mangle)]
pub extern "C" fn ninebit_call() -> usize {
    static HOOK: Once = Once::new();
    HOOK.call_once(|| {
        std::panic::set_hook(Box::new(|info| {
            let answer = json!({ "fault": info.to_string() }).to_string().into_bytes();
            BUFFERS.with(|buffers| {
                if let Ok(mut buffers) = buffers.try_borrow_mut() {
                    buffers.answer = answer;
                }
            });
        }));
    });
    let (request, file) =
        BUFFERS.with_borrow_mut(|buffers| (std::mem::take(&mut buffers.request), std::mem::take(&mut buffers.file)));
    let answer = SESSION.with_borrow_mut(|session| session.answer(&request, file)).into_bytes();
    BUFFERS.with_borrow_mut(|buffers| {
        buffers.answer = answer;
        buffers.answer.len()
    })
}

/// Returns the address of the answer.
#[unsafe(no_mangle)]
pub extern "C" fn ninebit_answer() -> *const u8 {
    BUFFERS.with_borrow(|buffers| buffers.answer.as_ptr())
}

/// Returns the length of the answer in bytes.
#[unsafe(no_mangle)]
pub extern "C" fn ninebit_answer_length() -> usize {
    BUFFERS.with_borrow(|buffers| buffers.answer.len())
}

/// Returns the address of the latest answer's picture: R, G, B, A, row by row from the top.
#[unsafe(no_mangle)]
pub extern "C" fn ninebit_picture() -> *const u8 {
    SESSION.with_borrow(|session| session.picture().as_flattened().as_ptr())
}
