//! Options that name an output file of one format.

use super::*;
use std::ffi::OsStr;

use clap::builder::{OsStringValueParser, TypedValueParser};
use ninebit::frame::Surface;
use ninebit::state::DepthFormat;

/// File extensions of picture formats. An output must not have one of another format.
const FORMATS: [&str; 27] = [
    "png", "apng", "jpg", "jpeg", "jpe", "jfif", "gif", "bmp", "dib", "tga", "tif", "tiff", "webp", "avif", "heic",
    "jxl", "ppm", "pgm", "pnm", "pam", "dds", "ktx", "ktx2", "hdr", "exr", "qoi", "svg",
];

/// Parses the name of an output file of a format; `-` is stdout.
pub(crate) fn output(format: &'static str) -> impl TypedValueParser<Value = Destination> {
    OsStringValueParser::new().try_map(move |name| from_name(&name, format))
}

/// Parses the name of a depth file: a PNG, or stored words; `-` is stdout.
pub(crate) fn depths() -> impl TypedValueParser<Value = Destination> {
    OsStringValueParser::new().try_map(|name| from_name(&name, if is_png(Path::new(&name)) { "png" } else { "raw" }))
}

/// Returns the upper 16 bits of each depth, as a PNG of depths holds them.
pub(crate) fn upper_depths(surface: &Surface, format: DepthFormat) -> Vec<u16> {
    surface.depths().map(|depth| (depth >> (format.bits() - 16)) as u16).collect()
}

/// Returns an error if the picture would go to stdout, where the report goes.
pub(crate) fn beside_report(picture: Option<&Destination>) -> Result<(), Failure> {
    if picture == Some(&Destination::Stdout) {
        let message = "the picture and the report cannot both go to stdout";
        return Err(Failure::usage(message, "write the picture to a file"));
    }
    Ok(())
}

/// Returns whether a file has the extension of a PNG.
pub(crate) fn is_png(path: &Path) -> bool {
    path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("png"))
}

/// Converts a name to a destination. Any extension is allowed, except that of another format.
fn from_name(name: &OsStr, format: &'static str) -> Result<Destination, String> {
    let path = Path::new(name);
    let ending = path.extension().and_then(|ending| ending.to_str()).unwrap_or_default().to_ascii_lowercase();
    if ending != format && FORMATS.contains(&ending.as_str()) {
        let other = shown::path(&path.with_extension(format));
        let format = format.to_ascii_uppercase();
        return Err(format!("this command writes {format}: write to `{other}` and convert that"));
    }
    Ok(Destination::from(name))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn other_formats_are_refused() {
        for name in ["a.png", "a.PNG", "a", "-", "/dev/null", "tmp.Xy12", "a.jpg.part"] {
            assert!(from_name(name.as_ref(), "png").is_ok(), "{name}");
        }
        assert!(from_name("a.png".as_ref(), "raw").is_err());
        for name in ["a.jpg", "b/a.JPEG", "a.b.webp", "a.dds"] {
            assert!(from_name(name.as_ref(), "png").is_err(), "{name}");
            assert!(from_name(name.as_ref(), "raw").is_err(), "{name}");
        }
        assert!(from_name("a.dds".as_ref(), "dds").is_ok() && is_png(Path::new("a.PNG")));
        assert_eq!(
            from_name("b/a.png".as_ref(), "dds"),
            Err("this command writes DDS: write to `b/a.dds` and convert that".to_owned())
        );
    }
}
