//! Edges of cube maps, drawn by `cube-edge.ron` and `cube-ties.ron`.

use super::content::{directions, dot, unit};
use super::page::{Section, cells};
use super::view::{Picture, draw, plan, scene, visit};
use ninebit::plan::Plan;
use ninebit::raster::binary::Binary;
use ninebit::state::{Scene, Texture, TextureImage};
use ninebit::texture::coordinates::Coordinates;
use ninebit::texture::cube::Face;
use ninebit_scene::generate::normal_map::encode;

pub fn section() -> Section {
    let scene = scene("cube-edge.ron");
    let mut rows = vec![cells([
        "texels a face",
        "largest jump inside a face, steps",
        "across an edge",
        "largest error of the direction",
    ])];
    for side in [4, 8, 16, 32, 64, 128] {
        let (inside, across, worst) = jumps(&scene, side);
        rows.push(vec![
            format!("{side} x {side}"),
            inside.to_string(),
            across.to_string(),
            format!("{worst:.1} degrees"),
        ]);
    }
    let plan_of_page = plan(&scene);
    let frame = draw(&plan_of_page);
    // Eight times the errors of the bilinear half with respect to the exact directions.
    let map = faces(&plan_of_page);
    let error = Picture::from(256, 256, |x, y| {
        let (_, direction) = map[256 * y + x];
        let want = encode(unit(direction));
        let got = frame.at(x + 256, y);
        std::array::from_fn(|n| got[n].abs_diff(want[n]).saturating_mul(8))
    });
    let panels = vec![
        frame.part(64, 64, 128, 128).tile("nearest"),
        frame.part(320, 64, 128, 128).tile("bilinear: seams between the faces"),
        error.part(64, 64, 128, 128).tile("error of bilinear, eight times"),
    ];
    let ties_of_page = draw(&plan(&super::view::scene("cube-ties.ron")));
    Section {
        name: "cube",
        tables: vec![rows, ties()],
        pictures: vec![
            ("cube-edge.svg", vec![panels]),
            ("cube-ties.svg", vec![vec![ties_of_page.tile("directions in the order of the table")]]),
        ],
        charts: vec![],
    }
}

/// Returns face and direction of each pixel of the bilinear half.
fn faces(plan: &Plan) -> Vec<(Face, [f64; 3])> {
    let mut map = vec![(Face::PositiveX, [0.0; 3]); 256 * 256];
    visit(plan, |covered| {
        if covered.draw == 1 {
            let Coordinates::Direction(g) = Coordinates::new(covered.coordinates(), covered.unit) else {
                panic!("a cube map is sampled with a direction");
            };
            let at = covered.sample();
            // Numbers of at most 26 bits.
            let direction = g.map(|g| {
                let Binary { mantissa, exponent } = at.value(&g);
                mantissa as f64 * 2_f64.powi(exponent as i32)
            });
            let face = Face::from_direction(direction, direction.map(f64::abs), 0.0);
            let (i, j) = covered.pixel;
            map[256 * j as usize + i as usize - 256] = (face, direction);
        }
    });
    map
}

/// Measures the bilinear half with a normalisation map of another size. Returns the largest difference of adjacent pixels on one face, and
/// on two faces, and the largest angle between the direction and the vector that is read, in degrees.
fn jumps(scene: &Scene, side: u32) -> (u8, u8, f64) {
    let mut scene = scene.clone();
    let Texture { image: TextureImage::Texels(texels), .. } = &mut scene.textures[0] else { panic!("texels expected") };
    (texels.width, texels.height, texels.words) = (side, side, directions(side).into());
    let plan = plan(&scene);
    let (frame, map) = (draw(&plan), faces(&plan));
    let (mut inside, mut across, mut least) = (0, 0, 1.0_f64);
    for y in 0..256 {
        for x in 0..256 {
            let here = frame.at(x + 256, y);
            let read = here.map(|byte| (f64::from(byte) - 128.0) / 127.0);
            least = least.min(dot(unit(read), unit(map[256 * y + x].1)));
            for (i, j) in [(x + 1, y), (x, y + 1)] {
                if i < 256 && j < 256 {
                    let there = frame.at(i + 256, j);
                    let jump = (0..3).map(|n| here[n].abs_diff(there[n])).max().unwrap();
                    let same = map[256 * y + x].0 == map[256 * j + i].0;
                    let most = if same { &mut inside } else { &mut across };
                    *most = jump.max(*most);
                }
            }
        }
    }
    (inside, across, least.acos().to_degrees())
}

/// TEX-13: returns the rows that `cube-ties.ron` shows, with the face that is read for each tie.
fn ties() -> Vec<Vec<String>> {
    let scene = scene("cube-ties.ron");
    let frame = draw(&plan(&scene));
    let colors = [
        ("+X", [220, 60, 50]),
        ("-X", [110, 30, 25]),
        ("+Y", [80, 190, 90]),
        ("-Y", [40, 95, 45]),
        ("+Z", [70, 110, 230]),
        ("-Z", [35, 55, 115]),
    ];
    let mut rows = vec![cells(["direction", "face that is read"])];
    for (n, corner) in scene.draws[0].vertices.iter().step_by(4).enumerate() {
        let [x, y, z, _] = corner.texture_coordinates[0].map(|c| c as i32);
        let square = frame.part(32 * n + 2, 2, 28, 28);
        assert!(square.pixels.iter().all(|pixel| *pixel == square.pixels[0]), "one face in the whole square");
        let face = colors.iter().find(|(_, color)| *color == square.pixels[0]).unwrap().0;
        rows.push(vec![format!("({x}, {y}, {z})"), face.to_string()]);
    }
    rows
}
