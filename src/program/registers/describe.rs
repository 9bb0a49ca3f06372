//! Describes words in the terms of the combiner language.

use super::code::{final_of, input_of, portion_of};
use super::{RegisterWords, Word, layout};
use crate::text::words::{final_operand, operand, register};
use ninebit::shown;
use ninebit::state::{Bias, Named, Profile, Register, Scale};

/// A word with its meaning.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Description {
    /// Offset of its method in the chip's 3D class.
    pub method: u32,
    /// Name of the word, such as `RC_IN_RGB[1]`.
    pub name: String,
    /// Value of the word.
    pub value: u32,
    /// Meaning of the value.
    pub meaning: String,
}

/// Describes every word of the chip, in the order of the methods.
pub fn describe(words: &RegisterWords) -> Vec<Description> {
    let chip = words.chip;
    let mut list: Vec<Description> = words
        .all()
        .map(|(word, index, value)| Description {
            method: word.method(chip) + 4 * index as u32,
            name: word.label(chip, index),
            value,
            meaning: meaning(words, word, index),
        })
        .collect();
    list.sort_by_key(|description| description.method);
    list
}

fn meaning(words: &RegisterWords, word: Word, index: usize) -> String {
    let chip = words.chip;
    let value = words.get(word, index);
    let (config, at) = layout::config(chip);
    let count = layout::stages(chip).value_in(words.get(config, at));
    let idle = index as u32 >= count;
    match word {
        Word::RcInAlpha | Word::RcInRgb | Word::RcOutAlpha if idle => "stage not used".to_owned(),
        Word::RcInAlpha | Word::RcInRgb => {
            let alpha = word == Word::RcInAlpha;
            named("ABCD", [24, 16, 8, 0].map(|shift| operand(&input_of(value >> shift, alpha), alpha)))
        }
        Word::RcOutAlpha => outputs(value, true),
        Word::RcOutRgb => {
            let what = if idle { "stage not used".to_owned() } else { outputs(value, false) };
            if chip == Profile::Nv10 && index == 1 { format!("{what}; {}", stages(count, value >> 27)) } else { what }
        }
        Word::RcFinal0 => {
            named("ABCD", [24, 16, 8, 0].map(|shift| final_operand(&final_of(value >> shift, false), false)))
        }
        Word::RcFinal1 => {
            let [e, f] = [24, 16].map(|shift| final_operand(&final_of(value >> shift, false), false));
            let g = final_operand(&final_of(value >> 8, true), true);
            let flags = [(7, "the colour sum is clamped"), (6, "col1 inverted in it"), (5, "spare0 inverted in it")];
            let flags = flags.iter().filter(|(bit, _)| value >> bit & 1 == 1).map(|(_, what)| format!("; {what}"));
            named("EFG", [e, f, g]) + &flags.collect::<String>()
        }
        Word::RcColor | Word::RcConstantColor0 | Word::RcConstantColor1 => {
            let [b, g, r, a] = value.to_le_bytes();
            format!("R {r}, G {g}, B {b}, A {a}")
        }
        Word::RcConfig => {
            let own = |bit: u32| if value >> bit & 1 == 1 { "of each stage" } else { "of the first stage for all" };
            format!("{}; const0 {}; const1 {}", stages(count, value >> 8), own(12), own(16))
        }
    }
}

fn stages(count: u32, mux: u32) -> String {
    let bit = if mux & 1 == 1 { "most" } else { "least" };
    format!("{}; mux by the {bit} significant bit", shown::count(count.into(), "stage"))
}

fn named<const N: usize>(names: &str, values: [String; N]) -> String {
    let parts = names.chars().zip(values).map(|(name, value)| format!("{name} = {value}"));
    parts.collect::<Vec<_>>().join(", ")
}

fn outputs(value: u32, alpha: bool) -> String {
    let portion = portion_of(0, value, alpha);
    let mut parts = Vec::new();
    for (name, output, dot, blue) in [
        ("AB", portion.ab_output, portion.ab_dot_product, portion.ab_blue_to_alpha),
        ("CD", portion.cd_output, portion.cd_dot_product, portion.cd_blue_to_alpha),
    ] {
        if dot {
            parts.push(format!("{name} is a dot product"));
        }
        if output != Register::Zero {
            parts.push(format!("{} = {name}", register(output)));
        }
        if blue {
            parts.push(format!("{}.a = blue of {name}", register(output)));
        }
    }
    let third = if portion.mux { "mux(AB, CD)" } else { "AB + CD" };
    if portion.sum_output != Register::Zero {
        parts.push(format!("{} = {third}", register(portion.sum_output)));
    } else if portion.mux {
        parts.push("mux, discarded".to_owned());
    }
    if portion.bias != Bias::None {
        parts.push("bias -1/2".to_owned());
    }
    if portion.scale != Scale::One {
        parts.push(format!("scale {}", portion.scale.name().to_lowercase()));
    }
    if parts.is_empty() { "nothing is kept".to_owned() } else { parts.join(", ") }
}
