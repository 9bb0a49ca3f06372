//! `ninebit op`: one operation of the chip on given integers, without a scene.
//!
//! Nothing of a rule stands here. Options become state, the model says whether a chip takes it, and its own functions then run on the given integers.

mod address;
mod blend;
mod combiner;
mod command_line;
mod cube;
mod filter;
mod final_combiner;
mod inputs;
mod operation;
mod program;
mod table;
mod unit;
pub(crate) mod words;

use clap::Subcommand;
use ninebit::legality::texture::TextureChecks;
use ninebit::limits::Limits;

use super::program_file::ProgramArguments;
use super::{Context, Exit, Failure, Format, PolicyArguments, Report, StateArguments, vectors};
use command_line::CommandLine;
use inputs::{Assignment, Contents, FourInputs};
use operation::{Column, Common, ProfileArgument, Setup, columns, set};
use words::Input;

#[derive(Debug, Subcommand)]
#[allow(rustdoc::broken_intra_doc_links, reason = "help texts have brackets that are no links")]
pub(crate) enum Command {
    /// One general combiner stage on given register contents
    ///
    /// An input is written REGISTER[.COMPONENT][:MAPPING], for example tex0:expand, tex0.a or zero:invert, or
    /// with a mapping of the combiner language: -expand(col0.a). Without a mapping it is unsigned.
    ///
    /// Registers: tex0 to tex3, primary, secondary, spare0, spare1, const0, const1, fog, zero. Components: rgb, a; b in the alpha portion.
    /// Mappings: identity, invert, expand, expand_negate, half_bias, half_bias_negate, signed, negate. The names of
    /// NV_register_combiners and of the combiner language are known, too.
    ///
    /// Without --ab, --cd and --sum, AB goes to spare0; with C or D the sum (or the mux) does; with a dot product, AB goes to spare0 and CD
    /// to spare1.
    Combiner(combiner::Arguments),
    /// The final combiner on given register contents: A B + (1 - A) C + D, and G
    ///
    /// Inputs are written as for `ninebit op combiner`, with the mappings identity and invert; A to D may be ef (E times F) and
    /// spare0_plus_secondary (short: sum).
    Final(final_combiner::Arguments),
    /// A whole pixel program on what a pixel brings, without a scene
    ///
    /// The program is a file: register words by name or by method, as logs of pushbuffers and the Xbox's shader definitions have them, or any other language of
    /// `--from`.
    Program(program::Arguments),
    /// One pixel's blend and store
    Blend(blend::Arguments),
    /// The bilinear mix of four texels
    Filter(filter::Arguments),
    /// A texel index brought inside the image
    Address(address::Arguments),
    /// A look-up in a cube map: face, coordinates, texels
    Cube(cube::Arguments),
    /// Any unit of the conformance vectors: stencil test, depth words, interpolation and so on
    Unit(unit::Arguments),
}

pub(super) use unit::setup as unit_setup;

/// Returns the checks of textures for a chip.
fn texture_checks(profile: &ProfileArgument) -> TextureChecks {
    TextureChecks { profile: profile.profile, largest_side: Limits::default().texture_side }
}

/// Runs one operation.
pub(crate) fn run(command: &Command, context: Context) -> Result<(), Failure> {
    match command {
        Command::Combiner(arguments) => combiner::run(arguments, context),
        Command::Final(arguments) => final_combiner::run(arguments, context),
        Command::Program(arguments) => program::run(arguments, context),
        Command::Blend(arguments) => blend::run(arguments, context),
        Command::Filter(arguments) => filter::run(arguments),
        Command::Address(arguments) => address::run(arguments, context),
        Command::Cube(arguments) => cube::run(arguments, context),
        Command::Unit(arguments) => unit::run(arguments),
    }
}
