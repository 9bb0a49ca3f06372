//! Checks tables of the languages of programs.

use super::{names, rows, spans};
use crate::bench::Bench;
use ninebit::state::{Named, TextureFormat};
use ninebit_program::texture_environment::BaseFormat;
use ninebit_program::texture_stages::ArgumentSource;
use std::collections::BTreeSet;

/// Arguments of texture stages have the names and numbers of the source; modifiers follow.
#[test]
fn arguments_of_texture_stages_are_listed() {
    let listed: Vec<String> =
        rows("docs/languages/programs.md", "arguments").iter().map(|row| row[0].replace('`', "")).collect();
    let known = ArgumentSource::ALL.iter().enumerate().map(|(n, source)| format!("{} ({n})", source.name()));
    let known = known.chain(["Complement (16)".to_owned(), "AlphaReplicate (32)".to_owned()]);
    assert_eq!(listed, known.collect::<Vec<_>>());
}

/// Texel formats stand beside their base formats.
#[test]
fn base_formats_are_those_of_the_source() {
    const PAGE: &str = "docs/languages/programs.md";
    let mut named = BTreeSet::new();
    for row in rows(PAGE, "base formats") {
        for format in row[1].split(", ").filter_map(TextureFormat::from_name) {
            assert_eq!(spans(&row[0]), [BaseFormat::from_format(format).name()], "{}", format.name());
            named.insert(format.name());
        }
    }
    for format in TextureFormat::ALL.iter().filter(|format| format.depth().is_none() && !named.contains(format.name()))
    {
        let other = if format.has_alpha() { BaseFormat::Rgba } else { BaseFormat::Rgb };
        assert_eq!(BaseFormat::from_format(*format), other, "{PAGE}: {}", format.name());
    }
    assert_eq!(names(PAGE, "base formats"), BaseFormat::ALL.iter().map(|base| base.name().to_owned()).collect());
}

/// Each register has its number in the words of a program that reads it.
#[test]
fn numbers_of_registers_are_those_of_words() {
    let bench = Bench::new();
    let mut checked = 0;
    for row in rows("docs/languages/registers.md", "registers") {
        for pair in row.chunks(2) {
            let registers = pair[1].split([' ', ',', ':']).filter(|word| !word.is_empty());
            for (code, register) in pair[0].split(", ").zip(registers) {
                if ["color_sum", "final_product"].contains(&register) {
                    continue;
                }
                let text = format!("{{ rgb {{ spare0 = {register} * tex0; }} }} out.rgb = spare0; out.a = fog.a;");
                bench.write("block.rc", text);
                let words = bench.run("lower block.rc --to registers --profile nv2a").text();
                let (_, rest) = words.split_once("rc_in_rgb: [0x").unwrap();
                assert_eq!(&rest[1..2], code, "{register}: {words}");
                checked += 1;
            }
        }
    }
    assert_eq!(checked, 12);
}

/// The last register of each bank is read, one beyond is refused.
#[test]
fn registers_of_shaders_are_read() {
    let bench = Bench::new();
    let is_read = |text: &str| {
        bench.write("block.psh", text);
        bench.run("lower block.psh --to combiners --profile nv2a").status == 0
    };
    let tex = "tex t0\ntex t1\ntex t2\ntex t3\nmov r0, t0\nmov r1, t0\n";
    for row in rows("docs/languages/pixel-shader.md", "registers") {
        let (first, last) = row[0].split_once(" to ").or_else(|| row[0].split_once(", ")).unwrap();
        let (bank, last) = (&first[..1], last[1..].parse::<u32>().unwrap());
        let define = |n: u32| if bank == "c" { format!("def c{n}, 1, 0, 0, 1\n") } else { String::new() };
        let text =
            |n: u32| format!("ps.1.1\n{}{tex}mul r0, {bank}{n}, {first}\n", define(n)).replace("c0", &format!("c{n}"));
        assert!(is_read(&text(last)), "{}", text(last));
        assert!(!is_read(&text(last + 1)), "{}", text(last + 1));
    }
}

/// The fields that stand for states of Direct3D are fields or words of the scene format.
#[test]
fn states_of_direct3d_are_fields() {
    let format = std::fs::read_to_string(crate::repository::at("docs/scene-format.md")).unwrap();
    let words: BTreeSet<&str> = format.split(|c: char| !c.is_alphanumeric() && c != '_').collect();
    for row in rows("docs/languages/programs.md", "states") {
        for span in spans(&row[1]) {
            let named = span.split(|c: char| !c.is_alphanumeric() && c != '_').filter(|word| !word.is_empty());
            for word in named.filter(|word| word.parse::<u32>().is_err()) {
                assert!(words.contains(word), "the scene format has no `{word}`: {span}");
            }
        }
    }
}

/// The last register of each bank of vertex programs is read, one beyond is refused; outputs are written.
#[test]
fn registers_of_vertex_programs_are_read() {
    use ninebit_program::vertex_shader::read;
    let program = |line: &str| format!("vs.1.1\nmov oPos, v0\n{line}\n");
    for row in rows("docs/languages/vertex-shader.md", "registers") {
        let registers = spans(&row[0]);
        if row[1].starts_with("outputs") {
            for name in registers {
                let text = program(&format!("mov {name}.x, v0.x"));
                assert!(read(&text).is_ok(), "{text}: {:?}", read(&text));
            }
        } else if let [first, last] = registers[..] {
            let (bank, last) = (&first[..1], last[1..].parse::<u32>().unwrap());
            let line = |n: u32| if bank == "r" { format!("mov r{n}, v0") } else { format!("mov oPos, {bank}{n}") };
            let [last, beyond] = [last, last + 1].map(|n| read(&program(&line(n))).is_ok());
            assert!(last && !beyond, "{registers:?}: {last}, {beyond}");
        }
    }
}

/// The printer and the reader of the combiner language have every word of its grammar.
#[test]
fn words_of_the_grammar_are_read() {
    let page = std::fs::read_to_string(crate::repository::at("docs/languages/combiner-language.md")).unwrap();
    let [begin, end] = ["begin", "end"].map(|word| format!("<!-- held by tests/tables.rs (grammar): {word} -->"));
    let grammar = page.split_once(&begin).unwrap().1.split_once(&end).unwrap().0;
    let files = std::fs::read_dir(crate::repository::at("src/program/text")).unwrap();
    let sources: String = files.map(|file| std::fs::read_to_string(file.unwrap().path()).unwrap()).collect();
    let words = grammar.split('"').skip(1).step_by(2).map(|word| word.trim_start_matches(['!', '.']));
    let words: BTreeSet<&str> = words.filter(|word| word.len() > 1).collect();
    assert!(words.len() >= 20, "{words:?}");
    for word in words {
        assert!(sources.contains(&format!("\"{word}")) || sources.contains(&format!("{word}\"")), "{word}");
    }
}

/// Tables of bits have every field of the layout, each within a row.
#[test]
fn bits_of_words_are_those_of_the_layout() {
    use ninebit::state::Profile;
    use ninebit_program::registers::layout::{self, Field};
    let output = [layout::OUTPUTS.as_slice(), &layout::DOT_PRODUCTS, &layout::BLUE_TO_ALPHA].concat();
    let config = [layout::mux_by_msb(Profile::Nv10), layout::stages(Profile::Nv10)];
    let output = [output, vec![layout::MUX, layout::OPERATION], config.to_vec()].concat();
    for (table, fields) in
        [("bits of inputs", vec![layout::REGISTER, layout::ALPHA, layout::MAPPING]), ("bits of outputs", output)]
    {
        let bits = |part: &str| {
            let (first, last) = part.split_once(" to ").unwrap_or((part, part));
            first.parse::<u32>().unwrap()..=last.parse::<u32>().unwrap()
        };
        let rows = rows("docs/languages/registers.md", table);
        let listed: Vec<BTreeSet<u32>> = rows.iter().map(|row| row[0].split(", ").flat_map(bits).collect()).collect();
        let inside = |field: &Field| (field.shift..field.shift + field.bits).collect::<BTreeSet<u32>>();
        for field in &fields {
            assert!(listed.iter().any(|row| row.is_superset(&inside(field))), "{table}: {field:?}");
        }
        let all: BTreeSet<u32> = fields.iter().flat_map(inside).collect();
        assert_eq!(listed.into_iter().flatten().collect::<BTreeSet<u32>>(), all, "{table}");
    }
}
