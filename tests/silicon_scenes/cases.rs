//! The captured frames: which of their pixels are compared, and how their scenes are made.

use crate::scenes;
use ninebit::frame::Surface;

/// A captured frame and the pixels that are compared.
pub struct Case {
    /// Name of the scene's file, without its extension.
    pub name: &'static str,
    /// Path of the capture among the golden results.
    pub capture: &'static str,
    /// Number of pixels that are compared.
    pub pixels: u64,
    /// Whether a pixel is compared, before text is excluded. Scenes with cubes compare the pixels that the cubes cover, which they find in
    /// their depth buffer.
    pub region: fn(u32, u32, &Surface) -> bool,
    /// Returns the text of the scene, if it is generated.
    pub scene: Option<fn() -> String>,
}

/// The frame of the format suites: a quad, without the text at the top left.
fn formats(x: u32, y: u32, _: &Surface) -> bool {
    (135..505).contains(&x) && (55..425).contains(&y) && (x >= 330 || y >= 190)
}

/// A square of 256 pixels in the middle of the frame.
fn middle(x: u32, y: u32, _: &Surface) -> bool {
    (192..448).contains(&x) && (112..368).contains(&y)
}

/// Squares of `side` pixels whose top-left corners are at all combinations of `columns` and `rows`.
fn squares(x: u32, y: u32, columns: &[u32], rows: &[u32], side: u32) -> bool {
    columns.iter().any(|left| (*left..left + side).contains(&x))
        && rows.iter().any(|top| (*top..top + side).contains(&y))
}

fn lod_bias(x: u32, y: u32, _: &Surface) -> bool {
    squares(x, y, &[192, 288, 384, 480, 576], &[200, 296, 392], 64)
}

/// The left part of the frame, which has nested squares.
fn nested(x: u32, _: u32, _: &Surface) -> bool {
    x < 160
}

/// Everything except for the text and the group whose border comes from the texture.
fn border(x: u32, y: u32, _: &Surface) -> bool {
    let labels = (15..=69).contains(&y) || (190..=244).contains(&y);
    let group = (253..=387).contains(&x) && (245..=390).contains(&y);
    !labels && !group
}

/// The group whose border comes from the texture, without 28 pixels that the rules before WGT-1 did not give and the four that WGT-1 does not
/// give. All of these lie exactly between two border texels.
fn border_texels(x: u32, y: u32, _: &Surface) -> bool {
    let known = matches!(x, 267..=277 | 310..=319 | 352..=362);
    (256..384).contains(&x) && (255..378).contains(&y) && !(y == 275 && known)
}

/// Pixels that are nearer than the cleared depth.
fn cubes(x: u32, y: u32, surface: &Surface) -> bool {
    y >= 130 && surface.depth[(y * surface.width + x) as usize] != 0xff_ffff
}

fn bump_matrices(x: u32, y: u32, _: &Surface) -> bool {
    squares(x, y, &[152, 296, 440], &[64, 208, 352], 128) && !(x >= 440 && y >= 352)
}

fn bump_signs(x: u32, y: u32, _: &Surface) -> bool {
    let text = [180, 380].iter().any(|left| (*left..left + 70).contains(&x))
        && [145, 320].iter().any(|top| (*top..top + 30).contains(&y));
    squares(x, y, &[146, 326], &[66, 246], 168) && !text
}

/// All cases: the thirteen frames, and further parts of two of them.
pub static CASES: [Case; 15] = [
    Case {
        name: "t01-r5g6b5",
        capture: "Texture_format/TexFmt_R5G6B5.png",
        pixels: 110_575,
        region: formats,
        scene: None,
    },
    Case {
        name: "t02-a4r4g4b4",
        capture: "Texture_format/TexFmt_A4R4G4B4.png",
        pixels: 110_575,
        region: formats,
        scene: None,
    },
    Case {
        name: "t03-p8-64",
        capture: "Texture_format/TexFmt_SZ_Index8_p64.png",
        pixels: 110_575,
        region: formats,
        scene: None,
    },
    Case { name: "t04-dxt3", capture: "Texture_DXT/DXT3_plasma_dxt3.png", pixels: 65_536, region: middle, scene: None },
    Case { name: "t05-dxt1", capture: "Texture_DXT/DXT1_plasma_dxt1.png", pixels: 65_536, region: middle, scene: None },
    Case {
        name: "t06-lod-bias",
        capture: "Texture_LOD_Bias/LODBias.png",
        pixels: 61_440,
        region: lod_bias,
        scene: Some(scenes::lod_bias),
    },
    Case {
        name: "t06-nested-levels",
        capture: "Texture_LOD_Bias/LODBias.png",
        pixels: 73_836,
        region: nested,
        scene: Some(scenes::nested_levels),
    },
    Case {
        name: "t07-address",
        capture: "Texture_border/2D.png",
        pixels: 217_090,
        region: border,
        scene: Some(scenes::border),
    },
    Case {
        name: "t07-border-texels",
        capture: "Texture_border/2D.png",
        pixels: 15_712,
        region: border_texels,
        scene: Some(scenes::border_texels),
    },
    Case {
        name: "t08-cube-map",
        capture: "Texture_cubemap/Cubemap_q0.0.png",
        pixels: 56_879,
        region: cubes,
        scene: Some(scenes::cube_map),
    },
    Case {
        name: "t09-dot-cube",
        capture: "Texture_cubemap/DotSTRCube_-1to1GL.png",
        pixels: 56_879,
        region: cubes,
        scene: Some(scenes::dot_cube),
    },
    Case {
        name: "t10-dot-2d",
        capture: "Pixel_shader/DotST.png",
        pixels: 65_536,
        region: middle,
        scene: Some(scenes::dot_2d),
    },
    Case {
        name: "t11-dependent-green-blue",
        capture: "Pixel_shader/StageDependentGreenBlue.png",
        pixels: 65_536,
        region: middle,
        scene: None,
    },
    Case {
        name: "t12-bump-matrices",
        capture: "Pixel_shader/BumpEnvMap.png",
        pixels: 131_072,
        region: bump_matrices,
        scene: Some(scenes::bump_matrices),
    },
    Case {
        name: "t13-bump-signs",
        capture: "Bump_map/BumpMap_G8B8_R90.png",
        pixels: 104_496,
        region: bump_signs,
        scene: Some(scenes::bump_signs),
    },
];
