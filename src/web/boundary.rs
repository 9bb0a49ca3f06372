//! The functions that a WebAssembly host calls.
//!
//! The host writes into buffers of this module and reads from them; each is a vector that this module owns, and the functions below say where it lies and how
//! long it is. No pointer comes in, so there is nothing to trust and no `unsafe` block: the lint is lifted for the exported names alone. WebAssembly here has one
//! thread.
//!
//! A panic ends the call by a trap. What it said is left in the answer, which the host can read before it starts a new instance.
#![allow(unsafe_code, reason = "exported names are unsafe attributes; nothing else here is")]
#![allow(unreachable_pub, reason = "the host reaches them")]

use std::cell::RefCell;
use std::sync::Once;

use serde_json::json;

use crate::Session;

/// What host and module hand each other.
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

/// Makes room for a request of so many bytes, and says where.
#[unsafe(no_mangle)]
pub extern "C" fn ninebit_request(length: usize) -> *mut u8 {
    BUFFERS.with_borrow_mut(|buffers| room(&mut buffers.request, length))
}

/// Makes room for a file of so many bytes, and says where. The next request takes it.
#[unsafe(no_mangle)]
pub extern "C" fn ninebit_file(length: usize) -> *mut u8 {
    BUFFERS.with_borrow_mut(|buffers| room(&mut buffers.file, length))
}

fn room(buffer: &mut Vec<u8>, length: usize) -> *mut u8 {
    buffer.clear();
    buffer.resize(length, 0);
    buffer.as_mut_ptr()
}

/// Answers the request that was written; the length of the answer.
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

/// Where the answer lies.
#[unsafe(no_mangle)]
pub extern "C" fn ninebit_answer() -> *const u8 {
    BUFFERS.with_borrow(|buffers| buffers.answer.as_ptr())
}

/// How long it is.
#[unsafe(no_mangle)]
pub extern "C" fn ninebit_answer_length() -> usize {
    BUFFERS.with_borrow(|buffers| buffers.answer.len())
}

/// Where the picture of the latest answer lies: R, G, B, A, row by row from the top.
#[unsafe(no_mangle)]
pub extern "C" fn ninebit_picture() -> *const u8 {
    SESSION.with_borrow(|session| session.picture().as_flattened().as_ptr())
}
