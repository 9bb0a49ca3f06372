//! `ninebit op combiner`.

use std::fmt::Write;

use clap::{Args, ValueEnum};
use ninebit::combiner::general::{self, PlannedPortion, PlannedStage};
use ninebit::combiner::registers::{self, channel_name};
use ninebit::state::{Bias, GeneralStage, MuxSelect, Named, Policies, Register, Scale};
use ninebit::trace::Observer;
use serde_json::json;

use super::{Contents, Context, Failure, FourInputs, Operation, Results, Template, inputs, words};

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

/// A stage with register contents.
struct Stage {
    stage: GeneralStage,
    half: Half,
    mux_select: MuxSelect,
    policies: Policies,
}

/// Runs one general stage.
pub(crate) fn run(arguments: &Arguments, context: Context) -> Result<(), Failure> {
    arguments.contents.drive("combiner", |profile, policies| {
        let template = Template { draw: program(arguments), ..Template::default() };
        let combiners = template.combiners(profile, context)?;
        let stage = combiners.stages.first().copied().unwrap_or(GeneralStage::idle([[0; 4]; 2]));
        Ok(Stage { stage, half: arguments.portion, mux_select: combiners.mux_select, policies })
    })
}

/// The stage as a scene writes it, one field a line.
fn program(arguments: &Arguments) -> String {
    let mut fields: Vec<(&str, String)> = Vec::new();
    fields.extend(arguments.inputs.fields());
    for (name, output) in ["ab", "cd", "sum"].into_iter().zip(outputs(arguments)) {
        let word = |register: Register| if register == Register::Zero { "Discard" } else { register.name() };
        fields.extend(output.map(|output| (name, word(output).to_owned())));
    }
    for (name, flag) in [
        ("ab_dot", arguments.ab_dot),
        ("cd_dot", arguments.cd_dot),
        ("ab_blue_to_alpha", arguments.ab_blue_to_alpha),
        ("cd_blue_to_alpha", arguments.cd_blue_to_alpha),
        ("mux", arguments.mux),
    ] {
        fields.extend(flag.then(|| (name, "true".to_owned())));
    }
    if arguments.scale != Scale::One {
        fields.push(("scale", arguments.scale.name().to_owned()));
    }
    if arguments.bias {
        fields.push(("bias", Bias::NegativeHalf.name().to_owned()));
    }
    let mut text = String::new();
    for (name, value) in fields {
        let _ = writeln!(text, "                {name}: {value},");
    }
    let portion = if arguments.portion == Half::Rgb { "rgb" } else { "alpha" };
    format!(
        "        program: Combiners(\n            mux_select: {},\n            stages: [({portion}: (\n{text}            ))],\n        ),\n",
        arguments.mux_select.name()
    )
}

/// Destinations of AB, CD and the sum: as given, or one that shows the result.
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

impl Operation for Stage {
    fn run<O: Observer>(&self, values: &[i64], observer: &mut O) -> Results {
        let mut registers = inputs::load(values);
        let stage = PlannedStage {
            index: 0,
            rgb: PlannedPortion::whole(self.stage.rgb, 7),
            alpha: PlannedPortion::whole(self.stage.alpha, 8),
            constants: self.stage.constants,
            // The registers hold them already.
            reads_constants: false,
        };
        general::run(&stage, self.mux_select, &self.policies, &mut registers, observer);
        let (portion, channels) = match self.half {
            Half::Rgb => (&stage.rgb, 0..3),
            Half::Alpha => (&stage.alpha, 3..4),
        };
        let mut results = Results::new();
        let outputs = [portion.portion.ab_output, portion.portion.cd_output, portion.portion.sum_output];
        for (n, register) in outputs.into_iter().enumerate().filter(|(n, _)| portion.live[*n] != 0) {
            let blue = portion.blue_to_alpha.get(n).is_some_and(|blue| *blue).then_some(3);
            for channel in channels.clone().chain(blue) {
                let name = format!("{}.{}", registers::name(register), channel_name(channel));
                results.push((name, json!(registers.read(register, channel).fixed)));
            }
        }
        results
    }
}
