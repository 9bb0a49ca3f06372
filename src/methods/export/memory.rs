//! The places of surfaces, textures and palettes in memory.

use std::sync::Arc;

use ninebit::rop;
use ninebit::state::{
    CUBE_FACES, DepthFormat, Palette, Profile, Scene, Target, Texels, Texture, TextureFormat, TextureImage,
    TextureKind, depth_stencil,
};

use super::{ExportError, refuse};
use crate::draw::texture::{BORDERED_SIDE, FACE_BYTES};
use crate::memory::{LARGEST_MEMORY, Layout, bytes, raw};

/// Where the first thing lies.
pub const FIRST: u32 = 0x0010_0000;
/// Surfaces and textures begin at multiples of this.
const ALIGNMENT: u32 = 256;

/// Where surfaces, textures and palettes lie in memory.
#[derive(Debug)]
pub(super) struct MemoryMap {
    /// The image of memory.
    pub bytes: Vec<u8>,
    /// Addresses of the targets' colours.
    pub surfaces: Vec<u32>,
    /// Addresses of the targets' depths.
    pub depths: Vec<u32>,
    /// Whether the targets are swizzled.
    pub swizzled: Vec<bool>,
    /// Addresses of the textures; of those that show a target, the target's.
    pub textures: Vec<u32>,
    /// Addresses of the palettes.
    pub palettes: Vec<u32>,
}

/// Returns the bytes from row to row of a surface or a linear texture.
pub(crate) fn pitch(width: u32, bytes: u32) -> u32 {
    (width * bytes).next_multiple_of(64)
}

impl MemoryMap {
    /// Returns a map without memory, of which all addresses are 0.
    pub(super) fn nowhere(scene: &Scene) -> MemoryMap {
        let (targets, textures, palettes) = (scene.targets.len(), scene.textures.len(), scene.palettes.len());
        MemoryMap {
            bytes: Vec::new(),
            surfaces: vec![0; targets],
            depths: vec![0; targets],
            swizzled: vec![false; targets],
            textures: vec![0; textures],
            palettes: vec![0; palettes],
        }
    }

    pub(super) fn new(scene: &Scene) -> Result<MemoryMap, ExportError> {
        let count = scene.targets.len();
        let mut placed = MemoryMap {
            bytes: Vec::new(),
            surfaces: Vec::with_capacity(count),
            depths: Vec::with_capacity(count),
            swizzled: vec![false; count],
            textures: Vec::with_capacity(scene.textures.len()),
            palettes: Vec::with_capacity(scene.palettes.len()),
        };
        placed.reserve(FIRST, &[])?;
        for texture in &scene.textures {
            if let (Some(target), TextureKind::TwoDimensional) = (texture.image.target(), texture.kind) {
                placed.swizzled[target] = true;
            }
        }
        for (index, target) in scene.targets.iter().enumerate() {
            let size = [target.width, target.height, 1];
            let is_swizzled = placed.swizzled[index];
            let mut put = |words: &Option<Arc<[u32]>>, format: TextureFormat, pitch: u32| {
                let layout = if is_swizzled { Layout::Swizzled } else { Layout::Pitch(pitch) };
                let image = words.as_ref().map_or(Vec::new(), |words| bytes(words, format, size, layout));
                placed.reserve(pitch * target.height, &image)
            };
            let [contents, depth_contents] = match scene.profile {
                Profile::Nv2a => [target.contents.clone(), target.depth_contents.clone()],
                Profile::Nv10 => initial(target),
            };
            let colors = put(&contents, raw(target.format), pitch(target.width, target.format.bytes()))?;
            let format = target.depth.map_or(DepthFormat::Z24S8, |depth| depth.format);
            let format = format.texture_format();
            let depths = put(&depth_contents, format, pitch(target.width, format.bytes()))?;
            placed.surfaces.push(colors);
            placed.depths.push(depths);
        }
        for texture in &scene.textures {
            let at = match &texture.image {
                TextureImage::Texels(texels) => placed.put(&image(texture, texels)?)?,
                TextureImage::Target { target } => placed.surfaces[*target],
                TextureImage::Depth { target } => placed.depths[*target],
            };
            placed.textures.push(at);
        }
        for Palette { entries, .. } in &scene.palettes {
            let bytes: Vec<u8> = entries.iter().flat_map(|word| word.to_le_bytes()).collect();
            let at = placed.put(&bytes)?;
            placed.palettes.push(at);
        }
        Ok(placed)
    }

    fn put(&mut self, image: &[u8]) -> Result<u32, ExportError> {
        self.reserve(image.len() as u32, image)
    }

    /// Takes the next free place for so many bytes, which begin with `image`.
    fn reserve(&mut self, count: u32, image: &[u8]) -> Result<u32, ExportError> {
        let at = self.bytes.len() as u32;
        let end = (u64::from(at) + u64::from(count)).next_multiple_of(ALIGNMENT.into());
        if end > LARGEST_MEMORY {
            return refuse(format!(
                "its surfaces and textures take more than {LARGEST_MEMORY} bytes, which no console has"
            ));
        }
        self.bytes.extend_from_slice(image);
        self.bytes.resize(end as usize, 0);
        Ok(at)
    }
}

/// Returns the words that a target's colours and depths begin as, its clears among them.
fn initial(target: &Target) -> [Option<Arc<[u32]>>; 2] {
    let all = |word: u32| vec![word; target.width as usize * target.height as usize].into();
    let colors = || all(rop::surface::pack(target.format, target.clear_color));
    let depths = target.depth.map(|depth| {
        let word = depth_stencil(depth.clear, depth.clear_stencil);
        target.depth_contents.clone().unwrap_or_else(|| all(word))
    });
    [Some(target.contents.clone().unwrap_or_else(colors)), depths]
}

/// Returns the bytes of a texture as they lie in memory.
fn image(texture: &Texture, texels: &Texels) -> Result<Vec<u8>, ExportError> {
    let (format, words) = (texture.format, &texels.words);
    if texture.kind == TextureKind::Rectangle {
        let layout = Layout::Pitch(pitch(texels.width, format.bytes()));
        return Ok(bytes(words, format, [texels.width, texels.height, 1], layout));
    }
    if texels.border {
        if texels.levels > 1 || texture.kind != TextureKind::TwoDimensional {
            return refuse(format!("texture `{}` has border texels and levels", texture.name));
        }
        let stored = [texels.width, texels.height].map(|side| (2 * side).max(BORDERED_SIDE));
        let [columns, rows] = [texels.width, texels.height].map(|side| (side + 8) as usize);
        let mut all = vec![0; stored[0] as usize * stored[1] as usize];
        for row in 0..rows {
            let first = row * stored[0] as usize;
            all[first..first + columns].copy_from_slice(&words[row * columns..(row + 1) * columns]);
        }
        return Ok(bytes(&all, format, [stored[0], stored[1], 1], Layout::Swizzled));
    }
    let faces = if texture.kind == TextureKind::Cube { CUBE_FACES } else { 1 };
    let mut image = Vec::new();
    let mut words = words.iter().copied();
    for _ in 0..faces {
        image.resize(image.len().next_multiple_of(FACE_BYTES as usize), 0);
        for level in 0..texels.levels {
            let [width, height] = [texels.width, texels.height].map(|side| (side >> level).max(1));
            let count = format.words(width, height) * texels.layers as usize;
            let of_level: Vec<u32> = words.by_ref().take(count).collect();
            image.extend(bytes(&of_level, format, [width, height, texels.layers], Layout::Swizzled));
        }
    }
    Ok(image)
}
