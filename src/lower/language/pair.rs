//! Prints a draw as a vertex and a fragment shader, for hosts that rasterise.

use super::*;

/// The shaders of a draw in GLSL 4.50; with another first line they are GLSL ES 3.10.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Shaders {
    /// The vertex shader. It takes snapped vertices (RAS-1), each with the number of its triangle.
    pub vertex: String,
    /// The fragment shader: what the surface and its depth buffer hold afterwards.
    pub fragment: String,
}

const VERSION: &str = "#version 450
// For GLSL ES 3.10 the first line is #version 310 es.
";

const VERTEX: &str = "precision highp int;
precision highp float;

// Columns and rows of the surface.
layout(location = 0) uniform ivec2 ninebit_size;
// Column and row of a vertex in 1/16 pixel (RAS-1), and the number of its triangle.
layout(location = 0) in ivec3 ninebit_vertex;
layout(location = 0) flat out int ninebit_number;

// Row 0 of the surface is row 0 of the framebuffer.
void main()
{
    gl_Position = vec4(vec2(ninebit_vertex.xy) / vec2(8 * ninebit_size) - 1.0, 0.0, 1.0);
    ninebit_number = ninebit_vertex.z;
}
";

const FETCH: &str = "// NINEBIT_FETCH: held words come by framebuffer fetch, otherwise from copies of the surfaces.
#ifdef NINEBIT_FETCH
#extension GL_EXT_shader_framebuffer_fetch : require
#endif
";

/// The constants of triangles.
pub(crate) const TRIANGLES: &str = "
layout(std430, binding = 0) readonly buffer NinebitTriangles { NinebitTriangle ninebit_triangles[]; };
";

/// What a fragment shader reads besides. Texture memory begins with the words at which the units' memories begin.
const BINDINGS: &str = "// The first four words say where the memory of each unit begins.
layout(std430, binding = 1) readonly buffer NinebitMemory { uint ninebit_memory[]; };
uint ninebit_texel(int unit, int at) { return ninebit_memory[ninebit_memory[unit] + uint(at)]; }
layout(location = 0) flat in int ninebit_number;
";

impl Shaders {
    /// Prints the shaders of a draw.
    pub fn new(draw: &Draw<'_>) -> Shaders {
        let text = Language::Glsl.print_whole(std::slice::from_ref(draw)).unwrap_or_default() + TRIANGLES;
        let call = format!("{}(ninebit_triangles[ninebit_number]", draw.name);
        Shaders::from_text(&text, &call, surfaces(draw.function))
    }

    /// Prints shaders by a text for every draw, which declares the constants of triangles, and the beginning of a call of its function.
    pub(crate) fn of_every_draw(text: &str, call: &str) -> Shaders {
        let both = [("word", "words"), ("depth", "depths")];
        Shaders::from_text(text, call, both.map(|(one, all)| Surface { one, all, read: true, written: true }))
    }

    fn from_text(text: &str, call: &str, surfaces: [Surface; 2]) -> Shaders {
        let each = |of: &dyn Fn(usize, &Surface) -> String| -> String {
            surfaces.iter().enumerate().map(|(n, surface)| of(n, surface)).collect()
        };
        let output = |n: usize, kind: &str, one: &str| {
            format!("layout(location = {n}) {kind} highp uint ninebit_stored_{one};\n")
        };
        let sampler =
            |n: usize, all: &str| format!("layout(binding = {n}) uniform highp usampler2D ninebit_held_{all};\n");
        let sampled = |one: &str, all: &str| format!("    uint {one} = texelFetch(ninebit_held_{all}, at, 0).x;\n");
        // A driver may lose words that are fetched and stored as they are, so only what changes is fetched.
        let kept = each(&|n, s| if s.read && !s.written { sampler(n, s.all) } else { String::new() });
        let fetched = each(&|n, s| if s.written { output(n, "inout", s.one) } else { String::new() });
        let copied = each(&|n, s| if s.written { sampler(n, s.all) + &output(n, "out", s.one) } else { String::new() });
        let read = each(&|_, s| match (s.read, s.written) {
            (_, true) => format!("    uint {0} = ninebit_stored_{0};\n", s.one),
            (true, false) => sampled(s.one, s.all),
            (false, false) => format!("    uint {} = 0u;\n", s.one),
        });
        let looked_up = each(&|_, s| {
            if s.read || s.written { sampled(s.one, s.all) } else { format!("    uint {} = 0u;\n", s.one) }
        });
        let written =
            each(&|_, s| if s.written { format!("    ninebit_stored_{0} = {0};\n", s.one) } else { String::new() });
        let fragment = format!(
            "{VERSION}{FETCH}{text}{BINDINGS}{kept}#ifdef NINEBIT_FETCH\n{fetched}#else\n{copied}#endif

// NINEBIT_COVERS: RAS-2 and RAS-3 are computed here; what is drawn has to cover the triangle.
void main()
{{
    ivec2 at = ivec2(gl_FragCoord.xy);
#ifdef NINEBIT_COVERS
    if (!ninebit_covers(ninebit_triangles[ninebit_number], at.x, at.y)) discard;
#endif
#ifdef NINEBIT_FETCH
{read}#else
{looked_up}#endif
    {call}, at.x, at.y, word, depth);
{written}}}
"
        );
        Shaders { vertex: format!("{VERSION}{VERTEX}"), fragment }
    }
}

/// A surface of words: that of colours, or the depth buffer.
struct Surface {
    /// Name of one word.
    one: &'static str,
    /// Name of all words.
    all: &'static str,
    read: bool,
    written: bool,
}

/// Returns how a function uses the surface and its depth buffer.
fn surfaces(function: &Function) -> [Surface; 2] {
    let inputs = function.inputs();
    let (word, depth) = match function.result {
        Result::Pixel { word, depth, .. } => (Some(word), depth),
        Result::Fragment(_) | Result::Stored { .. } => (None, None),
    };
    let is_held =
        |word: Operand| word.line().is_some_and(|line| function.lines[line].operation == Operation::Input(Input::Held));
    [
        Surface {
            one: "word",
            all: "words",
            read: inputs.contains(&Input::Held),
            written: word.is_some_and(|word| !is_held(word)),
        },
        Surface { one: "depth", all: "depths", read: inputs.contains(&Input::Depth), written: depth.is_some() },
    ]
}
