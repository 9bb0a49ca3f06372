//! Catches panics.
//!
//! A panic is a fault of this program, but a fault with one scene should not hide the results of the others: [`catch_panic`] turns it into a
//! [`Panic`] that reports show. Decoders occasionally panic on malformed files. A scene with such a file is an
//! ordinary error, not a crash, so decoders run under [`quietly`].
//!
//! Binaries that are shipped therefore have to unwind: `panic = "abort"` would disable this. Not everything can be caught: without memory, or
//! with a full stack, the process ends.

use std::any::Any;
use std::cell::Cell;
use std::collections::VecDeque;
use std::fmt;
use std::panic::{AssertUnwindSafe, catch_unwind, set_hook, take_hook};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, Once, PoisonError};

thread_local! {
    /// Whether panics of this thread are expected and must not be printed.
    static QUIET: Cell<bool> = const { Cell::new(false) };
}

/// Number of running [`catch_panic`] calls. While there are any, panics of all threads are recorded for them.
static CATCHERS: AtomicUsize = AtomicUsize::new(0);

/// The latest panics, for the calls that catch them. A payload does not tell where it was thrown, and a panic of a worker thread is caught in
/// another thread than it occurred in.
static LATEST: Mutex<VecDeque<Panic>> = Mutex::new(VecDeque::new());

/// Number of latest panics that are kept.
const KEPT: usize = 64;

/// A fault of this program.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Panic {
    /// Message of the panic.
    pub message: String,
    /// File, line and column of the source, if known.
    pub(crate) place: Option<String>,
}

impl Panic {
    /// The code of this fault, which `docs/errors.md` lists.
    pub const CODE: &'static str = "NB0801";

    /// The help for this fault: what to do about it.
    pub const HELP: &'static str = concat!(
        "this is a fault of ninebit ",
        env!("CARGO_PKG_VERSION"),
        ", not of your scene: please report it with this message, the command line and the scene"
    );
}

impl fmt::Display for Panic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "internal error: ")?;
        if let Some(place) = &self.place {
            write!(f, "{place}: ")?;
        }
        f.write_str(&self.message)
    }
}

/// Runs `work`, and returns a panic in it, or in threads whose panics reach it, as an error. Nothing is printed.
///
/// # Errors
/// The panic.
pub fn catch_panic<T>(work: impl FnOnce() -> T) -> Result<T, Panic> {
    install();
    CATCHERS.fetch_add(1, Ordering::Relaxed);
    // Nothing that `work` changes is used after a panic: callers pass their data by reference and drop the results.
    let result = catch_unwind(AssertUnwindSafe(work));
    CATCHERS.fetch_sub(1, Ordering::Relaxed);
    result.map_err(|payload| {
        let message = message(payload.as_ref());
        let mut latest = LATEST.lock().unwrap_or_else(PoisonError::into_inner);
        let known = latest.iter().rposition(|panic| panic.message == message).and_then(|at| latest.remove(at));
        known.unwrap_or(Panic { message, place: None })
    })
}

/// Runs `work`, which reads untrusted bytes, and returns the message of a panic as an error.
///
/// The panic hook stays silent for this thread while `work` runs, and only for this thread: the previous hook
/// keeps reporting everything else.
///
/// # Errors
/// The message of the panic.
pub fn quietly<T>(work: impl FnOnce() -> T) -> Result<T, String> {
    install();
    let outer = QUIET.replace(true);
    // Unwind safety is as in `catch_panic`.
    let result = catch_unwind(AssertUnwindSafe(work));
    QUIET.set(outer);
    result.map_err(|payload| message(payload.as_ref()))
}

fn install() {
    static INSTALL: Once = Once::new();
    INSTALL.call_once(|| {
        let previous = take_hook();
        set_hook(Box::new(move |info| {
            if QUIET.get() {
                return;
            }
            if CATCHERS.load(Ordering::Relaxed) == 0 {
                return previous(info);
            }
            let mut latest = LATEST.lock().unwrap_or_else(PoisonError::into_inner);
            if latest.len() == KEPT {
                latest.pop_front();
            }
            latest
                .push_back(Panic { message: message(info.payload()), place: info.location().map(ToString::to_string) });
        }));
    });
}

/// Returns the text of a panic's payload.
fn message(payload: &(dyn Any + Send)) -> String {
    if let Some(text) = payload.downcast_ref::<&str>() {
        (*text).to_owned()
    } else if let Some(text) = payload.downcast_ref::<String>() {
        text.clone()
    } else {
        "no message".to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_becomes_its_message_and_the_thread_goes_on() {
        assert_eq!(quietly(|| 7), Ok(7));
        assert_eq!(quietly(|| -> u32 { panic!("palette") }), Err("palette".to_owned()));
        assert_eq!(quietly(|| -> u32 { panic!("index {}", 3) }), Err("index 3".to_owned()));
        assert!(!QUIET.get(), "other panics of this thread are reported again");
    }

    #[test]
    fn quiet_work_nests() {
        let outer = quietly(|| {
            let inner = quietly(|| -> u32 { panic!("inner") });
            assert!(QUIET.get(), "still inside the outer one");
            inner
        });
        assert_eq!(outer, Ok(Err("inner".to_owned())));
    }

    #[test]
    fn a_caught_panic_says_where() {
        let panic = catch_panic(|| -> u32 { panic!("table of {} rows", 3) }).expect_err("it panicked");
        let text = panic.to_string();
        assert!(
            text.starts_with("internal error: src/files/catch_panic.rs:") && text.ends_with(": table of 3 rows"),
            "{text}"
        );
        assert_eq!(catch_panic(|| 7), Ok(7));
    }

    #[test]
    fn a_panic_of_another_thread_says_where() {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a pool");
        let panic = catch_panic(|| pool.install(|| -> u32 { panic!("of a worker") })).expect_err("it panicked");
        assert_eq!(panic.message, "of a worker");
        assert!(panic.place.is_some_and(|place| place.starts_with("src/files/catch_panic.rs:")));
    }
}
