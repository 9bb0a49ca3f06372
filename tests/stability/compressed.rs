//! Normal maps in DXT blocks: `normals-*.ron`.

use super::page::{Section, cells};
use super::view::{Picture, draw, plan, rms, scene};

pub fn section() -> Section {
    let shown = |name: &str| draw(&plan(&scene(&format!("normals-{name}.ron"))));
    let whole = shown("uncompressed");
    let mut rows = vec![cells(["normal map as", "mean, steps", "rms", "largest"])];
    let mut panels = vec![crop(&whole)];
    for (name, label) in
        [("dxt3", "DXT3"), ("dxt5", "DXT5"), ("dxt1", "DXT1 on nv2a, dithered"), ("dxt1-nv10", "DXT1 on nv10, 565")]
    {
        let frame = shown(name);
        let differences: Vec<u8> = frame.pixels.iter().zip(&whole.pixels).map(|(a, b)| a[0].abs_diff(b[0])).collect();
        let mean = differences.iter().map(|d| f64::from(*d)).sum::<f64>() / differences.len() as f64;
        let largest = differences.iter().max().unwrap();
        rows.push(vec![label.to_string(), format!("{mean:.2}"), format!("{:.2}", rms(&frame, &whole)), largest.to_string()]);
        if name != "dxt5" {
            panels.push(crop(&frame));
        }
    }
    Section {
        name: "compressed",
        tables: vec![rows],
        pictures: vec![("normals-compressed.png", Picture::row(&panels))],
        charts: vec![],
    }
}

fn crop(frame: &Picture) -> Picture {
    frame.part(32, 32, 128, 128)
}
