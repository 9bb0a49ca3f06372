//! Reads Wavefront OBJ files. The `obj` crate reads vertices and faces; this module turns the corners of faces into vertices.
//!
//! The crate gets only what it needs: comments are cut off, and statements that do not concern triangles are blanked, so that groups and
//! materials neither cost memory nor split the list of faces. Line numbers stay as they are.

use std::collections::HashMap;

use obj::{IndexTuple, ObjData, ObjError};

use super::Surface;
use ninebit::diagnostic::{Diagnostic, shorten};
use ninebit::place::Span;
use ninebit_files::catch_panic;
use ninebit_program::finding;

/// Number of findings after which no more are looked for.
const MAX_FINDINGS: usize = 16;

/// Statements that do not concern triangles.
const WITHOUT_TRIANGLES: &[&str] = &["o", "g", "s", "usemtl", "mtllib", "l", "p", "vp"];

type LineResult<T> = Result<T, Box<Diagnostic>>;

/// Reads the vertices (`v`, `vt`, `vn`) and faces (`f`) of a file; a face of more than three corners becomes a triangle fan. The first row of
/// a texture is at the top in this program and at the bottom in the file, so t becomes 1 - t.
///
/// # Errors
/// The first line that is not understood; numbers that are not finite; indices without an element; more than `vertices` vertices or
/// `indices` indices.
pub(crate) fn read(text: &str, vertices: usize, indices: usize) -> Result<Surface, Vec<Diagnostic>> {
    let file = File { text };
    let data = file.count(indices).and_then(|()| file.parse()).map_err(|finding| vec![*finding])?;
    let mut findings = file.not_finite(&data);
    let surface = file.surface(&data, vertices, &mut findings);
    if findings.is_empty() { Ok(surface) } else { Err(findings) }
}

/// Returns the statement of a line, empty if it does not concern triangles.
fn statement(line: &str) -> &str {
    let content = line.split('#').next().unwrap_or("");
    let passed_over = content.split_whitespace().next().is_some_and(|word| WITHOUT_TRIANGLES.contains(&word));
    if passed_over { &line[..0] } else { content.trim() }
}

/// Returns the number of corners of a face.
fn corners(statement: &str) -> usize {
    statement.split_whitespace().skip(1).count()
}

#[derive(Clone, Copy)]
struct File<'t> {
    text: &'t str,
}

impl<'t> File<'t> {
    /// Returns the statement of each line.
    fn statements(self) -> impl Iterator<Item = &'t str> {
        self.text.split('\n').map(statement)
    }

    /// Returns the statements that begin with `name`, in the order of the file.
    fn named(self, name: &str) -> impl Iterator<Item = &'t str> {
        self.statements().filter(move |statement| statement.split_whitespace().next() == Some(name))
    }

    /// Returns the place of a slice of the text.
    fn span(self, part: &str) -> Span {
        let start = (part.as_ptr() as usize).saturating_sub(self.text.as_ptr() as usize);
        start..start + part.len()
    }

    fn refused(self, part: &str, message: impl Into<String>, help: &str) -> Diagnostic {
        finding("NB0236", self.span(part), message, "in this line", help)
    }

    fn too_many(self, code: &'static str, part: &str, message: String) -> Diagnostic {
        finding(code, self.span(part), message, "too many from here", "`ninebit limits` prints what is allowed")
    }

    /// Refuses a file with too many faces or corners before anything is built from it.
    fn count(self, limit: usize) -> LineResult<()> {
        let mut indices = 0;
        for face in self.named("f") {
            indices += 3 * corners(face).saturating_sub(2).max(1);
            if indices > limit {
                return Err(Box::new(self.too_many("NB0609", face, format!("more than {limit} indices in a mesh"))));
            }
        }
        Ok(())
    }

    fn parse(self) -> LineResult<ObjData> {
        let mut reduced = String::with_capacity(self.text.len() + 1);
        for statement in self.statements() {
            reduced.push_str(statement);
            reduced.push('\n');
        }
        match catch_panic::quietly(|| ObjData::load_buf(reduced.as_bytes())) {
            Ok(Ok(data)) => Ok(data),
            Ok(Err(error)) => Err(Box::new(self.explain(&error))),
            Err(panic) => {
                let message = format!("the reader of Wavefront files gave up ({})", shorten(&panic));
                Err(Box::new(Diagnostic::error("NB0236", 0..0, message).label("this file")))
            }
        }
    }

    /// Turns an error of the crate into a finding with a message of our own: the crate's message counts lines from 0.
    fn explain(self, error: &ObjError) -> Diagnostic {
        let line = |number: usize| self.statements().nth(number).unwrap_or(&self.text[..0]);
        match error {
            ObjError::ArgumentListFailure { line_number, .. } => {
                let help = "a position and a normal have three decimal numbers, texture coordinates two";
                self.refused(line(*line_number), "numbers are missing, or are no numbers", help)
            }
            ObjError::MalformedFaceGroup { line_number, group } => {
                let message = format!("`{}` is not a corner of a face", shorten(group));
                self.refused(line(*line_number), message, "write `1`, `1/2`, `1//3` or `1/2/3`")
            }
            ObjError::ZeroVertexNumber { line_number } => {
                self.refused(line(*line_number), "there is no position 0", "indices are counted from 1")
            }
            ObjError::UnexpectedCommand { line_number, command } => {
                let help = "read are v, vt, vn, f; passed over o, g, s, usemtl, mtllib, l, p, vp";
                self.refused(line(*line_number), format!("there is no statement `{}`", shorten(command)), help)
            }
            other => self.refused(&self.text[..0], other.to_string(), "write a Wavefront OBJ file"),
        }
    }

    /// Finds numbers that are not finite, since the crate accepts `inf` and `nan`.
    fn not_finite(self, data: &ObjData) -> Vec<Diagnostic> {
        let finite = |numbers: &[f32]| numbers.iter().all(|number| number.is_finite());
        let lists = [data.position.as_flattened(), data.texture.as_flattened(), data.normal.as_flattened()];
        if lists.into_iter().all(finite) {
            return Vec::new();
        }
        let whole: [(&str, Vec<bool>); 3] = [
            ("v", data.position.iter().map(|position| finite(position)).collect()),
            ("vt", data.texture.iter().map(|coordinates| finite(coordinates)).collect()),
            ("vn", data.normal.iter().map(|normal| finite(normal)).collect()),
        ];
        let lines = whole.into_iter().flat_map(|(name, whole)| self.named(name).zip(whole));
        let broken = lines.filter(|(_, whole)| !whole).take(MAX_FINDINGS);
        broken.map(|(line, _)| self.refused(line, "a number is not finite", "write decimal numbers")).collect()
    }

    /// Makes a vertex for each combination of indices, in the order in which faces use them.
    fn surface(self, data: &ObjData, vertices: usize, findings: &mut Vec<Diagnostic>) -> Surface {
        let mut surface = Surface::default();
        let mut known = HashMap::new();
        let polygons = data.objects.iter().flat_map(|object| &object.groups).flat_map(|group| &group.polys);
        for (face, polygon) in self.named("f").zip(polygons) {
            if findings.len() >= MAX_FINDINGS {
                break;
            }
            let count = corners(face);
            if count < 3 {
                let message = format!("a face has at least three corners, not {count}");
                findings.push(self.refused(face, message, "write `f 1 2 3`"));
                continue;
            }
            let mut fan = Vec::with_capacity(count);
            for (word, corner) in face.split_whitespace().skip(1).zip(&polygon.0) {
                if let Err(finding) = self.check(data, word, corner) {
                    findings.push(*finding);
                    break;
                }
                let next = surface.positions.len();
                let number = *known.entry(*corner).or_insert(next as u32);
                if number as usize == next {
                    if next >= vertices {
                        let message = format!("more than {vertices} vertices in a mesh");
                        findings.push(self.too_many("NB0603", word, message));
                        return surface;
                    }
                    add(&mut surface, data, corner);
                }
                fan.push(number);
            }
            for pair in fan.get(1..).unwrap_or_default().windows(2) {
                surface.indices.extend([fan[0], pair[0], pair[1]]);
            }
        }
        if surface.indices.is_empty() && findings.is_empty() {
            let help = "a mesh needs faces: lines such as `f 1/1 2/2 3/3`";
            findings.push(finding("NB0236", 0..0, "this file has no triangles", "here", help));
        }
        surface
    }

    /// Checks that the file has what a corner refers to. The crate does not check indices against its lists, and ignores a fourth index as well as
    /// indices of texture coordinates and normals that it cannot read.
    fn check(self, data: &ObjData, word: &str, corner: &IndexTuple) -> LineResult<()> {
        let IndexTuple(position, coordinates, normal) = *corner;
        let read = 1 + usize::from(coordinates.is_some()) + usize::from(normal.is_some());
        if word.split('/').filter(|part| !part.is_empty()).count() != read {
            let message = format!("`{}` is not a corner of a face", shorten(word));
            return Err(Box::new(self.refused(word, message, "write `1`, `1/2`, `1//3` or `1/2/3`, counted from 1")));
        }
        for (what, index, count) in [
            ("position", Some(position), data.position.len()),
            ("texture coordinates", coordinates, data.texture.len()),
            ("normal", normal, data.normal.len()),
        ] {
            if index.is_some_and(|index| index >= count) {
                let message = format!("`{}` names no {what} of this file", shorten(word));
                let help = format!("there are {count}, counted from 1, or from -1 backward");
                return Err(Box::new(self.refused(word, message, &help)));
            }
        }
        Ok(())
    }
}

/// Adds a vertex whose indices have been checked; absent attributes are zero.
fn add(surface: &mut Surface, data: &ObjData, corner: &IndexTuple) {
    let IndexTuple(position, coordinates, normal) = *corner;
    surface.positions.push(data.position[position]);
    let coordinates = coordinates.map(|index| data.texture[index]);
    surface.texture_coordinates.push(coordinates.map_or([0.0; 2], |[s, t]| [s, upright(t)]));
    surface.normals.push(normal.map_or([0.0; 3], |index| data.normal[index]));
}

#[allow(clippy::float_arithmetic, reason = "texture coordinates are floats")]
fn upright(t: f32) -> f32 {
    1.0 - t
}

#[cfg(test)]
mod tests {
    use super::*;

    fn from_text(text: &str) -> Surface {
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
        let surface = from_text(text);
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
            ("f 1 2", "NB0236", "f 1 2"),
            ("f 1 2 4", "NB0236", "4"),
            ("f 0 1 2", "NB0236", "f 0 1 2"),
            ("f -4 1 2", "NB0236", "-4"),
            ("f 1 2 -9223372036854775808", "NB0236", "-9223372036854775808"),
            ("f 1/1 2 3", "NB0236", "1/1"),
            ("f 1/1/1/1 2 3", "NB0236", "1/1/1/1"),
            ("f 1//2 2 3", "NB0236", "1//2"),
            ("f 1/0 2 3", "NB0236", "1/0"),
            ("f 1/x 2 3 # comment", "NB0236", "1/x"),
            ("  f a b c\r", "NB0236", "f a b c"),
            ("f 9999999999999999999999 2 3", "NB0236", "f 9999999999999999999999 2 3"),
            ("f 1 2 3\nv 1 2", "NB0236", "v 1 2"),
            ("f 1 2 3\n# v\nv 1 2 inf\n", "NB0236", "v 1 2 inf"),
            ("f 1 2 3\nvt x 0", "NB0236", "vt x 0"),
            ("f 1 2 3\ng x\ncurv 1 2 # v 1", "NB0236", "curv 1 2"),
            ("f 1 2 3 1 2 3 1", "NB0609", "f 1 2 3 1 2 3 1"),
            ("v 1 1 1\nv 2 2 2\nv 3 3 3\nf 1 2 3\nf 4 5 6", "NB0603", "6"),
        ] {
            assert_eq!(refusal(&format!("{triangle}{line}")), (code, part.to_owned()), "{line}");
        }
        let many = "f 7 8 9\n".repeat(100);
        assert_eq!(read(&many, 5, 300).expect_err("no positions").len(), MAX_FINDINGS);
    }

    #[test]
    fn groups_and_materials_take_nothing_away() {
        let triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
        let text =
            format!("{triangle}usemtl a\nf 1 2 3\ng\no x\nusemtl b\nusemtl c\nf 3 2 1\ng y\nmtllib\nf 2 3 1\no\n");
        assert_eq!(from_text(&text).indices, [0, 1, 2, 2, 1, 0, 1, 2, 0]);
    }

    fn sound(text: &str) -> Result<(), proptest::test_runner::TestCaseError> {
        match read(text, 8, 24) {
            Ok(surface) => {
                let count = surface.positions.len();
                proptest::prop_assert!(count <= 8 && surface.indices.len() <= 24);
                proptest::prop_assert!(surface.indices.iter().all(|index| (*index as usize) < count));
                proptest::prop_assert_eq!([surface.normals.len(), surface.texture_coordinates.len()], [count; 2]);
                proptest::prop_assert!(surface.positions.as_flattened().iter().all(|number| number.is_finite()));
            }
            Err(findings) => {
                let placed = |finding: &Diagnostic| finding.span.clone().is_some_and(|place| text.get(place).is_some());
                proptest::prop_assert!((1..=MAX_FINDINGS).contains(&findings.len()) && findings.iter().all(placed));
            }
        }
        Ok(())
    }

    proptest::proptest! {
        #[test]
        fn garbage_is_read_or_refused(text in "([vfn t0-9/.\\-\n]|vt|vn|f 1|v 1 1 1\n){0,60}") {
            sound(&text)?;
        }

        #[test]
        fn mangled_files_are_read_or_refused(
            edits in proptest::collection::vec((0..200_usize, "[vfnto/#.e\\-0-9 \n\r]|inf|usemtl |-?[0-9]{19}|\u{3000}|\\PC"), 1..6),
        ) {
            let mut file: Vec<String> = include_str!("../../../vectors/scenes/programs/cube.obj").chars().map(String::from).collect();
            for (place, edit) in edits {
                let length = file.len();
                file[(length - 1 - place) % length] = edit;
            }
            sound(&file.concat())?;
        }

        /// Corners of all kinds, counted from either end.
        #[test]
        fn faces_say_what_was_written(
            faces in proptest::collection::vec(
                proptest::collection::vec((0..4_usize, proptest::option::of(0..3_usize), proptest::option::of(0..2_usize), proptest::bool::ANY), 3..6),
                1..5,
            ),
        ) {
            let mut text = "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 3 0 0\nvt 4 1\nvt 5 1\nvt 6 1\nvn 7 0 0\nvn 8 0 0\n".to_owned();
            for face in &faces {
                text.push('f');
                for (position, coordinates, normal, backward) in face {
                    let index = |index: usize, count: i64| if *backward { index as i64 - count } else { index as i64 + 1 };
                    let coordinates = coordinates.map_or(String::new(), |n| index(n, 3).to_string());
                    let normal = normal.map_or(String::new(), |n| format!("/{}", index(n, 2)));
                    text += &format!(" {}/{coordinates}{normal}", index(*position, 4));
                }
                text.push('\n');
            }
            let surface = from_text(&text);
            let vertex = |index: &u32| {
                let n = *index as usize;
                (surface.positions[n][0], surface.texture_coordinates[n][0], surface.normals[n][0])
            };
            let written = |(position, coordinates, normal, _): &(usize, Option<usize>, Option<usize>, bool)| {
                (*position as f32, coordinates.map_or(0.0, |n| (n + 4) as f32), normal.map_or(0.0, |n| (n + 7) as f32))
            };
            let fans = faces.iter().flat_map(|face| face[1..].windows(2).flat_map(|pair| [written(&face[0]), written(&pair[0]), written(&pair[1])]));
            proptest::prop_assert_eq!(surface.indices.iter().map(vertex).collect::<Vec<_>>(), fans.collect::<Vec<_>>());
        }
    }
}
