//! Declares the fields of pixel programs.

use super::*;
use ninebit::state::{Bias, MuxSelect, Scale};
use ninebit_program::texture_environment as environment;
use ninebit_program::texture_stages::{Operation, ResultArgument};

source! {
    struct ProgramFile "program" {
        /// a file in the scene's folder
        file: String [required],
    }
    struct RegisterWords {
        /// words of NV10
        nv10: Nv10Words<'a> [or "one of the four"],
        /// words of NV20
        nv20: Nv20Words<'a> [or "one of the four"],
        /// words [as text](languages/registers.md#words-as-text), in the layout of the profile's chip
        text: String [or "one of the four"],
        /// such a text in a file of the scene's folder
        file: String [or "one of the four"],
    }
    struct Nv10Words {
        /// lists, one word for each stage
        rc_in_alpha: List<'a, u32>, rc_in_rgb: List<'a, u32>,
        /// `[constant 0, constant 1]` of the program
        rc_color: List<'a, u32>,
        /// lists, one word for each stage; the second of `rc_out_rgb` also holds the number of stages and the like
        rc_out_alpha: List<'a, u32>, rc_out_rgb: List<'a, u32>,
        /// the final combiner
        rc_final0: u32, rc_final1: u32,
    }
    struct Nv20Words {
        /// lists, one word for each stage
        rc_in_alpha: List<'a, u32>, rc_in_rgb: List<'a, u32>,
        /// `[constant 0, constant 1]` of the final combiner
        rc_color: List<'a, u32>,
        /// lists, one word for each stage
        rc_constant_color0: List<'a, u32>, rc_constant_color1: List<'a, u32>, rc_out_alpha: List<'a, u32>, rc_out_rgb: List<'a, u32>,
        /// the final combiner
        rc_final0: u32, rc_final1: u32,
        /// number of stages and the like
        rc_config: u32,
    }
    struct Combiners "program" {
        /// `(c0, c1)`: constant colours of all stages and the final combiner
        constants: Tuple<'a, Color> [or "`((0, 0, 0, 0), (0, 0, 0, 0))`"],
        /// the bit of SPARE0's alpha that steers `mux` (CMB-10)
        mux_select: Name<state::MuxSelect> = MuxSelect::Msb,
        /// one to eight general stages, two on Nv10 (CMB-12)
        stages: List<'a, Stage<'a>> [required],
        /// the final combiner
        final_combiner: FinalCombiner<'a> [or "fog over SPARE0 + SECONDARY"],
    }
    struct TextureStages {
        /// list of stages, at most eight
        stages: List<'a, TextureStage<'a>> [or "stage 0 in its initial state"],
        /// the texture factor
        texture_factor: Color [or "of the text, or `(255, 255, 255, 255)`"],
        /// the specular colour is added at the end
        specular_enable: bool [or "of the text, or `false`"],
        /// instead of `stages`: calls or lines of an effect file, [pasted](languages/programs.md#as-pasted-text)
        text: String,
        /// instead: such a text in a file of the scene's folder
        file: String,
    }
    struct TextureStage {
        /// operation, `DotProduct3`
        color_op: Name<Operation> [or "stage 0 `Modulate`, others `Disable`"],
        /// `Diffuse`, `Current`, `Texture`, `TextureFactor`, `Specular`, `Temp`, `Constant`; with modifiers `(Diffuse, Complement)`,
        /// `(Texture, Complement, AlphaReplicate)`
        color_arg0: StageArgument [or "`Current`"], color_arg1: StageArgument [or "`Texture`"], color_arg2: StageArgument [or "`Current`"],
        /// operation of alpha
        alpha_op: Name<Operation> [or "stage 0 `SelectArg1`, others `Disable`"],
        /// as of the colour
        alpha_arg0: StageArgument [or "`Current`"], alpha_arg1: StageArgument [or "`Texture`"], alpha_arg2: StageArgument [or "`Current`"],
        /// where the result goes
        result_arg: Name<ResultArgument> = ResultArgument::Current,
        /// colour of `Constant`
        constant: Color [color] = [0; 4],
        /// set of texture coordinates of the unit, 0 to 3; or `CameraSpaceNormal`, `CameraSpacePosition`, `CameraSpaceReflectionVector`, `SphereMap` (TSH-11)
        texture_coordinate_index: Word [or "the stage's number"],
        /// `Disable`, `Count1` to `Count4`; with a division `(Count3, Projected)`. How the stage's coordinates meet the entry of its number in
        /// `texture_matrices`: see [there](languages/programs.md#direct3d-texture-stages). Where no stage has them the matrices apply as in any draw
        texture_transform_flags: TransformFlags [or "`Disable`"],
        /// `(m00, m01, m10, m11)` of `BumpEnvMap` and `BumpEnvMapLuminance` (Nv2a)
        bump_matrix: Numbers [or "`(0, 0, 0, 0)`" numbers 4..=4, "a bump matrix"],
        /// `(scale, offset)`
        bump_luminance: Numbers [or "`(0, 0)`" numbers 2..=2, "a bump luminance"],
    }
    struct PixelShader "pixel shader" {
        /// the shader
        text: String [or "one of the two"],
        /// instead: the shader in a file of the scene's folder
        file: String [required],
        /// table of constants, `{ "c0": Float(1, -0.5, 0, 1), "c1": (255, 128, 0) }`: floats limited to -1..1, bytes, or names of colours. What the shader
        /// defines itself goes before
        constants: Entries<'a, Color> [or "0, with a warning"],
        /// table of texture stage states for `texbem` and `texbeml`, by the register that they load: `{ "t1": (matrix: (m00, m01, m10, m11), luminance:
        /// (scale, offset)) }`
        bump: Entries<'a, BumpEnvironment<'a>> [or "required by these"],
    }
    struct TextureEnvironment {
        /// list of units, unit 0 first
        units: List<'a, EnvironmentUnit<'a>>,
        /// adds the secondary colour at the end
        color_sum: bool [or "of the text, or `false`"],
        /// in place of `units`: calls of glTexEnv, [pasted](languages/programs.md#as-pasted-calls)
        text: String,
        /// instead: such a text in a file of the scene's folder
        file: String,
    }
    struct EnvironmentUnit {
        /// what the unit does
        mode: Name<environment::Mode> = environment::Unit::initial().mode,
        /// the function; the dot products are of RGB
        combine_rgb: Name<environment::Function> [or "`Modulate`"], combine_alpha: Name<environment::Function> [or "`Modulate`"],
        /// `Texture`, `Texture0` to `Texture3`, `Constant`, `PrimaryColor`, `Previous`, `Zero`
        sources_rgb: List<'a, Name<environment::EnvironmentSource>> [or "`[Texture, Previous, Constant, Zero]`"],
        sources_alpha: List<'a, Name<environment::EnvironmentSource>> [or "`[Texture, Previous, Constant, Zero]`"],
        /// `SourceColor`, `OneMinusSourceColor`, `SourceAlpha`, `OneMinusSourceAlpha`
        operands_rgb: List<'a, Name<environment::Operand>>
            [or "`[SourceColor, SourceColor, SourceAlpha, OneMinusSourceColor]`"],
        /// the last two
        operands_alpha: List<'a, Name<environment::Operand>>
            [or "`[SourceAlpha, SourceAlpha, SourceAlpha, OneMinusSourceAlpha]`"],
        /// 1, 2 or 4
        scale_rgb: u32 [or "`1`"], scale_alpha: u32 [or "`1`"],
        /// the environment colour, `Constant`
        color: Color [color] = environment::Unit::initial().color,
        /// what the texture counts as
        base_format: Name<environment::BaseFormat> [or "of the texture's format"],
    }
    struct Stage {
        /// a portion; one that is left out writes nothing
        rgb: Portion<'a>, alpha: Portion<'a>,
        /// `(c0, c1)`: constant colours of this stage (Nv2a)
        constants: Tuple<'a, Color> [or "those of the program"],
    }
    struct Portion {
        /// inputs
        a: Input [or "`Zero`"], b: Input [or "`Zero`"], c: Input [or "`Zero`"], d: Input [or "`Zero`"],
        /// register for A B, for C D, for A B + C D; `Zero` is `Discard`, too
        ab: Output [or "`Discard`"], cd: Output [or "`Discard`"], sum: Output [or "`Discard`"],
        /// the product is a dot product (RGB only); `ab_dot` and `cd_dot` are read as well
        ab_dot_product: bool = false, cd_dot_product: bool = false,
        /// `sum` gets A B or C D, chosen by SPARE0's alpha
        mux: bool = false,
        /// results are multiplied
        scale: Name<state::Scale> = Scale::One,
        /// 0.5 is subtracted before, with scale `One` or `Two`
        bias: Name<state::Bias> = Bias::None,
        /// the blue result also becomes the alpha of that register (RGB only; Nv2a)
        ab_blue_to_alpha: bool = false, cd_blue_to_alpha: bool = false,
    }
    struct FinalCombiner {
        /// inputs, `Rgb` (default) or `Alpha`; A to D also read `Spare0PlusSecondary` and `ETimesF`
        a: FinalInput [or "`Zero`"], b: FinalInput [or "`Zero`"], c: FinalInput [or "`Zero`"], d: FinalInput [or "`Zero`"], e: FinalInput [or "`Zero`"],
        f: FinalInput [or "`Zero`"],
        /// `Alpha` (default) or `Blue` of a register
        g: FinalInput [or "`Spare0`"],
        /// SPARE0 + SECONDARY is limited to 1 (FIN-3)
        color_sum_clamp: bool = true,
        /// 1 - x enters that sum
        invert_spare0: bool = false, invert_secondary: bool = false,
        /// own constant colours (Nv2a)
        constants: Tuple<'a, Color> [or "those of the program"],
    }
}
