//! The command `ninebit registers`: prints the register words of programs with their meanings.

use super::*;
use std::fmt::Write;

use ninebit_program::registers::{Description, describe, encode};
use serde_json::Value;

use super::scene::chosen_draws;

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// The scene file, or a pixel program in a file of its own
    #[arg(value_name = "SCENE|PROGRAM")]
    source: PathBuf,
    #[command(flatten)]
    program: ProgramArguments,
    #[command(flatten)]
    state: StateArguments,
    /// Only this draw, numbered from 0
    #[arg(long, value_name = "N")]
    draw: Option<usize>,
    /// How to print the result
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
}

/// Prints the programs of a scene, or a program from a file of its own, as register words.
pub(crate) fn run(arguments: &Arguments, context: Context) -> Result<(), Failure> {
    let scene = arguments.program.scene(&arguments.source, &arguments.state, context)?;
    let draws = chosen_draws(&scene, arguments.draw)?;
    let words =
        draws.iter().map(|(number, draw)| (*number, &draw.name, describe(&encode(&draw.combiners, scene.profile))));
    match arguments.format {
        Format::Text => {
            let mut out = format!("profile {}\n", scene.profile.name());
            for (number, name, words) in words {
                let _ = writeln!(out, "\ndraw {number} `{}`", shown::name(name));
                words.iter().for_each(|word| line(&mut out, word));
            }
            write_text(&out)?;
        }
        Format::Json => {
            let word = |word: &Description| {
                json!({
                    "method": format!("{:04x}", word.method), "name": word.name,
                    "value": format!("{:08x}", word.value), "meaning": word.meaning,
                })
            };
            let draws = words.map(|(number, name, words)| {
                json!({ "draw": number, "name": name, "words": words.iter().map(word).collect::<Value>() })
            });
            let draws: Value = draws.collect();
            let value = json!({ "format": "ninebit-registers-1", "profile": scene.profile.name(), "draws": draws });
            write_json(&format!("{value:#}"))?;
        }
    }
    Ok(())
}

/// Writes a line of a word and its meaning.
pub(super) fn line(out: &mut String, word: &Description) {
    // Writing to a string cannot fail.
    let _ = writeln!(out, "  {:04x}  {:<22}{:08x}  {}", word.method, word.name, word.value, word.meaning);
}
