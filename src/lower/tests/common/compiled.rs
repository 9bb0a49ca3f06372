//! Draws a scene by a compiled program of C: its functions, and one that reads what they are given.

use std::fmt::Write;
use std::path::Path;
use std::process::Command;

use ninebit::engine::context::TriangleContext;
use ninebit::engine::walk::triangles;
use ninebit::engine::{RenderOptions, TextureWords, cleared, render};
use ninebit::frame::Frames;
use ninebit::limits::MEMORY_IMAGE;
use ninebit::plan::{Plan, PlanOptions};
use ninebit::raster::stroke::Figure;
use ninebit_files::read::{self, Kind};
use ninebit_lower::{Attribute, Field, Language, with_all_levels};

use crate::drawn::Printed;
use crate::setting::{bytes, compiler, run};

/// Number of words of a vertex of the printed structure.
const VERTEX: usize = 29;

/// A program that draws what it reads by SET_UP, COVERS and DRAW, which takes pixels of a row; BEGIN_DRAW reads the state of a draw.
pub const MAIN: &str = r#"
#include <stdio.h>
#include <stdlib.h>

static uint32_t *given;
static uint32_t next(void) { return *given++; }
static int64_t next64(void)
{
    const uint64_t low = next();
    return (int64_t)((uint64_t)next() << 32 | low);
}

/* Reads targets and draws, each triangle with its spans, and writes the words of the targets. */
int main(int count, char **names)
{
    FILE *file = fopen(names[1], "rb");
    if (count < 3 || !file) return 2;
    fseek(file, 0, SEEK_END);
    const long size = ftell(file);
    rewind(file);
    uint32_t *const all = given = malloc((size_t)size);
    if (!all || fread(all, 1, (size_t)size, file) != (size_t)size) return 2;
    fclose(file);
    const uint32_t targets = next(), draws = next();
    uint32_t width[16], pixels[16], *words[16], *depths[16];
    for (uint32_t n = 0; n < targets; n++) {
        width[n] = next();
        pixels[n] = next();
        words[n] = given;
        given += pixels[n];
        depths[n] = given;
        given += pixels[n];
    }
    for (uint32_t n = 0; n < draws; n++) {
        const uint32_t target = next(), triangles = next();
        BEGIN_DRAW;
        const uint32_t *texture[4];
        for (int unit = 0; unit < 4; unit++) {
            const uint32_t length = next();
            texture[unit] = given;
            given += length;
        }
        for (uint32_t k = 0; k < triangles; k++) {
            struct ninebit_vertex vertex[3];
            struct ninebit_triangle triangle;
            if (sizeof triangle != 4 * 184) return 5;
            memset(&triangle, 0, sizeof triangle);
            memcpy(vertex, given, sizeof vertex);
            given += sizeof vertex / 4;
            SET_UP(n, vertex, &triangle);
            triangle.offset = next64();
            triangle.offset_exponent = (int32_t)next();
            triangle.sprite[0] = (int32_t)next();
            triangle.sprite[1] = (int32_t)next();
            triangle.sprite_size = (int32_t)next();
            const uint32_t is_stroke = next();
            for (int e = 0; e < 3; e++) {
                const int64_t a = next64(), b = next64(), c = next64();
                if (is_stroke) {
                    triangle.edge_x[e] = (int32_t)a;
                    triangle.edge_y[e] = (int32_t)b;
                    triangle.edge[e] = c;
                } else if (triangle.edge_x[e] != a || triangle.edge_y[e] != b || triangle.edge[e] != c) {
                    return 3;
                }
            }
            for (uint32_t spans = next(); spans > 0; spans--) {
                const uint32_t y = next(), from = next(), to = next();
                const uint32_t at = y * width[target] + from;
                for (uint32_t x = from; x < to; x++) {
                    if (!is_stroke && !COVERS(&triangle, (int32_t)x, (int32_t)y)) return 4;
                }
                DRAW(n, &triangle, texture, (int32_t)from, (int32_t)y, (int32_t)(to - from), words[target] + at, depths[target] + at);
            }
        }
    }
    file = fopen(names[2], "wb");
    for (uint32_t n = 0; n < targets; n++) {
        fwrite(words[n], 4, pixels[n], file);
        fwrite(depths[n], 4, pixels[n], file);
    }
    return fclose(file);
}
"#;

impl Printed<'_> {
    /// Returns the functions in C, with a program that draws by them.
    pub fn c_text(&self) -> String {
        let draws = self.named();
        let mut text = Language::C99.print_whole(&draws).unwrap();
        let list = |of: &dyn Fn(usize) -> String| (0..draws.len()).map(|n| of(n) + ", ").collect::<String>();
        let _ = write!(
            text,
            "typedef void set_up(const struct ninebit_vertex *, struct ninebit_triangle *);\n\
             typedef void row(const struct ninebit_triangle *, const uint32_t *const *, int32_t, int32_t, int32_t, uint32_t *, uint32_t *);\n\
             static set_up *const set_ups[] = {{{}}};\nstatic row *const draw_row[] = {{{}}};\n\
             #define BEGIN_DRAW (void)0\n#define SET_UP(n, vertex, triangle) set_ups[n](vertex, triangle)\n\
             #define COVERS ninebit_covers\n#define DRAW(n, ...) draw_row[n](__VA_ARGS__)\n{MAIN}",
            list(&|n| format!("draw{n}_set_up")),
            list(&|n| format!("draw{n}_row")),
        );
        text
    }

    /// Returns what the program reads. With the states of draws, each precedes its draw, whose memories have all levels. Textures that are targets
    /// hold what the engine has drawn.
    pub fn given(&self, states: Option<&[Vec<u32>]>) -> Vec<u32> {
        let plan = self.plan;
        let mut given = self.targets(&cleared(plan));
        for (number, draw) in plan.draws().iter().enumerate() {
            let before = self.before(number);
            let words = TextureWords::new(plan, &plan.draws()[number..=number], &before.surfaces);
            let height = plan.targets()[draw.target].height.into();
            let mut drawn = Vec::new();
            let mut count = 0;
            for ((rows, columns), n) in triangles(draw, (0, height)) {
                let Some(context) = TriangleContext::new(plan, draw, n, rows) else { continue };
                count += 1;
                self.triangle(number, &context, (rows, columns), &mut drawn);
            }
            given.extend([draw.target as u32, count]);
            let mut sampled = draw.clone();
            if let Some(states) = states {
                given.extend(&states[number]);
                sampled = with_all_levels(plan, draw);
            }
            for memory in words.memories(&sampled) {
                given.push(memory.len() as u32);
                given.extend(memory.iter());
            }
            given.extend(drawn);
        }
        given
    }

    /// Appends a triangle with its spans.
    fn triangle(
        &self,
        number: usize,
        context: &TriangleContext<'_>,
        (rows, columns): ((i64, i64), (i64, i64)),
        out: &mut Vec<u32>,
    ) {
        let (_, setup) = &self.draws[number];
        for k in 0..3 {
            let before = out.len();
            let of = |attribute: Attribute| attribute.value_of(context, k) as u32;
            out.extend([Attribute::Position(0), Attribute::Position(1), Attribute::Z, Attribute::W].map(of));
            (0..8).for_each(|n| out.push(of(Attribute::Color(n / 4, n % 4))));
            (0..16).for_each(|n| out.push(of(Attribute::Coordinate(n / 4, n % 4))));
            out.push(of(Attribute::Fog));
            assert_eq!(out.len() - before, VERTEX);
        }
        let wide = |n: i64, out: &mut Vec<u32>| out.extend([n as u32, (n >> 32) as u32]);
        let constants = setup.constants(context);
        wide(constants[&Field::Offset], out);
        let others = [Field::OffsetExponent, Field::Sprite(0), Field::Sprite(1), Field::SpriteSize];
        out.extend(others.map(|field| constants[&field] as u32));
        out.push((context.triangle.figure != Figure::Triangle).into());
        context.triangle.edge_functions().iter().flatten().for_each(|n| wide(*n, out));
        let mut spans = Vec::new();
        let top = context.triangle.rows.0.max(rows.0);
        for j in top..context.triangle.rows.1.min(rows.1) {
            let (from, to) = context.triangle.span(j, columns);
            // Stippled pixels are left out one by one.
            let mut open = None;
            for i in from..=to.max(from) {
                let is_in = i < to && !context.is_left_out(i, j);
                match (open, is_in) {
                    (None, true) => open = Some(i),
                    (Some(first), false) => {
                        spans.push([j, first, i]);
                        open = None;
                    }
                    _ => {}
                }
            }
        }
        out.push(spans.len() as u32);
        out.extend(spans.iter().flatten().map(|n| *n as u32));
    }

    /// Returns the head of what a program reads: how many targets and draws there are, and what targets hold.
    pub fn targets(&self, frames: &Frames) -> Vec<u32> {
        let mut given = vec![frames.surfaces.len() as u32, self.plan.draws().len() as u32];
        for surface in &frames.surfaces {
            let mut depth = surface.depth.clone();
            depth.resize(surface.words.len(), 0);
            given.extend([surface.width, surface.words.len() as u32]);
            given.extend(surface.words.iter().chain(&depth));
        }
        given
    }

    /// Returns the frames before a draw that reads them.
    pub fn before(&self, number: usize) -> Frames {
        if !self.plan.reads_target(&self.plan.draws()[number]) {
            return Frames { surfaces: Vec::new() };
        }
        let mut scene = self.scene.clone();
        scene.draws.truncate(number);
        let options = PlanOptions { policies: self.plan.policies, ..PlanOptions::default() };
        render(&Plan::compile(&scene, &options).unwrap(), &RenderOptions::default())
    }

    /// Compiles the program and draws.
    ///
    /// # Errors
    /// What the compiler or the program says.
    pub fn compiled(&self, folder: &Path) -> Result<Frames, String> {
        std::fs::write(folder.join("whole.c"), self.c_text()).unwrap();
        std::fs::write(folder.join("given.bin"), bytes(&self.given(None))).unwrap();
        let flags = std::env::var("NINEBIT_LOWER_CFLAGS").unwrap_or_else(|_| "-O1".to_string());
        let mut command = Command::new(compiler());
        command.args("-std=c99 -Wall -Wextra -Werror -pedantic -Wno-unused-function".split(' '));
        run(command.args(flags.split_whitespace()).args(["whole.c", "-o", "whole"]), folder)?;
        run(Command::new(folder.join("whole")).args(["given.bin", "drawn.bin"]), folder)?;
        let mut frames = cleared(self.plan);
        self.read(folder, &mut frames);
        Ok(frames)
    }

    /// Reads the targets that a program has drawn.
    pub fn read(&self, folder: &Path, frames: &mut Frames) {
        let drawn = read::bytes(&folder.join("drawn.bin"), Kind::Regular, MEMORY_IMAGE).unwrap();
        let mut drawn = drawn.as_chunks::<4>().0.iter().map(|word| u32::from_le_bytes(*word));
        for surface in &mut frames.surfaces {
            let has_depth = !surface.depth.is_empty();
            surface.words.iter_mut().for_each(|word| *word = drawn.next().unwrap());
            let depth: Vec<u32> = drawn.by_ref().take(surface.words.len()).collect();
            if has_depth {
                surface.depth = depth;
            }
        }
    }
}
