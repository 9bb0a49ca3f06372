//! Data that crates of ninebit embed, from the folder `vectors` of its repository. A package holds no file from outside its folder: this one is
//! the folder's.

/// The licence of conformance vectors, which travels in each pack.
pub const LICENSE: &str = include_str!("LICENSE");

/// Path within a pack, and text, of each schema of conformance vectors.
pub const SCHEMAS: [(&str, &str); 5] = [
    ("schema/layout.schema.json", include_str!("schema/layout.schema.json")),
    ("schema/leaf.schema.json", include_str!("schema/leaf.schema.json")),
    ("schema/manifest.schema.json", include_str!("schema/manifest.schema.json")),
    ("schema/row.schema.json", include_str!("schema/row.schema.json")),
    ("schema/sweep.schema.json", include_str!("schema/sweep.schema.json")),
];

/// The captured frames with their digests, as a table whose columns are separated by tabs.
pub const FRAMES: &str = include_str!("captures/frames.tsv");

/// Names of all captured suites, and how many frames each has.
pub const CAPTURED: &str = include_str!("captures/suites.tsv");

/// Image files that the captured programs load (MIT), as they are: DDS and PNG.
pub mod images {
    macro_rules! files {
        ($($(#[$meta:meta])* $name:ident $file:literal),+ $(,)?) => {
            $($(#[$meta])* pub const $name: &[u8] = include_bytes!(concat!("captures/images/", $file));)+
        };
    }
    files! {
        /// Plasma in DXT1, 32 x 32 texels, 6 levels.
        PLASMA_DXT1 "plasma_dxt1.dds",
        /// Plasma with alpha in DXT1, 32 x 32 texels, 6 levels.
        PLASMA_ALPHA_DXT1 "plasma_alpha_dxt1.dds",
        /// Plasma in DXT3, 32 x 32 texels, 6 levels.
        PLASMA_DXT3 "plasma_dxt3.dds",
        /// Plasma with alpha in DXT3, 32 x 32 texels, 6 levels.
        PLASMA_ALPHA_DXT3 "plasma_alpha_dxt3.dds",
        /// Plasma in DXT5, 32 x 32 texels, 6 levels.
        PLASMA_DXT5 "plasma_dxt5.dds",
        /// Plasma with alpha in DXT5, 32 x 32 texels, 6 levels.
        PLASMA_ALPHA_DXT5 "plasma_alpha_dxt5.dds",
        /// Bands in DXT1, 64 x 256 texels, 9 levels.
        BANDS_DXT1 "64x256_bands_dxt1.dds",
        /// Bands in DXT3, 64 x 256 texels, 9 levels.
        BANDS_DXT3 "64x256_bands_dxt3.dds",
        /// Bands in DXT5, 64 x 256 texels, 9 levels.
        BANDS_DXT5 "64x256_bands_dxt5.dds",
        /// An object-space normal map of a cube, unfolded, 256 x 256 pixels.
        NORMALS "cube_normals_object_space.png",
        /// A bump map of waves, 128 x 128 pixels.
        WATER "water_bump_map.png",
        /// The image that the bump map displaces, 128 x 128 pixels.
        SEEN "bump_map_test_image.png",
    }
}

/// Meshes that the captured programs light (MIT), packed with gzip: the number of vertices, then two lists of floats, positions and normals.
pub mod meshes {
    macro_rules! files {
        ($($(#[$meta:meta])* $name:ident $file:literal),+ $(,)?) => {
            $($(#[$meta])* pub const $name: &[u8] = include_bytes!(concat!("captures/meshes/", $file));)+
        };
    }
    files! {
        /// A square of 50 by 50 fields.
        GRID "flat_mesh_grid.mesh.gz",
        /// A cone.
        CONE "light_control_test_mesh_cone.mesh.gz",
        /// A cylinder.
        CYLINDER "light_control_test_mesh_cylinder.mesh.gz",
        /// A sphere.
        SPHERE "light_control_test_mesh_sphere.mesh.gz",
        /// The head of an ape.
        HEAD "light_control_test_mesh_suzanne.mesh.gz",
        /// A torus.
        TORUS "light_control_test_mesh_torus.mesh.gz",
    }
}

/// What programs that ask a chip leave their answers by: a zip without compression, in C.
pub mod archive {
    /// The functions.
    pub const SOURCE: &str = include_str!("harness/gl/archive.c");
    /// Their declarations.
    pub const HEADER: &str = include_str!("harness/gl/archive.h");
}
