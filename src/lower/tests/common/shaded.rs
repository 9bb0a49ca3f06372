//! Draws a scene by its printed WGSL.

use std::collections::HashMap;
use std::fmt::Write;
use std::path::Path;

use ninebit::engine::context::TriangleContext;
use ninebit::engine::walk::triangles;
use ninebit::engine::{TextureWords, cleared};
use ninebit::frame::Frames;
use ninebit::raster::stroke::Figure;
use ninebit_lower::{Draw, Field, Language, Part};

use crate::drawn::Printed;
use crate::setting::{bytes, drawing, run};

const HEAD: &str = "
struct Bounds { width: u32, height: u32, x: u32, y: u32, right: u32, bottom: u32, triangles: u32, unused: u32 }
@group(0) @binding(0) var<storage, read> bounds: Bounds;
@group(0) @binding(1) var<storage, read> triangles: array<NinebitTriangle>;
@group(0) @binding(2) var<storage, read> memory: array<u32>;
@group(0) @binding(3) var<storage, read_write> words: array<u32>;
@group(0) @binding(4) var<storage, read_write> depths: array<u32>;
fn ninebit_texel(unit: i32, at: i32) -> u32 { return memory[memory[unit] + u32(at)]; }
";

impl Printed<'_> {
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
        let draws: Vec<Draw<'_>> = (self.draws.iter().enumerate())
            .map(|(n, (function, setup))| Draw {
                name: format!("draw{n}"),
                about: format!("draw {n}"),
                function,
                setup,
            })
            .collect();
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
        let plan = self.plan;
        let mut frames = cleared(plan);
        let mut given = vec![frames.surfaces.len() as u32, plan.draws().len() as u32];
        for surface in &frames.surfaces {
            let mut depth = surface.depth.clone();
            depth.resize(surface.words.len(), 0);
            given.extend([surface.width, surface.words.len() as u32]);
            given.extend(surface.words.iter().chain(&depth));
        }
        for (number, draw) in plan.draws().iter().enumerate() {
            let before = if plan.reads_target(draw) { self.before(number) } else { Frames { surfaces: Vec::new() } };
            let words = TextureWords::new(plan, &plan.draws()[number..=number], &before.surfaces);
            let window = draw.windows.first().map_or([0; 4], |w| [w.x, w.y, w.x + w.width, w.y + w.height]);
            let mut all = Vec::new();
            for ((rows, _), n) in triangles(draw, (0, plan.targets()[draw.target].height.into())) {
                if let Some(context) = TriangleContext::new(plan, draw, n, rows) {
                    all.extend(triangle(&self.draws[number].1.constants(&context)));
                }
            }
            let mut memory = vec![0; 4];
            for (unit, words) in self.memories(number, &words).iter().enumerate() {
                memory[unit] = memory.len() as u32;
                memory.extend(words.iter());
            }
            given.push(draw.target as u32);
            given.extend(window);
            for part in [all, memory] {
                given.push(part.len() as u32);
                given.extend(part);
            }
        }
        std::fs::write(folder.join("whole.wgsl"), self.wgsl_text()).unwrap();
        std::fs::write(folder.join("draws.bin"), bytes(&given)).unwrap();
        run(&mut drawing("whole.py"), folder)?;
        self.read(folder, &mut frames);
        Ok(frames)
    }
}

/// Returns the constants of a triangle in the layout of the printed structure.
fn triangle(constants: &HashMap<Field, i64>) -> Vec<u32> {
    let mut out = Vec::new();
    let of = |field: Field| constants.get(&field).copied().unwrap_or(0);
    let single = |field: Field, out: &mut Vec<u32>| out.push(of(field) as u32);
    let wide = |field: Field, out: &mut Vec<u32>| out.extend([of(field) as u32, (of(field) >> 32) as u32]);
    let binary = |field: Field, out: &mut Vec<u32>| {
        let packed = of(field);
        out.extend([(packed >> 16) as u32, ((packed & 0xffff) - 0x8000) as u32]);
    };
    (0..3).for_each(|k| single(Field::EdgeX(k), &mut out));
    (0..3).for_each(|k| single(Field::EdgeY(k), &mut out));
    (0..3).for_each(|k| wide(Field::Edge(k), &mut out));
    (0..3).for_each(|k| single(Field::Owns(k), &mut out));
    out.push(0);
    (0..3).for_each(|k| binary(Field::Ratio(k), &mut out));
    (0..24).for_each(|n| single(Field::Color(n / 12, n / 3 % 4, n % 3), &mut out));
    for n in 0..16 {
        Part::ALL.iter().for_each(|part| binary(Field::Coordinate(n / 4, n % 4, *part), &mut out));
    }
    Part::ALL.iter().for_each(|part| binary(Field::Fog(*part), &mut out));
    single(Field::FogByte, &mut out);
    out.push(0);
    (0..3).for_each(|k| binary(Field::Depth(k), &mut out));
    (0..9).for_each(|n| binary(Field::DepthDifference(n / 3, n % 3), &mut out));
    wide(Field::Offset, &mut out);
    single(Field::OffsetExponent, &mut out);
    out.push(0);
    assert_eq!(out.len(), 178);
    out
}
