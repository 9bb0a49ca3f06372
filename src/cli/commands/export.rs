//! The command `ninebit export`: scenes become methods of the chip's 3D class.

use super::*;

use ninebit::state::Profile;
use ninebit_files::output::write_below;
use ninebit_files::pending::PendingFolder;
use ninebit_methods::export::{Methods, console_program, export, push_buffer, trace};

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    scene: SceneArguments,
    /// What is written: lines as emulators trace methods, words of a push buffer, or a program for a console
    #[arg(long, value_enum, value_name = "FORM")]
    to: Form,
    /// The folder that is made
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
}

/// A form of methods.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Form {
    /// `methods.log`, lines that `ninebit import` reads: of nv2a as xemu traces them, of nv10 as Bochs
    Methods,
    /// `pushbuffer.bin`, little-endian words
    Pushbuffer,
    /// `NAME.c`, a program for nxdk that draws the scene on a console and keeps its first surface. It was never run on one
    #[value(name = "pgraph-c")]
    PgraphC,
}

/// Writes the methods of a scene, and the memory that they read.
pub(crate) fn run(arguments: &Arguments, context: Context) -> Result<(), Failure> {
    let (scene, plan) = arguments.scene.load(context)?;
    let methods: Methods = export(&scene, &plan).map_err(|error| {
        let help = "docs/import.md lists what methods cannot say";
        Failure::invalid("NB1610", format!("the scene has no methods: {error}"), help)
    })?;
    let folder = PendingFolder::create(&arguments.output)?;
    let stem = arguments.scene.scene.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let (name, bytes) = match arguments.to {
        Form::Methods => ("methods.log".to_owned(), trace(&methods).into_bytes()),
        Form::Pushbuffer => {
            ("pushbuffer.bin".to_owned(), push_buffer(&methods).iter().flat_map(|word| word.to_le_bytes()).collect())
        }
        Form::PgraphC if scene.profile == Profile::Nv10 => {
            return Err(Failure::usage("a console has no GeForce 256", "set `profile: Nv2a` in the scene"));
        }
        Form::PgraphC => {
            let Some(target) = scene.targets.first() else {
                return Err(Failure::usage("the scene has no target", "give it one"));
            };
            (format!("{stem}.c"), console_program(&methods, &stem, (0, target)).into_bytes())
        }
    };
    write_below(&folder.path().join(&name), &bytes)?;
    write_below(&folder.path().join("memory.bin"), &methods.memory)?;
    folder.commit()?;
    let mut text =
        format!("{name}: {} words\nmemory.bin: {} bytes; surfaces at\n", methods.writes.len(), methods.memory.len());
    for (target, address) in scene.targets.iter().zip(&methods.surfaces) {
        text.push_str(&format!("  {address:08x}  {}\n", shown::name(&target.name)));
    }
    Ok(write_text(&text)?)
}
