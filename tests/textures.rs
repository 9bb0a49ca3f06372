//! Tests the textures that scenes describe, by kind, source, levels and palette.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use crate::dds;

use dds::File;
use ninebit::engine::{self, RenderOptions};
use ninebit::limits::Limits;
use ninebit::state::{Level, Texels, TextureFormat, TextureImage, TextureKind};
use ninebit::texture::compressed::decode;
use ninebit_scene::{self as scene, LoadedScene, SceneError};
use std::fs;
use std::path::PathBuf;

/// A temporary folder with files for scenes.
struct Folder(tempfile::TempDir);

impl Folder {
    fn new(files: &[(&str, Vec<u8>)]) -> Folder {
        let folder = tempfile::tempdir().unwrap();
        for (name, bytes) in files {
            fs::write(folder.path().join(name), bytes).unwrap();
        }
        Folder(folder)
    }

    fn origin(&self) -> PathBuf {
        self.0.path().join("scene.ron")
    }

    /// Loads a scene with `top` at its beginning and one draw with `units`.
    fn load(&self, profile: &str, top: &str, units: &str) -> Result<LoadedScene, SceneError> {
        let text = format!(
            "(version: 1, profile: {profile}, {top} draws: [(vertices: Window([(position: (0, 0)), (position: (0, 9)), \
             (position: (9, 9))]), textures: [{units}])])"
        );
        scene::parse(&text, &self.origin(), &Limits::default())
    }

    /// Returns the only texture of a scene.
    fn texture(&self, profile: &str, fields: &str) -> (TextureKind, TextureFormat, Texels) {
        let loaded = self.load(profile, &format!("textures: {{ \"t\": ({fields}) }},"), "\"t\"");
        let texture = loaded.unwrap_or_else(|error| panic!("{error}")).scene.textures.remove(0);
        let TextureImage::Texels(texels) = texture.image else { panic!("texels expected") };
        let (_, face) = Level::chain(texture.format, texels.width, texels.height, texels.levels, texels.border);
        assert_eq!(texels.words.len(), face * if texture.kind == TextureKind::Cube { 6 } else { 1 });
        (texture.kind, texture.format, texels)
    }

    fn words(&self, fields: &str) -> Vec<u32> {
        self.texture("Nv2a", fields).2.words.to_vec()
    }
}

#[test]
fn dds_files_bring_format_levels_and_faces() {
    let folder = Folder::new(&[
        ("blocks.dds", File::coded(b"DXT3", 8, 2, 4, (0..16 * 5).collect()).bytes()),
        ("cube.dds", File::plain(dds::L8, 2, 2, 2, (0..30).collect()).with(dds::CAPS2, dds::CUBE).bytes()),
    ]);
    let (kind, format, texels) = folder.texture("Nv10", "source: File(\"blocks.dds\")");
    assert_eq!((kind, format), (TextureKind::TwoDimensional, TextureFormat::Dxt3));
    assert_eq!((texels.width, texels.height, texels.levels, texels.words.len()), (8, 2, 4, 20));
    // Only two levels are read, of which each has whole blocks.
    assert_eq!(folder.words("source: File(\"blocks.dds\"), levels: 2").len(), 12);
    let (kind, format, texels) = folder.texture("Nv10", "source: File(\"cube.dds\")");
    assert_eq!((kind, format, texels.levels), (TextureKind::Cube, TextureFormat::L8, 2));
    assert_eq!(*texels.words, (0..30).collect::<Vec<u32>>());
    // The first level of each face.
    let first: Vec<u32> = (0..30).filter(|n| n % 5 < 4).collect();
    assert_eq!(folder.words("source: File(\"cube.dds\"), levels: 1"), first);
    // The same bytes are read in another format.
    assert_eq!(folder.texture("Nv10", "format: I8, source: File(\"cube.dds\")").1, TextureFormat::I8);
}

#[test]
fn raw_memory_of_all_faces_and_levels() {
    let folder = Folder::new(&[("t.bin", (0..60).collect()), ("levels.bin", (0..42).collect())]);
    let words: Vec<u32> = (0..30).map(|n| 256 * (2 * n + 1) + 2 * n).collect();
    let source = "source: Raw(file: \"t.bin\", width: 2, height: 2)";
    assert_eq!(folder.words(&format!("kind: Cube, format: R5G6B5, levels: All, {source}")), words);
    let words = folder.words("format: A8, levels: 3, source: Raw(file: \"levels.bin\", width: 8, height: 4)");
    assert_eq!(words, (0..42).collect::<Vec<u32>>());
}

#[test]
fn levels_are_made_by_a_box_filter() {
    let folder = Folder::new(&[]);
    let rows = "source: Texels(width: 4, height: 2, rows: [\"00 01 10 20\", \"00 00 30 41\"])";
    let words = folder.words(&format!("format: L8, levels: All, {rows}"));
    // (0 + 1 + 0 + 0 + 2) >> 2 = 0, (16 + 32 + 48 + 65 + 2) >> 2 = 40; (0 + 40 + 1) >> 1 = 20.
    assert_eq!(words, [0, 1, 0x10, 0x20, 0, 0, 0x30, 0x41, 0, 40, 20]);
    assert_eq!(folder.words(&format!("format: L8, levels: 2, {rows}")).len(), 10);
    // Levels are computed from the stored texels. 255 and 0 yield 128, which is stored as 16 of 31.
    let two = "source: Texels(width: 2, height: 1, rows: [\"001f 0000\"])";
    assert_eq!(folder.words(&format!("format: R5G6B5, levels: All, {two}")), [0x1f, 0, 16]);
    let faces = ["positive_x", "negative_x", "positive_y", "negative_y", "positive_z", "negative_z"];
    let faces: Vec<String> =
        (1..).zip(faces).map(|(n, face)| format!("{face}: Solid(width: 2, height: 2, color: ({n}, 0, 0))")).collect();
    let words = folder.words(&format!("format: L8, levels: All, source: Faces({})", faces.join(", ")));
    assert_eq!(words, (1..=6).flat_map(|n| [n; 5]).collect::<Vec<u32>>());
}

#[test]
fn levels_are_listed() {
    let folder = Folder::new(&[]);
    let solid = |w: u32, h: u32, c: u32| format!("Solid(width: {w}, height: {h}, color: ({c}, 0, 0))");
    let mips = [solid(2, 1, 2), solid(1, 1, 3)].join(", ");
    assert_eq!(folder.words(&format!("format: L8, source: {}, mips: [{mips}]", solid(4, 1, 1))), [1, 1, 1, 1, 2, 2, 3]);
    // Every level has eight more columns and rows.
    let (_, _, texels) = folder.texture(
        "Nv2a",
        &format!("format: L8, border: true, source: {}, mips: [{}]", solid(10, 12, 1), solid(9, 10, 2)),
    );
    assert_eq!((texels.width, texels.height, texels.levels, texels.border), (2, 4, 2, true));
    assert_eq!(texels.words.iter().filter(|word| **word == 1).count(), 120);
}

#[test]
fn rectangles_have_any_sides() {
    let folder = Folder::new(&[]);
    let (kind, _, texels) = folder.texture("Nv2a", "kind: Rectangle, format: L8, source: Checker(width: 5, height: 3)");
    assert_eq!((kind, texels.width, texels.height), (TextureKind::Rectangle, 5, 3));
    let top = "targets: [(name: \"a\", width: 64, height: 64), (name: \"b\", width: 30, height: 7)], \
               textures: { \"t\": (kind: Rectangle, source: Target(\"b\")) },";
    let units = "(texture: \"t\", address: ClampToEdge)";
    for profile in ["Nv10", "Nv2a"] {
        let scene = folder.load(profile, top, units).unwrap().scene;
        assert_eq!(scene.textures[0].kind, TextureKind::Rectangle);
    }
}

#[test]
fn palettes_of_files_textures_and_units() {
    let entries: Vec<u8> = (0..256_u32).flat_map(|n| [n as u8, 0, 0, 255]).collect();
    let folder = Folder::new(&[("p.dds", File::plain(dds::P8, 2, 1, 1, [entries, vec![7, 255]].concat()).bytes())]);
    let row = |word: &str| vec![word; 32].join(" ");
    let top = format!(
        "palettes: {{ \"red\": [\"{}\"], \"blue\": [\"{}\"] }}, textures: {{ \"own\": (source: File(\"p.dds\")), \
         \"named\": (format: P8, palette: \"red\", source: Texels(width: 2, height: 1, rows: [\"00 01\"])) }},",
        row("ffff0000"),
        row("ff0000ff")
    );
    let units =
        "\"own\", (texture: \"named\"), (texture: \"named\", palette: \"blue\"), (texture: \"own\", palette: \"red\")";
    let loaded = folder.load("Nv2a", &top, units).unwrap_or_else(|error| panic!("{error}"));
    let (scene, units) = (&loaded.scene, &loaded.scene.draws[0].textures);
    let first = |n: usize| scene.palettes[units[n].unwrap().palette.unwrap()].entries[0];
    assert_eq!([first(0), first(1), first(2), first(3)], [0xff00_0000, 0xffff_0000, 0xff00_00ff, 0xffff_0000]);
    assert_eq!(scene.palettes[units[0].unwrap().palette.unwrap()].entries[9], 0xff09_0000);
    assert_eq!(loaded.render_warnings(false), "");
}

#[test]
fn chips_hold_different_sizes() {
    let folder = Folder::new(&[]);
    let code = |profile: &str, fields: &str| match folder.load(
        profile,
        &format!("textures: {{ \"t\": ({fields}) }},"),
        "(texture: \"t\", address: ClampToEdge)",
    ) {
        Ok(_) => "",
        Err(error) => error.diagnostics[0].code,
    };
    let plain = |kind: &str, format: &str, w: u32, h: u32| {
        format!("kind: {kind}, format: {format}, source: Checker(width: {w}, height: {h})")
    };
    let cube = |format: &str, side: u32| {
        let face = format!("Checker(width: {side}, height: {side})");
        format!(
            "format: {format}, source: Faces(positive_x: {face}, negative_x: {face}, positive_y: {face}, negative_y: {face}, \
             positive_z: {face}, negative_z: {face})"
        )
    };
    for (profile, fields, expected) in [
        ("Nv10", plain("TwoDimensional", "L8", 2048, 1), ""),
        ("Nv10", plain("TwoDimensional", "L8", 1, 4096), "NB0321"),
        ("Nv2a", plain("TwoDimensional", "L8", 1, 4096), ""),
        ("Nv2a", plain("TwoDimensional", "L8", 1, 8192), "NB0321"),
        ("Nv2a", plain("TwoDimensional", "L8", 1, 3), "NB0219"),
        ("Nv10", plain("Rectangle", "I8", 2046, 2047), ""),
        ("Nv10", plain("Rectangle", "I8", 2048, 2), "NB0321"),
        ("Nv10", plain("Rectangle", "L8", 2, 2), "NB0330"),
        ("Nv10", plain("Rectangle", "I8", 3, 2), "NB0330"),
        ("Nv2a", plain("Rectangle", "L8", 3, 4096), ""),
        ("Nv10", cube("R5G6B5", 1024), ""),
        ("Nv10", cube("R5G6B5", 2048), "NB0321"),
        ("Nv10", cube("A8R8G8B8", 512), ""),
        ("Nv10", cube("X8R8G8B8", 1024), "NB0321"),
        ("Nv2a", cube("A8R8G8B8", 1024), ""),
    ] {
        assert_eq!(code(profile, &fields), expected, "{profile} {fields}");
    }
}

/// The limit applies to all textures together, including generated levels and faces.
#[test]
fn memory_is_limited() {
    let limits = Limits { texture_bytes: 4 * (64 + 16 + 4 + 1), ..Limits::default() };
    let text = |levels: &str| {
        format!(
            "(version: 1, profile: Nv2a, textures: {{ \"t\": (source: Checker(width: 8, height: 8), levels: {levels}) }}, draws: [])"
        )
    };
    let parse = |levels: &str, limits: &Limits| scene::parse(&text(levels), &PathBuf::from("x.ron"), limits);
    assert!(parse("All", &limits).is_ok());
    let less = Limits { texture_bytes: limits.texture_bytes - 1, ..limits };
    assert_eq!(parse("All", &less).unwrap_err().diagnostics[0].code, "NB0607");
    assert!(parse("3", &less).is_ok());
}

/// A DXT1 texture that is drawn texel by texel has the colours of the decoder, dithered on nv2a and not on nv10.
#[test]
fn blocks_reach_the_frame() {
    let block = [0x1234_u16.to_le_bytes(), 0x9876_u16.to_le_bytes(), [0x1b, 0xe4], [0x4e, 0xb1]].concat();
    let folder = Folder::new(&[("b.dds", File::coded(b"DXT1", 4, 4, 1, block).bytes())]);
    for (profile, dithered) in [("Nv10", false), ("Nv2a", true)] {
        let text = format!(
            "(version: 1, profile: {profile}, targets: [(width: 4, height: 4)], textures: {{ \"t\": (source: File(\"b.dds\")) }}, \
             draws: [(vertices: Window([(position: (0, 0), t0: (0, 0)), (position: (4, 0), t0: (1, 0)), \
             (position: (4, 4), t0: (1, 1)), (position: (0, 4), t0: (0, 1))]), topology: Quads, \
             textures: [(texture: \"t\", mag_filter: Nearest)], \
             program: Combiners(stages: [()], final_combiner: (d: Texture0, g: (Texture0, Alpha))))])"
        );
        let loaded =
            scene::parse(&text, &folder.origin(), &Limits::default()).unwrap_or_else(|error| panic!("{error}"));
        let frame = engine::render(&loaded.plan, &RenderOptions::default()).surfaces.swap_remove(0).rgba8();
        for (n, pixel) in frame.into_iter().enumerate() {
            let words = [0x9876_1234, 0xb14e_e41b];
            let texel = decode(TextureFormat::Dxt1, dithered, &words, n as u32 % 4, n as u32 / 4);
            assert_eq!(pixel, texel.bytes, "{profile} texel {n}");
        }
    }
}
