//! The commands `ninebit vectors sweep`, `merge` and `digest`: digests of every row of a unit.

use super::*;

use crate::shard::Shard;
use ninebit::random::Random;
use ninebit::threads::on_threads;
use ninebit_files::output::make_folder;
use ninebit_vectors::exhaustive::{Exhaustive, MAX_ROWS};
use ninebit_vectors::part::Part;
use ninebit_vectors::tree::{self, SweepHeader, Tree};
use rayon::prelude::*;

#[derive(Debug, Args)]
pub(crate) struct SweepArguments {
    /// The unit
    #[arg(long, value_name = "UNIT", value_parser = super::unit)]
    unit: &'static dyn Unit,
    /// The chip: nv10 or nv2a
    #[arg(long, default_value = "nv2a", value_parser = named::<Profile>)]
    profile: Profile,
    /// Only rows of which this column has this number, or one of this range: COLUMN=NUMBER or COLUMN=FIRST..LAST, both included, or COLUMN=WORD/MASK,
    /// words that differ from WORD only in bits of MASK, or COLUMN=COLUMN, the number of the other; may be given for several columns
    #[arg(long, value_name = "COLUMN=NUMBERS")]
    only: Vec<String>,
    /// Only a part of the leaves: I/N, I from 1 to N
    #[arg(long, value_name = "I/N", default_value_t = Shard::ALL, value_parser = str::parse::<Shard>)]
    shard: Shard,
    /// Threads; 0 for one a core
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = up_to::<MAXIMUM_THREADS>)]
    threads: usize,
    /// The folder of the leaves; it is made, and leaves that are there are kept
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
}

/// Computes the leaves of a shard.
pub(crate) fn sweep(arguments: &SweepArguments) -> Result<(), Failure> {
    let SweepArguments { unit, profile, only, shard, threads, output } = arguments;
    if !unit.profiles().contains(profile) {
        return Err(super::lacks(*unit, *profile));
    }
    let part = Part::new(*unit, only).map_err(|message| {
        let help = "`ninebit vectors list --format json` has the columns of every unit";
        Failure::usage(format!("--only: {message}"), help)
    })?;
    let sweep = Exhaustive::from_part(*unit, *profile, part).ok_or_else(|| {
        let name = [&[unit.name().to_owned()], &only[..]].concat().join(" ");
        let help = "a sweep has every row; `--only COLUMN=NUMBERS` takes a part, `ninebit vectors export` boundaries and random ones";
        Failure::usage(format!("`{name}` has more than {MAX_ROWS} rows"), help)
    })?;
    make_folder(output)?;
    let mine: Vec<u64> = (0..sweep.leaves()).filter(|leaf| shard.takes(*leaf)).collect();
    let results: Vec<Result<bool, VectorError>> =
        on_threads(*threads, || mine.par_iter().map(|leaf| tree::work(output, &sweep, *leaf)).collect());
    let results = results.into_iter().collect::<Result<Vec<bool>, _>>()?;
    let computed = results.iter().filter(|computed| **computed).count();
    let (name, profile, leaves, kept) =
        (SweepHeader::new(&sweep).name(), profile.name(), mine.len(), mine.len() - computed);
    Ok(write_text(&format!(
        "{name} {profile}, shard {shard}: {leaves} of {} leaves, {computed} computed, {kept} were there\n",
        sweep.leaves()
    ))?)
}

#[derive(Debug, Args)]
pub(crate) struct MergeArguments {
    /// Folders of leaves
    #[arg(value_name = "DIR", required = true)]
    folders: Vec<PathBuf>,
    /// The file of the tree; `-` for standard output. Without it only the root is printed
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
}

/// Merges leaves into a tree.
pub(crate) fn merge(arguments: &MergeArguments) -> Result<(), Failure> {
    let tree = tree::merge(&arguments.folders)?;
    let destination = arguments.output.as_ref().map(|path| Destination::from(path.as_os_str()));
    if let Some(destination) = &destination {
        destination.write(tree.text().as_bytes())?;
    }
    if destination == Some(Destination::Stdout) {
        return Ok(());
    }
    let Tree { header: header @ SweepHeader { profile, leaves, .. }, rows, root, .. } = &tree;
    let text = format!("{} {profile}: {rows} rows in {leaves} leaves\nroot {root}\n", header.name());
    Ok(write_text(&text)?)
}

#[derive(Debug, Args)]
pub(crate) struct DigestArguments {
    /// Trees, as `merge` writes them
    #[arg(value_name = "TREE", required = true)]
    trees: Vec<PathBuf>,
    /// Compute only so many leaves of each, drawn by the seed
    #[arg(long, value_name = "N")]
    sample: Option<usize>,
    /// Of the drawn leaves
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Threads; 0 for one a core
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = up_to::<MAXIMUM_THREADS>)]
    threads: usize,
}

/// Recomputes trees, or some of their leaves.
pub(crate) fn digest(arguments: &DigestArguments) -> Result<(), Failure> {
    let mut differs = false;
    for path in &arguments.trees {
        let (tree, sweep) = Tree::read(path)?;
        let mut chosen: Vec<usize> = (0..tree.leaf.len()).collect();
        if let Some(sample) = arguments.sample {
            let mut random = Random::new(arguments.seed, &tree.header.unit);
            while chosen.len() > sample {
                chosen.swap_remove(random.below(chosen.len() as u128) as usize);
            }
            chosen.sort_unstable();
        }
        let wrong: Vec<usize> = on_threads(arguments.threads, || {
            let wrong = chosen.par_iter().filter(|index| sweep.leaf(**index as u64) != tree.leaf[**index]);
            wrong.copied().collect()
        });
        let SweepHeader { profile, leaves, behaviour_rev, .. } = &tree.header;
        let mut text = format!("{} {profile}: {} of {leaves} leaves computed, ", tree.header.name(), chosen.len());
        if wrong.is_empty() {
            text.push_str("all as the tree has them\n");
        } else {
            differs = true;
            let shown: Vec<String> = wrong.iter().take(8).map(ToString::to_string).collect();
            let _ = writeln!(text, "{} differ: leaf {} ...", wrong.len(), shown.join(", "));
            if *behaviour_rev != BEHAVIOUR {
                let _ = writeln!(text, "  the tree is of behaviour {behaviour_rev}, the model of {BEHAVIOUR}");
            }
        }
        write_text(&text)?;
    }
    if differs { Err(Failure::difference()) } else { Ok(()) }
}
