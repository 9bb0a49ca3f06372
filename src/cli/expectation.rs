//! Expectations of scenes: `NAME.expect.ron` beside `NAME.ron`.
//!
//! An expectation normally requires equality: it is the digest of a picture, our own or a captured one. In other cases (a photograph of a screen, a
//! capture with an unreliable region) a mask excludes pixels, and an allowance states how many pixels may differ and by how much. An allowance needs
//! the picture itself.

use std::path::Path;

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use thiserror::Error;

use ninebit::diagnostic::{DOCUMENTS, ErrorKind};
use ninebit::frame::Surface;
use ninebit::limits::{self, FileLimit};
use ninebit_files::picture::{digest, hexadecimal};
use ninebit_files::read::{self, Kind, ReadError};
use ninebit_scene::image::{self, ImageError, ImageLimits, Rgba};
use ninebit_scene::path::{PathError, resolve};

/// Version of the format.
pub const VERSION: u32 = 1;

/// Expected picture of one target of a scene.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Expectation {
    /// Version of the format: [`VERSION`].
    pub version: u32,
    /// Name of the target.
    pub target: String,
    /// Width of the picture.
    pub width: u32,
    /// Height of the picture.
    pub height: u32,
    /// [`digest`] of the picture, in which masked pixels are taken as 0, 0, 0, 0.
    pub sha256: String,
    /// SHA-256 of the words of the target's depth buffer, four bytes each, little-endian: 256 depth + stencil.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub depth: Option<String>,
    /// Name of the capture, if the picture is one. Such a digest is never replaced by that of a drawn picture.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub capture: Option<String>,
    /// Number of pixels that the mask leaves to be compared.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pixels: Option<u64>,
    /// An image in the same folder, of the same size: pixels where its red is 0 are not compared.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mask: Option<String>,
    /// Differences that are accepted.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub allowance: Option<Allowance>,
    /// An image in the same folder, of the same size: the expected picture, to show where another one differs.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub picture: Option<String>,
    /// Files in the same folder that the scene needs and that are not distributed with it. The scene is skipped if one is missing.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub needs: Vec<String>,
}

/// Differences from a picture that are accepted, and why.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Allowance {
    /// An image in the same folder: the expected picture itself.
    pub picture: String,
    /// Maximum number of differing pixels.
    pub pixels: u64,
    /// Maximum difference of a channel.
    pub difference: u8,
    /// Reason why the differences are acceptable.
    pub reason: String,
}

/// Difference between a picture and its expectation.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum Mismatch {
    /// The size differs.
    #[error("the picture is {width} x {height}")]
    Size {
        /// Width of the picture that was drawn.
        width: u32,
        /// Height of the picture that was drawn.
        height: u32,
    },
    /// The digest differs. Without the expected picture no more is known.
    #[error("the picture's digest is {sha256}")]
    Digest {
        /// SHA-256 of the picture that was drawn, in hexadecimal.
        sha256: String,
    },
    /// The digest of the depth buffer differs; the picture is as expected.
    #[error("the picture is as expected, the digest of its depths is {sha256}")]
    Depth {
        /// SHA-256 of the depth buffer that was drawn, in hexadecimal.
        sha256: String,
    },
    /// The picture differs by more than is allowed.
    #[error("{pixels} pixels differ, by {difference} at most, the first at {},{}", .first[0], .first[1])]
    Pixels {
        /// Number of differing pixels.
        pixels: u64,
        /// Largest difference of a channel.
        difference: u8,
        /// Column and row of the first differing pixel.
        first: [u32; 2],
    },
}

/// Reason why an expectation cannot be used.
#[derive(Debug, Error)]
pub enum ExpectationError {
    /// The text is not an expectation.
    #[error("{0}")]
    Text(String),
    /// The file exceeds its size limit.
    #[error("it is larger than {0}")]
    TooLarge(FileLimit),
    /// A file that it names is refused.
    #[error(transparent)]
    Path(#[from] PathError),
    /// An image that it names is refused.
    #[error(transparent)]
    Image(#[from] ImageError),
    /// The mask leaves a different number of pixels to be compared.
    #[error("{found} pixels are compared, not {expected}")]
    Pixels {
        /// Number of pixels according to the expectation.
        expected: u64,
        /// Number of pixels according to the mask.
        found: u64,
    },
    /// An image that it names has a different size.
    #[error("`{name}` is {width} x {height}, not of the size expected")]
    Size {
        /// The image's file, as the expectation names it.
        name: String,
        /// Width of the image.
        width: u32,
        /// Height of the image.
        height: u32,
    },
}

impl ExpectationError {
    /// Returns the error code, as `docs/errors.md` lists it.
    pub fn code(&self) -> &'static str {
        match self {
            ExpectationError::Path(error) => error.code(),
            ExpectationError::Image(error) => error.code(),
            ExpectationError::TooLarge(_) => "NB1207",
            _ => "NB1205",
        }
    }

    /// Returns the advice to the user.
    pub fn help(&self) -> String {
        let help = match self {
            ExpectationError::TooLarge(_) => "is it an expectation? `ninebit replay --bless` writes one",
            ExpectationError::Text(_) => {
                return format!("its fields are in {DOCUMENTS}/scene-format.md; `ninebit replay --bless` writes one");
            }
            ExpectationError::Path(error) => return error.help(),
            ExpectationError::Image(error) => error.help(),
            ExpectationError::Pixels { .. } => "take the mask that belongs to it, or mend `pixels`",
            ExpectationError::Size { .. } => "masks and pictures are of the size that the expectation states",
        };
        help.to_owned()
    }

    /// Returns the kind of the error, which determines the exit status.
    pub fn kind(&self) -> ErrorKind {
        match self {
            ExpectationError::Path(error) if error.is_missing() => ErrorKind::Missing,
            ExpectationError::Image(error) if error.is_missing() => ErrorKind::Missing,
            ExpectationError::Image(error) if error.is_limit() => ErrorKind::Limit,
            ExpectationError::TooLarge(_) => ErrorKind::Limit,
            _ => ErrorKind::Invalid,
        }
    }
}

impl Expectation {
    /// Returns the expectation that `surface` meets exactly.
    pub fn from_surface(target: &str, surface: &Surface) -> Self {
        Expectation {
            version: VERSION,
            target: target.to_owned(),
            width: surface.width,
            height: surface.height,
            sha256: ninebit_files::picture::surface_digest(surface),
            ..Expectation::default()
        }
    }

    /// Parses an expectation.
    ///
    /// # Errors
    /// Returns an error if the text is too long, is not RON of this form, or has another version.
    pub fn parse(text: &str) -> Result<Self, ExpectationError> {
        if text.len() as u64 > limits::EXPECTATION.bytes {
            return Err(ExpectationError::TooLarge(limits::EXPECTATION));
        }
        let options = ron::Options::default().with_default_extension(ron::extensions::Extensions::IMPLICIT_SOME);
        let expectation: Expectation =
            options.from_str(text).map_err(|error| ExpectationError::Text(error.to_string()))?;
        if expectation.version != VERSION {
            let version = expectation.version;
            return Err(ExpectationError::Text(format!("version {version} is not known; this is version {VERSION}")));
        }
        Ok(expectation)
    }

    /// Reads an expectation's file. Returns `None` if it does not exist.
    ///
    /// # Errors
    /// The same as [`parse`](Self::parse), or if the file cannot be read or is not UTF-8.
    pub fn read(path: &Path) -> Result<Option<Self>, ExpectationError> {
        let bytes = match read::bytes(path, Kind::Regular, limits::EXPECTATION) {
            Ok(bytes) => bytes,
            Err(ReadError::Missing) => return Ok(None),
            Err(ReadError::TooLarge(limit)) => return Err(ExpectationError::TooLarge(limit)),
            Err(error) => return Err(ExpectationError::Text(format!("it cannot be read: {error}"))),
        };
        let text = String::from_utf8(bytes).map_err(|_| ExpectationError::Text("it is not UTF-8 text".to_owned()))?;
        Self::parse(&text).map(Some)
    }

    /// Returns the expectation as text.
    pub fn to_text(&self) -> String {
        let pretty = ron::ser::PrettyConfig::new().extensions(ron::extensions::Extensions::IMPLICIT_SOME);
        // Writing plain strings and numbers into memory cannot fail.
        ron::ser::to_string_pretty(self, pretty).unwrap_or_default() + "\n"
    }

    /// Compares a surface with the expectation. Images are read from `folder`. Returns `None` if the surface is as expected.
    ///
    /// # Errors
    /// Returns an error if the mask or the picture cannot be used, or the mask leaves another number of pixels than stated.
    pub fn compare(&self, surface: &Surface, folder: &Path) -> Result<Option<Mismatch>, ExpectationError> {
        let (width, height) = (surface.width, surface.height);
        if [width, height] != [self.width, self.height] {
            return Ok(Some(Mismatch::Size { width, height }));
        }
        let mut pixels = surface.rgba8();
        let compared = self.compared(folder)?;
        let sha256 = masked_digest(width, height, &mut pixels, &compared);
        if sha256 == self.sha256 {
            let depth = self.depth.as_ref().map(|expected| (expected, depth_digest(surface)));
            let other = depth.filter(|(expected, sha256)| *expected != sha256);
            return Ok(other.map(|(_, sha256)| Mismatch::Depth { sha256 }));
        }
        let Some(allowance) = &self.allowance else { return Ok(Some(Mismatch::Digest { sha256 })) };
        let expected = self.image(folder, &allowance.picture)?;
        let differing =
            pixels.iter().zip(expected.pixels()).enumerate().filter(|(index, (a, b))| compared[*index] && a != b);
        let (mut count, mut difference, mut first) = (0, 0, None);
        for (index, (a, b)) in differing {
            count += 1;
            difference = a.iter().zip(b).map(|(a, b)| a.abs_diff(*b)).max().unwrap_or(0).max(difference);
            first.get_or_insert(index as u32);
        }
        let at = first.unwrap_or(0);
        let accepted = count <= allowance.pixels && difference <= allowance.difference;
        let mismatch = Mismatch::Pixels { pixels: count, difference, first: [at % width, at / width] };
        Ok((!accepted).then_some(mismatch))
    }

    /// Returns whether each pixel is compared, row by row.
    ///
    /// # Errors
    /// Returns an error if the mask cannot be used, or leaves another number of pixels than stated.
    pub fn compared(&self, folder: &Path) -> Result<Vec<bool>, ExpectationError> {
        let compared = match &self.mask {
            Some(name) => self.image(folder, name)?.pixels().iter().map(|pixel| pixel[0] != 0).collect(),
            None => vec![true; self.width as usize * self.height as usize],
        };
        let found = compared.iter().filter(|compared| **compared).count() as u64;
        match self.pixels {
            Some(expected) if expected != found => Err(ExpectationError::Pixels { expected, found }),
            _ => Ok(compared),
        }
    }

    /// Returns the files of [`needs`](Self::needs) that are not in `folder`.
    ///
    /// # Errors
    /// Returns an error if a name is not a plain one, or the file system refuses the path.
    pub fn missing(&self, folder: &Path) -> Result<Vec<&str>, ExpectationError> {
        let mut missing = Vec::new();
        for name in &self.needs {
            match resolve(folder, name) {
                Ok(_) => {}
                Err(error) if error.is_missing() => missing.push(name.as_str()),
                Err(error) => return Err(error.into()),
            }
        }
        Ok(missing)
    }

    /// Reads an image in `folder` that has the expected size.
    ///
    /// # Errors
    /// Returns an error if the image cannot be used, or has another size.
    pub fn image(&self, folder: &Path, name: &str) -> Result<Rgba, ExpectationError> {
        let image = image::load(&resolve(folder, name)?, &ImageLimits::default())?;
        if [image.width(), image.height()] != [self.width, self.height] {
            let (width, height) = (image.width(), image.height());
            return Err(ExpectationError::Size { name: name.to_owned(), width, height });
        }
        Ok(image)
    }
}

/// Returns [`Expectation::depth`] of a surface.
pub(crate) fn depth_digest(surface: &Surface) -> String {
    let words: Vec<u8> = surface.chip_depth_words().flat_map(u32::to_le_bytes).collect();
    hexadecimal(&Sha256::digest(words))
}

/// Sets pixels that are not compared to 0, 0, 0, 0. Returns the [`digest`].
pub fn masked_digest(width: u32, height: u32, pixels: &mut [[u8; 4]], compared: &[bool]) -> String {
    for (pixel, compared) in pixels.iter_mut().zip(compared) {
        if !compared {
            *pixel = [0; 4];
        }
    }
    digest(width, height, pixels)
}

#[cfg(test)]
mod tests {
    use super::*;
    use ninebit::state::SurfaceFormat;
    use ninebit_files::output::{Compression, encode_png, write_file};

    fn surface(words: &[u32]) -> Surface {
        Surface { width: 2, height: 1, format: SurfaceFormat::A8R8G8B8, words: words.to_vec(), depth: Vec::new() }
    }

    #[test]
    fn text_and_back() {
        let mut expectation = Expectation::from_surface("frame", &surface(&[1, 2]));
        assert_eq!(Expectation::parse(&expectation.to_text()).expect("parses"), expectation);
        expectation.mask = Some("mask.png".to_owned());
        (expectation.capture, expectation.pixels) = (Some("Suite/Frame.png".to_owned()), Some(1));
        expectation.allowance =
            Some(Allowance { picture: "p.png".to_owned(), pixels: 3, difference: 1, reason: "a camera".to_owned() });
        assert_eq!(Expectation::parse(&expectation.to_text()).expect("parses"), expectation);
        assert!(Expectation::parse(&expectation.to_text().replace("version: 1", "version: 2")).is_err());
        assert!(Expectation::parse("(version: 1, colour: 2)").is_err());
        assert!(Expectation::parse(&" ".repeat((64 << 10) + 1)).is_err());
        // However deeply brackets are nested, the text is refused at the first that does not belong.
        for start in ["", "(version: ", "(needs: [", "(colour: ", "(allowance: (picture: "] {
            assert!(Expectation::parse(&(start.to_owned() + &"([".repeat(30_000))).is_err(), "{start}");
        }
    }

    #[test]
    fn files_that_are_not_handed_out_are_missed() {
        let folder = tempfile::tempdir().expect("folder");
        write_file(&folder.path().join("here.png"), b"").expect("writes");
        let needs = |names: &[&str]| Expectation {
            needs: names.iter().map(|name| (*name).to_owned()).collect(),
            ..Expectation::from_surface("frame", &surface(&[1, 2]))
        };
        let expectation = needs(&["here.png", "captured/a.png", "b.png"]);
        assert_eq!(expectation.missing(folder.path()).expect("plain names"), ["captured/a.png", "b.png"]);
        assert!(needs(&["../here.png"]).missing(folder.path()).is_err());
        assert_eq!(Expectation::parse(&expectation.to_text()).expect("parses"), expectation);
    }

    #[test]
    fn depths_are_compared_where_they_are_expected() {
        let with = |depth: &[u32]| Surface { depth: depth.to_vec(), ..surface(&[1, 2]) };
        let mut expectation = Expectation::from_surface("frame", &with(&[3, 4]));
        let compare = |expectation: &Expectation, depth: &[u32]| expectation.compare(&with(depth), Path::new("."));
        assert_eq!(compare(&expectation, &[5]).expect("compares"), None);
        expectation.depth = Some(depth_digest(&with(&[3, 4])));
        assert_eq!(Expectation::parse(&expectation.to_text()).expect("parses"), expectation);
        assert_eq!(compare(&expectation, &[3, 4]).expect("compares"), None);
        let sha256 = depth_digest(&with(&[3, 5]));
        assert_eq!(compare(&expectation, &[3, 5]).expect("compares"), Some(Mismatch::Depth { sha256 }));
        assert!(compare(&expectation, &[]).expect("compares").is_some());
    }

    #[test]
    fn equality_is_the_rule() {
        let expectation = Expectation::from_surface("frame", &surface(&[1, 2]));
        let folder = Path::new(".");
        assert_eq!(expectation.compare(&surface(&[1, 2]), folder).expect("compares"), None);
        let other = expectation.compare(&surface(&[1, 3]), folder).expect("compares");
        assert!(matches!(other, Some(Mismatch::Digest { .. })), "{other:?}");
        let tall = Surface { width: 1, height: 2, ..surface(&[1, 2]) };
        assert_eq!(expectation.compare(&tall, folder).expect("compares"), Some(Mismatch::Size { width: 1, height: 2 }));
    }

    #[test]
    fn masks_and_allowances_are_exceptions() {
        let folder = tempfile::tempdir().expect("folder");
        let store = |name: &str, pixels: &[[u8; 4]]| {
            let png = encode_png(2, 1, pixels, Compression::Small).expect("encodes");
            write_file(&folder.path().join(name), &png).expect("writes");
        };
        store("mask.png", &[[255; 4], [0, 255, 255, 255]]);
        store("picture.png", &surface(&[1, 2]).rgba8());

        let masked =
            Expectation { mask: Some("mask.png".to_owned()), ..Expectation::from_surface("frame", &surface(&[1, 0])) };
        assert_eq!(masked.compare(&surface(&[1, 99]), folder.path()).expect("compares"), None);
        assert!(masked.compare(&surface(&[2, 0]), folder.path()).expect("compares").is_some());
        let counted = |pixels| Expectation { pixels: Some(pixels), ..masked.clone() };
        assert_eq!(counted(1).compare(&surface(&[1, 99]), folder.path()).expect("compares"), None);
        let other = counted(2).compare(&surface(&[1, 99]), folder.path());
        assert!(matches!(other, Err(ExpectationError::Pixels { expected: 2, found: 1 })), "{other:?}");

        let allowance = |pixels, difference| {
            Some(Allowance { picture: "picture.png".to_owned(), pixels, difference, reason: "a test".to_owned() })
        };
        let expected = |allowance| Expectation { allowance, ..Expectation::from_surface("frame", &surface(&[1, 2])) };
        let compare = |allowance| expected(allowance).compare(&surface(&[1, 5]), folder.path()).expect("compares");
        assert_eq!(compare(allowance(1, 3)), None);
        assert_eq!(compare(allowance(1, 2)), Some(Mismatch::Pixels { pixels: 1, difference: 3, first: [1, 0] }));
        assert!(compare(allowance(0, 3)).is_some());
    }
}
