//! Runs calls: on a stack of their own, with errors and panics as statuses.

use std::ffi::c_char;
use std::{ptr, thread};

use ninebit::faults::{self, Operation};
use ninebit_files::catch_panic::{Panic, catch_panic};

use super::borrow::{put, text};
use super::failure::{Failure, NinebitStatus};

/// Size of the stack on which scenes are read, drawn and traced, in bytes. The caller's may be small: threads of musl have 128 KiB. A render takes
/// some 370 KiB of it, whatever it draws, and notation that is nested as deeply as it may be 50 KiB.
pub(crate) const STACK: usize = 4 << 20;

/// Code of the error that no thread can be started, which `docs/errors.md` lists.
const NO_THREAD: &str = "NB0802";

/// Runs `work` on a thread with [`STACK`], and waits for it.
pub(crate) fn on_own_stack<T: Send>(work: impl FnOnce() -> T + Send) -> Result<T, Failure> {
    thread::scope(|scope| {
        let started = faults::check(Operation::Start).and_then(|()| {
            thread::Builder::new().name("ninebit".to_owned()).stack_size(STACK).spawn_scoped(scope, work)
        });
        let started = started.map_err(|error| Failure {
            status: NinebitStatus::Limit,
            text: format!(
                "error[{NO_THREAD}]: a thread cannot be started: {error}\n  help: let the process have more threads or memory\n"
            ),
        })?;
        // `call` makes a panic a status.
        Ok(started.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)))
    })
}

/// Runs a call. If it fails, returns its status and writes its message to `message`, unless that is null.
pub(crate) fn call(message: *mut *mut c_char, work: impl FnOnce() -> Result<(), Failure>) -> NinebitStatus {
    // SAFETY: the caller of every function promises that `message` is null or may be written.
    unsafe { put(message, ptr::null_mut()) };
    let failure = match catch_panic(work) {
        Ok(Ok(())) => return NinebitStatus::Ok,
        Ok(Err(failure)) => failure,
        Err(panic) => Failure {
            status: NinebitStatus::Internal,
            text: format!("error[{}]: {panic}\n  help: {}\n", Panic::CODE, Panic::HELP),
        },
    };
    // A text that nobody receives would never be freed.
    if !message.is_null() {
        // SAFETY: as above.
        unsafe { put(message, text(failure.text)) };
    }
    failure.status
}
