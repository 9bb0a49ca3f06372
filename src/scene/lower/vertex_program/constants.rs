//! Lowers the constants of a vertex program: `{ c0: Matrix(...), c12: (0, 0, 1) }`.

use super::*;
use ninebit::vertex::shader::{CONSTANTS, Opcode, SourceRegister};

type Program = (ShaderText, ProgramText);
/// An entry of the scene's constants: its place, its first register, and its number of registers.
type Entry = (Span, usize, usize);

/// Value of a constant in the scene: one register, or the four rows of a matrix.
enum Value {
    Vector([f32; 4]),
    Rows([[f32; 4]; 4]),
}

/// Reads the constants, adds those that the program defines, and compares them with those that it reads.
pub(super) fn constants<'a>(
    reader: &mut Reader<'a>,
    raw: &Option<Raw<'a, Entries<'a, source::ShaderConstant>>>,
    program: Option<&Program>,
) -> Constants {
    let mut constants: Constants = [[0.0; 4]; CONSTANTS];
    let mut given: Vec<Option<Span>> = vec![None; CONSTANTS];
    let mut entries: Vec<Entry> = Vec::new();
    if let Some((written, text)) = program {
        for ((index, values), place) in written.shader.definitions.iter().zip(&written.definitions) {
            constants[*index] = *values;
            given[*index] = Some(text.span(place.clone()));
        }
    }
    for (key, raw) in raw.as_ref().and_then(|raw| reader.read(raw)).map(|entries| entries.0).unwrap_or_default() {
        let place = reader.span(&key);
        let Some(first) = index(key.text) else {
            let message = format!("there is no constant `{}`", shorten(key.text));
            let help = "constants are c0 to c95: `constants: { c0: Matrix(Identity), c12: (0, 0, 1) }`";
            reader.push(finding("NB0204", place, message, "not known", help));
            continue;
        };
        let Some(value) = value(reader, &raw) else { continue };
        let rows = match &value {
            Value::Vector(vector) => std::slice::from_ref(vector),
            Value::Rows(rows) => &rows[..],
        };
        if first + rows.len() > CONSTANTS {
            let message = format!("a matrix at c{first} reaches up to c{}", first + rows.len() - 1);
            reader.push(finding("NB0206", place, message, "out of range", "there are c0 to c95: a matrix takes four"));
            continue;
        }
        let taken = (first..first + rows.len()).find_map(|index| Some((index, given[index].clone()?)));
        if let Some((index, other)) = taken {
            let message = format!("c{index} has a value already");
            let label = if rows.len() == 1 { "again here".to_owned() } else { format!("c{first} to c{}", first + 3) };
            let help = "keep one of them; a matrix takes four constants, and `def` gives one its value as well";
            reader.push(finding("NB0388", place, message, label, help).related(other, "first here"));
            continue;
        }
        for (offset, row) in rows.iter().enumerate() {
            constants[first + offset] = *row;
            given[first + offset] = Some(place.clone());
        }
        entries.push((place, first, rows.len()));
    }
    if let Some(program) = program {
        compare(reader, program, &given, &entries);
        meanings(reader, program, &entries);
    }
    constants
}

/// Checks that constants that are read have a value, and that those of the scene are read.
fn compare(reader: &mut Reader<'_>, (written, text): &Program, given: &[Option<Span>], entries: &[Entry]) {
    let (read, any) = written.constants_read();
    let unread: Vec<_> =
        entries.iter().filter(|(_, first, count)| read[*first..first + count].iter().all(Option::is_none)).collect();
    if any {
        return;
    }
    for (index, place) in read.iter().enumerate() {
        let Some(place) = place.clone().filter(|_| given[index].is_none()) else { continue };
        // A matrix without a value is reported once, at its first row.
        let same = |other: usize| read[other].as_ref() == Some(&place) && given[other].is_none();
        if index > 0 && same(index - 1) {
            continue;
        }
        let rows = (index..CONSTANTS).take_while(|row| same(*row)).count();
        let (name, verb) = match rows {
            1 => (format!("c{index}"), "has"),
            _ => (format!("c{index} to c{}", index + rows - 1), "have"),
        };
        let alike = unread.iter().filter(|(_, _, count)| (*count > 1) == (rows > 1));
        let given: Vec<String> = alike.map(|(_, first, _)| format!("c{first}")).collect();
        let help = if given.is_empty() {
            format!("add it: `constants: {{ c{index}: {} }}`", if rows > 1 { "Matrix(...)" } else { "(0, 0, 0, 1)" })
        } else {
            format!("nothing reads {}: is that the number that is meant?", given.join(", "))
        };
        reader.push(text.locate(finding("NB0387", place, format!("{name} {verb} no value"), "read here", help)));
    }
    for (place, first, _) in unread {
        let message = format!("the constant c{first} is not used");
        let help = "remove it, or check its number";
        reader.push(warning("NB0901", place.clone(), message, "the vertex program does not read it", help));
    }
}

/// Finds matrices of the scene that the program reads from another row than the first, or as vectors.
fn meanings(reader: &mut Reader<'_>, (written, text): &Program, entries: &[Entry]) {
    let matrices: Vec<_> = entries.iter().filter(|(_, _, count)| *count > 1).collect();
    for (instruction, places) in written.shader.instructions.iter().zip(&written.places) {
        for (n, source) in instruction.sources.iter().enumerate() {
            let SourceRegister::Constant { index, relative: false } = source.register else { continue };
            let word = instruction.opcode.word();
            let rows = instruction.opcode.matrix().filter(|_| n == 1).map(|(rows, _)| rows);
            let read = index..index + rows.unwrap_or(1);
            let overlaps = |(_, first, count): &&&(Span, usize, usize)| read.start < first + count && *first < read.end;
            let Some((_, first, _)) = matrices.iter().find(overlaps) else { continue };
            let finding = match rows {
                Some(_) if index == *first => continue,
                Some(_) => {
                    let message = format!("`{word}` reads a matrix from c{index}, and the scene has one at c{first}");
                    Diagnostic::error("NB0381", places.sources[n].clone(), message).label("begins between its rows")
                }
                None if matches!(instruction.opcode, Opcode::Dp3 | Opcode::Dp4) && !source.negate => continue,
                // The reader of programs has warned of this: the program itself reads the constant in both ways.
                None if written.warnings.iter().any(|known| known.span.as_ref() == Some(&places.sources[n])) => {
                    continue;
                }
                None => {
                    let message = format!("c{index} is a vector here and a row of the scene's matrix at c{first}");
                    Diagnostic::warning("NB0911", places.sources[n].clone(), message).label("another meaning")
                }
            };
            let note = format!("the scene's matrix fills c{first} to c{}", first + 3);
            reader.push(text.locate(finding.note(note).help("check the number: a matrix takes four constants")));
        }
    }
}

/// Parses the key of a constant: `c12`, `c08` or `12`.
fn index(key: &str) -> Option<usize> {
    let digits = key.strip_prefix(['c', 'C']).unwrap_or(key).trim_end();
    let plain = !digits.is_empty() && digits.len() <= 3 && digits.bytes().all(|byte| byte.is_ascii_digit());
    digits.parse().ok().filter(|index| plain && *index < CONSTANTS)
}

fn value<'a>(reader: &mut Reader<'a>, raw: &Raw<'a, source::ShaderConstant>) -> Option<Value> {
    if raw.text.starts_with('(') || raw.is_text() {
        return reader.numbers(&raw.as_other::<Numbers>(), "a constant", 1..=4, [0.0; 4]).map(Value::Vector);
    }
    let (kind, rest) = reader.variant(raw, "constant", &["Matrix", "Color"])?;
    let list = reader.read(&Raw::<Tuple<'a, source::Matrix>>::new(rest))?;
    let [part] = list.0[..] else {
        let what = ["a matrix", "a colour"][kind];
        let message = format!("expected {what} in these parentheses");
        let help = "write `c0: Matrix(\"world\")`, `c41: Color((255, 240, 220))` or four numbers";
        return reader.refuse(finding("NB0211", reader.range(rest), message, "here", help));
    };
    if kind == 0 {
        return reader.value(&part).map(Value::Rows);
    }
    let color = reader.value(&part.as_other::<source::Color>())?;
    Some(Value::Vector(color::floats(color)))
}
