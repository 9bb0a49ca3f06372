//! The command `ninebit limits`: the sizes above which inputs are refused.

use super::*;
use std::fmt::Write;

use ninebit::limits::table;

/// Prints the limits, one a line: name, value, what is counted.
pub(crate) fn run() -> Result<(), Failure> {
    let mut text = String::new();
    for (name, value, counted) in table(&Limits::default()) {
        let _ = writeln!(text, "{name:<22}{value:>12}  {counted}");
    }
    Ok(write_text(&text)?)
}
