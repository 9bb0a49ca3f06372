//! What may be written where: the fields of a scene file, as they are read.
//!
//! Every field is the unread text of a value ([`Raw`]). Fields are optional here; what happens to an absent one stands where it is
//! used, and in `docs/scene-format.md`. Variants (`Window(...)`, `File(...)`) are taken apart by their readers.

use super::literal::{Literal, Number};
use super::notation::{Notation, trim};
use super::outline::{Described, Form};
use super::raw::{Entries, Few, Numbers, Raw, Reserved, Tuple};
use super::reader::Name;
use crate::truth;
use ninebit::state;
use ninebit::vertex::fog::{FogEvaluation, FogSource};
use ninebit_program::texture_environment;
use ninebit_program::texture_stages::{Operation, ResultArgument};

/// Why a value is not what is expected.
pub(super) enum Mismatch<'a> {
    /// It is of another kind.
    Kind,
    /// It is a whole number, and too large or too small.
    Range,
    /// It has a field of this name, and may have these.
    Unknown(&'a str, &'static [&'static str]),
    /// It has a field of this name twice.
    Twice(&'a str),
}

/// What is read of a well-formed text.
pub(super) trait Expected<'a>: Sized {
    /// What it looks like, in the singular, with its article, for "expected ...".
    const EXPECTED: &'static str;

    /// Reads the text of a value, down to the next brackets inside it.
    ///
    /// # Errors
    /// The first reason why it is not what is expected.
    fn read(notation: &Notation<'a>, text: &'a str) -> Result<Self, Mismatch<'a>>;
}

macro_rules! expected {
    ($(<$life:lifetime $(, $of:ident)*> $type:ty: $expected:literal, |$notation:pat_param, $text:ident| $read:expr;)+) => {
        $(impl<$life $(, $of)*> Expected<$life> for $type {
            const EXPECTED: &'static str = $expected;
            fn read($notation: &Notation<$life>, $text: &$life str) -> Result<Self, Mismatch<$life>> {
                $read
            }
        })+
    };
}
expected! {
    <'a> String: "a text in double quotes", |_, text| {
        let literal = Literal::of(text).ok_or(Mismatch::Kind)?;
        Ok(literal.characters().map(|(character, _)| character).collect())
    };
    <'a> u8: "a whole number from 0 to 255", |_, text| number(text);
    <'a> u32: "a whole number from 0 to 4294967295", |_, text| number(text);
    <'a> f32: "a number", |_, text| number(text);
    <'a> Few<u8>: "one to four bytes in parentheses", |notation, text| few(notation, text);
    <'a> Numbers: "one to four numbers in parentheses", |notation, text| few(notation, text);
    <'a> bool: "`true` or `false`", |_, text| match text {
        "true" => Ok(true),
        "false" => Ok(false),
        _ => Err(Mismatch::Kind),
    };
    <'a> Vec<u32>: "a list of whole numbers, such as `[0, 1, 2]`", |notation, text| {
        items(notation, text, b'[')?.into_iter().map(number).collect()
    };
    <'a, T> Vec<Raw<'a, T>>: "a list in square brackets", |notation, text| {
        Ok(items(notation, text, b'[')?.into_iter().map(Raw::new).collect())
    };
    <'a, T> Tuple<'a, T>: "values in parentheses, such as `(1, 2, 3)`", |notation, text| {
        Ok(Tuple(items(notation, text, b'(')?.into_iter().map(Raw::new).collect()))
    };
    <'a, T> Entries<'a, T>: "a table in braces, such as `{ \"name\": ... }`", |notation, text| {
        let entries = notation.entries(text, b'{').ok_or(Mismatch::Kind)?;
        Ok(Entries(entries.into_iter().map(|(key, value)| (Raw::new(key), Raw::new(value))).collect()))
    };
}

fn items<'a>(notation: &Notation<'a>, text: &'a str, open: u8) -> Result<Vec<&'a str>, Mismatch<'a>> {
    notation.items(text, open).ok_or(Mismatch::Kind)
}

fn number<'a, N: Number>(text: &'a str) -> Result<N, Mismatch<'a>> {
    N::number(text).map_err(|()| Mismatch::Kind)?.ok_or(Mismatch::Range)
}

fn few<'a, N: Number>(notation: &Notation<'a>, text: &'a str) -> Result<Few<N>, Mismatch<'a>> {
    let items = items(notation, text, b'(')?;
    let mut values = [N::default(); 4];
    for (n, item) in items.iter().enumerate() {
        *values.get_mut(n).ok_or(Mismatch::Kind)? = number(item)?;
    }
    Ok(Few { values, count: items.len() })
}

/// The fields of a structure that are written, by their place in `names`. Before the parentheses may stand what it is called here.
fn fields<'a>(
    notation: &Notation<'a>,
    text: &'a str,
    called: &str,
    names: &'static [&'static str],
    mut field: impl FnMut(usize, &'a str),
) -> Result<(), Mismatch<'a>> {
    let inside = text.strip_prefix(called).map_or(text, trim);
    let mut written = vec![false; names.len()];
    for (name, value) in notation.entries(inside, b'(').ok_or(Mismatch::Kind)? {
        let index = names.iter().position(|known| *known == name).ok_or(Mismatch::Unknown(name, names))?;
        if std::mem::replace(&mut written[index], true) {
            return Err(Mismatch::Twice(name));
        }
        // As the notation has it, a field may say that it is not there, or that it is.
        let some = value.strip_prefix("Some").and_then(|rest| notation.items(trim(rest), b'('));
        match some.as_deref() {
            _ if value == "None" => {}
            Some([value]) => field(index, value),
            _ => field(index, value),
        }
    }
    Ok(())
}

macro_rules! source {
    ($($(#[$meta:meta])* struct $name:ident { $($field:ident : $type:ty),* $(,)? })+) => { $(
        $(#[$meta])*
        #[derive(Default)]
        pub(super) struct $name<'a> { $(pub(super) $field: Option<Raw<'a, $type>>),* }
        impl<'a> $name<'a> {
            /// The fields that are written, with their texts.
            #[allow(dead_code, reason = "asked of a few")]
            pub(super) fn written(&self) -> impl Iterator<Item = (&'static str, &'a str)> {
                [$((stringify!($field), self.$field.as_ref().map(|raw| raw.text))),*]
                    .into_iter()
                    .filter_map(|(name, text)| Some((name, text?)))
            }
        }
        impl<'a> Described for $name<'a> {
            fn form() -> Form {
                Form::Fields(|| vec![$((stringify!($field), <$type as Described>::form)),*])
            }
        }
        impl<'a> Expected<'a> for $name<'a> {
            const EXPECTED: &'static str = "fields in parentheses, `(field: value, ...)`";
            fn read(notation: &Notation<'a>, text: &'a str) -> Result<Self, Mismatch<'a>> {
                const NAMES: &[&str] = &[$(stringify!($field)),*];
                let mut values = [None; NAMES.len()];
                fields(notation, text, stringify!($name), NAMES, |index, value| values[index] = Some(value))?;
                let [$($field),*] = values;
                Ok($name { $($field: $field.map(Raw::new)),* })
            }
        }
    )+ };
}

/// A list of values.
pub(super) type List<'a, T> = Vec<Raw<'a, T>>;

/// A colour: bytes, `Float(...)`, or a name.
pub(super) struct Color;
/// A matrix, or a name.
pub(super) struct Matrix;
/// A mesh, or a name.
pub(super) struct MeshSource;
/// `Window(...)`, `Matrix(...)`, `Program(...)`.
pub(super) struct VertexSource;
/// A list of vertices, or a name.
pub(super) struct VertexList;
/// A pixel program, or a name.
pub(super) struct Program;
/// A blend function, or a name.
pub(super) struct BlendSource;
/// `File(...)`, `Texels(...)` and so on.
pub(super) struct ImageSource;
/// The state of a unit, or just the name of its texture.
pub(super) struct Unit;
/// A stage of the texture shader: its fields, or just its operation.
pub(super) struct ShaderStage;
/// What a stage of the texture shader does.
pub(super) struct ShaderOperation;
/// What of a mesh goes into a vertex.
pub(super) struct Attribute;
/// A constant of a vertex program: numbers, `Matrix(...)`, `Color(...)`.
pub(super) struct ShaderConstant;
/// How a coordinate set is made: `(s: ..., t: ...)`, a word, or `None`.
pub(super) struct CoordinateSource;
/// Where a component of a coordinate set comes from.
pub(super) struct Generator;
/// An input of a combiner portion.
pub(super) struct Input;
/// An input of the final combiner.
pub(super) struct FinalInput;
/// A destination of a combiner portion.
pub(super) struct Output;
/// Where the normals of a truth come from.
pub(super) struct NormalSource;
/// An argument of a texture stage.
pub(super) struct StageArgument;

/// `Count3`, or `(Count3, Projected)`.
pub(super) struct TransformFlags;
/// A word without further meaning to the types: one of a few.
pub(super) struct Word;

source! {
    /// The whole file.
    struct Scene {
        version: u32,
        profile: Name<state::Profile>,
        names: Names<'a>,
        targets: List<'a, Target<'a>>,
        textures: Entries<'a, Texture<'a>>,
        palettes: Entries<'a, List<'a, String>>,
        draws: List<'a, Draw<'a>>,
        truth: Truth<'a>,
        family: String,
    }
    /// What several scenes share, in a file of its own.
    struct Family {
        names: Names<'a>,
        targets: List<'a, Target<'a>>,
        truth: Truth<'a>,
    }
    /// What the picture ought to show.
    struct Truth {
        equation: Word,
        normal: NormalSource,
        lights: List<'a, TruthLight<'a>>,
        eye: TruthPlace<'a>,
        material: TruthMaterial<'a>,
        hemisphere: TruthHemisphere<'a>,
        color_map: String,
        shading_normal: ShadingNormal<'a>,
    }
    struct TruthLight { position: Numbers, direction: Numbers, color: Color }
    struct TruthPlace { position: Numbers, direction: Numbers }
    struct TruthMaterial {
        ambient: Color,
        diffuse: Color,
        specular: Color,
        exponent: u32,
        model: Name<truth::Model>,
        self_shadowing: bool,
    }
    struct TruthHemisphere {
        axis: Numbers,
        sky: Color,
        ground: Color,
        integral: Name<truth::Integral>,
        occlusion: HeightFile<'a>,
    }
    struct ShadingNormal { register: Name<state::Register>, unit: u32, space: Name<truth::Space> }
    struct RadialNormals { center: Numbers }
    struct HemisphereNormals { zero_outside: bool, size: u32, noise: f32, seed: u32 }
    struct HeightFile { file: String, scale: f32, channel: Word }
    /// Values that repeat.
    struct Names {
        vectors: Entries<'a, Numbers>,
        colors: Entries<'a, Color>,
        matrices: Entries<'a, Matrix>,
        vertices: Entries<'a, VertexList>,
        meshes: Entries<'a, MeshSource>,
        programs: Entries<'a, Program>,
        blends: Entries<'a, BlendSource>,
    }
    struct Target {
        name: String,
        width: u32,
        height: u32,
        format: Name<state::SurfaceFormat>,
        clear: Clear<'a>,
        contents: String,
        depth: Name<state::DepthFormat>,
        clip: Rectangle<'a>,
    }
    struct Clear { color: Color, depth: f32, stencil: u8 }
    /// A clear among the draws.
    struct ClearDraw { color: Color, color_mask: Tuple<'a, bool>, depth: f32, stencil: u8, rectangle: Rectangle<'a> }
    struct StencilTest {
        function: Name<state::CompareFunction>,
        reference: u8,
        mask: u8,
        write_mask: u8,
        fail: Name<state::StencilOperation>,
        depth_fail: Name<state::StencilOperation>,
        pass: Name<state::StencilOperation>,
    }
    struct ColorKey { color: Color, mode: Name<state::ColorKeyMode> }
    struct WindowClip { rectangles: List<'a, Rectangle<'a>>, exclusive: bool }
    struct Texture {
        kind: Word,
        format: Name<state::TextureFormat>,
        source: ImageSource,
        levels: Word,
        mips: List<'a, ImageSource>,
        palette: String,
        border: bool,
        first_level: u32,
    }
    struct RawFile { file: String, width: u32, height: u32, layers: u32 }
    struct Faces {
        positive_x: ImageSource,
        negative_x: ImageSource,
        positive_y: ImageSource,
        negative_y: ImageSource,
        positive_z: ImageSource,
        negative_z: ImageSource,
    }
    struct TexelRows { width: u32, height: u32, rows: List<'a, String> }
    struct SolidImage { width: u32, height: u32, color: Color }
    struct CheckerImage { width: u32, height: u32, cell: u32, colors: Tuple<'a, Color> }
    struct RampImage { width: u32, height: u32, from: Color, to: Color, axis: Word }
    struct Draw {
        name: String,
        target: String,
        vertices: VertexSource,
        indices: Vec<u32>,
        topology: Name<state::Topology>,
        shade_model: Name<state::ShadeModel>,
        provoking_vertex: Name<state::ProvokingVertex>,
        perspective: bool,
        cull: Name<state::Cull>,
        front_face: Name<state::FrontFace>,
        scissor: Rectangle<'a>,
        window_clip: WindowClip<'a>,
        fog: Fog<'a>,
        textures: List<'a, Unit>,
        program: Program,
        alpha_test: AlphaTest<'a>,
        depth_test: DepthTest<'a>,
        blend: BlendSource,
        blend_constant: Color,
        color_mask: Tuple<'a, bool>,
        dither: bool,
        stencil_test: StencilTest<'a>,
        clear: ClearDraw<'a>,
        logic_op: Reserved,
        texture_shader: List<'a, ShaderStage>,
        texgen: List<'a, CoordinateSource>,
        viewer: Word,
        texture_matrices: List<'a, Matrix>,
        truth: bool,
    }
    struct Vertex {
        position: Numbers,
        diffuse: Color,
        specular: Color,
        fog: f32,
        fog_coordinate: f32,
        normal: Numbers,
        t0: Numbers,
        t1: Numbers,
        t2: Numbers,
        t3: Numbers,
    }
    struct MatrixVertices {
        matrix: Matrix,
        model_view: Matrix,
        viewport: Viewport<'a>,
        vertices: VertexList,
        mesh: MeshSource,
        diffuse: Attribute,
        specular: Attribute,
        t0: Attribute,
        t1: Attribute,
        t2: Attribute,
        t3: Attribute,
    }
    struct ProgramVertices {
        text: String,
        file: String,
        constants: Entries<'a, ShaderConstant>,
        inputs: ShaderInputs<'a>,
        viewport: Viewport<'a>,
        clip_depth: Word,
        vertices: VertexList,
        mesh: MeshSource,
    }
    struct ShaderInputs {
        v0: Attribute,
        v1: Attribute,
        v2: Attribute,
        v3: Attribute,
        v4: Attribute,
        v5: Attribute,
        v6: Attribute,
        v7: Attribute,
        v8: Attribute,
        v9: Attribute,
        v10: Attribute,
        v11: Attribute,
        v12: Attribute,
        v13: Attribute,
        v14: Attribute,
        v15: Attribute,
    }
    struct Viewport { x: f32, y: f32, width: f32, height: f32, near: f32, far: f32, depth_clamp: bool }
    struct Grid { columns: u32, rows: u32, size: Numbers, repeat: Numbers }
    struct Sphere { slices: u32, stacks: u32, radius: f32, repeat: Numbers }
    struct Torus { slices: u32, sides: u32, radius: f32, tube: f32, repeat: Numbers }
    struct Cylinder { slices: u32, stacks: u32, radius: f32, height: f32, caps: bool, repeat: Numbers }
    struct Triangles { vertices: VertexList, indices: Vec<u32> }
    struct LightVector { position: Numbers, direction: Numbers, space: Word }
    struct HalfVector { position: Numbers, direction: Numbers, viewer: Numbers, space: Word }
    struct Frustum { left: f32, right: f32, bottom: f32, top: f32, near: f32, far: f32 }
    struct LookAt { eye: Numbers, center: Numbers, up: Numbers }
    struct Rectangle { x: u32, y: u32, width: u32, height: u32 }
    struct Fog {
        enabled: bool,
        color: Color,
        mode: Name<state::FogMode>,
        density: f32,
        start: f32,
        end: f32,
        parameters: Numbers,
        coordinate_source: Name<FogSource>,
        evaluation: Name<FogEvaluation>,
    }
    struct CoordinateSet { input: u32, s: Generator, t: Generator, r: Generator, q: Generator }
    struct Emboss { light: Numbers, scale: Numbers }
    struct UnitState {
        texture: String,
        palette: String,
        coordinates: u32,
        address: Name<state::AddressMode>,
        address_s: Name<state::AddressMode>,
        address_t: Name<state::AddressMode>,
        address_r: Name<state::AddressMode>,
        min_filter: Name<state::Filter>,
        mag_filter: Name<state::Filter>,
        mip_filter: Name<state::MipFilter>,
        border_color: Color,
        signed: Tuple<'a, bool>,
        lod_bias: f32,
        min_lod: f32,
        max_lod: f32,
        anisotropy: u32,
        cylindrical_wrap: Tuple<'a, bool>,
        color_key: ColorKey<'a>,
        shadow: ShadowComparison<'a>,
    }
    struct ShadowComparison { function: Name<state::CompareFunction>, reference: Name<state::ShadowReference> }
    struct StageState {
        operation: ShaderOperation,
        previous: u32,
        mapping: Name<state::DotMapping>,
        coordinates: u32,
    }
    struct CullFragment { s: Word, t: Word, r: Word, q: Word }
    struct BumpEnvironment { matrix: Numbers, luminance: Numbers }
    struct ConstantEye { eye: Numbers }
    struct AlphaTest { function: Name<state::CompareFunction>, reference: Word }
    struct DepthTest {
        function: Name<state::CompareFunction>,
        write: bool,
        vertex_depths: Name<state::VertexDepths>,
        w_buffer: bool,
        range: DepthRange<'a>,
        offset: PolygonOffset<'a>,
    }
    struct DepthRange { lowest: f32, highest: f32, clamp: bool, drop_triangles: bool }
    struct PolygonOffset { bias: f32, factor: f32 }
    struct Blend {
        equation: Name<state::BlendEquation>,
        source: Name<state::BlendFactor>,
        destination: Name<state::BlendFactor>,
    }
    struct ProgramFile { file: String }
    struct RegisterWords { nv10: Nv10Words<'a>, nv20: Nv20Words<'a>, text: String, file: String }
    struct Nv10Words {
        rc_in_alpha: List<'a, u32>,
        rc_in_rgb: List<'a, u32>,
        rc_color: List<'a, u32>,
        rc_out_alpha: List<'a, u32>,
        rc_out_rgb: List<'a, u32>,
        rc_final0: u32,
        rc_final1: u32,
    }
    struct Nv20Words {
        rc_in_alpha: List<'a, u32>,
        rc_in_rgb: List<'a, u32>,
        rc_color: List<'a, u32>,
        rc_constant_color0: List<'a, u32>,
        rc_constant_color1: List<'a, u32>,
        rc_out_alpha: List<'a, u32>,
        rc_out_rgb: List<'a, u32>,
        rc_final0: u32,
        rc_final1: u32,
        rc_config: u32,
    }
    struct Combiners {
        constants: Tuple<'a, Color>,
        mux_select: Name<state::MuxSelect>,
        stages: List<'a, Stage<'a>>,
        final_combiner: FinalCombiner<'a>,
    }
    struct TextureStages {
        stages: List<'a, TextureStage<'a>>,
        texture_factor: Color,
        specular_enable: bool,
        text: String,
        file: String,
    }
    struct TextureStage {
        color_op: Name<Operation>,
        color_arg0: StageArgument,
        color_arg1: StageArgument,
        color_arg2: StageArgument,
        alpha_op: Name<Operation>,
        alpha_arg0: StageArgument,
        alpha_arg1: StageArgument,
        alpha_arg2: StageArgument,
        result_arg: Name<ResultArgument>,
        constant: Color,
        texture_coordinate_index: Word,
        texture_transform_flags: TransformFlags,
        bump_matrix: Numbers,
        bump_luminance: Numbers,
    }
    struct PixelShader {
        text: String,
        file: String,
        constants: Entries<'a, Color>,
        bump: Entries<'a, BumpEnvironment<'a>>,
    }
    struct TextureEnvironment { units: List<'a, EnvironmentUnit<'a>>, color_sum: bool, text: String, file: String }
    struct EnvironmentUnit {
        mode: Name<texture_environment::Mode>,
        combine_rgb: Name<texture_environment::Function>,
        combine_alpha: Name<texture_environment::Function>,
        sources_rgb: List<'a, Name<texture_environment::EnvironmentSource>>,
        sources_alpha: List<'a, Name<texture_environment::EnvironmentSource>>,
        operands_rgb: List<'a, Name<texture_environment::Operand>>,
        operands_alpha: List<'a, Name<texture_environment::Operand>>,
        scale_rgb: u32,
        scale_alpha: u32,
        color: Color,
        base_format: Name<texture_environment::BaseFormat>,
    }
    struct Stage { rgb: Portion<'a>, alpha: Portion<'a>, constants: Tuple<'a, Color> }
    struct Portion {
        a: Input,
        b: Input,
        c: Input,
        d: Input,
        ab: Output,
        cd: Output,
        sum: Output,
        ab_dot: bool,
        cd_dot: bool,
        mux: bool,
        scale: Name<state::Scale>,
        bias: Name<state::Bias>,
        ab_blue_to_alpha: bool,
        cd_blue_to_alpha: bool,
    }
    struct FinalCombiner {
        a: FinalInput,
        b: FinalInput,
        c: FinalInput,
        d: FinalInput,
        e: FinalInput,
        f: FinalInput,
        g: FinalInput,
        color_sum_clamp: bool,
        invert_spare0: bool,
        invert_secondary: bool,
        constants: Tuple<'a, Color>,
    }
}

impl<'a> Truth<'a> {
    /// These fields, and where they are not written those of another.
    pub(super) fn or(self, other: Self) -> Self {
        Truth {
            equation: self.equation.or(other.equation),
            normal: self.normal.or(other.normal),
            lights: self.lights.or(other.lights),
            eye: self.eye.or(other.eye),
            material: self.material.or(other.material),
            hemisphere: self.hemisphere.or(other.hemisphere),
            color_map: self.color_map.or(other.color_map),
            shading_normal: self.shading_normal.or(other.shading_normal),
        }
    }
}

impl<'a> ShaderInputs<'a> {
    /// By their numbers.
    pub(super) fn list(self) -> [Option<Raw<'a, Attribute>>; 16] {
        let ShaderInputs { v0, v1, v2, v3, v4, v5, v6, v7, v8, v9, v10, v11, v12, v13, v14, v15 } = self;
        [v0, v1, v2, v3, v4, v5, v6, v7, v8, v9, v10, v11, v12, v13, v14, v15]
    }
}
