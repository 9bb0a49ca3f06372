//! The command `ninebit vectors`: conformance vectors exported, checked and compared.

mod adopt;
mod check;
mod compare;
mod diff;
mod export;
mod list;
pub(super) mod scenes;
mod show;
mod sweep;

use std::fmt::Write;

use super::*;
use ninebit::threads::MAXIMUM as MAXIMUM_THREADS;
use ninebit_vectors::error::VectorError;
use ninebit_vectors::{BEHAVIOUR, Unit, pack, units};

/// Conformance vectors: what the units of the chip yield, as tables.
#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// List the units, what each does, and the rules behind it
    List(list::Arguments),
    /// Write the tables of some or all units into a folder
    Export(export::Arguments),
    /// Check a pack: whole, unchanged, and every row as the model has it
    ///
    /// Exit status 0: it is; 1: the model says something else of some rows; 3: the pack is not valid; 4: a file is missing.
    Check(check::Arguments),
    /// Print a row of a pack: inputs, intermediates, outputs, rules, and how it came to be
    ///
    /// Exit status 0: the model has it so; 1: the model says something else; 3: the row or table is not valid; 4: a file is missing.
    Show(show::Arguments),
    /// Compare two packs row by row
    ///
    /// Rows are found by their ids. Exit status 0: the packs have the same rows; 1: they differ.
    Diff(diff::Arguments),
    /// Compute the digests of every row of a unit, or of a shard of them
    ///
    /// Workers share nothing but the folder; one that was stopped is started again and goes on. Leaves that are there and whole are kept.
    Sweep(sweep::SweepArguments),
    /// Join the leaves of a sweep to a tree
    ///
    /// The root is the same for every number of shards. Exit status 3: a leaf is there twice, was changed, or is of another sweep or
    /// version; 4: leaves are missing.
    Merge(sweep::MergeArguments),
    /// Compute digests again and compare them with a tree
    ///
    /// Exit status 0: they are the same; 1: some differ; 3: the tree is not valid.
    Digest(sweep::DigestArguments),
    /// Hold what a card or a driver answered to its pack: exact, off by one or worse, by unit, tag and policy
    ///
    /// Exit status 0: everything is exact or waived; 1: it is not; 3: the pack or the results are not valid; 4: a file is missing.
    Compare(compare::Arguments),
    /// Record what a real card answered as truth, grade SILICON
    ///
    /// Software renderers and cards with OpenGL 2 or later are refused. Exit status 0: recorded; 3: refused; 4: a file is missing.
    Adopt(adopt::Arguments),
}

/// Runs a subcommand.
pub(crate) fn run(command: &Command) -> Result<(), Failure> {
    match command {
        Command::List(arguments) => list::run(arguments),
        Command::Export(arguments) => export::run(arguments),
        Command::Check(arguments) => check::run(arguments),
        Command::Show(arguments) => show::run(arguments),
        Command::Diff(arguments) => diff::run(arguments),
        Command::Sweep(arguments) => sweep::sweep(arguments),
        Command::Merge(arguments) => sweep::merge(arguments),
        Command::Digest(arguments) => sweep::digest(arguments),
        Command::Compare(arguments) => compare::run(arguments),
        Command::Adopt(arguments) => adopt::run(arguments),
    }
}

impl From<VectorError> for Failure {
    fn from(error: VectorError) -> Self {
        let exit = match error {
            VectorError::Missing { .. } => Exit::Missing,
            VectorError::TooLarge { .. } => Exit::Limit,
            VectorError::Output(error) => return error.into(),
            _ => Exit::Invalid,
        };
        Failure { exit, report: Report::message(Some(error.code()), &error.to_string(), error.help()) }
    }
}

/// Returns the failure for a unit that a chip does not have.
pub(super) fn lacks(unit: &dyn Unit, profile: Profile) -> Failure {
    let help = "`ninebit vectors list` says which chips have a unit";
    Failure::usage(format!("{} has no unit `{}`", profile.name(), unit.name()), help)
}

/// Parses the name of a unit.
pub(super) fn unit(name: &str) -> Result<&'static dyn Unit, String> {
    units::by_name(name).ok_or_else(|| {
        let known: Vec<&str> = units::all().into_iter().map(Unit::name).collect();
        format!("there is no such unit; the units are {}", known.join(", "))
    })
}
