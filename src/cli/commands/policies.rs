//! The command `ninebit policies`: rules with alternatives, and their values.

use super::*;
use std::fmt::Write;

use ninebit::state::POLICIES;

/// Prints every rule with alternatives; a star marks the default value.
pub(crate) fn run() -> Result<(), Failure> {
    let mut text = String::from("Rules with alternatives. Choose with `--policy RULE=VALUE`; * is the default.\n");
    for policy in POLICIES {
        let _ = write!(text, "\n{:<8}{}\n", policy.rule, policy.question);
        for (index, (value, meaning)) in policy.values.iter().enumerate() {
            let mark = if index == 0 { '*' } else { ' ' };
            let _ = writeln!(text, "      {mark} {value:<8} {meaning}");
        }
    }
    Ok(write_text(&text)?)
}
