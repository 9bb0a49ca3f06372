//! The words of the language, and those of its later versions, which are recognised and refused.

use super::{Bank, Mask, Modifier, Operation, Selector, ShaderRegister, TextureOperation, Version};
use ninebit::state::{Named, Scale};

/// Meaning of an instruction's name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Word {
    Arithmetic(Operation),
    Texture(TextureOperation),
    Define,
    Nothing,
}

/// Returns the names of all instructions.
pub(super) fn names() -> impl Iterator<Item = &'static str> {
    Operation::NAMES.iter().chain(TextureOperation::NAMES).chain(&["def", "nop"]).copied()
}

/// Finds an instruction by its name in lower case.
pub(super) fn find(name: &str) -> Option<Word> {
    let named = Operation::from_name(name).map(Word::Arithmetic);
    let named = named.or_else(|| TextureOperation::from_name(name).map(Word::Texture));
    named.or(match name {
        "def" => Some(Word::Define),
        "nop" => Some(Word::Nothing),
        _ => None,
    })
}

/// Instructions of later versions: name, version, and what to do instead.
const LATER: &[(&str, &str, &str)] = &[
    ("cmp", "1.2", "`cnd` compares r0.a with 1/2: `add r0.a, ...` of the value and 1/2, then `cnd`"),
    ("dp4", "1.2", "use `dp3`, and `mad` for the alpha"),
    ("texreg2rgb", "1.2", "use `texreg2ar` or `texreg2gb`, which look up two coordinates"),
    ("texdp3", "1.2", "use `tex` and `texcoord`, and `dp3`"),
    ("texdp3tex", "1.2", "use `texm3x2pad` and `texm3x2tex` with a second row of zeros"),
    ("texm3x3", "1.2", "use `texm3x3tex` with a cube map that holds the directions"),
    ("texm3x2depth", "1.3", "leave it out: the depth of the triangle is taken"),
    ("texcrd", "1.4", "use `texcoord`"),
    ("texld", "1.4", "use `tex`"),
    ("texdepth", "1.4", "leave it out: the depth of the triangle is taken"),
    ("bem", "1.4", "use `texbem`"),
    ("phase", "1.4", "draw in two passes with `blend`"),
];

/// Returns the version that introduced an instruction, and what to do instead; `None` if it is no instruction of a later version.
pub(super) fn later(name: &str) -> Option<(&'static str, &'static str)> {
    LATER.iter().find(|(known, ..)| *known == name).map(|(_, version, help)| (*version, *help))
}

/// Finds a version by its name in lower case, with points or underscores. Returns `Some(Err)` for other versions of a known kind of shader.
pub(super) fn version(word: &str) -> Option<Result<Version, ()>> {
    let kinds = ["ps.", "vs.", "xps."];
    let word = word.replace('_', ".");
    kinds.iter().any(|kind| word.starts_with(kind)).then(|| Version::from_name(&word).ok_or(()))
}

/// Finds a register by its name in lower case. Returns `Some(Err)` with its bank if only the number is wrong.
pub(super) fn register(word: &str) -> Option<Result<ShaderRegister, Bank>> {
    let bank = Bank::ALL.iter().find(|bank| word.starts_with(bank.name()))?;
    let digits = &word[1..];
    if digits.is_empty() || !digits.bytes().all(|byte| byte.is_ascii_digit()) {
        return None;
    }
    let index = digits.parse().ok().filter(|index| *index < bank.count());
    Some(index.map(|index| ShaderRegister { bank: *bank, index }).ok_or(*bank))
}

/// Finds the write mask that a destination's suffix stands for.
pub(super) fn mask(word: &str) -> Option<Mask> {
    match word {
        "rgba" | "xyzw" => Some(Mask::All),
        "rgb" | "xyz" => Some(Mask::Color),
        "a" | "w" => Some(Mask::Alpha),
        _ => None,
    }
}

/// Finds the channels that a source's suffix stands for.
pub(super) fn selector(word: &str) -> Option<Selector> {
    match word {
        "rgba" | "xyzw" | "rgb" | "xyz" => Some(Selector::All),
        "a" | "w" => Some(Selector::Alpha),
        "b" | "z" => Some(Selector::Blue),
        _ => None,
    }
}

/// Finds the modifier that a source's suffix stands for.
pub(super) fn modifier(word: &str) -> Option<Modifier> {
    Modifier::from_name(&format!("_{word}"))
}

/// Suffixes of instructions that scale the result.
pub(super) const SCALES: &[(&str, Scale)] = &[("x2", Scale::Two), ("x4", Scale::Four), ("d2", Scale::Half)];
