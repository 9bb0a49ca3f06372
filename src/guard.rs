//! Catches panics of code that reads untrusted bytes, without a word on stderr.
//!
//! Decoders of other people's files panic now and then on bytes nobody thought of. A scene with such a file is an ordinary
//! error, not a crash, so the decoder runs here. Shipped binaries must therefore unwind: `panic = "abort"` would undo it.

use std::any::Any;
use std::cell::Cell;
use std::panic::{AssertUnwindSafe, catch_unwind, set_hook, take_hook};
use std::sync::Once;

thread_local! {
    /// Panics of this thread are expected and must not print.
    static QUIET: Cell<bool> = const { Cell::new(false) };
}

/// Runs `work`; a panic becomes its message.
///
/// The panic hook stays silent for this thread while `work` runs, and only for this thread: the hook that was installed
/// before keeps reporting everything else.
///
/// # Errors
/// The message of the panic.
pub(crate) fn quietly<T>(work: impl FnOnce() -> T) -> Result<T, String> {
    static INSTALL: Once = Once::new();
    INSTALL.call_once(|| {
        let previous = take_hook();
        set_hook(Box::new(move |info| {
            if !QUIET.get() {
                previous(info);
            }
        }));
    });
    let outer = QUIET.replace(true);
    // Nothing that `work` touches survives a panic: the callers hand in their bytes by reference and drop the rest.
    let result = catch_unwind(AssertUnwindSafe(work));
    QUIET.set(outer);
    result.map_err(|payload| message(payload.as_ref()))
}

/// The text of a panic's payload.
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
    fn guards_nest() {
        let outer = quietly(|| {
            let inner = quietly(|| -> u32 { panic!("inner") });
            assert!(QUIET.get(), "still inside the outer guard");
            inner
        });
        assert_eq!(outer, Ok(Err("inner".to_owned())));
    }
}
