//! Pixel programs on arrays of registers.

use std::path::Path;

use ninebit::combiner::registers::{Registers, name};
use ninebit::limits::Limits;
use ninebit::number::{LANES, Lane, Lanes16};
use ninebit::state::{Combiners, Named, Policies, Profile, Register};
use ninebit::threads::on_threads;
use ninebit::trace::Silent;
use ninebit_scene::assets::Bundle;
use ninebit_scene::{ProgramLanguage, load_program_with};
use numpy::{PyArray1, PyReadonlyArray1};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::fail::{Failure, detached, exception};
use crate::units::conditions;

/// Registers that a pixel brings.
const INPUTS: [Register; 7] = [
    Register::PrimaryColor,
    Register::SecondaryColor,
    Register::Fog,
    Register::Texture0,
    Register::Texture1,
    Register::Texture2,
    Register::Texture3,
];

/// Registers that a program leaves behind.
const OUTPUTS: [Register; 8] = [
    Register::Spare0,
    Register::Spare1,
    Register::Texture0,
    Register::Texture1,
    Register::Texture2,
    Register::Texture3,
    Register::PrimaryColor,
    Register::SecondaryColor,
];

/// Runs a program on registers. `inputs` holds R, G, B, A of each pixel as int16, one array for each register that is given, all of `pixels` times 4
/// numbers. Returns the fragment and the registers that are left, in the same form.
#[pyfunction]
#[allow(clippy::too_many_arguments, reason = "the package names them")]
pub(crate) fn evaluate<'py>(
    py: Python<'py>,
    program: String,
    language: &str,
    inputs: Vec<(String, PyReadonlyArray1<'py, i16>)>,
    pixels: usize,
    profile: &str,
    policies: Vec<String>,
) -> PyResult<Bound<'py, PyDict>> {
    let fail = |failure| exception(py, failure);
    let conditions = conditions(profile, &policies).map_err(fail)?;
    let combiners = combiners(program, language, conditions.profile).map_err(fail)?;
    let outputs = written(&combiners);
    let mut given: Vec<(Register, &[i16])> = Vec::new();
    for (register, values) in &inputs {
        let found = INPUTS.iter().find(|known| name(**known) == register);
        let Some(found) = found else {
            let names: Vec<&str> = INPUTS.iter().map(|register| name(*register)).collect();
            let message = format!("`{register}` is no input of a program");
            return Err(fail(Failure::argument(message, format!("pass {}", names.join(", ")))));
        };
        given.push((*found, values.as_slice()?));
    }
    let results = detached(py, || {
        for (register, values) in &given {
            let least = if matches!(register, Register::PrimaryColor | Register::SecondaryColor | Register::Fog) {
                0
            } else {
                -256
            };
            let (lowest, highest) = values.iter().fold((0, 0), |(l, h), v| (*v.min(&l), *v.max(&h)));
            if lowest < least || highest > 255 {
                let message = format!("`{}` holds {least} to 255", name(*register));
                return Err(Failure::argument(message, "255 is 1.0; clip the array"));
            }
        }
        let mut results = vec![vec![0_i16; pixels * 4]; outputs.len() + 1];
        let (profile, policies) = (conditions.profile, &conditions.policies);
        let context = Context { combiners: &combiners, outputs: &outputs, profile, policies };
        on_threads(1, || context.run(&given, pixels, &mut results));
        Ok(results)
    })?;
    let dict = PyDict::new(py);
    for (key, values) in outputs.iter().map(|register| name(*register)).chain(["fragment"]).zip(results) {
        dict.set_item(key, PyArray1::from_vec(py, values))?;
    }
    Ok(dict)
}

/// Reads a program.
fn combiners(text: String, language: &str, profile: Profile) -> Result<Combiners, Failure> {
    let language = ProgramLanguage::from_name(language).ok_or_else(|| {
        let help = format!("write one of {}", ProgramLanguage::NAMES.join(", "));
        Failure::argument(format!("there is no language `{language}`"), help)
    })?;
    let bundle = Bundle { files: [("program".to_owned(), text.into_bytes())].into() };
    let (scene, _) = load_program_with(Path::new("program"), language, profile, &Limits::default(), &bundle)?;
    Ok(scene.draws.into_iter().next().map(|draw| draw.combiners).unwrap_or_default())
}

/// Returns the registers that a program writes; SPARE0's alpha begins as that of TEXTURE0.
fn written(combiners: &Combiners) -> Vec<Register> {
    let portions = combiners.stages.iter().flat_map(|stage| [&stage.rgb, &stage.alpha]);
    let written: Vec<Register> = portions.flat_map(|p| [p.ab_output, p.cd_output, p.sum_output]).collect();
    OUTPUTS.into_iter().filter(|register| *register == Register::Spare0 || written.contains(register)).collect()
}

/// A program and what it runs under.
struct Context<'a> {
    combiners: &'a Combiners,
    outputs: &'a [Register],
    profile: Profile,
    policies: &'a Policies,
}

impl Context<'_> {
    fn run(&self, inputs: &[(Register, &[i16])], pixels: usize, results: &mut [Vec<i16>]) {
        let muxes = self.combiners.stages.iter().any(|stage| stage.rgb.mux || stage.alpha.mux);
        let mut pixel = 0;
        // Lanes take the same decisions, and a mux decides by the pixel.
        while !muxes && pixel + LANES <= pixels {
            let read =
                |values: &[i16], c: usize| Lanes16(std::array::from_fn(|n| i32::from(values[(pixel + n) * 4 + c])));
            self.at(inputs, read, |at, c, lanes: Lanes16<i32>| {
                let out = &mut results[at][pixel * 4..][..LANES * 4];
                (0..LANES).for_each(|n| out[n * 4 + c] = lanes.0[n] as i16);
            });
            pixel += LANES;
        }
        for pixel in pixel..pixels {
            let read = |values: &[i16], c: usize| i32::from(values[pixel * 4 + c]);
            self.at(inputs, read, |at, c, value: i32| results[at][pixel * 4 + c] = value as i16);
        }
    }

    /// Runs the program on the registers that `read` makes of the inputs, and passes each channel of the outputs and, after them, of the fragment.
    fn at<L: Lane>(
        &self,
        inputs: &[(Register, &[i16])],
        read: impl Fn(&[i16], usize) -> L,
        mut put: impl FnMut(usize, usize, L),
    ) {
        let mut registers = Registers::new();
        for (register, values) in inputs {
            registers.load(*register, [0, 1, 2, 3].map(|c| read(values, c)));
        }
        let bytes = |constants: [[u8; 4]; 2], _| constants.map(|constant| constant.map(L::byte));
        let fragment = self.combiners.observed(&mut registers, bytes, (self.profile, self.policies), &mut Silent);
        for (n, register) in self.outputs.iter().enumerate() {
            (0..4).for_each(|c| put(n, c, registers.read(*register, c)));
        }
        (0..4).for_each(|c| put(self.outputs.len(), c, fragment[c]));
    }
}
