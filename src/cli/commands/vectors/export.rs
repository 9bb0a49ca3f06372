//! The command `ninebit vectors export`: writes tables of units as a pack.

use super::*;
use std::collections::HashSet;

use ninebit_vectors::cases::Level;
use ninebit_vectors::gpu::write::BATCHES;
use ninebit_vectors::pack::Options;
use ninebit_vectors::view::View;

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// The folder of the pack; it is made; a pack in it is replaced when the new one is whole
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    /// The chip: nv10 or nv2a
    #[arg(long, default_value = "nv2a", value_parser = super::named::<Profile>)]
    profile: Profile,
    /// How many rows a unit has: L0 at most 1000, L1 60 000, L2 5 000 000
    #[arg(long, default_value = "L0", value_parser = super::named::<Level>)]
    level: Level,
    /// Of the random rows
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Only this unit; may be given several times
    #[arg(long = "unit", value_name = "UNIT", value_parser = super::unit)]
    units: Vec<&'static dyn Unit>,
    /// Only rows that a policy or a reading changes: those to ask a real card first
    #[arg(long)]
    deciding: bool,
    /// Also write a view: hex (packed words for $readmemh, with layouts for Verilog and C), jsonl or c (an array of structures); may be given several times
    #[arg(long = "view", value_name = "VIEW", value_parser = super::named::<View>)]
    views: Vec<View>,
    /// Also write draws for a graphics card, for the program in vectors/harness/gl: the view `gpu`
    #[arg(long)]
    gpu_batches: bool,
    /// Also write this scene, or those of this folder, as draws for a graphics card, with the picture of each reading: vectors/scenes/deciding; may be given several times
    #[arg(long, value_name = "PATH")]
    scenes: Vec<PathBuf>,
}

/// Writes a pack.
pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let Arguments { profile, level, seed, deciding, .. } = *arguments;
    let mut chosen = if arguments.units.is_empty() { units::all() } else { arguments.units.clone() };
    if let Some(unit) = arguments.units.iter().find(|unit| !unit.profiles().contains(&profile)) {
        return Err(super::lacks(*unit, profile));
    }
    chosen.retain(|unit| unit.profiles().contains(&profile));
    let mut seen = HashSet::new();
    chosen.retain(|unit| seen.insert(unit.name()));
    let mut views = arguments.views.clone();
    if arguments.gpu_batches && !views.contains(&View::Gpu) {
        views.push(View::Gpu);
    }
    let options = Options { profile, level, seed, units: chosen, deciding, views };
    let manifest = pack::export(&arguments.output, &options)?;
    let mut text = String::new();
    for file in manifest.files.iter().filter(|file| file.path.ends_with(".tsv")) {
        let _ = writeln!(text, "{:<24}{:>9} rows {:>12} bytes", file.unit, file.rows, file.bytes);
    }
    for file in manifest.files.iter().filter(|file| file.path.ends_with(".gpu.txt")) {
        let _ = write!(text, "{:<24}{:>9} rows as draws", file.unit, file.rows);
        let _ = match file.left_out {
            0 => writeln!(text),
            rows => writeln!(text, ", {rows} left out: at most {BATCHES} batches"),
        };
    }
    if !arguments.scenes.is_empty() {
        text.push_str(&scenes::export(&arguments.output, &arguments.scenes, profile)?);
    }
    let _ = writeln!(text, "root {}", manifest.root);
    Ok(write_text(&text)?)
}
