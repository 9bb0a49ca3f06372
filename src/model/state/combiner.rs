//! State of the register combiners, in the terms of NV_register_combiners.

use super::{Named, named};

/// Declares [`Register`] and [`FinalRegister`]; the latter begins with the variants of the former.
macro_rules! registers {
    ($($(#[$meta:meta])* $register:ident),+; $($(#[$final_meta:meta])* $final_register:ident),+ $(,)?) => {
        named! {
            /// A register of the general combiner stages.
            pub enum Register { $($(#[$meta])* $register),+ }
        }
        named! {
            /// A register that the final combiner can read. General stages may have written it before.
            pub enum FinalRegister { $($(#[$meta])* $register,)+ $($(#[$final_meta])* $final_register),+ }
        }
        impl From<Register> for FinalRegister {
            fn from(register: Register) -> Self {
                match register { $(Register::$register => FinalRegister::$register),+ }
            }
        }
    };
}
registers! {
    /// Always 0. As a destination it is [`Register::DISCARD`].
    Zero,
    /// Constant colour 0.
    ConstantColor0,
    /// Constant colour 1.
    ConstantColor1,
    /// Fog colour in RGB and fog factor in alpha.
    Fog,
    /// The interpolated diffuse colour.
    PrimaryColor,
    /// The interpolated specular colour.
    SecondaryColor,
    /// The result of texture unit 0.
    Texture0,
    /// The result of texture unit 1.
    Texture1,
    /// The result of texture unit 2 (nv2a).
    Texture2,
    /// The result of texture unit 3 (nv2a).
    Texture3,
    /// Scratch register 0. Its alpha selects the output of the mux.
    Spare0,
    /// Scratch register 1.
    Spare1;
    /// SPARE0 + SECONDARY, up to 2.0 (FIN-3). Only the RGB of inputs A to D can read it.
    Spare0PlusSecondary,
    /// The product of E and F (FIN-4). Only the RGB of inputs A to D can read it.
    ETimesF,
}

impl Register {
    /// The destination that keeps nothing, GL_DISCARD_NV: the chip's word for it is that of [`Register::Zero`].
    pub const DISCARD: Register = Register::Zero;

    /// Returns its name as a destination: `Discard`, or that of the register.
    pub fn destination(self) -> &'static str {
        if self == Register::DISCARD { "Discard" } else { self.name() }
    }

    /// Returns the destination of that [name](Self::destination); `Zero` means `Discard` too.
    pub fn from_destination(name: &str) -> Option<Register> {
        if name == Register::DISCARD.destination() { Some(Register::DISCARD) } else { Register::from_name(name) }
    }
}

named! {
    /// The component of a register that an input reads.
    pub enum Component {
        /// R, G and B. Only RGB portions and the final combiner read it.
        Rgb,
        /// Blue. Only alpha portions and input G of the final combiner read it.
        Blue,
        /// Alpha, which an RGB portion replicates to all channels.
        Alpha,
    }
}
named! {
    /// Input mappings of the general stages (CMB-2 to CMB-5), as formulas of the register's value x.
    pub enum InputMapping {
        /// max(0, x), which drops negative values.
        UnsignedIdentity,
        /// 1 - max(0, x).
        UnsignedInvert,
        /// 2 max(0, x) - 1.
        ExpandNormal,
        /// 1 - 2 max(0, x).
        ExpandNegate,
        /// max(0, x) - 1/2.
        HalfBiasNormal,
        /// 1/2 - max(0, x).
        HalfBiasNegate,
        /// x itself, negative values included.
        SignedIdentity,
        /// -x, negative values included.
        SignedNegate,
    }
}
named! {
    /// The factor that scales the outputs of a portion (CMB-7).
    pub enum Scale {
        /// Multiplies by 1.
        One,
        /// Multiplies by 2.
        Two,
        /// Multiplies by 4.
        Four,
        /// Multiplies by 1/2.
        Half,
    }
}
named! {
    /// The bias of a portion's outputs, applied before the scale.
    pub enum Bias {
        /// Subtracts nothing from the output.
        None,
        /// Subtracts 1/2. Legal only with [`Scale::One`] and [`Scale::Two`].
        NegativeHalf,
    }
}
named! {
    /// The bit of SPARE0's alpha that selects the output of the mux (CMB-10).
    pub enum MuxSelect {
        /// The most significant bit, which is set if the value is at least 128.
        Msb,
        /// The least significant bit, bit 0.
        Lsb,
    }
}

/// One of the inputs A, B, C, D of a general portion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CombinerInput {
    /// The register that is read.
    pub register: Register,
    /// The component of that register.
    pub component: Component,
    /// The mapping that turns the register's value into a factor.
    pub mapping: InputMapping,
}

impl CombinerInput {
    /// Returns an input that reads ZERO through the unsigned identity, so that its value is 0.
    pub fn zero(component: Component) -> Self {
        CombinerInput { register: Register::Zero, component, mapping: InputMapping::UnsignedIdentity }
    }
}

/// The RGB or the alpha half of a general stage.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Portion {
    /// Inputs A, B, C and D.
    pub inputs: [CombinerInput; 4],
    /// Destination of AB. [`Register::DISCARD`] discards it.
    pub ab_output: Register,
    /// Destination of CD. [`Register::DISCARD`] discards it.
    pub cd_output: Register,
    /// Destination of AB + CD, or of the mux. [`Register::DISCARD`] discards it.
    pub sum_output: Register,
    /// Whether AB is a dot product (RGB only).
    pub ab_dot_product: bool,
    /// Whether CD is a dot product (RGB only).
    pub cd_dot_product: bool,
    /// Whether the third output is mux(AB, CD) instead of the sum.
    pub mux: bool,
    /// The factor that multiplies all three outputs.
    pub scale: Scale,
    /// The bias that is added to all three outputs before the scale.
    pub bias: Bias,
    /// Whether the blue of AB is also written to the alpha of `ab_output` (RGB only; nv2a).
    pub ab_blue_to_alpha: bool,
    /// Whether the blue of CD is also written to the alpha of `cd_output` (RGB only; nv2a).
    pub cd_blue_to_alpha: bool,
}

impl Portion {
    /// Returns a portion that writes nothing.
    pub fn idle(component: Component) -> Self {
        Portion {
            inputs: [CombinerInput::zero(component); 4],
            ab_output: Register::Zero,
            cd_output: Register::Zero,
            sum_output: Register::Zero,
            ab_dot_product: false,
            cd_dot_product: false,
            mux: false,
            scale: Scale::One,
            bias: Bias::None,
            ab_blue_to_alpha: false,
            cd_blue_to_alpha: false,
        }
    }
}

/// One general combiner stage.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct GeneralStage {
    /// The portion that computes red, green and blue.
    pub rgb: Portion,
    /// The portion that computes alpha.
    pub alpha: Portion,
    /// Constant colours 0 and 1 of this stage, as R, G, B, A bytes. On nv10 all stages have the same ones.
    pub constants: [[u8; 4]; 2],
}

impl GeneralStage {
    /// Returns a stage that changes no register.
    pub fn idle(constants: [[u8; 4]; 2]) -> Self {
        GeneralStage { rgb: Portion::idle(Component::Rgb), alpha: Portion::idle(Component::Alpha), constants }
    }

    /// Returns OpenGL's initial stage (NV_register_combiners, table 5), which copies the primary colour to SPARE0.
    pub fn initial(constants: [[u8; 4]; 2]) -> Self {
        let portion = |component| {
            let input = |register, mapping| CombinerInput { register, component, mapping };
            let mut portion = Portion::idle(component);
            portion.inputs[0] = input(Register::PrimaryColor, InputMapping::UnsignedIdentity);
            portion.inputs[1] = input(Register::Zero, InputMapping::UnsignedInvert);
            portion.sum_output = Register::Spare0;
            portion
        };
        GeneralStage { rgb: portion(Component::Rgb), alpha: portion(Component::Alpha), constants }
    }
}

/// One of the inputs A to G of the final combiner.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FinalInput {
    /// The register that is read.
    pub register: FinalRegister,
    /// The component: `Rgb` or `Alpha` for inputs A to F, `Blue` or `Alpha` for input G.
    pub component: Component,
    /// Whether the mapping is unsigned invert instead of unsigned identity.
    pub invert: bool,
}

impl FinalInput {
    /// Returns an input that reads ZERO.
    pub fn zero(component: Component) -> Self {
        FinalInput { register: FinalRegister::Zero, component, invert: false }
    }

    /// Returns whether the input is 0 for every pixel.
    pub fn is_zero(&self) -> bool {
        self.register == FinalRegister::Zero && !self.invert
    }
}

/// The final combiner: rgb = A B + (1 - A) C + D, alpha = G.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FinalCombiner {
    /// Inputs A, B, C, D, E and F.
    pub inputs: [FinalInput; 6],
    /// Input G, the alpha of the fragment.
    pub g: FinalInput,
    /// Whether SPARE0 + SECONDARY is limited to 1.0 (FIN-3).
    pub color_sum_clamp: bool,
    /// Whether 255 - SPARE0 enters the sum in place of SPARE0 (FIN-3).
    pub invert_spare0: bool,
    /// Whether 255 - SECONDARY enters the sum in place of SECONDARY (FIN-3).
    pub invert_secondary: bool,
    /// Constant colours 0 and 1, as R, G, B, A bytes. On nv10 they equal those of the stages.
    pub constants: [[u8; 4]; 2],
}

impl FinalCombiner {
    /// Returns OpenGL's initial final combiner: fog applied to SPARE0 + SECONDARY, and the alpha of SPARE0.
    pub fn initial(constants: [[u8; 4]; 2]) -> Self {
        let input = |register, component| FinalInput { register, component, invert: false };
        let zero = FinalInput::zero(Component::Rgb);
        FinalCombiner {
            inputs: [
                input(FinalRegister::Fog, Component::Alpha),
                input(FinalRegister::Spare0PlusSecondary, Component::Rgb),
                input(FinalRegister::Fog, Component::Rgb),
                zero,
                zero,
                zero,
            ],
            g: input(FinalRegister::Spare0, Component::Alpha),
            color_sum_clamp: true,
            invert_spare0: false,
            invert_secondary: false,
            constants,
        }
    }
}

/// The source text of a general stage in the language of an API. Only reports show it; nothing is computed from it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct StageOrigin {
    /// Source of the RGB portion, such as "stage 0: ColorOp DotProduct3(Texture, Diffuse)".
    pub rgb: String,
    /// Source of the alpha portion.
    pub alpha: String,
}

/// A complete combiner program.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Combiners {
    /// The general stages: one to eight, or one to two on nv10.
    pub stages: Vec<GeneralStage>,
    /// The bit that selects the output of the mux. It is the same for all stages.
    pub mux_select: MuxSelect,
    /// The final combiner, which computes the fragment from the registers.
    pub final_combiner: FinalCombiner,
}
