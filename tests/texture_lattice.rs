//! Holds texel fetch and filter against TEX-1 to TEX-9, TEX-18, VOL-1 and SHD-1 where weights end or tie, where indices leave the image, and
//! where words are extreme.
//!
//! Numbers come from `engine/rows/lattice.rs`. Each pixel's coordinate lies half a step of 1/256 texel above a whole one, where no rounding of
//! weights reaches the next. What it shows is computed here from the rules; only blocks and words are decoded by the oracle.

use std::collections::BTreeSet;

use ninebit::engine::{Engine, Isa, RenderOptions, render};
use ninebit::plan::{Plan, PlanOptions};
use ninebit::random::Random;
use ninebit::state::*;
use ninebit_oracle::{block, texel};
use ninebit_test_support::lattice::{self, pick};

/// Sides of the target; each draw has two rows of it.
const SIDES: [u32; 2] = [64, 32];
const SCENES: u64 = 400;
const FILTERS: [Filter; 3] = [Filter::Nearest, Filter::Linear, Filter::Linear];

/// A texture, as its words lie in memory.
struct Image {
    profile: Profile,
    kind: TextureKind,
    format: TextureFormat,
    sides: [u32; 2],
    levels: u32,
    layers: u32,
    border: bool,
    words: Vec<u32>,
    palette: Vec<u32>,
}

impl Image {
    fn new<F: FnMut() -> u32>(next: &mut F) -> Image {
        let profile = pick(next, &[Profile::Nv2a, Profile::Nv2a, Profile::Nv2a, Profile::Nv10]);
        let nv2a = profile == Profile::Nv2a;
        let kinds =
            [TextureKind::TwoDimensional, TextureKind::TwoDimensional, TextureKind::Cube, TextureKind::Rectangle];
        let kind = if nv2a && next().is_multiple_of(6) { TextureKind::ThreeDimensional } else { pick(next, &kinds) };
        let flat = matches!(kind, TextureKind::TwoDimensional | TextureKind::Rectangle);
        let legal = |f: &TextureFormat| {
            (nv2a || !f.is_nv2a_only())
                && (kind != TextureKind::Rectangle || f.is_linear(profile))
                && (flat || f.depth().is_none())
                && (kind == TextureKind::Rectangle || !f.is_paired())
        };
        let formats: Vec<TextureFormat> = TextureFormat::ALL.iter().copied().filter(legal).collect();
        let format = pick(next, &formats);
        let side = |next: &mut F| 1 << pick(next, &[0, 1, 2, 3, 4, 5, 2, 3]);
        let mut sides = [side(next), side(next)];
        match kind {
            TextureKind::Rectangle => {
                sides = [2 * (1 + next() % 20), 1 + next() % 40];
                sides[0] -= u32::from(nv2a && !format.is_paired()) * (next() % 2);
            }
            TextureKind::Cube => sides[1] = sides[0],
            // The longest sides.
            TextureKind::TwoDimensional if next().is_multiple_of(12) => {
                sides[next() as usize % 2] = kind.largest_side(format, profile);
                sides = if sides[0].max(sides[1]) < 1 << 10 {
                    [1 << 11, 1]
                } else {
                    sides.map(|n| if n > 32 { n } else { 1 })
                };
            }
            _ => {}
        }
        let single = matches!(kind, TextureKind::Rectangle | TextureKind::ThreeDimensional) || format.depth().is_some();
        let levels = if single { 1 } else { 1 + next() % (sides[0].max(sides[1]).ilog2() + 1) };
        let layers = if kind == TextureKind::ThreeDimensional { 1 << (next() % 4) } else { 1 };
        let may = nv2a && kind == TextureKind::TwoDimensional && !format.is_compressed() && format.depth().is_none();
        let border = may && next().is_multiple_of(3);
        let mut image =
            Image { profile, kind, format, sides, levels, layers, border, words: Vec::new(), palette: Vec::new() };
        let faces = if kind == TextureKind::Cube { CUBE_FACES } else { layers } as usize;
        let bits = format.word_bits();
        image.words = (0..faces * image.face_words()).map(|_| word(next) >> (32 - bits)).collect();
        if format.is_paired() {
            for [first, second] in image.words.as_chunks_mut().0 {
                *second = *second & !0xffff | *first & 0xffff;
            }
        }
        if format == TextureFormat::P8 {
            let entries = if nv2a { 32 << (next() % 4) } else { 256 };
            image.palette = (0..entries).map(|_| word(next)).collect();
        }
        image
    }

    fn side(&self, level: u32, axis: usize) -> i64 {
        i64::from((self.sides[axis] >> level).max(1))
    }

    /// Returns how many texels a coordinate of 1 spans.
    fn span(&self, level: u32, axis: usize) -> i64 {
        if self.kind == TextureKind::Rectangle { 1 } else { self.side(level, axis) }
    }

    fn pitch(&self, level: u32, axis: usize) -> usize {
        self.side(level, axis) as usize + if self.border { 8 } else { 0 }
    }

    /// Returns the words of a block.
    fn block(&self) -> usize {
        if self.format == TextureFormat::Dxt1 { 2 } else { 4 }
    }

    fn level_words(&self, level: u32) -> usize {
        let [w, h] = [0, 1].map(|axis| self.pitch(level, axis));
        if self.format.is_compressed() { self.block() * w.div_ceil(4) * h.div_ceil(4) } else { w * h }
    }

    fn face_words(&self) -> usize {
        (0..self.levels).map(|level| self.level_words(level)).sum()
    }

    /// Returns the words from a texel on, or from the beginning of its block. Border texels lie at -4..0 and beyond the side.
    fn stored(&self, face: usize, level: u32, [x, y]: [i64; 2]) -> &[u32] {
        let first = face * self.face_words() + (0..level).map(|level| self.level_words(level)).sum::<usize>();
        let beyond = if self.border { 4 } else { 0 };
        let (x, y, pitch) = ((x + beyond) as usize, (y + beyond) as usize, self.pitch(level, 0));
        let offset = if self.format.is_compressed() {
            self.block() * (y / 4 * pitch.div_ceil(4) + x / 4)
        } else {
            y * pitch + x
        };
        &self.words[first + offset..]
    }
}

/// Returns a word of extreme bytes or bits.
fn word(next: &mut impl FnMut() -> u32) -> u32 {
    let bit = 1 << (next() % 32);
    match next() % 8 {
        0 => pick(next, &[0, u32::MAX, 0x8000_8000, 0x7fff_7fff, 0x8080_8080, 0x7f7f_7f7f, 0x5555_5555, 0xaaaa_aaaa]),
        1 => bit,
        2 => !bit,
        3 => bit - 1,
        4 => next(),
        _ => u32::from_le_bytes(std::array::from_fn(|_| lattice::byte(next))),
    }
}

/// Where a draw samples: coordinates in steps of 1/512 texel of level 0, at the upper left corner and for each pixel to the right and down.
struct Place {
    start: [i64; 2],
    right: [i64; 2],
    down: [i64; 2],
    /// Left edge and upper edge, width and height, in pixels.
    area: [u32; 4],
    q: f32,
    face: usize,
    /// In 1/512 layer.
    layer: i64,
    /// What depths are compared with.
    reference: f32,
    lod: i32,
}

impl Place {
    fn new<F: FnMut() -> u32>(next: &mut F, image: &Image, row: u32) -> Place {
        const STEPS: [i64; 14] = [0, 0, 2, 4, 64, 128, 254, 256, 258, 510, 512, 1000, 6, 130];
        const NEAR: [i64; 13] = [0, -1, 1, 127, 128, 126, 129, -127, -128, -129, 255, 256, 383];
        let width = pick(next, &[1, 2, 3, 5, 8, 15, 16, 17, 33, 63, 64]);
        let height = 1 + next() % 2;
        let area = [next() % (SIDES[0] - width + 1), 2 * row + next() % (3 - height), width, height];
        let step = |next: &mut F, along: bool| {
            let step = if along || next().is_multiple_of(4) { pick(next, &STEPS) } else { 0 };
            if next().is_multiple_of(3) { -2 * step } else { 2 * step }
        };
        let (right, down) = ([step(next, true), step(next, false)], [step(next, false), step(next, true)]);
        let start = [0, 1].map(|axis| {
            let repeats = i64::from(pick(next, &[0, 1, 2, 3, 5])) - 1;
            let edge = match next() % 16 {
                0 => pick(next, &[1 << 22, -(1 << 22), (1 << 23) - (1 << 17), (1 << 17) - (1 << 23)]),
                _ => 256 * image.side(0, axis) * repeats,
            };
            // A pixel of the row, rather than its corner, lies beside the edge.
            let back = i64::from(next() % width) * right[axis] / 2;
            2 * (edge + pick(next, &NEAR) - back) + 1
        });
        let last = 256 * i64::from(image.levels - 1);
        let lod = match next() % 4 {
            0 => 0,
            1 => pick(next, &[1, 127, 128, 129, 255, 256, 257, 383, 384, 385, 4095]),
            2 => last + pick(next, &[0, 1, -1, 128, -128, 127, -129]),
            _ => i64::from(next()) % (last + 256),
        };
        let reference = match next() % 4 {
            0 => lattice::within(next, (-12, 30)),
            1 => lattice::any(next),
            kind => {
                let word = next() % (1 << [16, 24][kind as usize - 2]);
                lattice::beside(next, word as f32)
            }
        };
        let layer = 256 * (i64::from(next() % 24) - 8) + pick(next, &[0, 127, 128, 255]);
        let mut place = Place {
            start,
            right,
            down,
            area,
            q: pick(next, &[1.0, 1.0, 1.0, 2.0, 0.25, -1.0]),
            face: next() as usize % 6,
            layer: 2 * layer + 1,
            reference,
            lod: lod.clamp(0, 4095) as i32,
        };
        if image.kind == TextureKind::Cube {
            place.stay_on_the_face(512 * image.side(0, 0));
        }
        if image.format.depth().is_some() {
            place.q = 1.0;
        }
        if !place.is_fine(image) {
            (place.right, place.down) = ([0; 2], [0; 2]);
        }
        place
    }

    /// Returns whether coordinates are exact to less than half a step: weights and terms lose up to twelve last bits of 24 (WGT-1).
    fn is_fine(&self, image: &Image) -> bool {
        let [_, _, width, height] = self.area.map(i64::from);
        let corners = [[0, 0], [width, 0], [0, height], [width, height]];
        let steps = corners.iter().flat_map(|at| self.corner(*at)).map(|corner| corner.abs() as f64 / 2.0);
        let least = 256.0 * image.span(0, 0).max(image.span(0, 1)) as f64;
        steps.fold(least, f64::max) * 12.0 * f64::exp2(-24.0) < 0.4
    }

    fn stay_on_the_face(&mut self, end: i64) {
        self.q = 1.0;
        for axis in 0..2 {
            let [_, _, width, height] = self.area.map(i64::from);
            let is_inside = |n: i64| (0..end).contains(&n);
            if ![[0, 0], [width, 0], [0, height], [width, height]].iter().all(|at| is_inside(self.corner(*at)[axis])) {
                (self.right[axis], self.down[axis]) = (0, 0);
                self.start[axis] = self.start[axis].rem_euclid(end);
            }
        }
    }

    /// Returns the coordinates at a corner between pixels.
    fn corner(&self, [i, j]: [i64; 2]) -> [i64; 2] {
        [0, 1].map(|axis| self.start[axis] + self.right[axis] * i + self.down[axis] * j)
    }

    /// Returns the coordinates at the centre of a pixel. Steps are multiples of 4: what is odd stays odd.
    fn centre(&self, [i, j]: [i64; 2]) -> [i64; 2] {
        [0, 1].map(|axis| self.start[axis] + self.right[axis] / 2 * (2 * i + 1) + self.down[axis] / 2 * (2 * j + 1))
    }

    fn vertex(&self, image: &Image, at: [u32; 2]) -> Vertex {
        let of = |axis: usize| 512.0 * image.span(0, axis) as f64;
        let corner = self.corner(at.map(i64::from));
        let [s, t] = [0, 1].map(|axis| corner[axis] as f64 / of(axis));
        let set = if image.kind == TextureKind::Cube {
            let [s, t] = [2.0 * s - 1.0, 2.0 * t - 1.0];
            // TEX-12.
            let [x, y, z] =
                [[1.0, -t, -s], [-1.0, -t, s], [s, 1.0, t], [s, -1.0, -t], [s, -t, 1.0], [-s, -t, -1.0]][self.face];
            [x, y, z, 1.0]
        } else if image.format.depth().is_some() {
            [s, t, self.reference.into(), 1.0]
        } else {
            let r = self.layer as f64 / (512.0 * f64::from(image.layers));
            let q = f64::from(self.q);
            [s * q, t * q, r * q, q]
        };
        let narrow = set.map(|n| n as f32);
        assert_eq!(narrow.map(f64::from), set, "a coordinate is exact");
        let [x, y] = [0, 1].map(|axis| (self.area[axis] + at[axis]) as f32);
        let mut texture_coordinates = Vertex::default().texture_coordinates;
        texture_coordinates[0] = narrow;
        Vertex { position: [x, y, 0.0, 1.0], texture_coordinates, ..Vertex::default() }
    }

    fn draw(&self, image: &Image, unit: TextureUnit, target: usize) -> Draw {
        let [_, _, width, height] = self.area;
        let corners = [[0, 0], [width, 0], [width, height], [0, height]];
        let combiners = if target == 0 { Combiners::showing(FinalRegister::Texture0) } else { negated() };
        Draw {
            target,
            vertices: corners.map(|at| self.vertex(image, at)).to_vec().into(),
            indices: vec![0, 1, 2, 0, 2, 3].into(),
            combiners,
            ..Draw::default()
        }
        .texture(0, unit)
    }
}

/// Returns a program that shows what is negative of TEXTURE0.
fn negated() -> Combiners {
    let mut combiners = Combiners::showing(FinalRegister::Spare0);
    let stage = &mut combiners.stages[0];
    for portion in [&mut stage.rgb, &mut stage.alpha] {
        portion.inputs[0].register = Register::Texture0;
        portion.inputs[0].mapping = InputMapping::SignedNegate;
        portion.inputs[1].mapping = InputMapping::UnsignedInvert;
        portion.ab_output = Register::Spare0;
    }
    combiners
}

fn unit<F: FnMut() -> u32>(next: &mut F, image: &Image, place: &Place) -> TextureUnit {
    let nv2a = image.profile == Profile::Nv2a;
    let compares = image.format.depth().is_some();
    let modes: &[AddressMode] = match (image.profile, image.kind) {
        (Profile::Nv10, TextureKind::Rectangle) => &[AddressMode::ClampToEdge],
        (Profile::Nv2a, _) if !compares => AddressMode::ALL,
        _ => &[AddressMode::Wrap, AddressMode::Mirror, AddressMode::ClampToEdge, AddressMode::Clamp],
    };
    let nearest = compares || image.kind == TextureKind::ThreeDimensional;
    let filter = |next: &mut F| if nearest { Filter::Nearest } else { pick(next, &FILTERS) };
    TextureUnit {
        palette: (image.format == TextureFormat::P8).then_some(0),
        address_s: pick(next, modes),
        address_t: pick(next, modes),
        address_r: pick(next, modes),
        mag_filter: filter(next),
        min_filter: filter(next),
        mip_filter: if nearest { MipFilter::None } else { pick(next, MipFilter::ALL) },
        lod_bias: lattice::whole(next, (-4096, 4095)) as i32,
        min_lod: place.lod,
        max_lod: place.lod,
        border_color: std::array::from_fn(|_| lattice::byte(next)),
        signed: std::array::from_fn(|_| nv2a && !compares && next().is_multiple_of(4)),
        shadow: compares.then(|| ShadowComparison {
            function: pick(next, CompareFunction::ALL),
            reference: if next().is_multiple_of(8) { ShadowReference::Zero } else { ShadowReference::R },
        }),
        ..TextureUnit::new(0)
    }
}

/// What a test has met.
type Met = BTreeSet<String>;

/// One unit's way through a texture.
struct Sampler<'a> {
    image: &'a Image,
    unit: &'a TextureUnit,
    met: &'a mut Met,
}

fn has_halves(format: TextureFormat) -> bool {
    matches!(format, TextureFormat::R16B16 | TextureFormat::Y16)
}

fn two_complement(flag: bool, n: i64, bits: u32) -> i64 {
    if flag && n >= 1 << (bits - 1) { n - (1 << bits) } else { n }
}

/// TEX-7: returns the index of a texel, or `None` for the border colour.
fn address(mode: AddressMode, i: i64, n: i64, border: bool) -> Option<i64> {
    match mode {
        AddressMode::Wrap => Some((i % n + n) % n),
        AddressMode::Mirror => {
            let back = (i % (2 * n) + 2 * n) % (2 * n);
            Some(if back >= n { 2 * n - 1 - back } else { back })
        }
        AddressMode::ClampToEdge | AddressMode::Clamp => Some(i.max(0).min(n - 1)),
        AddressMode::ClampToBorder if border => Some(i.max(-4).min(n + 3)),
        AddressMode::ClampToBorder => (0..n).contains(&i).then_some(i),
    }
}

impl Sampler<'_> {
    fn meet(&mut self, what: impl Into<String>) {
        self.met.insert(what.into());
    }

    fn signed_halves(&self) -> [bool; 2] {
        [self.image.format == TextureFormat::R16B16 && self.unit.signed[3], self.unit.signed[1]]
    }

    /// Returns R, G, B, A of a texel as they are filtered, or two halves.
    fn texel(&mut self, face: Option<usize>, level: u32, at: [i64; 2]) -> [i64; 4] {
        let modes = if self.image.kind == TextureKind::Cube {
            [AddressMode::ClampToEdge; 2]
        } else {
            [self.unit.address_s, self.unit.address_t]
        };
        let [x, y] = [0, 1].map(|axis| {
            let n = self.image.side(level, axis);
            if !(0..n).contains(&at[axis]) {
                self.meet(format!("{} {}", modes[axis].name(), if at[axis] < 0 { "below" } else { "above" }));
            }
            address(modes[axis], at[axis], n, self.image.border)
        });
        let (halves, bytes) = match (face, x, y) {
            (Some(face), Some(x), Some(y)) => {
                let (image, words) = (self.image, self.image.stored(face, level, [x, y]));
                let word = words[0];
                let bytes = match image.format {
                    format if format.is_compressed() => block::texel(
                        format,
                        image.profile == Profile::Nv2a,
                        &words[..image.block()],
                        x as usize,
                        y as usize,
                    ),
                    TextureFormat::P8 => {
                        let entry = image.palette[word as usize % image.palette.len()];
                        texel::bytes(TextureFormat::A8R8G8B8, entry)
                    }
                    format if has_halves(format) => [0; 4],
                    format => texel::bytes(format, word),
                };
                let high = if image.format == TextureFormat::Y16 { 0xffff } else { word >> 16 };
                ([high, word & 0xffff].map(i64::from), bytes.map(|n| n as i64))
            }
            _ => {
                self.meet("border colour");
                let bytes @ [r, g, b, a] = self.unit.border_color.map(i64::from);
                ([256 * a + r, 256 * g + b], bytes)
            }
        };
        if has_halves(self.image.format) {
            let [high, low] = self.signed_halves();
            return [two_complement(high, halves[0], 16), two_complement(low, halves[1], 16), 0, 0];
        }
        std::array::from_fn(|c| two_complement(self.unit.signed[c], bytes[c], 8))
    }

    /// TEX-6: returns a (256 - w) + b w, over 256 to the nearest.
    fn mix(a: [i64; 4], b: [i64; 4], w: i64) -> [i64; 4] {
        std::array::from_fn(|c| (a[c] * (256 - w) + b[c] * w + 128).div_euclid(256))
    }

    /// TEX-5, TEX-6: returns what a filter makes of a level, at coordinates in 1/256 texel of it.
    fn level(&mut self, filter: Filter, face: Option<usize>, level: u32, [u, v]: [i64; 2]) -> [i64; 4] {
        if filter == Filter::Nearest {
            return self.texel(face, level, [u.div_euclid(256), v.div_euclid(256)]);
        }
        let ([x, y], [wu, wv]) =
            ([u - 128, v - 128].map(|n| n.div_euclid(256)), [u - 128, v - 128].map(|n| n.rem_euclid(256)));
        self.meet(format!("weight {wu} along s"));
        self.meet(format!("weight {wv} along t"));
        let rows = [y, y + 1].map(|y| {
            let [a, b] = [x, x + 1].map(|x| self.texel(face, level, [x, y]));
            Self::mix(a, b, wu)
        });
        Self::mix(rows[0], rows[1], wv)
    }

    /// TEX-9: returns R, G, B, A of the register.
    fn sample(&mut self, place: &Place, at: [i64; 2]) -> [i64; 4] {
        let (image, unit, lod) = (self.image, self.unit, i64::from(place.lod));
        self.meet(image.format.name());
        self.meet(image.kind.name());
        let centre = place.centre(at);
        let on = |level: u32| {
            [0, 1].map(|axis| (centre[axis] * image.span(level, axis)).div_euclid(2 * image.span(0, axis)))
        };
        let face = match image.kind {
            TextureKind::Cube => Some(place.face),
            TextureKind::ThreeDimensional => {
                let layer = address(unit.address_r, place.layer.div_euclid(512), image.layers.into(), false);
                layer.map(|layer| layer as usize)
            }
            _ => Some(0),
        };
        if let (Some(format), Some(shadow)) = (image.format.depth(), unit.shadow) {
            let [x, y] = [0, 1].map(|axis| {
                let mode = [unit.address_s, unit.address_t][axis];
                address(mode, on(0)[axis].div_euclid(256), image.side(0, axis), false).unwrap()
            });
            return [self.compare(format, shadow, place.reference, image.stored(0, 0, [x, y])[0]); 4];
        }
        let last = i64::from(image.levels) - 1;
        let mut level = |filter: Filter, n: i64| {
            let n = n.min(last) as u32;
            self.level(filter, face, n, on(n))
        };
        let filtered = match (lod, unit.mip_filter) {
            (..=0, _) => level(unit.mag_filter, 0),
            (_, MipFilter::None) => level(unit.min_filter, 0),
            (_, MipFilter::Nearest) => level(unit.min_filter, (lod + 128) / 256),
            (_, MipFilter::Linear) => {
                let both = [0, 1].map(|more| level(unit.min_filter, lod / 256 + more));
                self.meet(format!("weight {} of levels", lod % 256));
                Self::mix(both[0], both[1], lod % 256)
            }
        };
        // TEX-18.
        if has_halves(image.format) {
            let [high, low] = [filtered[0], filtered[1]].map(|half| half.rem_euclid(1 << 16));
            let top = |flag: bool, half: i64| if flag { 2 * two_complement(true, half / 256, 8) } else { half / 256 };
            let [high_signed, low_signed] = self.signed_halves();
            return [high % 256, top(low_signed, low), low % 256, top(high_signed, high)];
        }
        std::array::from_fn(|c| if unit.signed[c] { 2 * filtered[c] } else { filtered[c] })
    }

    /// SHD-1, DEP-3: returns 255 where the comparison of the largest word whose depth is at most the reference passes, otherwise 0.
    fn compare(&mut self, format: DepthFormat, shadow: ShadowComparison, reference: f32, word: u32) -> i64 {
        // The stencil's bits are no depth.
        let (floats, stored) = match format {
            DepthFormat::Z16 => (None, word),
            DepthFormat::Z16F => (Some((12, 7)), word),
            DepthFormat::Z24S8 => (None, word & 0xff_ffff),
            DepthFormat::Z24S8F => (Some((16, 127)), word & 0xff_ffff),
        };
        let full = i64::from(format.largest());
        let reference = match (shadow.reference, floats) {
            (ShadowReference::Zero, _) => 0,
            (_, None) => (reference.max(0.0) as i64).min(full),
            (_, Some((kept, bias))) => {
                // Exponent and mantissa of a positive number, cut to `kept` bits.
                let exponent = i64::from(reference.to_bits() >> 23 & 255) - 127 + bias;
                let mantissa = i64::from(reference.to_bits() & 0x7f_ffff) >> (23 - kept);
                if reference <= 0.0 || exponent < 1 { 0 } else { (exponent << kept | mantissa).min(full) }
            }
        };
        let stored = i64::from(stored);
        self.meet(format!("{} of {:?}", shadow.function.name(), reference.cmp(&stored)));
        let passes = match shadow.function {
            CompareFunction::Never => false,
            CompareFunction::Always => true,
            CompareFunction::Less => reference < stored,
            CompareFunction::LessOrEqual => reference <= stored,
            CompareFunction::Equal => reference == stored,
            CompareFunction::NotEqual => reference != stored,
            CompareFunction::Greater => reference > stored,
            CompareFunction::GreaterOrEqual => reference >= stored,
        };
        if passes { 255 } else { 0 }
    }
}

/// Draws a random texture in many ways and returns the words that the rules give for both targets.
fn drawn(seed: u64, met: &mut Met) -> (Scene, [Vec<u32>; 2]) {
    let mut random = Random::seeded(seed);
    let next = &mut || random.bits() as u32;
    let image = Image::new(next);
    let mut words = [(); 2].map(|()| vec![0; (SIDES[0] * SIDES[1]) as usize]);
    let mut draws = Vec::new();
    for row in 0..SIDES[1] / 2 {
        let place = Place::new(next, &image, row);
        let unit = unit(next, &image, &place);
        draws.extend([0, 1].map(|target| place.draw(&image, unit, target)));
        let [left, top, width, height] = place.area.map(i64::from);
        for (i, j) in (0..height).flat_map(|j| (0..width).map(move |i| (i, j))) {
            let register = Sampler { image: &image, unit: &unit, met }.sample(&place, [i, j]);
            let at = ((top + j) * i64::from(SIDES[0]) + left + i) as usize;
            for (target, sign) in [1, -1].into_iter().enumerate() {
                let [r, g, b, a] = register.map(|n| (sign * n).clamp(0, 255) as u32);
                words[target][at] = a << 24 | r << 16 | g << 8 | b;
            }
        }
    }
    let texels = Texels {
        width: image.sides[0],
        height: image.sides[1],
        levels: image.levels,
        layers: image.layers,
        border: image.border,
        words: image.words.into(),
    };
    let target = |name: &str| Target { name: name.into(), ..Target::new(SIDES[0], SIDES[1], SurfaceFormat::A8R8G8B8) };
    let texture =
        Texture { name: "t".into(), kind: image.kind, format: image.format, image: TextureImage::Texels(texels) };
    let palettes = vec![Palette { name: "p".into(), entries: image.palette.into() }];
    let palettes = if image.format == TextureFormat::P8 { palettes } else { Vec::new() };
    let targets = vec![target("as it is"), target("negated")];
    (Scene { profile: image.profile, targets, textures: vec![texture], palettes, draws }, words)
}

#[test]
fn fetch_and_filter_at_the_ends_of_their_ranges() {
    let mut met = Met::new();
    let isas = Isa::ALL
        .iter()
        .filter(|isa| isa.is_available())
        .map(|isa| RenderOptions { isa: Some(*isa), ..RenderOptions::default() });
    let ways: Vec<RenderOptions> =
        isas.chain([RenderOptions { engine: Engine::Scalar, ..RenderOptions::default() }]).collect();
    for seed in 0..SCENES {
        let (scene, wanted) = drawn(seed, &mut met);
        let plan =
            Plan::compile(&scene, &PlanOptions::default()).unwrap_or_else(|errors| panic!("scene {seed}: {errors:?}"));
        for way in &ways {
            let frames = render(&plan, way);
            for (surface, wanted) in frames.surfaces.iter().zip(&wanted) {
                let Some(at) = (0..wanted.len()).find(|at| surface.words[*at] != wanted[*at]) else { continue };
                let (x, y) = (at as u32 % SIDES[0], at as u32 / SIDES[0]);
                let draw = &scene.draws[y as usize / 2 * 2];
                let texture = &scene.textures[0];
                panic!(
                    "scene {seed}, {way:?}, ({x}, {y}): {:08x}, by the rules {:08x}\n{:?} {:?} {:?}\n{:?}\n{:?}",
                    surface.words[at],
                    wanted[at],
                    scene.profile,
                    texture.kind,
                    texture.format,
                    draw.textures[0],
                    draw.vertices
                );
            }
        }
    }
    let name = |name: &&'static str| (*name).to_owned();
    let mut wanted: Vec<String> = TextureFormat::NAMES.iter().chain(TextureKind::NAMES).map(name).collect();
    wanted.extend(AddressMode::NAMES.iter().flat_map(|mode| [format!("{mode} below"), format!("{mode} above")]));
    wanted.push("border colour".to_owned());
    for weight in [0, 1, 127, 128, 129, 254, 255] {
        wanted.extend(["along s", "along t", "of levels"].map(|what| format!("weight {weight} {what}")));
    }
    let orders = ["Less", "Equal", "Greater"];
    wanted.extend(
        CompareFunction::NAMES.iter().flat_map(|function| orders.map(|order| format!("{function} of {order}"))),
    );
    let missing: Vec<String> = wanted.into_iter().filter(|what| !met.contains(what)).collect();
    assert!(missing.is_empty(), "not met: {missing:?}");
}
