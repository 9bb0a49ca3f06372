//! Wavefront OBJ files: vertices and faces.

use std::collections::HashMap;
use std::ops::Range;

use super::Surface;
use crate::diagnostic::{Diagnostic, shorten};

/// Findings beyond this many are not looked for.
const MOST_FINDINGS: usize = 16;

/// Statements that say nothing about triangles.
const WITHOUT_TRIANGLES: &[&str] = &["o", "g", "s", "usemtl", "mtllib", "l", "p", "vp"];

/// Reads the vertices (`v`, `vt`, `vn`) and faces (`f`) of a file; a face of more than three corners is cut into a fan. The first row of
/// a texture lies at the top here and at the bottom there: t is 1 minus what the file has.
///
/// # Errors
/// Lines that are not understood, indices of nothing, more than `vertices` vertices or `indices` indices.
pub fn read(text: &str, vertices: usize, indices: usize) -> Result<Surface, Vec<Diagnostic>> {
    let mut file = File { limits: (vertices, indices), ..File::default() };
    let mut findings = Vec::new();
    let mut start = 0;
    for line in text.split_inclusive('\n') {
        let at = start;
        start += line.len();
        let content = line.split('#').next().unwrap_or("");
        if let Err(finding) = file.line(at, content) {
            let ends = ["NB0603", "NB0609"].contains(&finding.code);
            findings.push(*finding);
            if ends || findings.len() >= MOST_FINDINGS {
                break;
            }
        }
    }
    if findings.is_empty() && file.surface.indices.is_empty() {
        let help = "a mesh needs faces: lines such as `f 1/1 2/2 3/3`";
        findings.push(Diagnostic::error("NB0236", 0..0, "this file has no triangles").label("here").help(help));
    }
    if findings.is_empty() { Ok(file.surface) } else { Err(findings) }
}

#[derive(Default)]
struct File {
    limits: (usize, usize),
    positions: Vec<[f32; 3]>,
    coordinates: Vec<[f32; 2]>,
    normals: Vec<[f32; 3]>,
    /// Vertices of the surface by their position, coordinates and normal.
    known: HashMap<[Option<usize>; 3], u32>,
    surface: Surface,
}

type Found<T> = Result<T, Box<Diagnostic>>;

fn refused(place: Range<usize>, message: impl Into<String>, help: &str) -> Box<Diagnostic> {
    Box::new(Diagnostic::error("NB0236", place, message).label("in this line").help(help))
}

fn too_many(code: &'static str, place: Range<usize>, message: String) -> Box<Diagnostic> {
    let help = "`ninebit limits` prints what is allowed";
    Box::new(Diagnostic::error(code, place, message).label("too many from here").help(help))
}

impl File {
    fn line(&mut self, start: usize, line: &str) -> Found<()> {
        let mut words = line.split_whitespace();
        let Some(word) = words.next() else { return Ok(()) };
        let place = |part: &str| {
            let offset = (part.as_ptr() as usize).saturating_sub(line.as_ptr() as usize);
            start + offset..start + offset + part.len()
        };
        match word {
            "v" => {
                let position = numbers(words, place(word), &place, 3)?;
                self.positions.push(position);
            }
            "vt" => {
                let [s, t, _] = numbers(words, place(word), &place, 1)?;
                self.coordinates.push([s, upright(t)]);
            }
            "vn" => {
                let normal = numbers(words, place(word), &place, 3)?;
                self.normals.push(normal);
            }
            "f" => self.face(words, place(word), &place)?,
            _ if WITHOUT_TRIANGLES.contains(&word) => {}
            _ => {
                let message = format!("there is no statement `{}`", shorten(word));
                return Err(refused(
                    place(word),
                    message,
                    "read are v, vt, vn, f; passed over o, g, s, usemtl, mtllib, l, p, vp",
                ));
            }
        }
        Ok(())
    }

    fn face<'t>(
        &mut self,
        words: impl Iterator<Item = &'t str>,
        place: Range<usize>,
        at: &dyn Fn(&str) -> Range<usize>,
    ) -> Found<()> {
        let mut corners = Vec::new();
        for word in words {
            corners.push(self.corner(word, at(word))?);
        }
        if corners.len() < 3 {
            let message = format!("a face has at least three corners, not {}", corners.len());
            return Err(refused(place, message, "write `f 1 2 3`"));
        }
        if self.surface.indices.len() + 3 * (corners.len() - 2) > self.limits.1 {
            let message = format!("more than {} indices in a mesh", self.limits.1);
            return Err(too_many("NB0609", place, message));
        }
        for pair in corners[1..].windows(2) {
            self.surface.indices.extend([corners[0], pair[0], pair[1]]);
        }
        Ok(())
    }

    /// The vertex of `1`, `1/2`, `1//3` or `1/2/3`.
    fn corner(&mut self, word: &str, place: Range<usize>) -> Found<u32> {
        let counts = [self.positions.len(), self.coordinates.len(), self.normals.len()];
        let mut parts = word.split('/');
        let mut key = [None; 3];
        for (n, slot) in key.iter_mut().enumerate() {
            let part = parts.next().unwrap_or("");
            if part.is_empty() && n > 0 {
                continue;
            }
            let what = ["position", "texture coordinates", "normal"][n];
            let index = part.parse::<i64>().ok().and_then(|number| match number {
                1.. => usize::try_from(number - 1).ok(),
                // Counted from the end.
                _ => usize::try_from(counts[n] as i64 + number).ok().filter(|_| number < 0),
            });
            *slot = index.filter(|index| *index < counts[n]);
            if slot.is_none() {
                let message = format!("`{}` names no {what} before this line", shorten(part));
                let help = format!("there are {} so far, counted from 1", counts[n]);
                return Err(refused(place, message, &help));
            }
        }
        if parts.next().is_some() {
            return Err(refused(place, "a corner has at most three numbers", "write `1/2/3`"));
        }
        if let Some(known) = self.known.get(&key) {
            return Ok(*known);
        }
        let [position, coordinates, normal] = key;
        let surface = &mut self.surface;
        let number = surface.positions.len();
        if number >= self.limits.0 {
            let message = format!("more than {} vertices in a mesh", self.limits.0);
            return Err(too_many("NB0603", place, message));
        }
        surface.positions.push(position.map_or([0.0; 3], |index| self.positions[index]));
        surface.texture_coordinates.push(coordinates.map_or([0.0; 2], |index| self.coordinates[index]));
        surface.normals.push(normal.map_or([0.0; 3], |index| self.normals[index]));
        self.known.insert(key, number as u32);
        Ok(number as u32)
    }
}

#[allow(clippy::float_arithmetic, reason = "texture coordinates are floats")]
fn upright(t: f32) -> f32 {
    1.0 - t
}

/// At least `least` numbers; the first three.
fn numbers<'t>(
    words: impl Iterator<Item = &'t str>,
    place: Range<usize>,
    at: &dyn Fn(&str) -> Range<usize>,
    least: usize,
) -> Found<[f32; 3]> {
    let (mut values, mut count) = ([0.0; 3], 0);
    for word in words {
        let number = word.parse::<f32>().ok().filter(|number| number.is_finite());
        let Some(number) = number else {
            return Err(refused(at(word), format!("`{}` is not a number", shorten(word)), "write decimal numbers"));
        };
        if let Some(slot) = values.get_mut(count) {
            *slot = number;
        }
        count += 1;
    }
    if count < least {
        let message = format!("{count} numbers where there are at least {least}");
        return Err(refused(place, message, "a position and a normal have three, texture coordinates two"));
    }
    Ok(values)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(text: &str) -> Surface {
        read(text, 100, 100).unwrap_or_else(|findings| panic!("{findings:?}"))
    }

    fn refusal(text: &str) -> (&'static str, String) {
        let findings = read(text, 5, 12).expect_err(text);
        let finding = findings.first().expect("finding");
        (finding.code, text[finding.span.clone().expect("place")].to_owned())
    }

    #[test]
    fn faces_share_their_vertices() {
        let text = "# a square\r\no square\nv 0 0 0\r\nv 1 0 0 1.0\nv 1 1 0 # corner\nv 0 1 0\nvt 0 0\nvt 1 0 0\nvt 1 1\nvn 0 0 1\n\
                    usemtl stone\ns off\nf 1/1/1 2/2/1 3/3/1 4//1\nf -4/-3/-1 -2/-1/-1 3\n";
        let surface = of(text);
        assert_eq!(surface.positions.len(), 5);
        assert_eq!(surface.indices, [0, 1, 2, 0, 2, 3, 0, 2, 4]);
        assert_eq!(surface.texture_coordinates, [[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0], [0.0, 0.0]]);
        assert_eq!((surface.normals[0], surface.normals[4]), ([0.0, 0.0, 1.0], [0.0; 3]));
    }

    #[test]
    fn what_is_wrong_has_its_place() {
        let triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
        for (line, code, part) in [
            ("", "NB0236", ""),
            ("f 1 2", "NB0236", "f"),
            ("f 1 2 4", "NB0236", "4"),
            ("f 0 1 2", "NB0236", "0"),
            ("f -4 1 2", "NB0236", "-4"),
            ("f 1/1 2 3", "NB0236", "1/1"),
            ("f 1/1/1/1 2 3", "NB0236", "1/1/1/1"),
            ("f 1//2 2 3", "NB0236", "1//2"),
            ("f a b c", "NB0236", "a"),
            ("f 9999999999999999999999 2 3", "NB0236", "9999999999999999999999"),
            ("v 1 2", "NB0236", "v"),
            ("v 1 2 inf", "NB0236", "inf"),
            ("vt x", "NB0236", "x"),
            ("curv 1 2", "NB0236", "curv"),
            ("f 1 2 3 1 2 3 1", "NB0609", "f"),
            ("v 1 1 1\nv 2 2 2\nv 3 3 3\nf 1 2 3\nf 4 5 6", "NB0603", "6"),
        ] {
            assert_eq!(refusal(&format!("{triangle}{line}")), (code, part.to_owned()), "{line}");
        }
        let many = "curv\n".repeat(100);
        assert_eq!(read(&many, 5, 5).expect_err("no statement").len(), MOST_FINDINGS);
    }

    proptest::proptest! {
        #[test]
        fn garbage_is_read_or_refused(text in "([vfn t0-9/.\\-\n]|vt|vn|f 1|v 1 1 1\n){0,60}") {
            match read(&text, 8, 24) {
                Ok(surface) => {
                    let count = surface.positions.len() as u32;
                    proptest::prop_assert!(surface.indices.iter().all(|index| *index < count) && count <= 8);
                }
                Err(findings) => proptest::prop_assert!(findings.iter().all(|f| f.span.clone().is_some_and(|s| text.get(s).is_some()))),
            }
        }
    }
}
