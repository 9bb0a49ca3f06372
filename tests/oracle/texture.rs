//! Samples at known coordinates: TEX-5 to TEX-9, TEX-14, TEX-18.

use super::block;
use super::coordinate::Place;
use super::raster::{Sample, Setup};
use super::sampling;
use super::tally::{count, count_named};
use super::texel::{self, Color};
use ninebit::frame::Surface;
use ninebit::state::{
    AddressMode, ColorKey, ColorKeyMode, DepthFormat, Filter, MipFilter, Named, Profile, Scene, ShadowComparison,
    TextureFormat, TextureImage, TextureKind, TextureUnit,
};
use std::cmp::Ordering;

/// A bound unit, with the words of its texture at the beginning of a draw.
pub struct Image {
    pub unit: TextureUnit,
    kind: TextureKind,
    format: TextureFormat,
    size: [u32; 2],
    levels: u32,
    layers: u32,
    border: bool,
    words: Vec<u32>,
    palette: Vec<u32>,
    nv2a: bool,
}

impl Image {
    pub fn new(scene: &Scene, unit: TextureUnit, surfaces: &[Surface]) -> Image {
        let texture = &scene.textures[unit.texture];
        let mut layers = 1;
        let (size, levels, border, words) = match &texture.image {
            TextureImage::Texels(t) => {
                layers = t.layers;
                ([t.width, t.height], t.levels, t.border, t.words.to_vec())
            }
            TextureImage::Depth { target } => {
                let s = &surfaces[*target];
                ([s.width, s.height], 1, false, s.depth.clone())
            }
            TextureImage::Target { target } => {
                let s = &surfaces[*target];
                let (pixel, texel) = (8 * scene.targets[*target].format.bytes(), 8 * texture.format.bytes());
                let width = s.width * pixel / texel;
                match pixel.cmp(&texel) {
                    Ordering::Less => count("texels", "longer than pixels"),
                    Ordering::Equal => {}
                    Ordering::Greater => count("texels", "shorter than pixels"),
                }
                // Bit n of a row is bit n % pixel of a pixel, and bit n % texel of a texel.
                let bit = |n: usize| s.words[n / pixel as usize] >> (n % pixel as usize) & 1;
                let word = |k: usize| (0..texel as usize).map(|n| bit(k * texel as usize + n) << n).sum();
                ([width, s.height], 1, false, (0..(width * s.height) as usize).map(word).collect())
            }
        };
        let palette = unit.palette.map_or(Vec::new(), |p| scene.palettes[p].entries.to_vec());
        let nv2a = scene.profile == Profile::Nv2a;
        Image { unit, kind: texture.kind, format: texture.format, size, levels, layers, border, words, palette, nv2a }
    }

    pub fn kind(&self) -> &'static str {
        self.kind.name()
    }

    pub fn is_cube(&self) -> bool {
        self.kind == TextureKind::Cube
    }

    fn side(&self, level: u32, axis: usize) -> u32 {
        (self.size[axis] >> level).max(1)
    }

    /// Returns the number of texels of a level that a coordinate of 1.0 spans, which is 1 for rectangles.
    pub fn scale(&self, level: u32) -> [u32; 2] {
        [0, 1].map(|a| if self.kind == TextureKind::Rectangle { 1 } else { self.side(level, a) })
    }

    /// Returns the number of stored columns and rows of a level, borders included.
    fn stored(&self, level: u32) -> [usize; 2] {
        [0, 1].map(|a| self.side(level, a) as usize + if self.border { 8 } else { 0 })
    }

    fn level_words(&self, level: u32) -> usize {
        let [w, h] = self.stored(level);
        match self.format {
            TextureFormat::Dxt1 => 2 * w.div_ceil(4) * h.div_ceil(4),
            TextureFormat::Dxt3 | TextureFormat::Dxt5 => 4 * w.div_ceil(4) * h.div_ceil(4),
            _ => w * h,
        }
    }

    /// Returns the channels of a stored texel as the filter reads them, or two halves for formats that have them.
    fn stored_texel(&self, face: usize, level: u32, [x, y]: [usize; 2]) -> [i128; 4] {
        let whole: usize = (0..self.levels).map(|n| self.level_words(n)).sum();
        let start = face * whole + (0..level).map(|n| self.level_words(n)).sum::<usize>();
        let words = &self.words[start..start + self.level_words(level)];
        let width = self.stored(level)[0];
        let of_block = match self.format {
            TextureFormat::Dxt1 => 2,
            TextureFormat::Dxt3 | TextureFormat::Dxt5 => 4,
            _ => 0,
        };
        if of_block > 0 {
            let block = of_block * (y / 4 * width.div_ceil(4) + x / 4);
            return self.bytes(block::texel(self.format, self.nv2a, &words[block..block + of_block], x, y));
        }
        let word = words[y * width + x];
        match self.format {
            TextureFormat::P8 => {
                let entry = self.palette[word as usize & (self.palette.len() - 1)];
                self.bytes(texel::bytes(TextureFormat::A8R8G8B8, entry))
            }
            format if texel::has_halves(format) => self.halves(texel::halves(format, word)),
            format => self.bytes(texel::bytes(format, word)),
        }
    }

    /// TEX-18: makes signed channels two's complement.
    fn bytes(&self, bytes: [i128; 4]) -> [i128; 4] {
        std::array::from_fn(|c| texel::signed(self.unit.signed[c], bytes[c], 8))
    }

    fn half_flags(&self) -> [bool; 2] {
        // The upper half of Y16 is constant and never signed.
        [self.unit.signed[3] && self.format == TextureFormat::R16B16, self.unit.signed[1]]
    }

    fn halves(&self, halves: [i128; 2]) -> [i128; 4] {
        let [high, low] = self.half_flags();
        [texel::signed(high, halves[0], 16), texel::signed(low, halves[1], 16), 0, 0]
    }

    fn border_color(&self) -> [i128; 4] {
        count("border", "color");
        let [r, g, b, a] = self.unit.border_color.map(i128::from);
        if texel::has_halves(self.format) { self.halves([a << 8 | r, g << 8 | b]) } else { self.bytes([r, g, b, a]) }
    }

    /// TEX-7, TEX-8, TEX-14: returns the texel at an index that may lie outside the image.
    fn fetch(&self, face: Option<usize>, level: u32, index: [i128; 2]) -> [i128; 4] {
        match (face, self.inside(level, index)) {
            (Some(face), Some(at)) => self.stored_texel(face, level, at),
            _ => self.border_color(),
        }
    }

    /// TEX-7: returns the position of a texel in the stored level, or `None` for the border colour.
    fn inside(&self, level: u32, index: [i128; 2]) -> Option<[usize; 2]> {
        let modes = [self.unit.address_s, self.unit.address_t];
        let mut at = [0; 2];
        for axis in 0..2 {
            let (i, n) = (index[axis], i128::from(self.side(level, axis)));
            if i < 0 || i >= n {
                count(if self.is_cube() { "cube edge" } else { "outside" }, modes[axis].name());
            }
            // If a border is stored, the interior begins at (4, 4).
            let origin = if self.border { 4 } else { 0 };
            let inside = match modes[axis] {
                _ if self.is_cube() => i.clamp(0, n - 1),
                AddressMode::Wrap => i.rem_euclid(n),
                AddressMode::Mirror => {
                    let i = i.rem_euclid(2 * n);
                    if i < n { i } else { 2 * n - 1 - i }
                }
                AddressMode::ClampToEdge | AddressMode::Clamp => i.clamp(0, n - 1),
                AddressMode::ClampToBorder if self.border => {
                    count("border", "texels");
                    i.clamp(-4, n + 3)
                }
                AddressMode::ClampToBorder if i < 0 || i >= n => return None,
                AddressMode::ClampToBorder => i,
            };
            at[axis] = (inside + origin) as usize;
        }
        Some(at)
    }

    /// VOL-1: returns the layer, or `None` for the border colour.
    fn layer(&self, setup: &Setup, sample: &Sample, place: &Place) -> Option<usize> {
        let (n, i) = (i128::from(self.layers), sampling::layer(place, setup, sample, self.layers) >> 8);
        count("layer", if (0..n).contains(&i) { "inside" } else { self.unit.address_r.name() });
        let layer = match self.unit.address_r {
            AddressMode::Wrap => i.rem_euclid(n),
            AddressMode::Mirror => (i.rem_euclid(2 * n)).min(2 * n - 1 - i.rem_euclid(2 * n)),
            AddressMode::ClampToEdge | AddressMode::Clamp => i.clamp(0, n - 1),
            AddressMode::ClampToBorder if (0..n).contains(&i) => i,
            AddressMode::ClampToBorder => return None,
        };
        Some(layer as usize)
    }

    /// SHD-1: compares a stored depth with the reference.
    pub fn compare(
        &self,
        shadow: ShadowComparison,
        setup: &Setup,
        sample: &Sample,
        place: &Place,
        set: usize,
    ) -> Color {
        count_named(self.format);
        let (_, [u, v]) = place.at(setup, sample, self.scale(0));
        // The border never occurs, because such units are refused.
        let at = self.inside(0, [u >> 8, v >> 8]).unwrap_or_default();
        let stored = i128::from(self.words[at[1] * self.size[0] as usize + at[0]] % (1 << 24));
        let format = match self.format {
            TextureFormat::Z16 => DepthFormat::Z16,
            TextureFormat::Z16F => DepthFormat::Z16F,
            TextureFormat::Z24S8 => DepthFormat::Z24S8,
            _ => DepthFormat::Z24S8F,
        };
        let reference = sampling::reference(setup, sample, set, format);
        Color::of_channels([sampling::compared(shadow, reference, stored); 4], [false; 4])
    }

    /// TEX-5, TEX-6: filters within a level.
    fn filtered(&self, filter: Filter, face: Option<usize>, level: u32, [u, v]: [i128; 2]) -> [i128; 4] {
        match filter {
            Filter::Nearest => self.fetch(face, level, [u >> 8, v >> 8]),
            Filter::Linear => {
                let (u, v) = (u - 128, v - 128);
                let (x, y) = (u >> 8, v >> 8);
                let [a, b, c, d] =
                    [[x, y], [x + 1, y], [x, y + 1], [x + 1, y + 1]].map(|at| self.fetch(face, level, at));
                let rows = [mix(a, b, u & 255), mix(c, d, u & 255)];
                mix(rows[0], rows[1], v & 255)
            }
        }
    }

    /// TEX-9: returns a lod in 1/256 with bias and limits applied.
    pub fn limited_lod(&self, lod: i128) -> i128 {
        let biased = lod + i128::from(self.unit.lod_bias);
        biased.max(self.unit.min_lod.into()).min(self.unit.max_lod.into())
    }

    /// KEY-1: returns whether a texel matches the key. The filter of a unit with a key is nearest.
    fn is_keyed(&self, value: [i128; 4]) -> bool {
        self.unit.color_key.is_some_and(|key| {
            let channels = if texel::has_alpha(self.format) { 4 } else { 3 };
            (0..channels).all(|c| value[c] & 255 == key.color[c].into())
        })
    }

    /// KEY-1: returns whether a sampled colour drops the fragment. A key that does so never changes the texel.
    pub fn drops(&self, color: &Color) -> bool {
        let drops = self.unit.color_key.is_some_and(|key| key.mode == ColorKeyMode::Texel);
        drops && self.is_keyed(color.bytes)
    }

    /// Samples at a place, with a lod that is already limited.
    pub fn sample(
        &self,
        setup: &Setup,
        sample: &Sample,
        place: &Place,
        lod: i128,
        taps: &[([i128; 2], i128)],
    ) -> Color {
        count_named(self.format);
        count_named(self.kind);
        let last = i128::from(self.levels) - 1;
        let level = |filter: Filter, n: i128| {
            let (face, at) = place.at(setup, sample, self.scale(n as u32));
            count("face", ["+X", "-X", "+Y", "-Y", "+Z", "-Z"][face]);
            count("level", ["0", "1", "2", "3", "4", "5", "6", "7"][(n as usize).min(7)]);
            let image =
                if self.kind == TextureKind::ThreeDimensional { self.layer(setup, sample, place) } else { Some(face) };
            if let [_] = taps {
                return self.filtered(filter, image, n as u32, at);
            }
            let mut sum = [128; 4];
            for (offset, weight) in taps {
                let tap = self.filtered(filter, image, n as u32, [at[0] + offset[0], at[1] + offset[1]]);
                sum = std::array::from_fn(|c| sum[c] + tap[c] * weight);
            }
            sum.map(|sum| sum >> 8)
        };
        let min = self.unit.min_filter;
        let value = match self.unit.mip_filter {
            _ if lod <= 0 => {
                count("magnified", self.unit.mag_filter.name());
                level(self.unit.mag_filter, 0)
            }
            MipFilter::None => {
                count("minified without levels", min.name());
                level(min, 0)
            }
            MipFilter::Nearest => {
                count("minified to the nearest level", min.name());
                level(min, last.min((lod + 128) >> 8))
            }
            MipFilter::Linear => {
                count("minified between levels", min.name());
                let n = lod >> 8;
                mix(level(min, last.min(n)), level(min, last.min(n + 1)), lod & 255)
            }
        };
        let keyed = self.is_keyed(value);
        let value = match self.unit.color_key {
            Some(ColorKey { mode: ColorKeyMode::Alpha, .. }) if keyed => [value[0], value[1], value[2], 0],
            Some(ColorKey { mode: ColorKeyMode::Color, .. }) if keyed => [0; 4],
            _ => value,
        };
        if texel::has_halves(self.format) {
            Color::of_halves([value[0], value[1]], self.half_flags())
        } else {
            Color::of_channels(value, self.unit.signed)
        }
    }
}

/// TEX-6: returns L(a, b, w) of every channel.
fn mix(a: [i128; 4], b: [i128; 4], w: i128) -> [i128; 4] {
    std::array::from_fn(|k| (a[k] * (256 - w) + b[k] * w + 128) >> 8)
}
