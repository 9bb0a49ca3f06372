//! The operation `ninebit op combiner`: one portion of a general stage.

use clap::{Args, ValueEnum};
use ninebit::legality::{self, Help, Notation};
use ninebit::place::{Part, Place, Places};
use ninebit::state::{Bias, Combiners, Component, GeneralStage, MuxSelect, Register, Scale};
use ninebit_vectors::units::ConfiguredStage;

use super::{CommandLine, Contents, Context, Failure, FourInputs, Input, words};

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    inputs: FourInputs<Register>,
    /// AB is a dot product
    #[arg(long, visible_alias = "dot")]
    ab_dot: bool,
    /// CD is a dot product
    #[arg(long)]
    cd_dot: bool,
    /// The third result is AB or CD, as the alpha of spare0 says, instead of AB + CD
    #[arg(long)]
    mux: bool,
    /// Which bit of spare0's alpha steers the mux: msb or lsb
    #[arg(long, value_name = "BIT", default_value = "msb", value_parser = words::mux_select)]
    mux_select: MuxSelect,
    /// Output scale: 1, 2, 4 or half
    #[arg(long, value_name = "SCALE", default_value = "1", value_parser = words::scale)]
    scale: Scale,
    /// Output bias: one half is taken off before the scale
    #[arg(long)]
    bias: bool,
    /// Which half of the stage
    #[arg(long, value_enum, default_value_t = Half::Rgb)]
    portion: Half,
    /// Where AB goes; `discard` drops it
    #[arg(long, value_name = "REGISTER", value_parser = words::destination)]
    ab: Option<Register>,
    /// Where CD goes
    #[arg(long, value_name = "REGISTER", value_parser = words::destination)]
    cd: Option<Register>,
    /// Where AB + CD, or the mux, goes
    #[arg(long, value_name = "REGISTER", value_parser = words::destination)]
    sum: Option<Register>,
    /// AB's blue also goes to the alpha of its destination (nv2a)
    #[arg(long, visible_alias = "blue-to-alpha")]
    ab_blue_to_alpha: bool,
    /// CD's blue also goes to the alpha of its destination (nv2a)
    #[arg(long)]
    cd_blue_to_alpha: bool,
    #[command(flatten)]
    contents: Contents,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Half {
    /// Red, green and blue
    Rgb,
    /// Alpha
    Alpha,
}

/// Runs one general stage.
pub(crate) fn run(arguments: &Arguments, context: Context) -> Result<(), Failure> {
    arguments.contents.drive(|profile| {
        let line = CommandLine::of_this_process();
        let (stage, places) = stage(arguments, &line);
        let combiners = Combiners { stages: vec![stage], ..Combiners::default() };
        line.accept(legality::check(&combiners, profile, &places, &Options).findings, context)?;
        let portion = if arguments.portion == Half::Alpha { Component::Alpha } else { Component::Rgb };
        Ok(ConfiguredStage { stage, portion, mux_select: arguments.mux_select })
    })
}

/// Names of the options in messages.
pub(super) struct Options;

impl Notation for Options {
    fn help(&self, help: Help) -> &'static str {
        match help {
            Help::OtherRegister => "send one of them to another register, or write `discard` for it",
            Help::FogBlue => "write `fog.b` for the fog colour's blue",
            help => help.text(),
        }
    }
}

/// Returns the stage, and the places of its options.
fn stage(arguments: &Arguments, line: &CommandLine) -> (GeneralStage, Places) {
    let (mut stage, mut places) = (GeneralStage::default(), Places::default());
    let alpha = arguments.portion == Half::Alpha;
    let mut note = |part, names: &[&str]| {
        let place = Place::General { stage: 0, alpha, part };
        line.value_range(names).into_iter().for_each(|span| places.set(place, span));
    };
    let (portion, usual) = if alpha { (&mut stage.alpha, Component::Alpha) } else { (&mut stage.rgb, Component::Rgb) };
    for (n, (name, input)) in arguments.inputs.all().into_iter().enumerate() {
        let Some(input) = input else { continue };
        portion.inputs[n] = Input { component: input.component.or(Some(usual)), ..input }.into();
        note(Part::Input(n), &[name]);
    }
    let slots = [&mut portion.ab_output, &mut portion.cd_output, &mut portion.sum_output];
    let names = ["ab", "cd", "sum"];
    for (n, ((slot, name), output)) in slots.into_iter().zip(names).zip(outputs(arguments)).enumerate() {
        *slot = output.unwrap_or(*slot);
        note(Part::Output(n), &[name]);
    }
    (portion.ab_dot_product, portion.cd_dot_product) = (arguments.ab_dot, arguments.cd_dot);
    (portion.ab_blue_to_alpha, portion.cd_blue_to_alpha) = (arguments.ab_blue_to_alpha, arguments.cd_blue_to_alpha);
    (portion.mux, portion.scale) = (arguments.mux, arguments.scale);
    portion.bias = if arguments.bias { Bias::NegativeHalf } else { Bias::None };
    for (part, names) in [
        (Part::Dot(0), &["ab-dot", "dot"][..]),
        (Part::Dot(1), &["cd-dot"]),
        (Part::BlueToAlpha(0), &["ab-blue-to-alpha", "blue-to-alpha"]),
        (Part::BlueToAlpha(1), &["cd-blue-to-alpha"]),
        (Part::Scale, &["scale"]),
        (Part::Bias, &["bias"]),
    ] {
        note(part, names);
    }
    (stage, places)
}

/// Returns the destinations of AB, CD and the sum: the given ones, or one that shows the result.
fn outputs(arguments: &Arguments) -> [Option<Register>; 3] {
    let given = [arguments.ab, arguments.cd, arguments.sum];
    if given != [None; 3] {
        return given;
    }
    let second = arguments.inputs.c.is_some() || arguments.inputs.d.is_some();
    let dot = arguments.ab_dot || arguments.cd_dot;
    match (second && !dot, second) {
        (true, _) => [None, None, Some(Register::Spare0)],
        (false, _) if arguments.mux => [None, None, Some(Register::Spare0)],
        (false, true) => [Some(Register::Spare0), Some(Register::Spare1), None],
        (false, false) => [Some(Register::Spare0), None, None],
    }
}
