//! Words of the command line: names of the state's enumerations, of the vendor's extensions, and short ones.

use ninebit::state::*;
use ninebit_program::text::words;

/// Returns a word without decoration: `GL_SPARE0_NV`, `Spare0` and `spare0` are the same.
fn plain(word: &str) -> String {
    let word = word.to_ascii_lowercase().replace('-', "_");
    let word = word.strip_prefix("gl_").unwrap_or(&word);
    let word = ["_nv", "_arb", "_ext"].iter().find_map(|end| word.strip_suffix(end)).unwrap_or(word);
    word.replace('_', "")
}

/// Returns the variant of a word, by its own name or by a name in `short` (plain word, own name).
fn named<T: Named>(what: &str, word: &str, short: &[(&str, &str)]) -> Result<T, String> {
    let wanted = plain(word);
    let wanted = short.iter().find(|(short, _)| plain(short) == wanted).map_or(wanted.clone(), |(_, name)| plain(name));
    let found = T::NAMES.iter().position(|name| plain(name) == wanted);
    found.map(|index| T::ALL[index]).ok_or_else(|| {
        // One name for each variant: the first short one, or its own.
        let names: Vec<String> = T::NAMES
            .iter()
            .map(|name| short.iter().find(|(_, own)| own == name).map_or_else(|| snake(name), |(s, _)| (*s).to_owned()))
            .collect();
        format!("there is no {what} `{}`; known: {}", word.chars().take(40).collect::<String>(), names.join(", "))
    })
}

/// Returns "OneMinusSourceAlpha" as "one_minus_source_alpha". Names of formats stay as they are.
fn snake(name: &str) -> String {
    if name.chars().skip(1).any(|letter| letter.is_ascii_digit())
        && name.chars().filter(char::is_ascii_uppercase).count() > 1
    {
        return name.to_ascii_lowercase();
    }
    let mut word = String::new();
    for letter in name.chars() {
        if letter.is_ascii_uppercase() && !word.is_empty() {
            word.push('_');
        }
        word.push(letter.to_ascii_lowercase());
    }
    word
}

/// Short names of registers, before those of the combiner language: of several names of a register messages have the first.
const REGISTERS: [(&str, &str); 9] = [
    ("primary", "PrimaryColor"),
    ("secondary", "SecondaryColor"),
    ("const0", "ConstantColor0"),
    ("const1", "ConstantColor1"),
    ("constant0", "ConstantColor0"),
    ("constant1", "ConstantColor1"),
    ("sum", "Spare0PlusSecondary"),
    ("spare0_plus_secondary_color", "Spare0PlusSecondary"),
    ("ef", "ETimesF"),
];

const MAPPINGS: &[(&str, &str)] = &[
    ("identity", "UnsignedIdentity"),
    ("unsigned", "UnsignedIdentity"),
    ("invert", "UnsignedInvert"),
    ("expand", "ExpandNormal"),
    ("half_bias", "HalfBiasNormal"),
    ("signed", "SignedIdentity"),
    ("negate", "SignedNegate"),
];

/// Reads a register of the general stages.
pub(super) fn register(word: &str) -> Result<Register, String> {
    any_register(word)
}

/// Reads a register of the general stages or of the final combiner.
fn any_register<R: Named>(word: &str) -> Result<R, String> {
    let names = words::registers().zip(FinalRegister::NAMES.iter().copied());
    let short: Vec<(&str, &str)> = REGISTERS.into_iter().chain(names).collect();
    named("register", word, &short)
}

/// Reads the destination of a result. ZERO discards it.
pub(super) fn destination(word: &str) -> Result<Register, String> {
    match plain(word).as_str() {
        "discard" => Ok(Register::Zero),
        "zero" => Err("ZERO cannot be written; `discard` drops the result".to_owned()),
        _ => register(word),
    }
}

/// Reads a channel, 0 to 3.
pub(super) fn channel(word: &str) -> Option<usize> {
    [["r", "red"], ["g", "green"], ["b", "blue"], ["a", "alpha"]].iter().position(|names| names.contains(&word))
}

/// An input as it is written: `REGISTER[.COMPONENT][:MAPPING]`, or with a mapping as in the combiner language.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Input<R> {
    pub(super) register: R,
    pub(super) component: Option<Component>,
    pub(super) mapping: Option<InputMapping>,
}

impl From<Input<Register>> for CombinerInput {
    /// Without a component, it is red, green and blue.
    fn from(input: Input<Register>) -> Self {
        let mapping = input.mapping.unwrap_or(InputMapping::UnsignedIdentity);
        CombinerInput { register: input.register, component: input.component.unwrap_or(Component::Rgb), mapping }
    }
}

impl From<Input<FinalRegister>> for FinalInput {
    /// Mappings that the final combiner lacks have been refused, so they become the identity.
    fn from(input: Input<FinalRegister>) -> Self {
        let invert = input.mapping == Some(InputMapping::UnsignedInvert);
        FinalInput { register: input.register, component: input.component.unwrap_or(Component::Rgb), invert }
    }
}

/// Reads an input of a general stage or of the final combiner.
pub(super) fn input<R: Named>(text: &str) -> Result<Input<R>, String> {
    let (place, mapping) = match (words::take_mapping(text), text.split_once(':')) {
        (Some((mapping, place)), _) => (place, Some(mapping)),
        (None, Some((place, mapping))) => (place, Some(named("mapping", mapping, MAPPINGS)?)),
        (None, None) => (text, None),
    };
    let (name, component) = match place.split_once('.') {
        Some((name, component)) => {
            let short = [("a", "Alpha"), ("b", "Blue")];
            (name, Some(named("component", component, &short)?))
        }
        None => (place, None),
    };
    Ok(Input { register: any_register(name)?, component, mapping })
}

/// Reads an output scale.
pub(super) fn scale(word: &str) -> Result<Scale, String> {
    let short = [("1", "One"), ("2", "Two"), ("4", "Four"), ("half", "Half"), ("0.5", "Half"), ("1/2", "Half")];
    let word = plain(word);
    named("scale", word.strip_prefix("scaleby").unwrap_or(&word), &short)
}

/// Reads the bit that steers the mux.
pub(super) fn mux_select(word: &str) -> Result<MuxSelect, String> {
    named("mux selection", word, &[])
}

/// Reads the name of a chip.
pub(crate) fn profile(word: &str) -> Result<Profile, String> {
    named("profile", word, &[])
}

pub(super) fn equation(word: &str) -> Result<BlendEquation, String> {
    let word = plain(word);
    named("blend equation", word.strip_prefix("func").unwrap_or(&word), &[])
}

pub(super) fn factor(word: &str) -> Result<BlendFactor, String> {
    let short = [
        ("0", "Zero"),
        ("1", "One"),
        ("sc", "SourceColor"),
        ("1sc", "OneMinusSourceColor"),
        ("sa", "SourceAlpha"),
        ("1sa", "OneMinusSourceAlpha"),
        ("dc", "DestinationColor"),
        ("1dc", "OneMinusDestinationColor"),
        ("da", "DestinationAlpha"),
        ("1da", "OneMinusDestinationAlpha"),
        ("cc", "ConstantColor"),
        ("1cc", "OneMinusConstantColor"),
        ("ca", "ConstantAlpha"),
        ("1ca", "OneMinusConstantAlpha"),
    ];
    let long = plain(word).replace("src", "source").replace("dst", "destination");
    let long = short.iter().find(|(short, _)| *short == long).map_or(long, |(_, name)| (*name).to_owned());
    // Messages name the factors as they are written.
    named("blend factor", &long, &[]).map_err(|message: String| message.replacen(&long, word, 1))
}

pub(super) fn surface(word: &str) -> Result<SurfaceFormat, String> {
    named("surface format", word, &[])
}

pub(super) fn address_mode(word: &str) -> Result<AddressMode, String> {
    let short = [("wrap", "Wrap"), ("repeat", "Wrap"), ("mirror", "Mirror"), ("mirrored_repeat", "Mirror")];
    named("address mode", word, &short)
}

/// Reads an integer, decimal or hexadecimal: `-128`, `0x80`, `-0x80`.
pub(super) fn number(text: &str) -> Option<i64> {
    let (sign, digits) = text.strip_prefix('-').map_or(("", text), |digits| ("-", digits));
    match digits.strip_prefix("0x").or_else(|| digits.strip_prefix("0X")) {
        // A number has one sign.
        Some(digits) if digits.starts_with(['+', '-']) => None,
        Some(digits) => i64::from_str_radix(&format!("{sign}{digits}"), 16).ok(),
        None => text.parse().ok(),
    }
}

/// Reads integers separated by commas.
pub(super) fn numbers(text: &str) -> Option<Vec<i64>> {
    text.split(',').map(|text| number(text.trim())).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_register_by_all_its_names() {
        for word in ["tex0", "texture0", "Texture0", "TEXTURE0", "GL_TEXTURE0_ARB"] {
            assert_eq!(register(word), Ok(Register::Texture0), "{word}");
        }
        assert_eq!(register("GL_CONSTANT_COLOR1_NV"), Ok(Register::ConstantColor1));
        assert_eq!(
            input::<FinalRegister>("SPARE0_PLUS_SECONDARY_COLOR_NV").map(|i| i.register),
            Ok(FinalRegister::Spare0PlusSecondary)
        );
        assert!(register("tex9").is_err_and(|e| e.contains("tex0, tex1") && e.contains("spare0")));
        assert!(destination("zero").is_err());
    }

    #[test]
    fn inputs_are_taken_apart() {
        let state = |text: &str| input::<Register>(text).map(CombinerInput::from);
        let expected = |register, component, mapping| Ok(CombinerInput { register, component, mapping });
        let unsigned = InputMapping::UnsignedIdentity;
        assert_eq!(state("tex0"), expected(Register::Texture0, Component::Rgb, unsigned));
        assert_eq!(state("tex0.a"), expected(Register::Texture0, Component::Alpha, unsigned));
        assert_eq!(state("zero:invert"), expected(Register::Zero, Component::Rgb, InputMapping::UnsignedInvert));
        assert_eq!(
            state("primary.b:half_bias_negate"),
            expected(Register::PrimaryColor, Component::Blue, InputMapping::HalfBiasNegate)
        );
        assert_eq!(state("fog:SIGNED_NEGATE_NV"), expected(Register::Fog, Component::Rgb, InputMapping::SignedNegate));
        // As in the combiner language.
        for (text, register, component, mapping) in [
            ("expand(tex0)", Register::Texture0, Component::Rgb, InputMapping::ExpandNormal),
            ("-half_bias( col0.a )", Register::PrimaryColor, Component::Alpha, InputMapping::HalfBiasNegate),
            ("- col1", Register::SecondaryColor, Component::Rgb, InputMapping::SignedNegate),
            ("unsigned_invert(zero)", Register::Zero, Component::Rgb, InputMapping::UnsignedInvert),
        ] {
            assert_eq!(state(text), expected(register, component, mapping), "{text}");
        }
        for wrong in ["-unsigned(tex0)", "sine(tex0)", "expand(tex0", "expand(color_sum)", "expand(tex0:signed)"] {
            assert!(state(wrong).is_err(), "{wrong}");
        }
        let inverted = input("ef:invert").map(FinalInput::from);
        let register = FinalRegister::ETimesF;
        assert_eq!(inverted, Ok(FinalInput { register, component: Component::Rgb, invert: true }));
        assert!(state("tex0:sine").is_err_and(|e| e.contains("half_bias, half_bias_negate")));
        assert!(state("tex0.q").is_err() && state("").is_err());
    }

    #[test]
    fn every_name_is_known_as_itself() {
        for name in BlendFactor::NAMES {
            assert_eq!(factor(name).map(Named::name).as_ref(), Ok(name));
        }
        for name in SurfaceFormat::NAMES {
            assert_eq!(surface(name).map(Named::name).as_ref(), Ok(name));
        }
        assert_eq!(factor("GL_ONE_MINUS_SRC_ALPHA"), Ok(BlendFactor::OneMinusSourceAlpha));
        assert_eq!((factor("1-sa"), factor("0")), (Ok(BlendFactor::OneMinusSourceAlpha), Ok(BlendFactor::Zero)));
        assert_eq!(
            (scale("2"), scale("half"), scale("SCALE_BY_FOUR_NV")),
            (Ok(Scale::Two), Ok(Scale::Half), Ok(Scale::Four))
        );
        assert_eq!(equation("FUNC_REVERSE_SUBTRACT"), Ok(BlendEquation::ReverseSubtract));
        assert_eq!(snake("OneMinusSourceAlpha"), "one_minus_source_alpha");
        assert_eq!(snake("A8R8G8B8"), "a8r8g8b8");
    }
}
