//! `ninebit lower`.

use clap::{Args, ValueEnum};
use ninebit::shown;
use ninebit_files::output::write_text;
use ninebit_program::{registers, text};
use ninebit_scene::register_words;

use super::Context;
use super::exit::Failure;
use super::scene::{SceneArguments, chosen_draws};

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    scene: SceneArguments,
    /// Only this draw, numbered from 0
    #[arg(long, value_name = "N")]
    draw: Option<usize>,
    /// The form
    #[arg(long, value_enum, value_name = "FORM")]
    to: Form,
}

/// Forms of programs.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum Form {
    /// The combiner language
    Combiners,
    /// Words of the registers of the scene's chip, as a scene has them
    Registers,
}

/// Prints the programs of a scene in another form.
pub(crate) fn run(arguments: &Arguments, context: Context) -> Result<(), Failure> {
    let (scene, _) = arguments.scene.load(context)?;
    let mut out = String::new();
    for (number, draw) in chosen_draws(&scene, arguments.draw)? {
        if !out.is_empty() {
            out.push('\n');
        }
        // The name could be anything: not in a comment that it would end.
        let name = shown::name(&draw.name);
        out.push_str(&format!("// draw {number} `{name}`\n"));
        if let Some(program) = &draw.vertex_program {
            let counts = format!("{} instructions, {} slots", program.instructions, program.slots);
            out.push_str(&format!("// its vertices come from a vertex program: {counts}\n"));
        }
        match arguments.to {
            Form::Combiners => out.push_str(&text::print(&draw.combiners)),
            Form::Registers => {
                out.push_str(&register_words(&registers::encode(&draw.combiners, scene.profile)));
                out.push('\n');
            }
        }
    }
    Ok(write_text(&out)?)
}
