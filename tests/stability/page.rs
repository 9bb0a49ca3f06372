//! The page: its tables, pictures and charts are those that were measured.

use super::view::Picture;
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Mutex;

use super::settings::bless;

const PAGE: &str = "docs/stability.md";
const PICTURES: &str = "docs/pictures/stability";
/// Bytes that a picture may have, so that the page stays quick to read.
const LARGEST: u64 = 40_000;

/// What one section of the page shows.
pub struct Section {
    /// As the markers in the page call it.
    pub name: &'static str,
    /// Heading cells, then the cells of each row.
    pub tables: Vec<Vec<Vec<String>>>,
    pub pictures: Vec<(&'static str, Picture)>,
    pub charts: Vec<(&'static str, String)>,
}

/// A row of cells.
pub fn cells<const N: usize>(cells: [&str; N]) -> Vec<String> {
    cells.map(str::to_string).to_vec()
}

/// A table in Markdown.
fn table(rows: &[Vec<String>]) -> String {
    let line = |row: &[String]| format!("| {} |\n", row.join(" | "));
    let rule = format!("|---|{}\n", "---:|".repeat(rows[0].len() - 1));
    line(&rows[0]) + &rule + &rows[1..].iter().map(|row| line(row)).collect::<String>()
}

/// Compares a section with the page, or writes it.
pub fn check(section: &Section) {
    static WRITING: Mutex<()> = Mutex::new(());
    for (name, picture) in &section.pictures {
        check_picture(name, picture);
    }
    for (name, chart) in &section.charts {
        let path = Path::new(PICTURES).join(name);
        if bless() {
            fs::write(&path, chart).unwrap();
        }
        let stored = fs::read_to_string(&path).unwrap_or_default();
        assert!(stored == *chart, "{} is another; BLESS=1 writes it", path.display());
    }
    let _writing = WRITING.lock();
    let mut page = fs::read_to_string(PAGE).unwrap();
    for (n, rows) in section.tables.iter().enumerate() {
        let (open, close) = (format!("<!-- measured {} {} -->\n", section.name, n + 1), "<!-- /measured -->");
        let start = page.find(&open).unwrap_or_else(|| panic!("{PAGE} has no {open}")) + open.len();
        let end = start + page[start..].find(close).unwrap();
        let measured = table(rows);
        if bless() {
            page.replace_range(start..end, &measured);
            fs::write(PAGE, &page).unwrap();
        } else {
            assert_eq!(page[start..end], measured, "{PAGE}, {open}BLESS=1 writes the table");
        }
    }
    for (name, _) in &section.pictures {
        assert!(page.contains(&format!("(pictures/stability/{name})")), "{PAGE} does not show {name}");
    }
    for (name, _) in &section.charts {
        assert!(page.contains(&format!("(pictures/stability/{name})")), "{PAGE} does not show {name}");
    }
    check_prose(section, &page);
}

/// Numbers with a decimal point in the text around a section's tables stand in one of them: the text cannot go stale alone.
fn check_prose(section: &Section, page: &str) {
    let marker = format!("<!-- measured {} 1 -->", section.name);
    let at = page.find(&marker).unwrap();
    let start = page[..at].rfind("\n## ").unwrap();
    let end = page[at..].find("\n## ").map_or(page.len(), |n| at + n);
    let measured: Vec<&String> = section.tables.iter().flatten().flatten().collect();
    let mut tables = false;
    for line in page[start..end].lines() {
        tables = (tables || line.starts_with("<!-- measured")) && !line.starts_with("<!-- /measured");
        if tables {
            continue;
        }
        for word in line.split(|c: char| !(c.is_ascii_digit() || c == '.')).map(|word| word.trim_matches('.')) {
            let known = || measured.iter().any(|cell| cell.split([' ', '-']).any(|part| part == word));
            assert!(!word.contains('.') || known(), "{PAGE}, {}: {word} was not measured: {line}", section.name);
        }
    }
}

/// As small as it gets: grey pictures in one channel.
fn png(picture: &Picture) -> Vec<u8> {
    let grey = picture.pixels.iter().all(|[r, g, b]| r == g && g == b);
    let (bytes, color) = if grey {
        (picture.pixels.iter().map(|pixel| pixel[0]).collect(), ExtendedColorType::L8)
    } else {
        (picture.pixels.concat(), ExtendedColorType::Rgb8)
    };
    let mut out = Vec::new();
    let encoder = PngEncoder::new_with_quality(&mut out, CompressionType::Best, FilterType::Adaptive);
    encoder.write_image(&bytes, picture.width as u32, picture.height as u32, color).unwrap();
    out
}

fn check_picture(name: &str, picture: &Picture) {
    let path = Path::new(PICTURES).join(name);
    if bless() {
        fs::create_dir_all(PICTURES).unwrap();
        fs::write(&path, png(picture)).unwrap();
    }
    let bytes = fs::read(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    assert!(bytes.len() as u64 <= LARGEST, "{} has {} bytes", path.display(), bytes.len());
    let stored = image::load_from_memory(&bytes).unwrap().to_rgb8();
    let same = stored.dimensions() == (picture.width as u32, picture.height as u32)
        && stored.into_raw() == picture.pixels.as_flattened();
    assert!(same, "{} is another; BLESS=1 writes it", path.display());
}

/// Every stored picture is shown.
pub fn check_files() {
    let page = fs::read_to_string(PAGE).unwrap();
    let files: Vec<PathBuf> = fs::read_dir(PICTURES).unwrap().map(|entry| entry.unwrap().path()).collect();
    for file in files {
        let name = file.file_name().unwrap().to_string_lossy().into_owned();
        assert!(page.contains(&format!("(pictures/stability/{name})")), "nothing shows {name}");
    }
}
