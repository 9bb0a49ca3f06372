//! Register contents on the command line and in tables.

use std::ops::RangeInclusive;

use clap::Args;
use ninebit::combiner::registers::{self, Registers, channel_name};
use ninebit::number::Paired;
use ninebit::state::{Named, Policies, Profile, Register};
use ninebit_vectors::units;

use super::{Column, Common, Failure, Input, Operation, PolicyArguments, ProfileArgument, Setup, set, words};

/// A name and four numbers, as `--in` gives them.
#[derive(Clone, Debug)]
pub(super) struct Assignment {
    name: String,
    values: Vec<i64>,
}

/// Reads `NAME=N`, `NAME=R,G,B` or `NAME=R,G,B,A`.
pub(super) fn assignment(text: &str) -> Result<Assignment, String> {
    let form = "write REGISTER=N, REGISTER=R,G,B or REGISTER=R,G,B,A, for example tex0=128,128,255";
    let (name, values) = text.split_once('=').ok_or(form)?;
    Ok(Assignment { name: name.trim().to_owned(), values: numbers(values)? })
}

/// Inputs A to D of a stage.
#[derive(Debug, Args)]
pub(super) struct FourInputs<R: Named + Send + Sync> {
    /// Input A [default: zero]
    #[arg(long, value_name = "INPUT", value_parser = words::input::<R>)]
    a: Option<Input<R>>,
    /// Input B
    #[arg(long, value_name = "INPUT", value_parser = words::input::<R>)]
    b: Option<Input<R>>,
    /// Input C
    #[arg(long, value_name = "INPUT", value_parser = words::input::<R>)]
    pub(super) c: Option<Input<R>>,
    /// Input D
    #[arg(long, value_name = "INPUT", value_parser = words::input::<R>)]
    pub(super) d: Option<Input<R>>,
}

impl<R: Named + Send + Sync> FourInputs<R> {
    /// Returns A to D with the names of their options.
    pub(super) fn all(&self) -> [(&'static str, Option<Input<R>>); 4] {
        [("a", self.a), ("b", self.b), ("c", self.c), ("d", self.d)]
    }
}

/// What the registers hold, and on which chip.
#[derive(Debug, Args)]
pub(super) struct Contents {
    /// What a register holds, -256 to 255: REGISTER=N, =R,G,B or =R,G,B,A; REGISTER.CHANNEL=N. The rest holds 0
    #[arg(long = "in", value_name = "REGISTER=VALUES", value_parser = assignment)]
    registers: Vec<Assignment>,
    /// Constant colour 0, 0 to 255
    #[arg(long, value_name = "R,G,B,A", value_parser = color)]
    const0: Option<[i64; 4]>,
    /// Constant colour 1, 0 to 255
    #[arg(long, value_name = "R,G,B,A", value_parser = color)]
    const1: Option<[i64; 4]>,
    #[command(flatten)]
    profile: ProfileArgument,
    #[command(flatten)]
    policies: PolicyArguments,
    #[command(flatten)]
    common: Common,
}

impl Contents {
    /// Runs an operation on registers. `operation` returns it for a chip and policies.
    pub(super) fn drive<T: Operation>(
        &self,
        name: &'static str,
        operation: impl FnOnce(Profile, Policies) -> Result<T, Failure>,
    ) -> Result<(), Failure> {
        let (profile, policies) = (self.profile.profile, self.policies.policies()?);
        let mut columns = register_columns();
        assign(&mut columns, &self.registers)?;
        for (register, color) in [(Register::ConstantColor0, self.const0), (Register::ConstantColor1, self.const1)] {
            set(&mut columns[4 * register as usize..], color.into_iter().flatten())?;
        }
        on_registers(name, columns, (profile, policies), operation(profile, policies)?).drive(&self.common)
    }
}

/// Sets up an operation on registers, with their columns.
pub(super) fn on_registers<T: Operation>(
    name: &'static str,
    columns: Vec<Column>,
    chip: (Profile, Policies),
    operation: T,
) -> Setup<T> {
    let known = "tex0.r, tex0.g, tex0.b, tex0.a and so on for tex1 to tex3, primary, secondary, spare0, spare1, const0, const1, fog";
    let find = |_: &[Column], name: &str| register_column(name);
    Setup { find, chip: Some(chip), ..Setup::new(name, columns, known, operation) }
}

/// Reads R, G, B, A. One number is used for all four, and three numbers leave alpha at 255, as in scenes.
pub(super) fn color(text: &str) -> Result<[i64; 4], String> {
    numbers(text).map(|numbers| four(&numbers))
}

fn numbers(text: &str) -> Result<Vec<i64>, String> {
    words::numbers(text)
        .filter(|numbers| matches!(numbers.len(), 1 | 3 | 4))
        .ok_or_else(|| "not one, three or four whole numbers, such as 128 or 0x80, with commas between".to_owned())
}

fn four(numbers: &[i64]) -> [i64; 4] {
    match *numbers {
        [r, g, b] => [r, g, b, 255],
        [r, g, b, a] => [r, g, b, a],
        _ => [numbers.first().copied().unwrap_or(0); 4],
    }
}

/// Range of a general register.
const SIGNED: RangeInclusive<i64> = -256..=255;
/// Range of a constant.
const BYTE: RangeInclusive<i64> = 0..=255;

/// Returns a column for each channel of each register, all 0.
pub(super) fn register_columns() -> Vec<Column> {
    let channels = Register::ALL.iter().flat_map(|register| (0..4).map(|channel| (*register, channel)));
    channels
        .map(|(register, channel)| {
            let range = match register {
                Register::Zero => 0..=0,
                Register::ConstantColor0 | Register::ConstantColor1 => BYTE,
                _ => SIGNED,
            };
            let name = format!("{}.{}", registers::name(register), channel_name(channel));
            let how = format!("write `--in {name}=N`");
            Column { value: Some(0), ..Column::new((&name, &name), range, 255, how) }
        })
        .collect()
}

/// Returns the index of the column of `REGISTER.CHANNEL` among [`register_columns`].
pub(super) fn register_column(name: &str) -> Option<usize> {
    let (register, channel) = name.split_once('.')?;
    let register = words::register(register).ok().filter(|register| *register != Register::Zero)?;
    Some(4 * register as usize + words::channel(channel)?)
}

/// Sets the columns that `--in` gives.
pub(super) fn assign(columns: &mut [Column], assignments: &[Assignment]) -> Result<(), Failure> {
    for Assignment { name, values } in assignments {
        if name.contains('.') {
            let (Some(column), [value]) = (register_column(name), values.as_slice()) else {
                let message = format!("`{name}` is not a channel of a register with one value");
                return Err(Failure::usage(message, "write for example `--in tex0.a=128`"));
            };
            set(&mut columns[column..], [*value])?;
            continue;
        }
        let register = words::register(name)
            .map_err(|message| Failure::usage(message, "write for example `--in tex0=128,128,255`"))?;
        set(&mut columns[4 * register as usize..], four(values))?;
    }
    Ok(())
}

/// Returns the registers. Each integer is also the ideal's real number.
pub(super) fn load(values: &[i64]) -> Registers<Paired> {
    let mut registers = Registers::new();
    for (register, values) in Register::ALL.iter().zip(values.chunks(4)) {
        for (channel, value) in values.iter().enumerate() {
            registers.write(*register, channel, units::paired(*value));
        }
    }
    registers
}
