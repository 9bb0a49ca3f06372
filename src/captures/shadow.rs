//! SHD-1: a depth texture as large as the frame, compared with one r by all eight functions, with R and with zero as the reference. Its words are
//! given, or drawn.

use super::*;

/// Names of [`CompareFunction::ALL`] as they appear in the names of frames.
const FUNCTIONS: &str = "N LT EQ LE GT NE GE A";

/// Format, its bits in the names of frames, and the least, greatest and reference word.
const RANGES: [(TextureFormat, u32, [u32; 3]); 6] = [
    (TextureFormat::Z16, 16, [0, 0xffff, 0x7fff]),
    (TextureFormat::Z16, 16, [0, 256, 128]),
    (TextureFormat::Z16, 16, [256, 512, 384]),
    (TextureFormat::Z24S8, 24, [0, 0xff_ffff, 0x7f_ffff]),
    (TextureFormat::Z24S8, 24, [0, 256, 128]),
    (TextureFormat::Z24S8, 24, [256, 512, 384]),
];

/// Number of boxes along each axis.
const BOXES: u32 = 15;
/// Width of the special boxes in pixels.
const WIDTH: u32 = SIZE.0 / BOXES / 2;
/// Pixels from one special box to the next.
const STEP: u32 = WIDTH + (SIZE.0 / BOXES - WIDTH) * 2;
/// First column of the special boxes.
const LEFT: u32 = SIZE.0 / 2 - STEP * 3 + WIDTH / 2;
/// First row of the special boxes.
const TOP: u32 = SIZE.1 / 2 - WIDTH / 2;
/// Height of the special boxes in pixels.
const HEIGHT: u32 = SIZE.1 / BOXES * 2;

/// The colours of the markers on the special boxes.
const MARKERS: [u32; 7] = [0xffff_aa00, 0xffff_7700, 0xffcc_5500, 0xff00_ff00, 0xff00_aacc, 0xff00_5577, 0xff00_2266];

/// Returns the words of the depth texture as they lie in memory: boxes that grow from the least to the greatest value, and seven special ones in the
/// middle.
///
/// The programs shift 24-bit words left only in the special boxes and at the sides.
fn words(format: TextureFormat, [least, greatest, reference]: [u32; 3]) -> Vec<u32> {
    let (width, height) = SIZE;
    let shift = if format == TextureFormat::Z24S8 { 8 } else { 0 };
    let (across, down) = (width / BOXES, height / BOXES);
    let indent = (width - across * BOXES) / 2;
    let mut words = vec![reference << shift; (width * height) as usize];
    let mut value = least as f32;
    let increment = greatest as f32 / (BOXES * BOXES) as f32;
    for row in 0..BOXES {
        for column in 0..BOXES {
            for y in row * down..(row + 1) * down {
                let first = (y * width + indent + column * across) as usize;
                words[first..first + across as usize].fill(value as u32);
            }
            value += increment;
        }
    }
    let special = [0, 1, reference - 1, reference, reference + 1, greatest - 1, greatest];
    for (n, value) in (0..).zip(special) {
        for y in TOP..TOP + HEIGHT {
            let first = (y * width + LEFT + n * STEP) as usize;
            words[first..first + WIDTH as usize].fill(value << shift);
        }
    }
    words
}

/// Converts a colour as the programs encode it, with red in the low byte.
fn color(word: u32) -> VertexColor {
    VertexColor::Bytes(word.to_le_bytes())
}

/// Returns a small triangle in each special box. `moved` transforms their edges.
fn markers(moved: fn([f32; 4]) -> [f32; 4]) -> Vec<Draw> {
    let (across, down) = (WIDTH as f32 / 4.0, HEIGHT as f32 / 4.0);
    let marker = |(n, word): (u32, u32)| {
        let (left, top) = ((LEFT + n * STEP) as f32, TOP as f32 + down);
        let [middle, ..] = moved([left + 2.0 * across, 0.0, 0.0, 0.0]);
        let [left, top, right, bottom] = moved([left + across, top, left + 3.0 * across, top + down]);
        let corners = [[left, bottom], [middle, top], [right, bottom]];
        Draw { topology: Topology::Triangles, ..quads(&corners, color(word), FinalRegister::PrimaryColor) }
    };
    (0..).zip(MARKERS).map(marker).collect()
}

/// Draws a rectangle that compares the first texture with one r. The texture covers the rectangle as if both had the frame's size.
fn compared(canvas: &mut Canvas, edges: [f32; 4], w: f32, shadow: ShadowComparison, r: f32) {
    let unit = TextureUnit { shadow: Some(shadow), ..nearest(0) };
    let draw = rectangle(edges, color(0xff22_77ff));
    let mut draw = textured(draw, 0, unit, corners([0.0, 0.0, SIZE.0 as f32, SIZE.1 as f32]));
    draw.vertices.update(|_, vertex| {
        vertex.position[3] = w;
        vertex.texture_coordinates.iter_mut().for_each(|at| at[2] = r);
    });
    draw.combiners = with_primary_alpha(FinalRegister::Texture0);
    canvas.draw(draw);
}

/// The shadow references, each with the digit in the names of frames.
const REFERENCES: [(ShadowReference, u8); 2] = [(ShadowReference::R, 3), (ShadowReference::Zero, 2)];

/// Adds the frames whose depth words are given.
fn depth_words(frames: &mut Frames) {
    for (format, bits, values) in RANGES {
        let memory = words(format, values);
        let texels = memory.iter().map(|word| if bits == 24 { word.rotate_right(8) } else { *word });
        let texture = images::of_words(TextureKind::Rectangle, format, [SIZE.0, SIZE.1], 1, texels.collect());
        for (name, function) in named(FUNCTIONS) {
            for (reference, stage) in REFERENCES {
                let [least, greatest, r] = values;
                let (texture, name) = (texture.clone(), format!("{stage}R{bits}_{least:X}-{greatest:X}_{r:X}_{name}"));
                frames.paint(name, 0xfe11_2233, move |canvas| {
                    canvas.texture(&texture);
                    let edges = [0.0, 100.0, SIZE.0 as f32, SIZE.1 as f32 - 100.0];
                    compared(canvas, edges, 1.0, ShadowComparison { function, reference }, r as f32);
                    markers(|edges| edges).into_iter().for_each(|marker| canvas.draw(marker));
                });
            }
        }
    }
}

/// Format, its name in those of frames, deepest depth, and two triples of the nearest, farthest and compared z in world space.
const DRAWN: [(TextureFormat, &str, f32, [[f32; 3]; 2]); 3] = [
    (TextureFormat::Z16, "16", 65535.0, [[-6.0, 193.0, -6.0 + 199.0 * 0.06], [10.0, 20.0, 15.0]]),
    (TextureFormat::Z16F, "16f", 511.9375, [[-6.0, 193.0, -6.0 + 199.0 * 0.0531], [10.0, 20.0, 14.04]]),
    (TextureFormat::Z24S8, "24", 16_777_215.0, [[-6.0, 193.0, 10.65], [10.0, 20.0, 11.47]]),
];

/// Distance of the special boxes from the three points in world space.
const NEARBY: f32 = 0.0125;

/// The way in which the programs compute depths: by the fixed function or by a vertex program.
#[derive(Clone, Copy)]
struct Path {
    deepest: f32,
    is_program: bool,
}

impl Path {
    /// Returns the function that moves screen edges through the inverse of the vertex transform.
    fn moved(self) -> fn([f32; 4]) -> [f32; 4] {
        if self.is_program { space::programmed_edges } else { unprojected }
    }

    /// Returns the depth of a point in world space, and its w. A vertex program adds the viewer's distance first, and every product and sum of it is
    /// cut; the guard bits of the transform unit's sums (VTX-5) would change four frames.
    fn depth(self, z: f32) -> [f32; 2] {
        let window = space::window_to(f64::from(self.deepest));
        if !self.is_program {
            let [_, _, depth, w] = space::fixed_function_to([0.0, 0.0, z, 1.0], &space::product(space::eye(), window));
            return [depth, w];
        }
        let w = space::toward_zero(f64::from(z) + space::DISTANCE);
        let scaled = space::toward_zero(f64::from(w) * window[2][2]);
        let depth = f64::from(space::toward_zero(f64::from(scaled) + window[3][2]));
        [space::toward_zero(depth * f64::from(space::toward_zero(1.0 / f64::from(w)))), w]
    }

    /// Returns a rectangle whose depths at its upper and lower edge are those of two z in world space.
    fn slope(self, edges: [f32; 4], [top, bottom]: [f32; 2]) -> Draw {
        let mut draw = rectangle(self.moved()(edges), color(0));
        draw.vertices.update(|n, vertex| {
            let at = self.depth(if n < 2 { top } else { bottom });
            vertex.position[2..].copy_from_slice(&at);
        });
        let range = DepthRange { lowest: 0.0, highest: 16_777_216.0, clamps: false, drops_triangles: true };
        Draw { depth_test: Some(in_steps(CompareFunction::Always, true, Some(range))), ..draw }
    }

    /// Draws the depth texture (a slope with seven boxes on it) and compares it.
    fn paint(self, canvas: &mut Canvas, format: TextureFormat, points: [f32; 3], shadow: ShadowComparison) {
        let ([least, greatest, z], (width, height)) = (points, (SIZE.0 as f32, SIZE.1 as f32));
        let depth = format.depth().map(|format| DepthBuffer { format, clear: format.largest(), clear_stencil: 0 });
        let target = canvas.target(Target { depth, ..Target::new(SIZE.0, SIZE.1, SurfaceFormat::A8R8G8B8) });
        let special = [least, least + NEARBY, z - NEARBY, z, z + NEARBY, greatest - NEARBY, greatest];
        let boxes = (0..).zip(special).map(|(n, z)| {
            let (left, top) = ((LEFT + n * STEP) as f32, TOP as f32);
            self.slope([left, top, left + WIDTH as f32, top + HEIGHT as f32], [z; 2])
        });
        let slope = self.slope([0.8, 6.0, width - 0.8, height - 6.0], [least, greatest]);
        canvas.draw_into(target, std::iter::once(slope).chain(boxes));
        let image = TextureImage::Depth { target };
        canvas.texture(&Texture { image, ..target_texture(format, target) });
        // The console's CPU rounds every product and sum.
        let scale = 200.0_f32 / 199.0 * self.deepest;
        let distance = space::DISTANCE as f32;
        let r = (scale * z + (distance * scale - scale)) / (z + distance);
        compared(canvas, self.moved()([0.8, height * 0.2, width - 0.8, height * 0.8]), 8.5, shadow, r);
        markers(self.moved()).into_iter().for_each(|marker| canvas.draw(marker));
    }
}

/// Adds the frames of Texture_shadow_comparator.
pub(super) fn frames(frames: &mut Frames) {
    depth_words(frames);
    for (format, bits, deepest, ranges) in DRAWN {
        for (is_program, letter) in [(false, 'F'), (true, 'P')] {
            for [least, greatest, mut z] in ranges {
                if is_program && z == 11.47 {
                    z = 11.45;
                }
                for (name, function) in named(FUNCTIONS) {
                    for (reference, stage) in REFERENCES {
                        let shadow = ShadowComparison { function, reference };
                        let name = format!("{stage}{letter}{bits}_{least:.2}-{greatest:.2}_{z:.4}_{name}");
                        let path = Path { deepest, is_program };
                        frames.paint(name, 0xfe44_3333, move |canvas| {
                            path.paint(canvas, format, [least, greatest, z], shadow);
                        });
                    }
                }
            }
        }
    }
}
