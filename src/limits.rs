//! How much a scene may ask for.
//!
//! Scenes come from anywhere. Every size that a scene chooses is compared with one of these before memory or time is spent.

/// Upper bounds on everything that a scene chooses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Bytes of the scene file.
    pub scene_bytes: u64,
    /// Levels of brackets inside each other.
    pub nesting: usize,
    /// Render targets.
    pub targets: usize,
    /// Columns and rows of a render target, each.
    pub target_side: u32,
    /// Bytes of all colour and depth surfaces together, at four bytes a pixel each.
    pub surface_bytes: u64,
    /// Textures.
    pub textures: usize,
    /// Columns and rows of a texture, each; a profile may allow less.
    pub texture_side: u32,
    /// Bytes of all textures together, decoded, at four bytes a texel.
    pub texture_bytes: u64,
    /// Bytes of one image file.
    pub image_file_bytes: u64,
    /// Bytes of the text of one program.
    pub program_bytes: u64,
    /// Bytes of one mesh file.
    pub mesh_file_bytes: u64,
    /// Draws.
    pub draws: usize,
    /// Vertices of all draws together.
    pub vertices: usize,
    /// Indices of all draws together.
    pub indices: usize,
}

impl Default for Limits {
    fn default() -> Self {
        Limits {
            scene_bytes: 8 << 20,
            nesting: 64,
            targets: 16,
            target_side: 4096,
            surface_bytes: 256 << 20,
            textures: 16,
            texture_side: 4096,
            texture_bytes: 256 << 20,
            image_file_bytes: 64 << 20,
            program_bytes: 64 << 10,
            mesh_file_bytes: 32 << 20,
            draws: 4096,
            vertices: 1 << 20,
            indices: 6 << 20,
        }
    }
}

/// Every limit: its name, its value, and what is counted.
pub fn table(limits: &Limits) -> Vec<(&'static str, u64, &'static str)> {
    vec![
        ("scene_bytes", limits.scene_bytes, "bytes of the scene file"),
        ("nesting", limits.nesting as u64, "levels of brackets inside each other"),
        ("targets", limits.targets as u64, "render targets"),
        ("target_side", u64::from(limits.target_side), "pixels along a side of a render target"),
        ("surface_bytes", limits.surface_bytes, "bytes of all colour and depth surfaces, four a pixel each"),
        ("textures", limits.textures as u64, "textures"),
        ("texture_side", u64::from(limits.texture_side), "texels along a side of a texture"),
        ("texture_bytes", limits.texture_bytes, "bytes of all textures decoded, four a texel"),
        ("image_file_bytes", limits.image_file_bytes, "bytes of one image file"),
        ("program_bytes", limits.program_bytes, "bytes of the text of one program"),
        ("mesh_file_bytes", limits.mesh_file_bytes, "bytes of one mesh file"),
        ("draws", limits.draws as u64, "draws"),
        ("vertices", limits.vertices as u64, "vertices of all draws"),
        ("indices", limits.indices as u64, "indices of all draws"),
    ]
}
