//! Encodes and decodes the fields of single words: registers, mappings and operations. Checks which values a chip accepts.

use super::{Refusal, Word, layout};
use ninebit::state::*;

/// Returns the code of a register: its number in [`FinalRegister`], except that the codes 6 and 7 are skipped.
pub fn register_code(register: impl Into<FinalRegister>) -> u32 {
    let number = register.into() as u32;
    if number < 6 { number } else { number + 2 }
}

/// Returns the register of a code; codes without a register stand for ZERO.
pub(super) fn final_register(code: u32) -> FinalRegister {
    FinalRegister::ALL.iter().copied().find(|known| register_code(*known) == code & 15).unwrap_or(FinalRegister::Zero)
}

fn general_register(code: u32) -> Register {
    ninebit::combiner::final_combiner::general(final_register(code))
}

/// Encodes an input of a general stage as a byte: mapping, component, register.
pub(super) fn input_byte(input: &CombinerInput) -> u32 {
    let mapping = InputMapping::ALL.iter().position(|mapping| *mapping == input.mapping).unwrap_or(0) as u32;
    layout::MAPPING.put(mapping)
        | layout::ALPHA.put((input.component == Component::Alpha).into())
        | layout::REGISTER.put(register_code(input.register))
}

/// Decodes such a byte of an RGB or alpha portion.
pub(super) fn input_of(byte: u32, alpha: bool) -> CombinerInput {
    CombinerInput {
        register: general_register(layout::REGISTER.value_in(byte)),
        component: component(byte, alpha),
        mapping: InputMapping::ALL[layout::MAPPING.value_in(byte) as usize],
    }
}

/// Returns the component of its register that an input byte reads in an RGB or alpha portion.
pub fn component(byte: u32, alpha: bool) -> Component {
    match (layout::ALPHA.is_set(byte), alpha) {
        (true, _) => Component::Alpha,
        (false, true) => Component::Blue,
        (false, false) => Component::Rgb,
    }
}

/// Encodes an input of the final combiner as a byte: invert, component, register.
pub(super) fn final_byte(input: &FinalInput) -> u32 {
    layout::INVERT.put(input.invert.into())
        | layout::ALPHA.put((input.component == Component::Alpha).into())
        | layout::REGISTER.put(register_code(input.register))
}

/// Decodes such a byte; `alpha` says that it is input G.
pub(super) fn final_of(byte: u32, alpha: bool) -> FinalInput {
    FinalInput {
        register: final_register(layout::REGISTER.value_in(byte)),
        component: component(byte, alpha),
        invert: layout::INVERT.is_set(byte),
    }
}

/// Codes of the pairs of bias and scale. The codes 5 and 7 would be a bias with x4 and with x1/2, which do not exist.
pub const OPERATIONS: [(u32, Bias, Scale); 6] = [
    (0, Bias::None, Scale::One),
    (1, Bias::NegativeHalf, Scale::One),
    (2, Bias::None, Scale::Two),
    (3, Bias::NegativeHalf, Scale::Two),
    (4, Bias::None, Scale::Four),
    (6, Bias::None, Scale::Half),
];

/// Encodes the output word of a portion, without the configuration that NV10 has in the same word.
pub(super) fn output_word(portion: &Portion) -> u32 {
    let operation = OPERATIONS.iter().find(|(_, bias, scale)| (*bias, *scale) == (portion.bias, portion.scale));
    let [ab, cd, sum] = layout::OUTPUTS;
    let ([ab_dot, cd_dot], [ab_blue, cd_blue]) = (layout::DOT_PRODUCTS, layout::BLUE_TO_ALPHA);
    ab.put(register_code(portion.ab_output))
        | cd.put(register_code(portion.cd_output))
        | sum.put(register_code(portion.sum_output))
        | ab_dot.put(portion.ab_dot_product.into())
        | cd_dot.put(portion.cd_dot_product.into())
        | layout::MUX.put(portion.mux.into())
        | layout::OPERATION.put(operation.map_or(0, |(code, ..)| *code))
        | ab_blue.put(portion.ab_blue_to_alpha.into())
        | cd_blue.put(portion.cd_blue_to_alpha.into())
}

/// Decodes the input and output words of a portion, which the chip accepts.
pub(super) fn portion_of(inputs: u32, output: u32, alpha: bool) -> Portion {
    let operation = OPERATIONS.iter().find(|(code, _, _)| *code == layout::OPERATION.value_in(output));
    let (_, bias, scale) = operation.copied().unwrap_or(OPERATIONS[0]);
    let [ab_output, cd_output, sum_output] = layout::OUTPUTS.map(|field| general_register(field.value_in(output)));
    let [ab_dot_product, cd_dot_product] = layout::DOT_PRODUCTS.map(|field| field.is_set(output));
    let [ab_blue_to_alpha, cd_blue_to_alpha] = layout::BLUE_TO_ALPHA.map(|field| field.is_set(output));
    Portion {
        inputs: layout::BYTES.map(|field| input_of(field.value_in(inputs), alpha)),
        cd_output,
        ab_output,
        sum_output,
        cd_dot_product,
        ab_dot_product,
        mux: layout::MUX.is_set(output),
        scale,
        bias,
        cd_blue_to_alpha,
        ab_blue_to_alpha,
    }
}

/// Returns the bits of a word that the chip stores.
pub fn stored(word: Word, index: usize, value: u32, chip: Profile) -> u32 {
    value & used_bits(word, index, chip)
}

fn used_bits(word: Word, index: usize, chip: Profile) -> u32 {
    match (word, chip) {
        (Word::RcInAlpha | Word::RcInRgb | Word::RcColor | Word::RcConstantColor0 | Word::RcConstantColor1, _) => !0,
        (Word::RcOutAlpha, _) => 0x3_cfff,
        (Word::RcOutRgb, Profile::Nv10) if index == 0 => 0x3_ffff,
        (Word::RcOutRgb, Profile::Nv10) => 0x3803_ffff,
        (Word::RcOutRgb, Profile::Nv2a) => 0xf_ffff,
        (Word::RcFinal0, _) => 0x3f3f_3f3f,
        (Word::RcFinal1, _) => 0x3f3f_3fe0,
        (Word::RcConfig, _) => 0x1_110f,
    }
}

/// Returns the reason that the chip refuses a word; `None` if it accepts the word.
pub fn refusal(word: Word, index: usize, value: u32, chip: Profile) -> Option<Refusal> {
    let name = word.label(chip, index);
    let refuse = |code, message: String, help: String| Some(Refusal { word, index, code, message, help });
    let code = layout::OPERATION.value_in(value);
    let is_output = matches!(word, Word::RcOutAlpha | Word::RcOutRgb);
    if is_output && !OPERATIONS.iter().any(|(known, ..)| *known == code) {
        let message = format!("{name} is {value:08x}: operation code {code} (bits 15 to 17) is a bias with x4 or x1/2");
        return refuse("NB0362", message, "the codes are 0 none, 1 bias, 2 x2, 3 bias and x2, 4 x4, 6 x1/2".to_owned());
    }
    for (field, shift, kind) in registers(word) {
        let code = value >> shift & 15;
        if !kind.takes(code, chip) {
            let message = format!("{name} is {value:08x}: {field} is register code {code:x}, which {}", kind.why(code));
            return refuse("NB0360", message, format!("codes there: {}", kind.list(chip)));
        }
    }
    let extra = value & !used_bits(word, index, chip);
    if extra != 0 {
        let message = format!("{name} is {value:08x}: {chip:?} does not take the bits {extra:08x}");
        let mut help = format!("{:08x} is what it would keep", value & used_bits(word, index, chip));
        if word == Word::RcOutAlpha && extra & 0x3000 != 0 {
            help.push_str("; the alpha portion has no dot product (bits 12 and 13)");
        }
        return refuse("NB0361", message, help);
    }
    let stages = match (word, chip) {
        (Word::RcOutRgb, Profile::Nv10) if index == 1 => Some((layout::stages(chip).value_in(value), "bits 28 and 29")),
        (Word::RcConfig, _) => Some((layout::stages(chip).value_in(value), "bits 0 to 3")),
        _ => None,
    };
    let most = chip.general_stages() as u32;
    if let Some((count, bits)) = stages
        && !(1..=most).contains(&count)
    {
        let message = format!("{name} is {value:08x}: {chip:?} does not take {count} general stages ({bits})");
        return refuse("NB0363", message, format!("write 1 to {most} there"));
    }
    None
}

/// The use of a register field, which determines its valid codes.
#[derive(Clone, Copy)]
enum Field {
    Input,
    Output,
    Sum,
}

impl Field {
    fn takes(self, code: u32, chip: Profile) -> bool {
        let exists = match code {
            6 | 7 => false,
            10 | 11 => chip == Profile::Nv2a,
            14 | 15 => matches!(self, Field::Sum),
            _ => true,
        };
        exists && !(matches!(self, Field::Output) && matches!(code, 1..=3))
    }

    fn why(self, code: u32) -> &'static str {
        match (self, code) {
            (_, 6 | 7) => "is no register",
            (Field::Output, 1..=3) => "cannot be written",
            (_, 14 | 15) => "is for A to D of the final combiner",
            _ => "this chip lacks",
        }
    }

    fn list(self, chip: Profile) -> String {
        let codes = (0..16).filter(|code| self.takes(*code, chip)).map(|code| format!("{code:x}"));
        codes.collect::<Vec<_>>().join(", ")
    }
}

/// Returns the register fields of a word: name, lowest bit, use.
fn registers(word: Word) -> Vec<(&'static str, u32, Field)> {
    let four = |kind| vec![("A", 24, kind), ("B", 16, kind), ("C", 8, kind), ("D", 0, kind)];
    match word {
        Word::RcInAlpha | Word::RcInRgb => four(Field::Input),
        Word::RcFinal0 => four(Field::Sum),
        Word::RcFinal1 => vec![("E", 24, Field::Input), ("F", 16, Field::Input), ("G", 8, Field::Input)],
        Word::RcOutAlpha | Word::RcOutRgb => {
            vec![("the result of CD", 0, Field::Output), ("of AB", 4, Field::Output), ("of the sum", 8, Field::Output)]
        }
        Word::RcColor | Word::RcConstantColor0 | Word::RcConstantColor1 | Word::RcConfig => Vec::new(),
    }
}
