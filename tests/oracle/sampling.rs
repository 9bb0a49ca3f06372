//! Computes volumes, depth comparisons, anisotropic taps and cylindrical wrap: VOL-1, SHD-1, TEX-17, CYL-1.

use super::coordinate::Place;
use super::raster::{Sample, Setup};
use super::real::{Number, bits};
use super::tally::count;
use ninebit::state::{
    AddressMode, CompareFunction, DepthFormat, Named, ShadowComparison, ShadowReference, TextureUnit,
};

/// CYL-1: returns the triangle with coordinates of a set that take the shorter way around, or `None` if the unit does not wrap.
pub fn wrapped(setup: &Setup, unit: &TextureUnit, set: usize) -> Option<Setup> {
    if unit.cylindrical_wrap == [false; 2] {
        return None;
    }
    let mut setup = setup.clone();
    for (axis, mode) in [unit.address_s, unit.address_t].into_iter().enumerate() {
        if !unit.cylindrical_wrap[axis] || mode == AddressMode::Mirror {
            continue;
        }
        let first = setup.vertices[0].texture_coordinates[set][axis];
        for vertex in &mut setup.vertices[1..] {
            let value = &mut vertex.texture_coordinates[set][axis];
            let away = *value - first;
            let repeats = (away.abs() - 0.5).ceil().max(0.0);
            count("cylinder", if repeats > 0.0 { "moved" } else { "stays" });
            *value -= repeats.copysign(away);
        }
    }
    Some(setup)
}

/// Returns whether n / d is at least m 2^g, for positive d and n that is not negative.
fn reaches(Number { m: n, e }: Number, Number { m: d, e: f }: Number, (m, g): (i128, i32)) -> bool {
    // n 2^e >= m d 2^(f + g)
    let product = m * d;
    if product == 0 || n == 0 {
        return product == 0;
    }
    let up = f + g - e;
    match (bits(n), bits(product) + up) {
        (a, b) if a != b => a > b,
        _ if up >= 0 => n >> up.min(126) >= product,
        _ => {
            n >= product >> (-up).min(126)
                && (n > product >> (-up).min(126) || product & ((1 << (-up).min(126)) - 1) == 0)
        }
    }
}

/// SHD-1, DEP-3: returns the largest word whose depth is at most r/q.
pub fn reference(setup: &Setup, sample: &Sample, set: usize, format: DepthFormat) -> i128 {
    let [mut r, mut q] = [2, 3].map(|n| setup.number(sample, |v| v.texture_coordinates[set][n]));
    if q.m < 0 {
        (r.m, q.m) = (-r.m, -q.m);
    }
    let full = i128::from(format.largest());
    if r.m <= 0 {
        return 0;
    }
    if q.m == 0 {
        return full;
    }
    let (kept, bias) = match format {
        DepthFormat::Z16F => (12, 7),
        _ => (16, 127),
    };
    let floats = matches!(format, DepthFormat::Z16F | DepthFormat::Z24S8F);
    let depth = |word: i128| match floats {
        false => (word, 0),
        true => {
            let field = (word >> kept).max(1);
            ((word & ((1 << kept) - 1)) | 1 << kept, field as i32 - bias - kept)
        }
    };
    // The last words have an exponent field that no finite number has.
    if format == DepthFormat::Z24S8F && reaches(r, q, depth(0xff_0000)) {
        return full;
    }
    let (mut low, mut high) = (if floats { 1 << kept } else { 0 }, full);
    if !reaches(r, q, depth(low)) {
        return 0;
    }
    while low < high {
        let middle = (low + high + 1) / 2;
        if reaches(r, q, depth(middle)) { low = middle } else { high = middle - 1 }
    }
    low
}

/// SHD-1: returns 255 if the comparison passes, otherwise 0.
pub fn compared(shadow: ShadowComparison, reference: i128, stored: i128) -> i128 {
    let reference = if shadow.reference == ShadowReference::Zero { 0 } else { reference };
    count("shadow", shadow.function.name());
    count("reference", shadow.reference.name());
    let passes = match shadow.function {
        CompareFunction::Never => false,
        CompareFunction::Less => reference < stored,
        CompareFunction::Equal => reference == stored,
        CompareFunction::LessOrEqual => reference <= stored,
        CompareFunction::Greater => reference > stored,
        CompareFunction::NotEqual => reference != stored,
        CompareFunction::GreaterOrEqual => reference >= stored,
        CompareFunction::Always => true,
    };
    if passes { 255 } else { 0 }
}

/// TEX-17: returns the offsets of a footprint's taps in 1/256 texel, and their weights, from the coordinates of a quad's three pixels.
pub fn taps(corners: [Option<[i128; 2]>; 3], limit: u32) -> Vec<([i128; 2], i128)> {
    let single = vec![([0, 0], 256)];
    let [Some(left), Some(right), Some(lower)] = corners else { return single };
    let side = |to: [i128; 2]| [0, 1].map(|a| (to[a] - left[a]).clamp(-1 << 29, 1 << 29));
    let length = |[u, v]: [i128; 2]| ((u * u + v * v) as u128).isqrt() as i128;
    let (across, down) = (side(right), side(lower));
    let (axis, l, k) = if length(across) >= length(down) {
        (across, length(across), length(down))
    } else {
        (down, length(down), length(across))
    };
    // m = max(k, l / A, 1), rounded up.
    let a = i128::from(limit);
    let m = k.max((l + a - 1) / a).max(65536);
    if l <= m {
        count("taps", "1");
        return single;
    }
    // Rounds toward zero in both directions, so that taps are symmetric.
    let at = |numerator: i128, denominator: i128| axis.map(|n| n * numerator / denominator / 256);
    if l <= 2 * m {
        count("taps", "2");
        let [u, v] = at(l - m, 2 * l);
        return vec![([u, v], 128), ([-u, -v], 128)];
    }
    let half = (l + 2 * m - 1) / (2 * m);
    count("taps", ["4", "6", "8"][half as usize - 2]);
    let inner = ((512 * m / l + 1) / 2).min(128 / (half - 1));
    let outer = 128 - (half - 1) * inner;
    (0..half)
        .flat_map(|n| {
            let [u, v] = at((2 * n + 1) * m, 2 * l);
            let weight = if n == half - 1 { outer } else { inner };
            [([u, v], weight), ([-u, -v], weight)]
        })
        .collect()
}

/// VOL-1: returns the coordinate among layers in 1/256 layer, or 0 for coordinates that the texture shader computes.
pub fn layer(place: &Place, setup: &Setup, sample: &Sample, layers: u32) -> i128 {
    place.along(setup, sample, 2, layers).unwrap_or(0)
}
