//! Direct3D pixel shaders, version 1.1: read, held against the language's rules, lowered to register combiners and a texture shader, printed.
//!
//! The language is in `docs/pixel-shader.md`.

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

pub use lower::{Bump, Context, Lowered, UnitUse, lower};
pub use print::{instruction, print};

/// Constant registers of the language.
pub const CONSTANTS: usize = 8;

named! {
    /// A version of the language whose instructions are those of 1.1.
    pub enum Version {
        /// One texture and one vertex colour in an instruction; pairs write one register.
        Ps10 = "ps.1.0",
        /// The version that is documented here.
        Ps11 = "ps.1.1",
        /// 1.1 with three textures in an instruction. What it adds besides is refused.
        Ps12 = "ps.1.2",
        /// 1.2 with instructions that are refused as well.
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
        /// t0 to t3: what the texture instructions give.
        Texture = "t",
        /// v0 and v1: the colours of the vertices.
        Color = "v",
    }
}

impl Bank {
    /// Registers of this kind.
    pub fn count(self) -> u8 {
        match self {
            Bank::Constant => CONSTANTS as u8,
            Bank::Temporary | Bank::Color => 2,
            Bank::Texture => 4,
        }
    }

    /// How many different ones an instruction can read.
    pub fn ports(self, version: Version) -> usize {
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
    /// The bank that it belongs to.
    pub bank: Bank,
    /// Its number, below [`Bank::count`].
    pub index: u8,
}

impl std::fmt::Display for ShaderRegister {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}{}", self.bank.name(), self.index)
    }
}

named! {
    /// Which channels of a source are read.
    pub enum Selector {
        /// Each its own.
        All = "",
        /// Alpha, for all.
        Alpha = ".a",
        /// Blue, for alpha.
        Blue = ".b",
    }
}
named! {
    /// What is made of a source. Of a negative register, all but `Plain` see 0.
    pub enum Modifier {
        /// x.
        Plain = "",
        /// x - 1/2.
        Bias = "_bias",
        /// 2x - 1.
        SignedScale = "_bx2",
        /// 1 - x. Not together with a minus.
        Invert = "1-",
    }
}

/// A source of an arithmetic instruction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Source {
    /// The register that is read.
    pub register: ShaderRegister,
    /// Which of its channels.
    pub selector: Selector,
    /// What is made of them.
    pub modifier: Modifier,
    /// The negative of all that.
    pub negate: bool,
}

named! {
    /// Which channels an instruction writes.
    pub enum Mask {
        /// Colour and alpha.
        All = "",
        /// R, G and B.
        Color = ".rgb",
        /// Alpha alone.
        Alpha = ".a",
    }
}

impl Mask {
    /// Whether it has the colour (false) or the alpha (true).
    pub fn has(self, alpha: bool) -> bool {
        match self {
            Mask::All => true,
            Mask::Color => !alpha,
            Mask::Alpha => alpha,
        }
    }
}

/// Where an arithmetic instruction writes.
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
    /// Sources it has.
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
        /// a b + (1 - a) c, a limited to 0..1.
        Lrp = "lrp" => 3,
        /// The sum of a b over R, G and B, in all channels that are written.
        Dp3 = "dp3" => 2,
        /// b if a, which is r0.a, is greater than 1/2, else c.
        Cnd = "cnd" => 3,
    }
}

/// What an instruction takes of a source's register.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Reads {
    /// Channels of its colour.
    pub color: bool,
    /// Its alpha channel.
    pub alpha: bool,
}

/// One arithmetic instruction.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Arithmetic {
    /// What it computes.
    pub operation: Operation,
    /// `_x2`, `_x4`, `_d2`.
    pub scale: Scale,
    /// `_sat`: limited to 0..1, after the scale.
    pub saturate: bool,
    /// Where the result goes.
    pub target: Spanned<Target>,
    /// The sources, as many as the operation has.
    pub sources: Vec<Spanned<Source>>,
    /// Issued together with the instruction before it: `+`.
    pub paired: bool,
    /// Its name in the text.
    pub span: Span,
}

impl Arithmetic {
    /// What it takes of the register of a source.
    pub fn reads(&self, source: &Source) -> Reads {
        let mask = self.target.value.mask;
        // The dot product is taken of colours, whatever it is written to.
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
    /// An instruction that loads a texture register, in the order of the table in `docs/pixel-shader.md`.
    pub enum TextureOperation =>
    /// Registers that are written behind its name, and whether its own holds a colour afterwards.
    form: (usize, bool) {
        /// The texture at its coordinates.
        Tex = "tex" => (1, true),
        /// The coordinates themselves, limited to 0..1.
        Texcoord = "texcoord" => (1, true),
        /// Drops the pixel if a coordinate is negative.
        Texkill = "texkill" => (1, false),
        /// The texture where a matrix times the source moves the coordinates.
        Texbem = "texbem" => (2, true),
        /// The same, and scaled by the source's luminance.
        Texbeml = "texbeml" => (2, true),
        /// The texture at the source's alpha and red.
        Texreg2ar = "texreg2ar" => (2, true),
        /// The texture at the source's green and blue.
        Texreg2gb = "texreg2gb" => (2, true),
        /// The first row of two.
        Texm3x2pad = "texm3x2pad" => (2, false),
        /// The second row, and the texture at the two products.
        Texm3x2tex = "texm3x2tex" => (2, true),
        /// The first or second row of three.
        Texm3x3pad = "texm3x3pad" => (2, false),
        /// The third row, and the cube map in that direction.
        Texm3x3tex = "texm3x3tex" => (2, true),
        /// The third row, and the cube map in the direction reflected, the eye a constant.
        Texm3x3spec = "texm3x3spec" => (3, true),
        /// The same, the eye in the three fourth coordinates.
        Texm3x3vspec = "texm3x3vspec" => (2, true),
    }
}

impl TextureOperation {
    /// Registers that are written behind its name.
    pub fn operands(self) -> usize {
        self.form().0
    }

    /// Whether it has a source register.
    pub fn has_source(self) -> bool {
        self.operands() > 1
    }

    /// Whether it is a row of a matrix, whose source may be `_bx2`.
    pub fn is_row(self) -> bool {
        self.name().starts_with("texm3x")
    }

    /// Whether its register holds a colour afterwards.
    pub fn gives_color(self) -> bool {
        self.form().1
    }
}

/// The source of a texture instruction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TextureSource {
    /// t0 to t2.
    pub unit: u8,
    /// `_bx2`: 2 x - 1 of each component.
    pub signed_scale: bool,
}

/// One texture instruction.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TextureInstruction {
    /// What it does.
    pub operation: TextureOperation,
    /// Its register, t0 to t3, and texture unit.
    pub unit: Spanned<u8>,
    /// The earlier register that it reads.
    pub source: Option<Spanned<TextureSource>>,
    /// The constant with the eye, of texm3x3spec.
    pub eye: Option<Spanned<u8>>,
    /// Its name in the text.
    pub span: Span,
}

/// `def`: a constant with its value.
#[derive(Clone, Debug, PartialEq)]
pub struct Definition {
    /// 0 to 7.
    pub index: u8,
    /// R, G, B, A, finite.
    pub value: [f32; 4],
    /// The register in the text.
    pub span: Span,
}

/// A pixel shader.
#[derive(Clone, Debug, PartialEq)]
pub struct PixelShader {
    /// The version that its first line names.
    pub version: Version,
    /// Constants that it defines itself.
    pub definitions: Vec<Definition>,
    /// Texture instructions, in order.
    pub textures: Vec<TextureInstruction>,
    /// Arithmetic instructions, in order.
    pub arithmetic: Vec<Arithmetic>,
}

impl PixelShader {
    /// Arithmetic instructions by the slot that they take: one, or a pair.
    pub fn slots(&self) -> impl DoubleEndedIterator<Item = &[Arithmetic]> {
        self.arithmetic.chunk_by(|_, next| next.paired)
    }

    /// Constants that are read, each with the first place.
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

/// A program that was read and checked.
#[derive(Clone, Debug, PartialEq)]
pub struct Parsed {
    /// What it says.
    pub program: PixelShader,
    /// What is probably not meant.
    pub warnings: Vec<Diagnostic>,
}

/// Reads a pixel shader and holds it against the rules of the language.
///
/// # Errors
/// Everything that is wrong with it, with places in `text`; at most 32 findings of notation, or 64 of rules.
pub fn parse(text: &str) -> Result<Parsed, Vec<Diagnostic>> {
    let (program, mut findings) = parser::read(text);
    if findings.iter().all(|finding| finding.severity != Severity::Error) {
        findings.extend(check::check(&program));
    }
    if findings.iter().any(|finding| finding.severity == Severity::Error) {
        return Err(findings);
    }
    Ok(Parsed { program, warnings: findings })
}
