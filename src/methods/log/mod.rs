//! Readers of logs: each form in use becomes the same entries.
//!
//! Every line is read by itself, so a log may mix forms. The forms are those that xemu, xqemu, nv2a-trace, xbdm_gdb_bridge, nv2apretty, Bochs and
//! recompilations print, and words of a push buffer; `docs/import.md` has an example of each.

mod event;
mod line;
mod reader;
mod words;

pub use event::{Entry, Event, Fault, Write};
pub use reader::{LONGEST_LINE, Reader};
pub use words::Words;
pub(crate) use words::{Header, header};
