//! Declares the fields of a scene: targets, vertices, raster operations and the truth.

use super::*;
use crate::generate::{SIDES, hemisphere, normal_map};
use crate::truth::{self, LARGEST_EXPONENT};
use crate::vertex_column::VertexColumn;
use ninebit::state::{
    BlendEquation, BlendFactor, CompareFunction, Cull, FrontFace, LARGEST_SIZE, LineRasterization, PointRasterization,
    PolygonMode, ProvokingVertex, ShadeModel, StencilOperation, SurfaceFormat, Topology, VertexDepths,
};
use std::ops::RangeInclusive;

/// The help of four flags, which says what they stand for.
pub(super) const CHANNELS: &str = "they stand for red, green, blue and alpha: `(true, true, true, false)`";

/// Widths of lines and sizes of points.
const SIZES: RangeInclusive<u32> = 0..=LARGEST_SIZE as u32;

/// The help of a size that is out of range.
const NINE_BITS: &str = "the register has nine bits and counts eighths: 8 is one pixel, 511 are 63 7/8";

source! {
    /// The whole file.
    struct Scene "scene" {
        /// `1`
        version: u32 [or "required"],
        /// GeForce 256 or Xbox; what one of them lacks is refused there
        profile: Name<state::Profile> [required],
        /// [values used by name](#names)
        names: Names<'a>,
        /// list of [render targets](#targets)
        targets: List<'a, Target<'a>> [or "one, `\"frame\"`"],
        /// table of [textures](#textures)
        textures: Entries<'a, Texture<'a>>,
        /// table of [palettes](#palettes)
        palettes: Entries<'a, List<'a, String>>,
        /// list of [draws](#draws), drawn in the order of the text
        draws: List<'a, Draw<'a>>,
        /// [what the picture ought to show](#truth)
        truth: Truth<'a>,
        /// name of a [family file](#families): names, targets and truth that scenes share
        family: String,
    }
    /// What several scenes share, in a file of its own.
    struct Family {
        /// as in a scene
        names: Names<'a>, targets: List<'a, Target<'a>>, truth: Truth<'a>,
    }
    /// What the picture ought to show.
    struct Truth "truth" {
        /// `Lighting`; or of the mesh's s and t `SignedProduct`, (2s - 1)(2t - 1), or `Difference`, s - t; or `DotProduct(a, b)` of two interpolated
        /// vectors of the vertices, as long as they are: `PrimaryColor`, `SecondaryColor`, `T0` to `T3`. What is negative is 0. All but `Lighting` stand
        /// alone
        equation: Word [or "`Lighting`"],
        /// where the surface's normals come from, below
        normal: NormalSource [or "`Mesh`"],
        /// list of [lights](#lights)
        lights: List<'a, TruthLight<'a>> [or "this or `hemisphere` is required"],
        /// where it is seen from
        eye: TruthPlace<'a> [or "required for highlights"],
        /// what the surface is made of
        material: TruthMaterial<'a>,
        /// light from all around
        hemisphere: TruthHemisphere<'a> [or "none"],
        /// name of an image that multiplies everything, R, G and B, bilinear
        color_map: String [or "none"],
        /// what holds the technique's normals; then they are measured, too
        shading_normal: ShadingNormal<'a> [or "not measured"],
    }
    struct TruthLight {
        /// where the light is, or the direction toward it; one of the two
        position: Numbers, direction: Numbers,
        /// its colour
        color: Color [color] = [255; 4],
    }
    struct TruthPlace {
        /// of a local viewer, or the direction toward an infinite one
        position: Numbers, direction: Numbers,
    }
    struct TruthMaterial {
        /// colour that is there without light
        ambient: Color [color] = [0, 0, 0, 255],
        /// colour of diffuse light
        diffuse: Color [color] = [255; 4],
        /// colour of highlights
        specular: Color [color] = [0, 0, 0, 255],
        /// the power of highlights
        exponent: u32 [in 1..=LARGEST_EXPONENT, "the exponent of a highlight"] = 1,
        /// highlights by N.H, or by R.V with the reflected light
        model: Name<truth::Model> = truth::Model::Blinn,
        /// no highlight where N.L is not above 0
        self_shadowing: bool = false,
    }
    struct TruthHemisphere {
        /// toward the middle of the sky
        axis: Numbers [numbers 3..=3, "the axis of a sky"] = [0.0, 1.0, 0.0, 0.0],
        /// colour of the sky
        sky: Color [color] = [255; 4],
        /// colour of the ground
        ground: Color [color] = [0, 0, 0, 255],
        /// the share of the sky: `Simplified` 0.5 + 0.5 cos q, `Exact` 1 - 0.5 sin q above and 0.5 sin q below the horizon
        integral: Name<truth::Integral> = truth::Integral::Simplified,
        /// a [height field](#normals): what its texels see of the sky (`ninebit generate occlusion`), not rounded
        occlusion: HeightFile<'a>,
    }
    struct ShadingNormal "shading normal" {
        /// the register that holds the technique's normals when a pixel begins: `Texture0` to `Texture3`, `PrimaryColor`, `SecondaryColor`
        register: Name<state::Register> [required],
        /// instead: the unit of the texture shader that takes a dot product with the normal, of as many bits as its mapping reads
        unit: u32 [in 1..=3, "a texture unit"],
        /// where they stand
        space: Name<truth::Space> = truth::Space::Tangent,
    }
    struct RadialNormals {
        /// the point that they point away from
        center: Numbers [numbers 3..=3, "a centre"] = [0.0; 4],
    }
    struct HemisphereNormals {
        /// the zero vector outside the hemisphere
        zero_outside: bool = hemisphere::Options::default().zero_outside,
        /// columns and rows, with `noise`
        size: u32 [in SIDES, "the side of an image"] = hemisphere::Options::default().size,
        /// as of `ninebit generate hemisphere-normals`
        noise: f32 [or "exact at every point"],
        /// of the noise
        seed: u32 = 1,
    }
    struct HeightFile "height field" {
        /// an image in the scene's folder
        file: String [required],
        /// the height of the brightest texel, in texels
        scale: f32 = normal_map::Options::default().scale as f32,
        /// the channel that holds heights
        channel: Word [one of "channel of heights": "Red", "Alpha"],
    }
    /// Values that repeat.
    struct Names {
        /// one to four numbers, `(0, 0.6, 0.8)`; used wherever such numbers stand: `LightVector(direction: "sun")`, `c12: "sun"`, `Vector("sun")`
        vectors: Entries<'a, Numbers>,
        /// a [colour](#colours), or the name of another; wherever a colour stands
        colors: Entries<'a, Color>,
        /// a [matrix](#matrices); names of others may stand in it; used in `matrix`, `Product`
        matrices: Entries<'a, Matrix>,
        /// a list of [vertices](#vertices), or a file of them; used in `Window("...")` and as `vertices` in `Matrix`, `Program`, `Triangles`
        vertices: Entries<'a, VertexList>,
        /// a [mesh](#meshes); used as `mesh` in `Matrix`, `Program`
        meshes: Entries<'a, MeshSource>,
        /// a [pixel program](#pixel-programs); used as `program`
        programs: Entries<'a, Program>,
        /// a [blend function](#blending); used as `blend`
        blends: Entries<'a, BlendSource>,
    }
    struct Target "target" {
        /// for `target` and `Target("...")`
        name: String [or "`\"frame\"` for the first, else required"],
        /// columns
        width: u32 [up to target_side, "NB0606", "the width of a target"] = 640,
        /// rows
        height: u32 [up to target_side, "NB0606", "the height of a target"] = 480,
        /// [surface format](#surface-formats)
        format: Name<state::SurfaceFormat> = SurfaceFormat::A8R8G8B8,
        /// what the target holds before the first draw
        clear: Clear<'a>,
        /// name of a [texture](#textures) whose words the target holds before the first draw, in place of the clear's colour: one picture of one level, of
        /// as many columns and rows, texels of as many bytes
        contents: String [or "none"],
        /// name of a texture of depths whose words the depth buffer holds before the first draw, in place of the clear's depth and stencil: of its own
        /// format, one picture of as many columns and rows
        depth_contents: String [or "none"],
        /// depth buffer; those that end in S8 have a stencil as well. On Nv2a also those with F, which hold floats (DEP-3)
        depth: Name<state::DepthFormat> [or "none"],
        /// a [rectangle](#rectangles) within the target: no draw touches pixels outside (CLP-2)
        clip: Rectangle<'a> [or "whole target"],
    }
    struct Clear {
        /// what the colours become
        color: Color [color] = [0, 0, 0, 255],
        /// or the stored word, `0x7f3c2c1c`, of the format's bits (CLR-1)
        word: u32 [or "`color`"],
        /// the depths, 0 to 1, of a float buffer 0 or more
        depth: f32 [or "all ones"],
        /// or the stored word, without a stencil
        depth_word: u32 [or "`depth`"],
        /// the stencils
        stencil: u8 [or "`0`"],
    }
    /// A clear among the draws.
    struct ClearDraw {
        /// what the colours become
        color: Color [or "they stay"],
        /// or the word that is stored, `0x7f3c2c1c`, of the format's bits (CLR-1)
        word: u32 [or "`color`"],
        /// `(red, green, blue, alpha)`: which of them
        color_mask: Tuple<'a, bool> [flags "four", help(CHANNELS)] = [true; 4],
        /// what the depths become, 0 to 1, of a float buffer 0 or more
        depth: f32 [or "they stay"],
        /// or the word that is stored, without a stencil; of a float buffer one whose exponent is not 0
        depth_word: u32 [or "`depth`"],
        /// what the stencils become
        stencil: u8 [or "they stay"],
        /// a [rectangle](#rectangles) within the target: where
        rectangle: Rectangle<'a> [or "whole target"],
    }
    struct StencilTest {
        /// how the reference compares with the stored stencil
        function: Name<state::CompareFunction> = CompareFunction::Always,
        /// compared, and written by `Replace`
        reference: u8 = 0,
        /// the bits that are compared
        mask: u8 = 255,
        /// the bits that are written
        write_mask: u8 = 255,
        /// what the stencil becomes where this test fails, where the depth test fails, and where both pass
        fail: Name<state::StencilOperation> = StencilOperation::Keep, depth_fail: Name<state::StencilOperation> = StencilOperation::Keep,
        pass: Name<state::StencilOperation> = StencilOperation::Keep,
    }
    struct WindowClip "window clip" {
        /// one to eight [rectangles](#rectangles), which may reach outside the target
        rectangles: List<'a, Rectangle<'a>> [required],
        /// `true`: pixels inside none are drawn, in place of those inside any
        exclusive: bool = false,
    }
    struct Draw "draw" {
        /// for messages and traces; no two alike
        name: String [or "`\"draw N\"`, N from 0"],
        /// name of the render target
        target: String [or "the first"],
        /// [where they come from](#vertex-sources)
        vertices: VertexSource [required],
        /// whole numbers, each below the number of vertices
        indices: Vec<u32> [or "every vertex once, in order"],
        /// how vertices make triangles (RAS-4): `Triangles`, `TriangleStrip`, `TriangleFan`, `Quads`, `QuadStrip`, `Polygon`; lines or points (LIN-1, PNT-1): `Lines`, `LineStrip`, `LineLoop`, `Points`
        topology: Name<state::Topology> = Topology::Triangles,
        /// colours interpolated, or those of one vertex
        shade_model: Name<state::ShadeModel> = ShadeModel::Smooth,
        /// which vertex gives a flat triangle its colours (RAS-5)
        provoking_vertex: Name<state::ProvokingVertex> = ProvokingVertex::Last,
        /// colours and coordinates are interpolated in perspective; `false`: linear on screen (WGT-1)
        perspective: bool = true,
        /// faces not drawn
        cull: Name<state::Cull> = Cull::None,
        /// winding of front faces as seen on screen
        front_face: Name<state::FrontFace> = FrontFace::CounterClockwise,
        /// what is drawn of front faces, and of the others: pixels, edges or corners (POL-1)
        front_polygon_mode: Name<state::PolygonMode> = PolygonMode::Fill, back_polygon_mode: Name<state::PolygonMode> = PolygonMode::Fill,
        /// numbers of the vertices whose edge flag is off: the edge from each to the next vertex of a triangle, quad or polygon is not drawn
        hidden_edges: Vec<u32> [or "all are drawn"],
        /// 32 words, `0xff00ff00`, the last of the top row: where a bit is 0, filled triangles have no pixel (STP-1)
        polygon_stipple: Vec<u32> [or "none"],
        /// filled triangles with smooth edges, one by one (SMO-1)
        smooth_polygons: bool = false,
        /// width of lines in 1/8 pixel; 0 draws none (LIN-1)
        line_width: u32 [in SIZES, "a line width", rule("LIN-1"), help(NINE_BITS)] = 8,
        /// how lines become pixels: rectangles, one pixel for each step of the longer axis, whatever the width (LIN-2), or rectangles with smooth edges (SMO-1)
        line_rasterization: Name<state::LineRasterization> = LineRasterization::Rectangular,
        /// size of points in 1/8 pixel (PNT-1)
        point_size: u32 [in SIZES, "a point size", rule("PNT-1"), help(NINE_BITS)] = 8,
        /// how points become pixels: squares, or one pixel each, whatever the size (PNT-1)
        point_rasterization: Name<state::PointRasterization> = PointRasterization::Rectangular,
        /// [the size of each point](#point-parameters) by its distance from the viewer, or the vertex program's oPts.x in pixels (PNT-3)
        point_parameters: PointParameters<'a> [or "`point_size`"],
        /// Nv2a only: over each point s and t of unit 3 run from 0 to 1 (PNT-2)
        point_sprite: bool = false,
        /// a [rectangle](#rectangles) within the target; 0 columns or rows draw nothing (CLP-2)
        scissor: Rectangle<'a> [or "whole target"],
        /// [rectangles](#rectangles) inside which pixels are drawn (CLP-1)
        window_clip: WindowClip<'a> [or "everywhere"],
        /// [fog](#fog): `(mode: Linear, start: 10, end: 50, color: (128, 128, 128))`
        fog: Fog<'a> [or "off, black"],
        /// list of [units](#texture-units), unit 0 first
        textures: List<'a, Unit> [or "none"],
        /// Nv2a only: R, G and B of all units become those of the Y, Cb and Cr that they yield (TEX-19)
        convert_yuv: bool = false,
        /// [pixel program](#pixel-programs)
        program: Program [or "the colours of the vertices, with fog"],
        /// keeps fragments by their [alpha](#alpha-test)
        alpha_test: AlphaTest<'a> [or "every fragment"],
        /// keeps fragments by their [depth](#depths), and stores it; the target needs a depth buffer
        depth_test: DepthTest<'a> [or "no test, no write"],
        /// [how colours are mixed](#blending) with what is stored, or a name
        blend: BlendSource [or "replaces"],
        /// colour for the blend's factors
        blend_constant: Color [color] = [0; 4],
        /// `(red, green, blue, alpha)`: what is written
        color_mask: Tuple<'a, bool> [flags "four", help(CHANNELS)] = [true; 4],
        /// only `false`: what the chip does is not known (ROP-7)
        dither: bool = false,
        /// keeps fragments by the stored [stencil](#stencil-test), and changes it; the target needs one
        stencil_test: StencilTest<'a> [or "no test, no write"],
        /// this entry is a [clear](#clears), not a draw
        clear: ClearDraw<'a>,
        /// *reserved*
        logic_op: ReservedValue,
        /// what the units do besides sampling, Nv2a only: list of [stages](#texture-shader)
        texture_shader: List<'a, ShaderStage> [or "each unit with a texture samples it"],
        /// [generated texture coordinates](#generated-texture-coordinates)
        texgen: List<'a, CoordinateSource> [or "coordinates as they are given"],
        /// where reflections are seen from: `Local`, the origin of eye space; `Infinite`, far away, looking along -z; `Infinite(x, y, z)`, along that
        /// direction of eye space
        viewer: ViewerWord = ninebit::vertex::Viewer::Local,
        /// a [matrix](#matrices) for each [coordinate set](#generated-texture-coordinates)
        texture_matrices: List<'a, Matrix> [or "coordinates as they are given"],
        /// `false`: the scene's [truth](#truth) says nothing of this draw
        truth: bool [or "`true`"],
    }
    struct Vertex "vertex" {
        /// `(x, y)`, `(x, y, z)` or `(x, y, z, w)` (RAS-0); z is 0, w is 1 where they are not written
        position: Numbers [required],
        /// primary colour
        diffuse: Color [color] = [255; 4],
        /// secondary colour
        specular: Color [color] = [0; 4],
        /// fog factor where fog has no `mode`: 0 is all fog, 1 is none
        fog: f32 [in 0.0..=1.0, "a fog factor", rule("NUM-6"), help("write 0.0 (all fog) to 1.0 (no fog)")] = 1.0,
        /// where a [fog function](#fog) is evaluated, `inf` and `NaN` too
        fog_coordinate: f32 [any] = 0.0,
        /// instead of both, of `Window` and `Matrix`: what the vertex passes on as its fog, a factor that may leave 0 to 1, d' or e (FOG-2, FOG-3)
        passed_fog: f32 [or "computed"],
        /// of its point, in 1/8 pixel (PNT-3), of `Window` and `Matrix`; not beside `point_parameters`
        point_size: u32 [or "that of the draw" in SIZES, "a point size", rule("PNT-3"), help(NINE_BITS)],
        /// `(x, y, z)` in object space, of any length, for generated coordinates
        normal: Numbers [numbers 3..=3, "a normal"] = [0.0; 4],
        /// texture coordinates `(s)`, `(s, t)`, `(s, t, r)` or `(s, t, r, q)`; 1 is the whole texture
        t0: Numbers [or "`(0, 0, 0, 1)`"], t1: Numbers [or "`(0, 0, 0, 1)`"], t2: Numbers [or "`(0, 0, 0, 1)`"], t3: Numbers [or "`(0, 0, 0, 1)`"],
    }
    struct RawVertices "vertex list" {
        /// a file in the scene's folder: 32-bit words, little-endian, vertex after vertex
        file: String [required],
        /// what the words of a vertex are, in order: `Position`, `Diffuse`, `Specular`, `T0` to `T3`, four floats each; `DiffuseBytes`, `SpecularBytes`, four
        /// bytes; `Fog`, `FogCoordinate`, `PassedFog`, a float; `PointSize`, a whole number
        columns: List<'a, Name<VertexColumn>> [required],
    }
    struct MatrixVertices "vertex source" {
        /// a [matrix](#matrices) from object to clip space
        matrix: Matrix [required],
        /// a matrix from object to eye space, for generated coordinates and fog alone; positions are multiplied by `matrix`
        model_view: Matrix [or "`Identity`"],
        /// the part of the target that clip space maps to
        viewport: Viewport<'a> [or "the whole target"],
        /// depths that clip space has before division by w, as of OpenGL's projections or as of Direct3D's
        clip_depth: Word [one of "range of depths in clip space": "MinusOneToOne", "ZeroToOne"],
        /// a list of vertices, or the name of one
        vertices: VertexList [or "one of the two"],
        /// a [mesh](#meshes), or the name of one
        mesh: MeshSource [or "one of the two"],
        /// for a mesh: a colour for all vertices, or an attribute: a vector v becomes the colour 0.5 + 0.5 v
        diffuse: Attribute [or "`(255, 255, 255, 255)`"], specular: Attribute [or "`(0, 0, 0, 0)`"],
        /// for a mesh: `(s, t, r, q)` for all vertices, or an attribute
        t0: Attribute [or "`TextureCoordinates`"], t1: Attribute [or "`TextureCoordinates`"], t2: Attribute [or "`TextureCoordinates`"],
        t3: Attribute [or "`TextureCoordinates`"],
    }
    struct ProgramVertices {
        /// the program; one of several lines is written `r#"..."#`
        text: String [or "one of the two"],
        /// instead: a file in the scene's folder
        file: String [or "one of the two"],
        /// `{ c0: ..., c8: ... }`: values of constants
        constants: Entries<'a, ShaderConstant> [or "none"],
        /// `(v0: ..., v8: ...)`: what input registers hold
        inputs: ShaderInputs<'a>
            [or "v0 `Position`, v3 `Normal`, v7 `TextureCoordinates`; of listed vertices v5 `Diffuse`, v6 `Specular`"],
        /// as in `Matrix`
        viewport: Viewport<'a> [or "the whole target"],
        /// as in `Matrix`
        clip_depth: Word [one of "range of depths in clip space": "MinusOneToOne", "ZeroToOne"],
        /// what it runs over, as in `Matrix`
        vertices: VertexList [or "one of the two"], mesh: MeshSource [or "one of the two"],
    }
    struct ShaderInputs {
        /// what the register holds
        v0: Attribute, v1: Attribute, v2: Attribute, v3: Attribute, v4: Attribute, v5: Attribute, v6: Attribute, v7: Attribute, v8: Attribute,
        v9: Attribute, v10: Attribute, v11: Attribute, v12: Attribute, v13: Attribute, v14: Attribute, v15: Attribute,
    }
    struct Viewport {
        /// of its first column and row, in pixels
        x: f32 = 0.0, y: f32 = 0.0,
        /// above 0
        width: f32 [or "the target's"], height: f32 [or "the target's"],
        /// the depths of the near and the far plane
        near: f32 [in 0.0..=1.0, "a depth", help("write 0.0 (near) to 1.0 (far)")] = 0.0,
        far: f32 [in 0.0..=1.0, "a depth", help("write 0.0 (near) to 1.0 (far)")] = 1.0,
        /// limits depths to 0..1 instead of [clipping](#clipping) at near and far
        depth_clamp: bool = false,
    }
    struct Grid "grid" {
        /// cells in the xy plane, facing +z, centred
        columns: u32 [required value], rows: u32 [required value],
        /// `(width, height)`
        size: Numbers [numbers 2..=2, "the size of a grid"] = [2.0, 2.0, 0.0, 0.0],
        /// how often the texture fits along s and t
        repeat: Numbers [numbers 2..=2, "the repeat of a texture"] = [1.0, 1.0, 0.0, 0.0],
    }
    struct Cuboid "box" {
        /// `(width, height, depth)`, centred on the origin; each face has its own normal and vertices
        size: Numbers [numbers 3..=3, "the size of a box"] = [2.0, 2.0, 2.0, 0.0],
        /// as of a grid, on each face; upright seen from outside, on top and bottom for a viewer who looks along the axis
        repeat: Numbers [numbers 2..=2, "the repeat of a texture"] = [1.0, 1.0, 0.0, 0.0],
    }
    struct Sphere "sphere" {
        /// about the origin, poles on the y axis, at least 3 slices and 2 stacks
        slices: u32 [required value], stacks: u32 [required value],
        /// the radius
        radius: f32 = 1.0,
        /// as of a grid
        repeat: Numbers [numbers 2..=2, "the repeat of a texture"] = [1.0, 1.0, 0.0, 0.0],
    }
    struct Torus "torus" {
        /// about the y axis
        slices: u32 [required value], sides: u32 [required value],
        /// to the middle of the tube
        radius: f32 = 1.0,
        /// the tube's own radius
        tube: f32 = 0.375,
        /// as of a grid
        repeat: Numbers [numbers 2..=2, "the repeat of a texture"] = [1.0, 1.0, 0.0, 0.0],
    }
    struct Cylinder "cylinder" {
        /// about the y axis, centred
        slices: u32 [required value], stacks: u32 [required value],
        /// the radius
        radius: f32 = 1.0,
        /// the height
        height: f32 = 2.0,
        /// with its ends closed
        caps: bool = true,
        /// as of a grid
        repeat: Numbers [numbers 2..=2, "the repeat of a texture"] = [1.0, 1.0, 0.0, 0.0],
    }
    struct Triangles "mesh" {
        /// listed vertices, or the name of a list: position, `normal` and `t0`
        vertices: VertexList [required],
        /// three for each triangle
        indices: Vec<u32> [or "each vertex once"],
    }
    struct LightVector {
        /// of a lamp, or the direction toward a light far away; one of the two
        position: Numbers, direction: Numbers,
        /// along tangent, binormal and normal, or as the vertices
        space: Word [one of "space": "Tangent", "Object"],
    }
    struct HalfVector "half vector" {
        /// of the light, as above
        position: Numbers, direction: Numbers,
        /// the viewer's position
        viewer: Numbers [required numbers 3..=3, "the viewer's position"],
        /// as above
        space: Word [one of "space": "Tangent", "Object"],
    }
    struct Frustum "projection" {
        /// the window's edges, at the distance `near`
        left: f32 [required value], right: f32 [required value], bottom: f32 [required value], top: f32 [required value],
        /// nothing nearer or farther is drawn: it is [clipped](#clipping); of `Frustum` above 0
        near: f32 [required value], far: f32 [required value],
    }
    struct Perspective "projection" {
        /// the angle from bottom to top that is seen, in degrees, below 180
        fov: f32 [required value],
        /// the window's width divided by its height
        aspect: f32 [required value],
        /// as of a frustum, above 0
        near: f32 [required value], far: f32 [required value],
    }
    struct LookAt "view" {
        /// where the viewer is, and what is in the middle
        eye: Numbers [required numbers 3..=3, "eye"], center: Numbers [required numbers 3..=3, "center"],
        /// upward
        up: Numbers [numbers 3..=3, "up"] = [0.0, 1.0, 0.0, 0.0],
    }
    struct Rectangle {
        /// of its first column and row, pixels from the top left
        x: u32 = 0, y: u32 = 0,
        /// columns and rows, at most 65535
        width: u32 [required], height: u32 [required],
    }
    struct AlphaTest "alpha test" {
        /// how alpha compares with the reference
        function: Name<state::CompareFunction> [required],
        /// a byte; of a greater number the low eight bits count, and a warning says so. Or `Float(0.5)`, which becomes a byte as constants do
        reference: AlphaReference = 0,
    }
    struct DepthTest {
        /// how a fragment's depth compares with the stored one
        function: Name<state::CompareFunction> = CompareFunction::Less,
        /// whether it is stored
        write: bool = true,
        /// z of a vertex is 0 to 1, of a fixed-point buffer in all; or it counts the buffer's last bits, with a fraction and beyond the buffer too, as the
        /// rasteriser gets it (DEP-1), only of `Window` positions. A float buffer holds z itself in both
        vertex_depths: Name<state::VertexDepths> = VertexDepths::Fractions,
        /// the buffer holds w in place of z, in its own steps (DEP-6): limits of `range` are of w, and `offset` has no factor
        w_buffer: bool = false,
        /// depths that are drawn
        range: DepthRange<'a> [or "all; the conversion limits them"],
        /// what is added to a triangle's depths (DEP-5)
        offset: PolygonOffset<'a> [or "none"],
    }
    struct DepthRange "depth range" {
        /// limits, in steps: pixels outside are dropped (DEP-4)
        lowest: f32 [required], highest: f32 [required],
        /// they are moved to the limit instead
        clamp: bool = false,
        /// a triangle goes whose vertices lie beyond the same limit
        drop_triangles: bool = false,
    }
    struct PolygonOffset {
        /// added, in steps
        bias: f32 = 0.0,
        /// of the steeper slope
        factor: f32 = 0.0,
    }
    struct Blend {
        /// what is done with the two products; the signed ones on Nv2a
        equation: Name<state::BlendEquation> = BlendEquation::Add,
        /// of the fragment, and of what is stored
        source: Name<state::BlendFactor> = BlendFactor::One, destination: Name<state::BlendFactor> = BlendFactor::Zero,
    }
}
