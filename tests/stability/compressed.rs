//! Normal maps in DXT blocks, drawn by `normals-*.ron`.

use super::content::ball;
use super::page::{Section, cells};
use super::view::{Picture, draw, plan, rms, scene};
use ninebit::state::{Scene, Texture, TextureImage};

pub fn section() -> Section {
    let shown = |name: &str| draw(&plan(&scene(&format!("normals-{name}.ron"))));
    let whole = shown("uncompressed");
    let mut rows = vec![cells(["normal map as", "mean, steps", "rms", "largest"])];
    let blank = Picture::filled(256, 1, [255; 3]);
    let (mut panels, mut errors) = (vec![crop(&whole).tile("A8R8G8B8")], vec![blank.tile("")]);
    for (name, label) in
        [("dxt3", "DXT3"), ("dxt5", "DXT5"), ("dxt1", "DXT1 on nv2a, dithered"), ("dxt1-nv10", "DXT1 on nv10, 565")]
    {
        let frame = shown(name);
        rows.push(row(label, &frame, &whole));
        if name != "dxt5" {
            let error = |x, y| [frame.at(x, y)[0].abs_diff(whole.at(x, y)[0]).saturating_mul(8); 3];
            errors.push(crop(&Picture::from(frame.width, frame.height, error)).tile("error, eight times"));
            panels.push(crop(&frame).tile(label));
        }
    }
    rows.push(row("A8R8G8B8 of 16 x 16", &draw(&plan(&smaller())), &whole));
    Section {
        name: "compressed",
        tables: vec![rows],
        pictures: vec![("normals-compressed.svg", vec![panels, errors])],
        charts: vec![],
    }
}

fn crop(frame: &Picture) -> Picture {
    frame.part(24, 104, 128, 128)
}

/// Returns a row with the errors of a frame. The margin is left out, because the maps end there.
fn row(label: &str, frame: &Picture, whole: &Picture) -> Vec<String> {
    let [frame, whole] = [frame, whole].map(|frame| frame.part(16, 16, 224, 224));
    let differences: Vec<u8> = frame.pixels.iter().zip(&whole.pixels).map(|(a, b)| a[0].abs_diff(b[0])).collect();
    let mean = differences.iter().map(|d| f64::from(*d)).sum::<f64>() / differences.len() as f64;
    let largest = differences.iter().max().unwrap().to_string();
    vec![label.to_string(), format!("{mean:.2}"), format!("{:.2}", rms(&frame, &whole)), largest]
}

/// Returns the reference scene with a smaller map, which takes half the bytes of the DXT1 map.
fn smaller() -> Scene {
    let mut scene = scene("normals-uncompressed.ron");
    let Texture { image: TextureImage::Texels(texels), .. } = &mut scene.textures[0] else { panic!("texels expected") };
    let picture = ball(16);
    let words = picture.pixels().iter().map(|[r, g, b, a]| u32::from_be_bytes([*a, *r, *g, *b]));
    (texels.width, texels.height, texels.words) = (16, 16, words.collect());
    scene
}
