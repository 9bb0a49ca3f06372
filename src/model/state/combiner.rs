//! Register combiners, in the terms of NV_register_combiners.

use super::named;

/// The registers of both; those of the final combiner begin as those of the general stages do.
macro_rules! registers {
    ($($(#[$meta:meta])* $register:ident),+; $($(#[$final_meta:meta])* $final_register:ident),+ $(,)?) => {
        named! {
            /// A register of the general combiner stages.
            pub enum Register { $($(#[$meta])* $register),+ }
        }
        named! {
            /// A register of the final combiner: as a stage left it, if one wrote it.
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
    /// Always 0. As a destination: discard.
    Zero,
    /// Constant colour 0.
    ConstantColor0,
    /// Constant colour 1.
    ConstantColor1,
    /// Fog colour and factor.
    Fog,
    /// The interpolated diffuse colour.
    PrimaryColor,
    /// The interpolated specular colour.
    SecondaryColor,
    /// Unit 0's result.
    Texture0,
    /// Unit 1's result.
    Texture1,
    /// Unit 2's result (nv2a).
    Texture2,
    /// Unit 3's result (nv2a).
    Texture3,
    /// Scratch; its alpha steers the mux.
    Spare0,
    /// A second scratch register.
    Spare1;
    /// SPARE0 + SECONDARY, up to 2.0 (FIN-3). Inputs A to D, RGB.
    Spare0PlusSecondary,
    /// E times F (FIN-4). Inputs A to D, RGB.
    ETimesF,
}

named! {
    /// Which component of a register an input reads.
    pub enum Component {
        /// R, G and B. RGB portion and final combiner only.
        Rgb,
        /// Blue. Alpha portion and final combiner's G only.
        Blue,
        /// Alpha, replicated in an RGB portion.
        Alpha,
    }
}
named! {
    /// Input mappings of the general stages (CMB-2 to CMB-5).
    pub enum InputMapping {
        /// max(0, x).
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
        /// x.
        SignedIdentity,
        /// -x.
        SignedNegate,
    }
}
named! {
    /// What an output is multiplied by (CMB-7).
    pub enum Scale {
        /// x1.
        One,
        /// x2.
        Two,
        /// x4.
        Four,
        /// x1/2.
        Half,
    }
}
named! {
    /// Output bias, applied before the scale.
    pub enum Bias {
        /// Nothing is subtracted.
        None,
        /// -1/2. Legal with scales One and Two.
        NegativeHalf,
    }
}
named! {
    /// Which bit of SPARE0's alpha steers the mux (CMB-10).
    pub enum MuxSelect {
        /// Most significant: value >= 128.
        Msb,
        /// Least significant: bit 0.
        Lsb,
    }
}

/// One of the inputs A, B, C, D of a general portion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CombinerInput {
    /// The register that is read.
    pub register: Register,
    /// Which of its channels.
    pub component: Component,
    /// How its value becomes a factor.
    pub mapping: InputMapping,
}

impl CombinerInput {
    /// ZERO through the unsigned identity: 0.
    pub fn zero(component: Component) -> Self {
        CombinerInput { register: Register::Zero, component, mapping: InputMapping::UnsignedIdentity }
    }
}

/// The RGB or the alpha half of a general stage.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Portion {
    /// A, B, C, D.
    pub inputs: [CombinerInput; 4],
    /// Destination of AB; `Register::Zero` discards.
    pub ab_output: Register,
    /// Destination of CD; `Register::Zero` discards.
    pub cd_output: Register,
    /// Destination of AB + CD, or of the mux; `Register::Zero` discards.
    pub sum_output: Register,
    /// AB is a dot product (RGB only).
    pub ab_dot_product: bool,
    /// CD is a dot product (RGB only).
    pub cd_dot_product: bool,
    /// The third output is mux(AB, CD) instead of the sum.
    pub mux: bool,
    /// What all three outputs are multiplied by.
    pub scale: Scale,
    /// What is subtracted from all three outputs first.
    pub bias: Bias,
    /// AB's blue also goes to the alpha of `ab_output` (RGB only; nv2a).
    pub ab_blue_to_alpha: bool,
    /// CD's blue also goes to the alpha of `cd_output` (RGB only; nv2a).
    pub cd_blue_to_alpha: bool,
}

impl Portion {
    /// A portion that writes nothing.
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
    /// What computes red, green and blue.
    pub rgb: Portion,
    /// What computes alpha.
    pub alpha: Portion,
    /// Constant colours 0 and 1 of this stage, R, G, B, A bytes. Equal in all stages on nv10.
    pub constants: [[u8; 4]; 2],
}

impl GeneralStage {
    /// A stage that changes nothing.
    pub fn idle(constants: [[u8; 4]; 2]) -> Self {
        GeneralStage { rgb: Portion::idle(Component::Rgb), alpha: Portion::idle(Component::Alpha), constants }
    }

    /// OpenGL's initial stage (NV_register_combiners, table 5): SPARE0 is the primary colour.
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
    /// Component: Rgb or Alpha for A to F, Blue or Alpha for G.
    pub component: Component,
    /// Unsigned invert instead of unsigned identity.
    pub invert: bool,
}

impl FinalInput {
    /// An input that reads ZERO.
    pub fn zero(component: Component) -> Self {
        FinalInput { register: FinalRegister::Zero, component, invert: false }
    }

    /// Whether the input is 0 whatever the pixel.
    pub fn is_zero(&self) -> bool {
        self.register == FinalRegister::Zero && !self.invert
    }
}

/// The final combiner: rgb = A B + (1 - A) C + D, alpha = G.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FinalCombiner {
    /// A, B, C, D, E, F.
    pub inputs: [FinalInput; 6],
    /// G: the alpha of the fragment.
    pub g: FinalInput,
    /// SPARE0 + SECONDARY is limited to 1.0 (FIN-3).
    pub color_sum_clamp: bool,
    /// 255 - SPARE0 enters the sum (FIN-3).
    pub invert_spare0: bool,
    /// 255 - SECONDARY enters the sum (FIN-3).
    pub invert_secondary: bool,
    /// Constant colours 0 and 1, R, G, B, A bytes. Equal to the stages' on nv10.
    pub constants: [[u8; 4]; 2],
}

impl FinalCombiner {
    /// OpenGL's initial final combiner: fog over SPARE0 + SECONDARY, alpha of SPARE0.
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

/// What a general stage was written as, in the language of an API. For reports; nothing is computed from it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct StageOrigin {
    /// The RGB portion: "stage 0: ColorOp DotProduct3(Texture, Diffuse)".
    pub rgb: String,
    /// The alpha portion.
    pub alpha: String,
}

/// A whole combiner program.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Combiners {
    /// One to eight general stages (two on nv10).
    pub stages: Vec<GeneralStage>,
    /// Mux bit, the same for all stages.
    pub mux_select: MuxSelect,
    /// What makes the fragment of the registers.
    pub final_combiner: FinalCombiner,
}
