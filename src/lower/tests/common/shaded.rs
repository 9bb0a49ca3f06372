//! Draws a scene by its printed WGSL, and by its shaders of GLSL.

use std::collections::HashMap;
use std::fmt::Write;
use std::path::Path;
use std::process::Command;

use ninebit::engine::context::TriangleContext;
use ninebit::engine::walk::triangles;
use ninebit::engine::{TextureWords, cleared};
use ninebit::frame::Frames;
use ninebit::raster::stroke::Figure;
use ninebit_lower::{Field, Language, Setup, Shaders, with_all_levels};

use crate::drawn::Printed;
use crate::setting::{GLSL_COMPILER, bytes, drawing, run};

const HEAD: &str = "
struct Bounds { width: u32, height: u32, x: u32, y: u32, right: u32, bottom: u32, triangles: u32, unused: u32 }
@group(0) @binding(0) var<storage, read> bounds: Bounds;
@group(0) @binding(1) var<storage, read> triangles: array<NinebitTriangle>;
@group(0) @binding(2) var<storage, read> memory: array<u32>;
@group(0) @binding(3) var<storage, read_write> words: array<u32>;
@group(0) @binding(4) var<storage, read_write> depths: array<u32>;
fn ninebit_texel(unit: i32, at: i32) -> u32 { return memory[memory[unit] + u32(at)]; }
";

/// What the host of printed GLSL provides.
const GLSL_HEAD: &str = "
layout(std430, binding = 0) readonly buffer Memory { uint memory[]; };
layout(std430, binding = 1) readonly buffer Triangles { NinebitTriangle triangles[]; };
layout(std430, binding = 2) buffer Words { uint words[]; };
uint ninebit_texel(int unit, int at) { return memory[65536 * unit + at]; }
layout(local_size_x = 64) in;
";

impl Printed<'_> {
    /// Compiles the functions in GLSL.
    ///
    /// # Errors
    /// What the compiler says.
    pub fn validated(&self, folder: &Path) -> Result<(), String> {
        let mut text =
            format!("#version 430\n{}{GLSL_HEAD}void main()\n{{\n", Language::Glsl.print_whole(&self.named()).unwrap());
        text += "    NinebitTriangle triangle = triangles[0];\n    if (!ninebit_covers(triangle, 1, 2)) return;\n";
        for n in 0..self.draws.len() {
            let _ = writeln!(text, "    if (draw{n}(triangle, 1, 2, words[0], words[1])) words[2] = {n}u;");
        }
        std::fs::write(folder.join("whole.comp"), text + "}\n").unwrap();
        run(Command::new(GLSL_COMPILER).arg("whole.comp"), folder)
    }

    /// Returns whether the shader can draw it: triangles alone, in one window each.
    pub fn is_plain(&self) -> bool {
        self.plan.draws().iter().all(|draw| {
            let all = &draw.assembly.triangles;
            let plain = (0..all.len()).all(|n| all.figure(n) == Figure::Triangle);
            plain && draw.windows.len() <= 1 && draw.polygon_stipple.is_none()
        })
    }

    /// Returns how many times a pixel would be compared with a triangle.
    pub fn comparisons(&self) -> usize {
        let pixels = |target: usize| {
            let target = &self.plan.targets()[target];
            target.width as usize * target.height as usize
        };
        self.plan.draws().iter().map(|draw| draw.assembly.triangles.len() * pixels(draw.target)).sum()
    }

    fn wgsl_text(&self) -> String {
        let draws = self.named();
        let mut text = Language::Wgsl.print_whole(&draws).unwrap() + HEAD;
        for n in 0..draws.len() {
            let _ = write!(
                text,
                "@compute @workgroup_size(8, 8)\nfn main{n}(@builtin(global_invocation_id) id: vec3<u32>) {{\n    \
                 if id.x < bounds.x || id.y < bounds.y || id.x >= bounds.right || id.y >= bounds.bottom {{ return; }}\n    \
                 let at = id.y * bounds.width + id.x;\n    \
                 for (var n = 0u; n < bounds.triangles; n++) {{\n        \
                 if !ninebit_covers(triangles[n], i32(id.x), i32(id.y)) {{ continue; }}\n        \
                 let drawn = draw{n}(triangles[n], i32(id.x), i32(id.y), words[at], depths[at]);\n        \
                 words[at] = drawn.word;\n        depths[at] = drawn.depth;\n    }}\n}}\n"
            );
        }
        text
    }

    /// Draws by WebGPU.
    ///
    /// # Errors
    /// What the driver says.
    pub fn shaded(&self, folder: &Path) -> Result<Frames, String> {
        std::fs::write(folder.join("whole.wgsl"), self.wgsl_text()).unwrap();
        self.drawn(folder, "whole.py", None)
    }

    /// Draws by OpenGL, which rasterises.
    ///
    /// # Errors
    /// What the driver says.
    pub fn paired(&self, folder: &Path) -> Result<Frames, String> {
        for (n, draw) in self.named().iter().enumerate() {
            write_shaders(folder, n, Shaders::new(draw));
        }
        self.drawn(folder, "pair.py", None)
    }

    /// Draws by a script, with the state of each draw if one text draws all.
    ///
    /// # Errors
    /// What the driver says.
    pub fn drawn(&self, folder: &Path, script: &str, states: Option<&[Vec<u32>]>) -> Result<Frames, String> {
        let plan = self.plan;
        let mut frames = cleared(plan);
        let mut given = self.targets(&frames);
        for (number, draw) in plan.draws().iter().enumerate() {
            let before = self.before(number);
            let words = TextureWords::new(plan, &plan.draws()[number..=number], &before.surfaces);
            let window = draw.windows.first().map_or([0; 4], |w| [w.x, w.y, w.x + w.width, w.y + w.height]);
            let every = states.map(|_| (Setup::of_all(plan, draw), with_all_levels(plan, draw)));
            let (setup, sampled) = every.as_ref().map_or((&self.draws[number].1, draw), |(setup, draw)| (setup, draw));
            let (mut all, mut vertices) = (Vec::new(), Vec::new());
            for ((rows, _), n) in triangles(draw, (0, plan.targets()[draw.target].height.into())) {
                if let Some(context) = TriangleContext::new(plan, draw, n, rows) {
                    let number = vertices.len() as u32 / 9;
                    all.extend(triangle(&setup.constants(&context)));
                    vertices.extend(context.positions().iter().flat_map(|[x, y]| [*x as u32, *y as u32, number]));
                }
            }
            let mut memory = vec![0; 4];
            for (unit, words) in words.memories(sampled).iter().enumerate() {
                memory[unit] = memory.len() as u32;
                memory.extend(words.iter());
            }
            given.push(draw.target as u32);
            given.extend(window);
            let state = states.map(|states| states[number].clone()).unwrap_or_default();
            for part in [all, memory, vertices, state] {
                given.push(part.len() as u32);
                given.extend(part);
            }
        }
        std::fs::write(folder.join("draws.bin"), bytes(&given)).unwrap();
        run(&mut drawing(script), folder)?;
        self.read(folder, &mut frames);
        Ok(frames)
    }
}

/// Writes the shaders of a draw.
pub fn write_shaders(folder: &Path, draw: usize, Shaders { vertex, fragment }: Shaders) {
    std::fs::write(folder.join(format!("draw{draw}.vert")), vertex).unwrap();
    std::fs::write(folder.join(format!("draw{draw}.frag")), fragment).unwrap();
}

/// Returns the constants of a triangle in the layout of the printed structure.
fn triangle(constants: &HashMap<Field, i64>) -> Vec<u32> {
    let words = |field: Field| field.words(constants.get(&field).copied().unwrap_or(0));
    let out: Vec<u32> = Field::all().into_iter().flat_map(words).collect();
    assert_eq!(out.len(), 184);
    out
}
