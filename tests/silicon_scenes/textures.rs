//! Computes the textures of the captured programs by the same formulas.

/// R, G, B, A bytes of a pixel.
pub type Pixel = [u8; 4];

/// A picture with its pixels row by row from the top.
pub struct Picture {
    pub width: u32,
    pub height: u32,
    pub pixels: Vec<Pixel>,
}

impl Picture {
    fn from_pixels(width: u32, height: u32, pixel: impl Fn(u32, u32) -> Pixel) -> Picture {
        let pixels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| pixel(x, y)).collect();
        Picture { width, height, pixels }
    }
}

/// Returns a gradient: green from left to right, red from top to bottom, blue the inverse of red, and alpha the sum of red and green.
pub fn gradient(width: u32, height: u32) -> Picture {
    let step = |i: u32, n: u32| (i as f32 * 255.0 / n as f32) as u8;
    Picture::from_pixels(width, height, |x, y| {
        let (r, g) = (step(y, height), step(x, width));
        [r, g, 255 - r, r.wrapping_add(g)]
    })
}

/// Returns two by two gradients, with alpha decreasing from the centre.
pub fn four_gradients() -> Picture {
    let one = gradient(128, 128);
    Picture::from_pixels(256, 256, |x, y| {
        let [r, g, b, _] = one.pixels[(y % 128 * 128 + x % 128) as usize];
        let (dx, dy) = (x as f32 - 128.0, y as f32 - 128.0);
        [r, g, b, (255.0 * (1.0 - (dx * dx + dy * dy) / 32768.0)) as u8]
    })
}

/// Returns 256 x 256 indices into 64 entries. The upper half has all of them, the lower half every fourth.
pub fn indices() -> Vec<u8> {
    (0..65536_u32).map(|k| if k < 32768 { k & 63 } else { k & !3 & 63 } as u8).collect()
}

/// Returns diagonal stripes in steps of two texels, alternately opaque and translucent.
pub fn stripes() -> Picture {
    const COLORS: [[u8; 3]; 4] = [[255, 0, 0], [0, 255, 0], [0x44, 0x44, 255], [255; 3]];
    Picture::from_pixels(32, 32, |x, y| {
        let n = (x / 2 + y / 2) as usize % 8;
        let [r, g, b] = COLORS[n / 2];
        [r, g, b, if n.is_multiple_of(2) { 255 } else { 0x66 }]
    })
}

/// Returns [`stripes`] with red and blue exchanged, in a checkered border of four texels on each side.
pub fn bordered_stripes() -> Picture {
    let inside = stripes();
    Picture::from_pixels(40, 40, |x, y| match (x.checked_sub(4), y.checked_sub(4)) {
        (Some(x), Some(y)) if x < 32 && y < 32 => {
            let [r, g, b, a] = inside.pixels[(y * 32 + x) as usize];
            [b, g, r, a]
        }
        _ if (x / 2 + y / 2) % 2 == 0 => [204, 204, 204, 255],
        _ => [68, 68, 68, 255],
    })
}

/// Returns a texture with green just below one half in two columns, and just above it in the others.
pub fn step() -> Picture {
    Picture::from_pixels(256, 256, |x, _| [0, if x < 2 { 0x7f } else { 0x80 }, 0x45, 255])
}

/// Returns colours that increase from the centre outwards, first fast and then slowly. `mask` tells which channels are on; all of these
/// have the largest of the three values.
pub fn radial(side: u32, mask: [bool; 3]) -> Picture {
    let side_f = side as f32;
    let centre = (side_f - 1.0) / 2.0;
    let farthest = (centre * centre + centre * centre).sqrt();
    Picture::from_pixels(side, side, |x, y| {
        let (x, y) = (x as f32, y as f32);
        let (dx, dy) = (x - centre, y - centre);
        let distance = (dx * dx + dy * dy).sqrt() / farthest;
        let brightness = if distance < 0.25 { distance / 0.25 * 0.5 } else { 0.5 + (distance - 0.25) / 0.75 * 0.5 };
        let byte = |share: f32| (share * brightness * 255.0) as u32 as u8;
        let [r, g, b] = [byte(x / side_f), byte(y / side_f), byte(0.75)];
        let largest = r.max(g).max(b);
        let [r, g, b] = mask.map(|on| if on { largest } else { 0 });
        [r, g, b, 255]
    })
}

/// Returns every stored picture with its name.
pub fn pictures() -> Vec<(String, Picture)> {
    let mut pictures = vec![
        ("gradient-256".to_string(), gradient(256, 256)),
        ("four-gradients".to_string(), four_gradients()),
        ("stripes".to_string(), stripes()),
        ("bordered-stripes".to_string(), bordered_stripes()),
        ("step".to_string(), step()),
    ];
    for (name, mask) in RADIAL {
        pictures.push((format!("radial-{name}"), radial(RADIAL_SIDE, mask)));
    }
    pictures
}

/// Width and height of the radial gradients.
const RADIAL_SIDE: u32 = 64;

/// The radial gradients with their channels, in the order of the faces of a cube map.
pub const RADIAL: [(&str, [bool; 3]); 6] = [
    ("red", [true, false, false]),
    ("magenta", [true, false, true]),
    ("green", [false, true, false]),
    ("yellow", [true, true, false]),
    ("blue", [false, false, true]),
    ("cyan", [false, true, true]),
];
