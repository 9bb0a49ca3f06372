//! The command `ninebit export`: scenes become methods of the chip's 3D class.

use super::vectors::scenes::{self, List};
use super::*;

use std::fmt::Write as _;

use ninebit_files::output::write_below;
use ninebit_files::pending::PendingFolder;
use ninebit_methods::console::{self, ConsoleScene, LONGEST_NAME};
use ninebit_methods::export::{export, push_buffer, trace};

use crate::replay::find;

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// The scene file, `-` for standard input; with `--to pgraph-c` also several files and folders
    #[arg(required = true, value_name = "SCENE")]
    scenes: Vec<PathBuf>,
    #[command(flatten)]
    state: StateArguments,
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
    /// A program for nxdk that draws scenes on a console and keeps the first surface of each. It was never run on one
    #[value(name = "pgraph-c")]
    PgraphC,
}

/// Writes the methods of scenes, and the memory that they read.
pub(crate) fn run(arguments: &Arguments, context: Context) -> Result<(), Failure> {
    match (arguments.to, &arguments.scenes[..]) {
        (Form::PgraphC, _) => program(arguments, context),
        (form, [scene]) => words(arguments, form, scene, context),
        _ => Err(Failure::usage("only a program holds several scenes", "name one scene, or take `--to pgraph-c`")),
    }
}

fn refuse(reason: &str) -> Failure {
    let help = "docs/import.md lists what methods cannot say";
    Failure::invalid("NB1610", format!("the scene has no methods: {reason}"), help)
}

fn words(arguments: &Arguments, form: Form, path: &Path, context: Context) -> Result<(), Failure> {
    let (scene, plan) = scene::load(path, &arguments.state, context)?;
    let methods = export(&scene, &plan).map_err(|error| refuse(&error.to_string()))?;
    let folder = PendingFolder::create(&arguments.output)?;
    let (name, bytes) = if form == Form::Methods {
        ("methods.log", trace(&methods).into_bytes())
    } else {
        ("pushbuffer.bin", push_buffer(&methods).iter().flat_map(|word| word.to_le_bytes()).collect())
    };
    write_below(&folder.path().join(name), &bytes)?;
    write_below(&folder.path().join("memory.bin"), &methods.memory)?;
    folder.commit()?;
    let mut text =
        format!("{name}: {} words\nmemory.bin: {} bytes; surfaces at\n", methods.writes.len(), methods.memory.len());
    for (target, address) in scene.targets.iter().zip(&methods.surfaces) {
        let _ = writeln!(text, "  {address:08x}  {}", shown::name(&target.name));
    }
    Ok(write_text(&text)?)
}

/// Returns a name that stands for itself in C, in an archive and on any disk.
fn plain_name(path: &Path) -> String {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let plain = |c: char| if c.is_ascii_alphanumeric() || "-_.".contains(c) { c } else { '_' };
    stem.chars().map(plain).take(LONGEST_NAME).collect()
}

/// Returns a scene of the program, with its plan, or the reason why a console cannot draw it.
fn console_scene(name: &str, scene: Scene, plan: Plan) -> Result<(ConsoleScene, Plan), String> {
    let (scene, plan) = scenes::of_profile(scene, plan, Profile::Nv2a)?;
    let target = scene.targets.first().cloned().ok_or("it has no target")?;
    let methods = export(&scene, &plan).map_err(|error| error.to_string())?;
    Ok((ConsoleScene { name: name.to_owned(), methods, target }, plan))
}

/// Writes a program that draws all scenes that have methods, and the pictures by which its answers are told.
fn program(arguments: &Arguments, context: Context) -> Result<(), Failure> {
    let found = find(&arguments.scenes).map_err(|error| Failure::usage(error.to_string(), "name one of them"))?;
    let paths: Vec<&Path> = found.iter().map(|entry| entry.path.as_path()).collect();
    let read = scene::each(&paths, context, |path| {
        let (scene, plan) = scene::load(path, &arguments.state, context)?;
        Ok((plain_name(path), scene, plan))
    });
    let (mut drawn, mut left_out) = (Vec::new(), Vec::new());
    let end = read.end();
    for (name, scene, plan) in read.made {
        match console_scene(&name, scene, plan) {
            Ok(made) => drawn.push(made),
            Err(reason) => left_out.push((name, reason)),
        }
    }
    if drawn.is_empty() {
        end?;
        let reasons: Vec<&str> = left_out.iter().map(|(_, reason)| reason.as_str()).collect();
        return Err(if reasons.is_empty() {
            Failure::usage("there is no scene", "name scenes, or a folder that has some")
        } else {
            refuse(&reasons.join("; "))
        });
    }
    let (scenes, plans): (Vec<ConsoleScene>, Vec<Plan>) = drawn.into_iter().unzip();
    let written = console::program(&scenes);
    let folder = PendingFolder::create(&arguments.output)?;
    for (name, bytes) in &written.files {
        write_below(&folder.path().join(name), bytes)?;
    }
    let (mut list, mut text) = (List::new(folder.path()), String::new());
    list.root(&written.root);
    for (scene, plan) in scenes.iter().zip(&plans) {
        list.add(&scene.name, plan)?;
        let _ = writeln!(text, "{:<24}{:>9} words", scene.name, scene.methods.writes.len());
    }
    for (name, reason) in &left_out {
        list.leave_out(name, reason);
        let _ = writeln!(text, "{name:<24} left out: {reason}");
    }
    list.write()?;
    folder.commit()?;
    let _ = writeln!(text, "root {}", written.root);
    write_text(&text)?;
    end
}
