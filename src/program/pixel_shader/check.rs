//! Checks the rules of the language, as Direct3D's validator does.

use super::*;
use crate::finding::{finding, warning};

/// Largest number of arithmetic instructions of a shader, where a pair counts as one.
const MAX_ARITHMETIC_SLOTS: usize = 8;

/// Largest number of findings.
const MAX_FINDINGS: usize = 64;

/// Checks a shader against the rules.
pub(super) fn check(program: &PixelShader) -> Vec<Diagnostic> {
    let mut check = Check { program, findings: Vec::new(), known: DefinedRegisters::default() };
    check.definitions();
    check.textures();
    check.count();
    for slot in program.slots() {
        check.pair(slot);
        check.ports(slot);
        for instruction in slot {
            check.instruction(instruction);
        }
        for instruction in slot {
            check.known.write(&instruction.target.value);
        }
    }
    check.result();
    check.findings.truncate(MAX_FINDINGS);
    check.findings
}

/// The registers that hold a value: colour and alpha of r0, r1 and t0 to t3.
#[derive(Clone, Copy, Debug, Default)]
struct DefinedRegisters {
    temporary: [[bool; 2]; 2],
    texture: [[bool; 2]; 4],
}

impl DefinedRegisters {
    fn portions(&self, register: ShaderRegister) -> [bool; 2] {
        match register.bank {
            Bank::Constant | Bank::Color => [true; 2],
            Bank::Temporary => self.temporary.get(usize::from(register.index)).copied().unwrap_or_default(),
            Bank::Texture => self.texture.get(usize::from(register.index)).copied().unwrap_or_default(),
        }
    }

    fn write(&mut self, target: &Target) {
        let index = usize::from(target.register.index);
        let slot = match target.register.bank {
            Bank::Temporary => self.temporary.get_mut(index),
            Bank::Texture => self.texture.get_mut(index),
            Bank::Constant | Bank::Color => None,
        };
        if let Some([color, alpha]) = slot {
            *color |= target.mask.has(false);
            *alpha |= target.mask.has(true);
        }
    }
}

struct Check<'p> {
    program: &'p PixelShader,
    findings: Vec<Diagnostic>,
    known: DefinedRegisters,
}

impl Check<'_> {
    fn push(&mut self, code: &'static str, span: &Span, message: String, label: &str, help: impl Into<String>) {
        self.findings.push(finding(code, span.clone(), message, label, help));
    }

    fn warn(&mut self, code: &'static str, span: &Span, message: String, label: &str, help: &str) {
        self.findings.push(warning(code, span.clone(), message, label, help));
    }

    /// Returns the place of the first instruction.
    fn first(&self) -> Option<usize> {
        let texture = self.program.textures.first().map(|instruction| instruction.span.start);
        let arithmetic = self.program.arithmetic.first().map(|instruction| instruction.span.start);
        texture.into_iter().chain(arithmetic).min()
    }

    fn definitions(&mut self) {
        let mut seen: [Option<Span>; CONSTANTS] = Default::default();
        for definition in &self.program.definitions {
            let Definition { index, span, .. } = definition;
            if self.first().is_some_and(|first| first < span.start) {
                let message = format!("def c{index} behind an instruction");
                let help = "definitions stand between the version and the instructions";
                self.push("NB0373", span, message, "too late", help);
            }
            let Some(slot) = seen.get_mut(usize::from(*index)) else { continue };
            match slot {
                Some(first) => {
                    let message = format!("c{index} is defined twice");
                    let finding = finding("NB0364", span.clone(), message, "again here", "keep one of them");
                    self.findings.push(finding.related(first.clone(), "first here"));
                }
                None => *slot = Some(span.clone()),
            }
        }
    }

    fn textures(&mut self) {
        let arithmetic = self.program.arithmetic.first().map(|instruction| instruction.span.start);
        let mut last: Option<u8> = None;
        for (n, texture) in self.program.textures.iter().enumerate() {
            let (unit, name) = (texture.unit.value, texture.operation.name());
            if arithmetic.is_some_and(|first| first < texture.span.start) {
                let message = format!("{name} t{unit} behind an arithmetic instruction");
                self.push("NB0373", &texture.span, message, "too late", "texture instructions come first: move it up");
            }
            if let Some(last) = last.filter(|last| unit <= *last) {
                let message = format!("t{unit} is loaded behind t{last}");
                let help = "each texture instruction has a register of its own, in the order of their numbers";
                self.push("NB0373", &texture.unit.span, message, "not in this order", help);
            }
            last = Some(unit.max(last.unwrap_or(0)));
            if let Some(source) = &texture.source {
                self.texture_source(texture, source);
            }
            self.rows(n, texture);
            if texture.operation.gives_color() {
                let register = ShaderRegister { bank: Bank::Texture, index: unit };
                self.known.write(&Target { register, mask: Mask::All });
            }
        }
    }

    fn texture_source(&mut self, texture: &TextureInstruction, source: &Spanned<TextureSource>) {
        let (unit, from) = (texture.unit.value, source.value.unit);
        if self.known.portions(ShaderRegister { bank: Bank::Texture, index: from })[0] {
            return;
        }
        let message = format!("{} t{unit} reads t{from}, {}", texture.operation.name(), self.emptiness(from));
        let help = match from < unit {
            true => format!("write `tex t{from}` before it"),
            false => "it reads a register with a lower number, loaded before".to_owned(),
        };
        self.push("NB0375", &source.span, message, "no colour here yet", help);
    }

    /// Says why a texture register holds no colour.
    fn emptiness(&self, index: u8) -> String {
        match self.program.textures.iter().find(|texture| texture.unit.value == index) {
            Some(texture) if !texture.operation.gives_color() => {
                format!("in which {} leaves no colour", texture.operation.name())
            }
            Some(_) => "which is not loaded before it".to_owned(),
            None => "which no texture instruction loads".to_owned(),
        }
    }

    /// Checks that the rows of a matrix stand together: pads and the instruction that completes them, in consecutive registers.
    fn rows(&mut self, n: usize, texture: &TextureInstruction) {
        use TextureOperation as Op;
        let unit = texture.unit.value;
        let at = |offset: isize| {
            let other = n.checked_add_signed(offset).and_then(|index| self.program.textures.get(index))?;
            (i16::from(other.unit.value) == i16::from(unit) + offset as i16).then_some(other.operation)
        };
        let [second_before, before, after, second_after] = [-2, -1, 1, 2].map(at);
        let third = |operation| matches!(operation, Some(Op::Texm3x3tex | Op::Texm3x3spec | Op::Texm3x3vspec));
        let wanted = match texture.operation {
            Op::Texm3x2pad => (after != Some(Op::Texm3x2tex)).then(|| format!("`texm3x2tex t{}` after it", unit + 1)),
            Op::Texm3x2tex => {
                (before != Some(Op::Texm3x2pad)).then(|| format!("`texm3x2pad t{}` before it", unit.max(1) - 1))
            }
            Op::Texm3x3pad => {
                let complete = third(second_after) && after == Some(Op::Texm3x3pad)
                    || third(after) && before == Some(Op::Texm3x3pad);
                (!complete).then(|| {
                    "two `texm3x3pad` and then `texm3x3tex`, `texm3x3spec` or `texm3x3vspec`, as t1, t2 and t3"
                        .to_owned()
                })
            }
            Op::Texm3x3tex | Op::Texm3x3spec | Op::Texm3x3vspec => (before != Some(Op::Texm3x3pad)
                || second_before != Some(Op::Texm3x3pad))
            .then(|| "`texm3x3pad t1` and `texm3x3pad t2` before it, and t3 itself".to_owned()),
            _ => None,
        };
        if let Some(wanted) = wanted {
            let message = format!("{} t{unit} is part of no whole matrix", texture.operation.name());
            self.push("NB0373", &texture.span, message, "a row without the others", format!("it takes {wanted}"));
        }
    }

    fn count(&mut self) {
        let slots = self.program.slots().count();
        if let Some(slot) = self.program.slots().nth(MAX_ARITHMETIC_SLOTS).and_then(<[Arithmetic]>::first) {
            let message = format!("{slots} arithmetic instructions; ps.1.1 has {MAX_ARITHMETIC_SLOTS}");
            let help =
                "a colour and an alpha instruction count as one if paired by `+`; or draw in two passes with `blend`";
            self.push("NB0374", &slot.span, message, "the first too many", help);
        }
    }

    /// Checks instructions that are issued together: one has to write colour, the other alpha.
    fn pair(&mut self, slot: &[Arithmetic]) {
        let [first, rest @ ..] = slot else { return };
        if first.paired {
            let message = "`+` without an instruction to pair with".to_owned();
            self.push("NB0376", &first.span, message, "nothing before it", "leave the `+` out");
        }
        let Some(second) = rest.first() else { return };
        if let Some(third) = rest.get(1) {
            let message = "three instructions cannot be issued together".to_owned();
            let help = "leave this `+` out: a pair is one instruction that writes `.rgb` and one that writes `.a`";
            self.push("NB0376", &third.span, message, "one too many", help);
        }
        let [one, other] = [first, second].map(|instruction| instruction.target.value);
        if !matches!((one.mask, other.mask), (Mask::Color, Mask::Alpha) | (Mask::Alpha, Mask::Color)) {
            let pipe = match (one.mask, other.mask) {
                (Mask::Alpha, Mask::Alpha) => "alpha",
                _ => "colour",
            };
            let message = format!("both instructions of this pair write {pipe}");
            let help = "one of a pair writes `.rgb`, the other `.a`";
            let error = finding("NB0376", second.target.span.clone(), message, "not in the same cycle", help);
            self.findings.push(error.related(first.target.span.clone(), "the other one"));
        } else if self.program.version == Version::Ps10 && one.register != other.register {
            let message = format!(
                "ps.1.0 pairs instructions that write one register, not {} and {}",
                one.register, other.register
            );
            self.push("NB0376", &second.target.span, message, "another register", "write `ps.1.1`");
        }
        if second.operation == Operation::Cnd && second.target.value.mask == Mask::Color {
            let message = "a colour `cnd` behind `+` does not compare: it takes its second source".to_owned();
            let help = "write the pair the other way round, cnd first, to have it compare";
            self.warn("NB0908", &second.span, message, "always the second source", help);
        }
    }

    /// Checks how many registers of each kind an instruction, and a pair, reads.
    fn ports(&mut self, slot: &[Arithmetic]) {
        let version = self.program.version;
        for bank in Bank::ALL {
            let mut all = Vec::new();
            for instruction in slot {
                let mut own = Vec::new();
                for source in instruction.sources.iter().filter(|source| source.value.register.bank == *bank) {
                    let index = source.value.register.index;
                    let new = |seen: &mut Vec<u8>| {
                        let new = !seen.contains(&index);
                        if new {
                            seen.push(index);
                        }
                        new
                    };
                    let (in_own, in_all) = (new(&mut own), new(&mut all));
                    let most = bank.ports(version);
                    let name = bank.name();
                    if in_own && own.len() == most + 1 {
                        let what = instruction.operation.name();
                        let message = match most {
                            1 => format!("{what} reads two {name} registers; {} can read one", version.name()),
                            _ => format!("{what} reads more than {most} of the {name} registers"),
                        };
                        let help = "`mov` one of them to r0 or r1 first";
                        self.push("NB0372", &source.span, message, "one too many", help);
                    } else if in_all && slot.len() > 1 && all.len() == 4 {
                        let message = format!("this pair reads more than 3 of the {name} registers");
                        self.push("NB0372", &source.span, message, "one too many", "issue the two after one another");
                    }
                }
            }
        }
    }

    fn instruction(&mut self, instruction: &Arithmetic) {
        let name = instruction.operation.name();
        let Spanned { value: target, span } = &instruction.target;
        if matches!(target.register.bank, Bank::Constant | Bank::Color) {
            let message = format!("{} cannot be written", target.register);
            self.push("NB0371", span, message, "read only", "write r0, r1 or a texture register");
        }
        if instruction.operation == Operation::Dp3 && target.mask == Mask::Alpha {
            let message = "dp3 cannot write alpha alone".to_owned();
            let help = "it runs in the colour pipe: write all channels, or `.rgb`";
            self.push("NB0371", span, message, "alpha only", help);
        }
        for (n, Spanned { value: source, span }) in instruction.sources.iter().enumerate() {
            if instruction.operation == Operation::Cnd && n == 0 {
                // An instruction that writes alpha reads alpha in any case.
                let alpha = source.selector == Selector::Alpha
                    || source.selector == Selector::All && target.mask == Mask::Alpha;
                let plain = source.modifier == Modifier::Plain && !source.negate;
                let r0 = ShaderRegister { bank: Bank::Temporary, index: 0 };
                if source.register != r0 || !alpha || !plain {
                    let help = "the first source is `r0.a`, as it is: compute the condition there";
                    self.push("NB0371", span, format!("{name} compares r0.a alone"), "not r0.a", help);
                }
            }
            if source.selector == Selector::Blue
                && (target.mask != Mask::Alpha || self.program.version == Version::Ps10)
            {
                let message = match self.program.version {
                    Version::Ps10 => "ps.1.0 does not read `.b`".to_owned(),
                    _ => format!("{name} cannot read blue for colours"),
                };
                let help = "`.b` is read by instructions that write `.a`, from ps.1.1 on";
                self.push("NB0371", span, message, "blue alone", help);
            }
            if source.register.bank == Bank::Constant && (source.modifier != Modifier::Plain || source.negate) {
                let message = format!("{} is modified, which the API leaves undefined for constants", source.register);
                let help = "put the modified value into the constant, or read it by way of r0 or r1";
                self.warn("NB0907", span, message, "modified as a register here", help);
            }
            self.read(instruction, source, span);
        }
    }

    /// Checks that a register is written before it is read.
    fn read(&mut self, instruction: &Arithmetic, source: &Source, span: &Span) {
        let Reads { color, alpha } = instruction.reads(source);
        let [has_color, has_alpha] = self.known.portions(source.register);
        let part = match (color && !has_color, alpha && !has_alpha) {
            (false, false) => return,
            (true, false) if has_alpha => "the colour of ",
            (false, true) if has_color => "the alpha of ",
            _ => "",
        };
        let register = source.register;
        let (message, help) = match register.bank {
            Bank::Texture => (
                format!("{} reads {part}{register}, {}", instruction.operation.name(), self.emptiness(register.index)),
                format!("write `tex {register}` with the other texture instructions"),
            ),
            _ => (
                format!("{} reads {part}{register} before it is written", instruction.operation.name()),
                format!("write it with an instruction above: `mov {register}, ...`"),
            ),
        };
        self.push("NB0375", span, message, "nothing here yet", help);
    }

    /// Checks that the shader writes its result, r0.
    fn result(&mut self) {
        let span = self.program.arithmetic.last().map(|instruction| instruction.target.span.clone());
        let span = span.or(self.program.textures.last().map(|texture| texture.unit.span.clone())).unwrap_or(0..0);
        match self.known.temporary[0] {
            [true, true] => {}
            [false, false] => {
                let message = "this shader does not write r0".to_owned();
                self.push("NB0377", &span, message, "the last result", "r0 is the pixel: `mov r0, ...` at the end");
            }
            [true, false] => {
                let message = "the alpha of r0 is not written".to_owned();
                let help = "it is that of texture 0, as a register combiner starts (CMB-13); write `mov r0.a, ...`";
                self.warn("NB0909", &span, message, "the last result", help);
            }
            [false, true] => {
                let message = "the colour of r0 is not written".to_owned();
                self.warn("NB0909", &span, message, "the last result", "it is black; write `mov r0.rgb, ...`");
            }
        }
    }
}
