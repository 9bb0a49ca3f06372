//! Minified normal maps with and without levels, drawn by `shimmer.ron`.

use super::content::length;
use super::page::{Section, cells};
use super::view::{Picture, draw, plan, scene, visit};
use ninebit::state::{Level, Positions, TextureImage};

pub fn section() -> Section {
    let mut scene = scene("shimmer.ron");
    let still = plan(&scene);
    for draw in &mut scene.draws {
        let Positions::Clip(viewport) = &mut draw.positions else { panic!("clip space") };
        viewport.x += 0.5;
    }
    let moved = plan(&scene);
    let (a, b) = (draw(&still), draw(&moved));
    // Band of lod of each pixel, where 0 means magnified.
    let mut bands = vec![None; a.pixels.len()];
    visit(&still, |covered| {
        let (i, j) = covered.pixel;
        bands[j as usize * a.width + i as usize] =
            Some((covered.lod().max(-1) / 256 + i32::from(covered.lod() > 0)) as usize);
    });
    // The left half has no levels and thus no lod, so it takes the band of the right half.
    let band = |x: usize, y: usize| bands[y * a.width + x % 256 + 256];
    let names = ["magnified", "1 to 2 texels a pixel", "2 to 4", "4 to 8", "more than 8"];
    let mut rows = vec![cells([
        "rms difference of two frames half a pixel apart, steps",
        "pixels",
        "level 0 alone",
        "all levels",
    ])];
    for (n, name) in names.iter().enumerate() {
        let mut squares = [0.0; 2];
        let mut count = 0;
        for y in 0..a.height {
            for x in (0..256).filter(|x| band(*x, y).is_some_and(|band| band.min(4) == n)) {
                count += 1;
                for half in 0..2 {
                    let at = x + 256 * half;
                    squares[half] += f64::from(a.at(at, y)[0].abs_diff(b.at(at, y)[0])).powi(2);
                }
            }
        }
        let [left, right] = squares.map(|s| format!("{:.1}", (s / f64::from(count.max(1))).sqrt()));
        rows.push(vec![name.to_string(), count.to_string(), left, right]);
    }
    let difference = Picture::from(a.width, a.height, |x, y| [a.at(x, y)[0].abs_diff(b.at(x, y)[0]); 3]);
    let halves = |of: &Picture, what: &str| {
        let half = |(name, left)| of.part(left, 0, 128, 128).tile(format!("{name}{what}"));
        [("level 0 alone", 64), ("all levels", 320)].map(half).to_vec()
    };
    Section {
        name: "minified",
        tables: vec![rows, levels(&scene)],
        pictures: vec![("shimmer.svg", vec![halves(&a, ""), halves(&difference, ", difference after half a pixel")])],
        charts: vec![],
    }
}

/// Returns the lengths of the normals of each level. A byte b stands for (b - 128) / 127.
fn levels(scene: &ninebit::state::Scene) -> Vec<Vec<String>> {
    let texture = &scene.textures[scene.draws[1].textures[0].unwrap().texture];
    let TextureImage::Texels(texels) = &texture.image else { panic!("texels expected") };
    let (levels, _) = Level::chain(texture.format, texels.width, texels.height, texels.levels, false);
    let mut rows = vec![cells(["level", "texels", "mean length of the normals", "shortest"])];
    for (n, level) in levels.iter().enumerate() {
        let words = &texels.words[level.offset..level.offset + (level.width * level.height) as usize];
        let lengths = words.iter().map(|word| {
            let component = |shift: u32| (f64::from(word >> shift & 255) - 128.0) / 127.0;
            length([component(16), component(8), component(0)])
        });
        let (sum, least) = lengths.fold((0.0, f64::INFINITY), |(sum, least), l| (sum + l, f64::min(least, l)));
        let size = format!("{} x {}", level.width, level.height);
        rows.push(vec![n.to_string(), size, format!("{:.3}", sum / words.len() as f64), format!("{least:.3}")]);
    }
    rows
}
