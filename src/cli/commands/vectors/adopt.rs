//! The command `ninebit vectors adopt`: records a card's results in the repository.

use super::*;

use ninebit_vectors::results::{self, adopt, compare};

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// The folder of the pack that was drawn
    #[arg(value_name = "PACK")]
    pack: PathBuf,
    /// The folder of results that vectors/harness/gl wrote
    #[arg(value_name = "RESULTS")]
    results: PathBuf,
    /// The folder of adopted results, where the device gets a folder of its own
    #[arg(short, long, value_name = "DIR", default_value = "vectors/results")]
    output: PathBuf,
    /// What the device is called there, such as geforce-256-ddr; without it the renderer's name is taken
    #[arg(long, value_name = "NAME")]
    device: Option<String>,
}

/// Records results of a card as ground truth.
pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let (manifest, tables) = pack::open(&arguments.pack)?;
    let results = results::open(&arguments.results, &manifest)?;
    let comparison = compare::compare(&tables, &results, &[], 0)?;
    let name = arguments.device.clone().unwrap_or_else(|| adopt::folder_name(&results.device.renderer));
    let (place, adopted) = adopt::adopt(&arguments.output, &name, &manifest, &results, &comparison)?;
    let mut text = String::new();
    for unit in &adopted.units {
        let (confirmed, contradicted) = (unit.confirmed, unit.contradicted);
        let _ = writeln!(text, "{:<24}{confirmed:>8} rows confirmed{contradicted:>8} contradicted", unit.unit);
    }
    let _ = writeln!(text, "{}: {} {}", shown::path(&place), adopted.grade, shown::name(&adopted.renderer));
    if adopted.behaviour_rev > BEHAVIOUR {
        let action = format!("change the rules, set BEHAVIOUR to {}", adopted.behaviour_rev);
        let _ = writeln!(text, "the model contradicts it: {action} and tell it in CHANGELOG.md, Numerics");
    }
    Ok(write_text(&text)?)
}
