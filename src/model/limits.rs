//! Limits of what a scene or a file may ask for.
//!
//! Scenes are untrusted. Every size that a scene chooses is compared with one of these limits before memory or time is
//! spent. [`FILES`] holds the limits of other files.

use std::fmt;

/// The largest size of a kind of file, under the name by which `ninebit limits` lists it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FileLimit {
    /// Name of the limit.
    pub name: &'static str,
    /// Largest size in bytes.
    pub bytes: u64,
    /// Name of the things that the limit counts.
    pub counted: &'static str,
}

impl fmt::Display for FileLimit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} bytes, the limit `{}`", self.bytes, self.name)
    }
}

const fn limit(name: &'static str, bytes: u64, counted: &'static str) -> FileLimit {
    FileLimit { name, bytes, counted }
}

/// The limit of `NAME.expect.ron`.
pub const EXPECTATION: FileLimit = limit("expectation_bytes", 64 << 10, "bytes of an expectation");
/// The limit of a table of `ninebit op`.
pub const OPERATION_TABLE: FileLimit = limit("operation_table_bytes", 64 << 20, "bytes of a table of `ninebit op`");
/// The limit of a pack's manifest.
pub const MANIFEST: FileLimit = limit("manifest_bytes", 4 << 20, "bytes of the manifest of a pack");
/// The limit of a table of vectors or of results.
pub const VECTOR_TABLE: FileLimit = limit("vector_table_bytes", 2 << 30, "bytes of a table of vectors or results");
/// The limit of a leaf of a sweep.
pub const LEAF: FileLimit = limit("leaf_bytes", 64 << 10, "bytes of a leaf of a sweep");
/// The limit of a tree of digests.
pub const TREE: FileLimit = limit("tree_bytes", 16 << 20, "bytes of a tree of digests");
/// The limit of the device file of results.
pub const DEVICE: FileLimit = limit("device_bytes", 1 << 20, "bytes of the device file of results");
/// The limit of a file of evaluators that were measured elsewhere.
pub const EVALUATORS: FileLimit = limit("evaluators_bytes", 1 << 20, "bytes of a file of evaluators");
/// The limit of a list of waivers.
pub const WAIVERS: FileLimit = limit("waivers_bytes", 1 << 20, "bytes of a list of waivers");
/// The limit of a page that a chart reads.
pub const PAGE: FileLimit = limit("page_bytes", 4 << 20, "bytes of a page that a chart reads");

/// The limit of a log of methods.
pub const LOG: FileLimit = limit("log_bytes", 8 << 30, "bytes of a log of methods");
/// The limit of an image of a console's memory.
pub const MEMORY_IMAGE: FileLimit = limit("memory_image_bytes", 128 << 20, "bytes of an image of memory");

/// Limits of files that are neither scenes nor named by a scene.
pub const FILES: [FileLimit; 12] = [
    EXPECTATION,
    OPERATION_TABLE,
    MANIFEST,
    VECTOR_TABLE,
    LEAF,
    TREE,
    DEVICE,
    EVALUATORS,
    WAIVERS,
    PAGE,
    LOG,
    MEMORY_IMAGE,
];

/// Upper bounds of everything that a scene chooses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Size of the scene file in bytes.
    pub scene_bytes: u64,
    /// Depth of nested brackets.
    pub nesting: usize,
    /// Number of render targets.
    pub targets: usize,
    /// Longest side of a render target in pixels.
    pub target_side: u32,
    /// Size of all colour and depth surfaces together in bytes, at four bytes for each pixel.
    pub surface_bytes: u64,
    /// Number of textures.
    pub textures: usize,
    /// Longest side of a texture in texels. A profile may allow less.
    pub texture_side: u32,
    /// Size of all decoded textures together in bytes, at four bytes for each texel.
    pub texture_bytes: u64,
    /// Size of an image file in bytes.
    pub image_file_bytes: u64,
    /// Size of the text of a program in bytes.
    pub program_bytes: u64,
    /// Size of a mesh file in bytes.
    pub mesh_file_bytes: u64,
    /// Number of draws.
    pub draws: usize,
    /// Number of vertices of all draws together.
    pub vertices: usize,
    /// Number of indices of all draws together.
    pub indices: usize,
    /// Number of pixels that all draws together may shade, once for each triangle that covers them. Plans may have more;
    /// [`engine::affordable`](crate::engine::affordable) compares.
    pub shaded_pixels: u64,
}

impl Default for Limits {
    fn default() -> Self {
        Limits {
            scene_bytes: 8 << 20,
            nesting: 64,
            targets: 16,
            target_side: 4096,
            surface_bytes: 256 << 20,
            textures: 4096,
            texture_side: 4096,
            texture_bytes: 256 << 20,
            image_file_bytes: 64 << 20,
            program_bytes: 64 << 10,
            mesh_file_bytes: 32 << 20,
            draws: 4096,
            vertices: 1 << 20,
            indices: 6 << 20,
            shaded_pixels: 100_000_000_000,
        }
    }
}

impl Limits {
    /// Returns [`scene_bytes`](Self::scene_bytes) as the limit of a file.
    pub fn scene_file(&self) -> FileLimit {
        limit("scene_bytes", self.scene_bytes, "bytes of the scene file")
    }

    /// Returns [`image_file_bytes`](Self::image_file_bytes) as the limit of a file.
    pub fn image_file(&self) -> FileLimit {
        limit("image_file_bytes", self.image_file_bytes, "bytes of one image file")
    }

    /// Returns [`program_bytes`](Self::program_bytes) as the limit of a file.
    pub fn program_file(&self) -> FileLimit {
        limit("program_bytes", self.program_bytes, "bytes of the text of one program")
    }

    /// Returns [`mesh_file_bytes`](Self::mesh_file_bytes) as the limit of a file.
    pub fn mesh_file(&self) -> FileLimit {
        limit("mesh_file_bytes", self.mesh_file_bytes, "bytes of one mesh file")
    }
}

/// Returns every limit: its name, its value, and what it counts.
pub fn table(limits: &Limits) -> Vec<(&'static str, u64, &'static str)> {
    let file = |limit: FileLimit| (limit.name, limit.bytes, limit.counted);
    let mut table = vec![
        file(limits.scene_file()),
        ("nesting", limits.nesting as u64, "levels of brackets inside each other"),
        ("targets", limits.targets as u64, "render targets"),
        ("target_side", u64::from(limits.target_side), "pixels along a side of a render target"),
        ("surface_bytes", limits.surface_bytes, "bytes of all colour and depth surfaces, four a pixel each"),
        ("textures", limits.textures as u64, "textures"),
        ("texture_side", u64::from(limits.texture_side), "texels along a side of a texture"),
        ("texture_bytes", limits.texture_bytes, "bytes of all textures decoded, four a texel"),
        file(limits.image_file()),
        file(limits.program_file()),
        file(limits.mesh_file()),
        ("draws", limits.draws as u64, "draws"),
        ("vertices", limits.vertices as u64, "vertices of all draws"),
        ("indices", limits.indices as u64, "indices of all draws"),
        (
            "shaded_pixels",
            limits.shaded_pixels,
            "pixels that are shaded; `--work` of the commands that draw allows others",
        ),
    ];
    table.extend(FILES.map(file));
    table
}
