//! Probes of texels and colours that depend on the last bits of the weights (WGT-1).

use crate::build::{draw, target, vertex};
use crate::sheet::bind;
use crate::table::Row;
use ninebit::frame::Surface;
use ninebit::state::*;

/// Colour beyond a texture of one texel. No texel has it.
const BEYOND: [u8; 4] = [255; 4];

/// Returns the scene that draws the triangle of a row at the row's pixel alone. A texel's word is its number along the row's axis.
fn scene(row: &Row) -> Scene {
    let (x, y): (u32, u32) = (row.number("x"), row.number("y"));
    let component = row.text("component");
    let axis = ["s", "t"].iter().position(|axis| *axis == component);
    let bits = |column: String| f32::from_bits(u32::from_str_radix(row.text(&column), 16).unwrap());
    let vertices = [0, 1, 2].map(|k| {
        let [px, py] = ["x", "y"].map(|axis| row.number::<f32>(&format!("{axis}{k}")) / 16.0);
        let value = format!("value{k}");
        let color = if axis.is_some() { 0 } else { row.number(&value) };
        let mut vertex = vertex(px, py, [color; 4]);
        vertex.position[3] = bits(format!("w{k}"));
        if let Some(axis) = axis {
            vertex.texture_coordinates[0][axis] = bits(value);
        }
        vertex
    });
    let mut draw = Draw {
        perspective: true,
        scissor: Some(Rectangle { x, y, width: 1, height: 1 }),
        ..draw(Topology::Triangles, vertices.to_vec())
    };
    let mut textures = Vec::new();
    if let Some(axis) = axis {
        let size: u32 = row.number("size");
        let (mut sides, mut kind, mut mode) = ([1, 1], TextureKind::TwoDimensional, AddressMode::Wrap);
        sides[axis] = size;
        if size == 1 {
            // A coordinate of a rectangle counts texels, as one of a single texel does.
            (sides[axis], kind, mode) = (8, TextureKind::Rectangle, AddressMode::ClampToBorder);
        }
        let [width, height] = sides;
        let words = (0..width * height).collect();
        let image = TextureImage::Texels(Texels { width, height, levels: 1, layers: 1, border: false, words });
        textures.push(Texture { name: "numbers".to_string(), kind, format: TextureFormat::A8R8G8B8, image });
        bind(&mut draw, 0, 0);
        let unit = draw.textures[0].as_mut().unwrap();
        (unit.address_s, unit.address_t, unit.border_color) = (mode, mode, BEYOND);
        draw.combiners = Combiners::showing(FinalRegister::Texture0);
    }
    let frame = target(x + 1, y + 1, SurfaceFormat::A8R8G8B8, [0; 4]);
    Scene { profile: Profile::Nv2a, targets: vec![frame], textures, palettes: vec![], draws: vec![draw] }
}

/// Returns what a model draws in place of what the chip showed, if that differs.
pub fn difference(row: &Row, render: impl Fn(&Scene) -> Vec<Surface>) -> Option<String> {
    let word = *render(&scene(row))[0].words.last().unwrap() & 0xff_ffff;
    let (shown, size): (i64, i64) = (row.number("shown"), row.number("size"));
    let expected = match size {
        0 => shown * 0x01_0101,
        1 => shown,
        _ => shown.rem_euclid(size),
    };
    (i64::from(word) != expected).then(|| format!("weights.tsv:{}: {}: {word:#x}", row.line, row.describe()))
}

/// Draws with the oracle.
pub fn by_oracle(scene: &Scene) -> Vec<Surface> {
    ninebit_oracle::render(scene, &Policies::DEFAULT)
}
