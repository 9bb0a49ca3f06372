//! Register contents on the command line and in tables.

use clap::Args;
use ninebit::state::{Named, Profile, Register};
use ninebit_vectors::unit::Conditions;
use ninebit_vectors::{Unit, units};

use super::{Column, Common, Failure, Input, PolicyArguments, ProfileArgument, Setup, set, words};

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
    #[arg(long, value_name = "INPUT", allow_hyphen_values = true, value_parser = words::input::<R>)]
    a: Option<Input<R>>,
    /// Input B
    #[arg(long, value_name = "INPUT", allow_hyphen_values = true, value_parser = words::input::<R>)]
    b: Option<Input<R>>,
    /// Input C
    #[arg(long, value_name = "INPUT", allow_hyphen_values = true, value_parser = words::input::<R>)]
    pub(super) c: Option<Input<R>>,
    /// Input D
    #[arg(long, value_name = "INPUT", allow_hyphen_values = true, value_parser = words::input::<R>)]
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
    /// Runs a unit on registers. `unit` returns it for a chip.
    pub(super) fn drive<U: Unit>(&self, unit: impl FnOnce(Profile) -> Result<U, Failure>) -> Result<(), Failure> {
        let conditions = Conditions { profile: self.profile.profile, policies: self.policies.policies()? };
        let mut columns = register_columns();
        assign(&mut columns, &self.registers)?;
        for (register, color) in [(Register::ConstantColor0, self.const0), (Register::ConstantColor1, self.const1)] {
            set(&mut columns[4 * register as usize..], color.into_iter().flatten())?;
        }
        on_registers(&unit(conditions.profile)?, columns, conditions).drive(&self.common)
    }
}

/// Sets up a unit on registers, with their columns.
pub(super) fn on_registers(unit: &dyn Unit, columns: Vec<Column>, conditions: Conditions) -> Setup<'_> {
    let known = "tex0.r, tex0.g, tex0.b, tex0.a and so on for tex1 to tex3, primary, secondary, spare0, spare1, const0, const1, fog";
    let find = |_: &[Column], name: &str| register_column(name);
    Setup { find, conditions, depends: true, ..Setup::new(unit, columns, known) }
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

/// Returns the columns of a unit on registers, all 0.
pub(super) fn register_columns() -> Vec<Column> {
    let columns = units::register_columns().into_iter().map(|input| {
        let (name, how) = (input.name.clone(), format!("write `--in {}=N`", input.name));
        Column { per_one: 255, value: Some(0), ..Column::from_input(input, &name, how) }
    });
    columns.collect()
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
