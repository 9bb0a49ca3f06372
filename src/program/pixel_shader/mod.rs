//! Direct3D pixel shaders, version 1.1: reads, checks and prints them, and lowers them to combiners and a texture shader.
//!
//! `docs/languages/pixel-shader.md` describes the language.

mod check;
mod constants;
mod factor;
mod lower;
mod operand;
mod parser;
mod portion;
mod prepare;
mod print;
mod scratch;
mod texture;
mod words;

use super::Spanned;
use crate::Span;
use ninebit::diagnostic::{Diagnostic, Severity};
use ninebit::state::{Named, Scale, named};

pub use lower::{Bump, Context, LoweredProgram, UnitUse, lower};
pub use print::{instruction, print};

/// Number of constant registers of the language.
pub const CONSTANTS: usize = 8;

named! {
    /// A version of the language that has the instructions of 1.1.
    pub enum Version {
        /// An instruction reads one texture and one vertex colour; pairs write one register.
        Ps10 = "ps.1.0",
        /// The documented version.
        Ps11 = "ps.1.1",
        /// An instruction reads three textures. Other additions are refused.
        Ps12 = "ps.1.2",
        /// Like 1.2; its additional instructions are refused.
        Ps13 = "ps.1.3",
    }
}
named! {
    /// A kind of register.
    pub enum Bank {
        /// c0 to c7: constants.
        Constant = "c",
        /// r0 and r1: results; r0 is the pixel.
        Temporary = "r",
        /// t0 to t3: results of the texture instructions.
        Texture = "t",
        /// v0 and v1: colours of the vertices.
        Color = "v",
    }
}

impl Bank {
    /// Returns the number of registers of this kind.
    pub(crate) fn count(self) -> u8 {
        match self {
            Bank::Constant => CONSTANTS as u8,
            Bank::Temporary | Bank::Color => 2,
            Bank::Texture => 4,
        }
    }

    /// Returns how many different registers of this kind an instruction can read.
    pub(crate) fn ports(self, version: Version) -> usize {
        match (self, version) {
            (Bank::Constant | Bank::Temporary, _) => 2,
            (Bank::Texture | Bank::Color, Version::Ps10) => 1,
            (Bank::Texture, Version::Ps12 | Version::Ps13) => 3,
            (Bank::Texture | Bank::Color, _) => 2,
        }
    }
}

/// A register of the language.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ShaderRegister {
    /// The kind of register.
    pub bank: Bank,
    /// Its number, below the bank's count.
    pub index: u8,
}

impl std::fmt::Display for ShaderRegister {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}{}", self.bank.name(), self.index)
    }
}

named! {
    /// The channels of a source that are read.
    pub enum Selector {
        /// Each channel its own.
        All = "",
        /// Alpha, for all channels.
        Alpha = ".a",
        /// Blue, for alpha.
        Blue = ".b",
    }
}
named! {
    /// A modifier of a source. Of a negative register, all but `Plain` read 0.
    pub enum Modifier {
        /// The value x itself.
        Plain = "",
        /// x - 1/2.
        Bias = "_bias",
        /// 2x - 1.
        SignedScale = "_bx2",
        /// 1 - x. It cannot be negated.
        Invert = "1-",
    }
}

/// A source of an arithmetic instruction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Source {
    /// The register that is read.
    pub register: ShaderRegister,
    /// The channels that are read.
    pub selector: Selector,
    /// The modifier of these.
    pub modifier: Modifier,
    /// Whether the modified value is negated.
    pub negate: bool,
}

named! {
    /// The channels that an instruction writes.
    pub enum Mask {
        /// Colour and alpha.
        All = "",
        /// R, G and B.
        Color = ".rgb",
        /// A without the colour.
        Alpha = ".a",
    }
}

impl Mask {
    /// Returns whether the mask includes the alpha (`true`) or the colour (`false`).
    pub fn has(self, alpha: bool) -> bool {
        match self {
            Mask::All => true,
            Mask::Color => !alpha,
            Mask::Alpha => alpha,
        }
    }
}

/// Destination of an arithmetic instruction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Target {
    /// r0, r1 or t0 to t3.
    pub register: ShaderRegister,
    /// The channels that are written.
    pub mask: Mask,
}

named! {
    /// An arithmetic instruction; a, b and c are its sources.
    pub enum Operation =>
    /// Returns the number of its sources.
    sources: usize {
        /// a.
        Mov = "mov" => 1,
        /// a + b.
        Add = "add" => 2,
        /// a - b.
        Sub = "sub" => 2,
        /// a b.
        Mul = "mul" => 2,
        /// a b + c.
        Mad = "mad" => 3,
        /// a b + (1 - a) c, with a clamped to 0..1.
        Lrp = "lrp" => 3,
        /// The sum of a b over R, G and B, in all channels that are written.
        Dp3 = "dp3" => 2,
        /// b if a, which is r0.a, is greater than 1/2, else c.
        Cnd = "cnd" => 3,
    }
}

/// The channels of a source's register that an instruction reads.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Reads {
    /// Whether it reads channels of the colour.
    pub(crate) color: bool,
    /// Whether it reads the alpha channel.
    pub(crate) alpha: bool,
}

/// One arithmetic instruction.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Arithmetic {
    /// The operation of the instruction.
    pub operation: Operation,
    /// The scale: `_x2`, `_x4`, `_d2`.
    pub scale: Scale,
    /// `_sat`: whether the result is clamped to 0..1, after the scale.
    pub saturate: bool,
    /// Destination of the result.
    pub target: Spanned<Target>,
    /// The sources, as many as the operation has.
    pub sources: Vec<Spanned<Source>>,
    /// `+`: whether it is issued together with the instruction before.
    pub paired: bool,
    /// Place of its name in the text.
    pub span: Span,
}

impl Arithmetic {
    /// Returns the channels of a source's register that the instruction reads.
    pub(crate) fn reads(&self, source: &Source) -> Reads {
        let mask = self.target.value.mask;
        // A dot product reads the colours, whatever channels it writes.
        let [color, alpha] = match self.operation {
            Operation::Dp3 => [true, false],
            _ => [mask.has(false), mask.has(true)],
        };
        match source.selector {
            Selector::All => Reads { color, alpha },
            Selector::Alpha => Reads { color: false, alpha: true },
            Selector::Blue => Reads { color: true, alpha: false },
        }
    }
}

named! {
    /// An instruction that loads a texture register, in the order of the table in `docs/languages/pixel-shader.md`.
    pub enum TextureOperation =>
    /// Returns the number of registers behind its name, and whether its own register holds a colour afterwards.
    form: (usize, bool) {
        /// Samples the texture at its coordinates.
        Tex = "tex" => (1, true),
        /// Gives the coordinates themselves, clamped to 0..1.
        Texcoord = "texcoord" => (1, true),
        /// Drops the pixel if a coordinate is negative.
        Texkill = "texkill" => (1, false),
        /// Samples the texture, with coordinates moved by a matrix times the source.
        Texbem = "texbem" => (2, true),
        /// Like `texbem`, and scales the result by the source's luminance.
        Texbeml = "texbeml" => (2, true),
        /// Samples the texture at the source's alpha and red.
        Texreg2ar = "texreg2ar" => (2, true),
        /// Samples the texture at the source's green and blue.
        Texreg2gb = "texreg2gb" => (2, true),
        /// Computes the first of two rows of a matrix.
        Texm3x2pad = "texm3x2pad" => (2, false),
        /// Computes the second row, and samples the texture at the two products.
        Texm3x2tex = "texm3x2tex" => (2, true),
        /// Computes the first or second of three rows of a matrix.
        Texm3x3pad = "texm3x3pad" => (2, false),
        /// Computes the third row, and samples the cube map in the direction of the three products.
        Texm3x3tex = "texm3x3tex" => (2, true),
        /// Computes the third row, and samples the cube map in the reflected direction, with a constant eye vector.
        Texm3x3spec = "texm3x3spec" => (3, true),
        /// Like `texm3x3spec`, with the eye vector in the three fourth coordinates.
        Texm3x3vspec = "texm3x3vspec" => (2, true),
    }
}

impl TextureOperation {
    /// Returns the number of registers behind its name.
    pub(crate) fn operands(self) -> usize {
        self.form().0
    }

    /// Returns whether it has a source register.
    pub(crate) fn has_source(self) -> bool {
        self.operands() > 1
    }

    /// Returns whether it is a row of a matrix, whose source may have `_bx2`.
    pub(crate) fn is_row(self) -> bool {
        self.name().starts_with("texm3x")
    }

    /// Returns whether its register holds a colour afterwards.
    pub(crate) fn gives_color(self) -> bool {
        self.form().1
    }
}

/// The source of a texture instruction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TextureSource {
    /// Number of the register: t0 to t2.
    pub unit: u8,
    /// `_bx2`: whether each component becomes 2 x - 1.
    pub signed_scale: bool,
}

/// One texture instruction.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TextureInstruction {
    /// The operation of the instruction.
    pub operation: TextureOperation,
    /// Number of its register, t0 to t3, and of the texture unit.
    pub unit: Spanned<u8>,
    /// The earlier register that it reads.
    pub source: Option<Spanned<TextureSource>>,
    /// The constant with the eye vector, of texm3x3spec.
    pub eye: Option<Spanned<u8>>,
    /// Place of its name in the text.
    pub span: Span,
}

/// `def`: a constant defined in the shader.
#[derive(Clone, Debug, PartialEq)]
pub struct Definition {
    /// Number of the constant, 0 to 7.
    pub index: u8,
    /// R, G, B and A, which are finite.
    pub value: [f32; 4],
    /// Place of the register in the text.
    pub span: Span,
}

/// A pixel shader.
#[derive(Clone, Debug, PartialEq)]
pub struct PixelShader {
    /// The version that its first line names.
    pub version: Version,
    /// Constants that the shader defines.
    pub definitions: Vec<Definition>,
    /// Texture instructions, in order.
    pub textures: Vec<TextureInstruction>,
    /// Arithmetic instructions, in order.
    pub arithmetic: Vec<Arithmetic>,
}

impl PixelShader {
    /// Returns the arithmetic instructions by slots: one instruction, or a pair.
    pub fn slots(&self) -> impl DoubleEndedIterator<Item = &[Arithmetic]> {
        self.arithmetic.chunk_by(|_, next| next.paired)
    }

    /// Returns the constants that are read, with the first place of each.
    pub fn constants_read(&self) -> Vec<Spanned<u8>> {
        let eyes = self.textures.iter().filter_map(|texture| texture.eye.clone());
        let sources = self.arithmetic.iter().flat_map(|instruction| &instruction.sources);
        let sources = sources.filter(|source| source.value.register.bank == Bank::Constant);
        let sources = sources.map(|source| Spanned { value: source.value.register.index, span: source.span.clone() });
        let mut found: Vec<Spanned<u8>> = Vec::new();
        for read in eyes.chain(sources) {
            if found.iter().all(|known| known.value != read.value) {
                found.push(read);
            }
        }
        found
    }
}

/// A shader that has been read and checked.
#[derive(Clone, Debug, PartialEq)]
pub struct CheckedShader {
    /// The shader that was read.
    pub program: PixelShader,
    /// Findings about what is probably unintended.
    pub warnings: Vec<Diagnostic>,
}

/// Reads a pixel shader and checks it against the rules of the language.
///
/// # Errors
/// All findings, with places in `text`: at most 32 about the notation, or 64 about the rules.
pub fn parse(text: &str) -> Result<CheckedShader, Vec<Diagnostic>> {
    let (program, mut findings) = parser::read(text);
    if findings.iter().all(|finding| finding.severity != Severity::Error) {
        findings.extend(check::check(&program));
    }
    if findings.iter().any(|finding| finding.severity == Severity::Error) {
        return Err(findings);
    }
    Ok(CheckedShader { program, warnings: findings })
}
