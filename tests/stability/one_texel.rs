//! The last levels of a texture, drawn by `one-texel-levels.ron`.

use super::page::{Section, cells};
use super::view::{draw, plan, scene};
use ninebit::state::{Level, TextureImage};

pub fn section() -> Section {
    let scene = scene("one-texel-levels.ron");
    let frame = draw(&plan(&scene));
    let texture = &scene.textures[0];
    let TextureImage::Texels(texels) = &texture.image else { panic!("texels expected") };
    let (levels, _) = Level::chain(texture.format, texels.width, texels.height, texels.levels, false);
    let mean = texels.words[..64].iter().map(|word| f64::from(*word)).sum::<f64>() / 64.0;
    let mut rows =
        vec![cells(["level", "texels", "lowest and highest shown", "mean shown", "off the mean of level 0"])];
    for (n, level) in levels.iter().enumerate() {
        let strip = frame.part(0, 16 * n, 256, 14);
        // One row is sufficient. All rows of the strip are the same, since the level is one texel high.
        assert!((1..14).all(|y| (0..256).all(|x| strip.at(x, y) == strip.at(x, 0))));
        let row: Vec<u8> = (0..256).map(|x| strip.at(x, 0)[0]).collect();
        let shown = row.iter().map(|v| f64::from(*v)).sum::<f64>() / 256.0;
        rows.push(vec![
            n.to_string(),
            format!("{} x {}", level.width, level.height),
            format!("{}, {}", row.iter().min().unwrap(), row.iter().max().unwrap()),
            format!("{shown:.2}"),
            format!("{:+.2}", shown - mean),
        ]);
    }
    Section {
        name: "one-texel",
        tables: vec![rows],
        pictures: vec![("one-texel-levels.svg", vec![vec![frame.tile("levels 0, at the top, to 6")]])],
        charts: vec![],
    }
}
