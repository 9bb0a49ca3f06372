//! Checks that hostile names of scenes, files and texts cannot inject terminal sequences or workflow commands into outputs or reports.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::fs;

use crate::bench::{Bench, Run};

/// A name in RON notation with the end of a line, workflow commands, ESC, CSI, a change of writing direction, markup of XML and HTML, and a
/// link.
const HOSTILE: &str = r#"n\n::error::injected\r##[error]old\u{1b}[31m\u{9b}2J\u{202e}\u{ffff}]]></failure><script>alert(1)</script>[a](http://b.c)|"#;

/// Returns a scene in which everything has the hostile name.
fn scene() -> String {
    format!(
        r#"(version: 1, profile: Nv2a, targets: [(name: "{HOSTILE}", width: 8, height: 8)],
        textures: {{ "{HOSTILE}": (source: Solid(width: 2, height: 2, color: (1, 2, 3))), "{HOSTILE}2": (source: Solid(width: 2, height: 2, color: (1, 2, 3))) }},
        draws: [(name: "{HOSTILE}", vertices: Window([(position: (0, 0)), (position: (9, 0)), (position: (0, 9))]), textures: ["{HOSTILE}"])])"#
    )
}

/// Checks that a text has no control characters, no invisible characters and no workflow commands. Lines that begin with `own` are commands
/// that the program itself intends.
fn harmless(what: &str, text: &str, own: &str) {
    for line in text.split('\n') {
        let bad = |c: char| {
            c != '\t' && c.is_control()
                || matches!(c, '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}' | '\u{2028}' | '\u{ffff}')
        };
        assert!(!line.contains(bad), "{what}: {line:?}");
        assert!(!line.contains("##["), "{what}: {line:?}");
        assert!(!line.trim_start().starts_with("::") || !own.is_empty() && line.starts_with(own), "{what}: {line:?}");
    }
}

fn harmless_run(what: &str, run: &Run, own: &str) {
    harmless(what, std::str::from_utf8(&run.stdout).unwrap(), own);
    harmless(what, &run.stderr, "");
}

#[test]
fn every_command_shows_hostile_names_as_text() {
    let bench = Bench::new();
    bench.write("a.ron", scene());
    // Each of these has an error, whose message quotes the name.
    bench.write("unknown.ron", scene().replace("textures: [\"", "textures: [\"no"));
    bench.write("field.ron", scene().replace("width: 8", &format!("width: 8, \"{HOSTILE}\": 1")));
    bench.write("control.ron", "(version: 1, /* \u{1b}[31m \u{9b}2J \u{202e} ##[error]x */ profile: Nv11)");
    for command in [
        "check a.ron",
        "explain a.ron --count",
        "lower a.ron --to combiners",
        "registers a.ron",
        "trace a.ron --pixel 1,1",
        "trace a.ron --pixel 1,1 --draw 7",
        "trace a.ron --pixel 1,1 --target none",
        "compare a.ron",
        "bench a.ron --frames 1",
        "measure a.ron",
        "texture a.ron",
        "texture a.ron:none",
        "check unknown.ron",
        "check field.ron",
        "check control.ron",
        "check control.ron --color always",
        "check a.ron --format json",
        "explain a.ron --format json",
        "registers a.ron --format json",
        "trace a.ron --pixel 1,1 --format json",
        "compare a.ron --format json",
        "render a.ron -o a.png --format json",
    ] {
        let run = bench.run(command);
        let colored = command.contains("--color");
        let stderr = if colored { run.stderr.replace("\x1b[", "[") } else { run.stderr.clone() };
        harmless_run(command, &Run { stderr, ..run }, "");
    }
    let run = bench.run("trace a.ron --pixel 1,1 --format json");
    let json: serde_json::Value = serde_json::from_slice(&run.stdout).unwrap();
    assert!(
        json["target"].as_str().unwrap().starts_with("n\n::error::injected\r##[error]old\u{1b}[31m\u{9b}2J\u{202e}")
    );
}

#[test]
fn the_command_line_is_shown_as_text() {
    let bench = Bench::new();
    for argument in ["\x1b[31m", "\n::error::x", "--\x1b[31m", "##[error]x"] {
        for command in ["", "check", "render", "op", "vectors check", "replay", "check --color always"] {
            let run = Run::from_output(bench.command(command).arg(argument).output().unwrap());
            let plain = run.stderr.replace("\x1b[0m", "").replace("\x1b[1m", "");
            assert!(run.status != 0, "{command} {argument:?}");
            if !command.contains("--color") {
                harmless_run(command, &run, "");
            }
            assert!(!plain.contains("\x1b[31m\n") && !plain.contains("\n::error"), "{command}: {plain:?}");
        }
    }
}

/// The JUnit schema of Jenkins: each element, its attributes (required ones end with `!`), and the elements that it may contain.
const JUNIT: [(&str, &[&str], &[&str]); 6] = [
    ("testsuites", &["name", "time", "tests", "failures", "disabled", "errors"], &["testsuite"]),
    (
        "testsuite",
        &[
            "name",
            "tests!",
            "failures",
            "errors",
            "time",
            "disabled",
            "skipped",
            "skips",
            "timestamp",
            "hostname",
            "id",
            "package",
            "assertions",
            "file",
            "skip",
            "log",
            "url",
        ],
        &["testsuite", "properties", "testcase", "system-out", "system-err"],
    ),
    (
        "testcase",
        &[
            "name!",
            "assertions",
            "time",
            "timestamp",
            "classname",
            "status",
            "class",
            "file",
            "line",
            "log",
            "group",
            "url",
        ],
        &["skipped", "error", "failure", "system-out", "system-err"],
    ),
    ("failure", &["type", "message"], &["#text"]),
    ("error", &["type", "message"], &["#text"]),
    ("skipped", &["type", "message"], &["#text"]),
];

/// Checks a report against [`JUNIT`] and XML 1.0. Returns the number of elements of each name.
fn valid(xml: &str) -> std::collections::BTreeMap<String, usize> {
    use quick_xml::events::Event;
    let allowed =
        |c: char| matches!(c, '\t' | '\n' | '\r' | ' '..='\u{d7ff}' | '\u{e000}'..='\u{fffd}' | '\u{10000}'..);
    assert!(xml.chars().all(allowed), "{xml:?}");
    let mut reader = quick_xml::Reader::from_str(xml);
    reader.config_mut().check_end_names = true;
    let (mut open, mut counts): (Vec<String>, _) = (vec!["".to_owned()], std::collections::BTreeMap::new());
    let inside = |open: &[String], name: &str| {
        let parent = open.last().unwrap();
        let known = JUNIT.iter().find(|(element, ..)| element == parent);
        let within = known.map_or(&["testsuites"][..], |(_, _, within)| *within);
        assert!(within.contains(&name), "`{name}` in `{parent}`: {xml}");
    };
    loop {
        let event = reader.read_event().unwrap_or_else(|error| panic!("{error}: {xml}"));
        let (tag, empty) = match &event {
            Event::Eof => break,
            Event::Start(tag) => (tag, false),
            Event::Empty(tag) => (tag, true),
            Event::End(_) => {
                open.pop();
                continue;
            }
            Event::Text(text) if text.trim().is_empty() => continue,
            Event::Text(_) | Event::GeneralRef(_) => {
                inside(&open, "#text");
                continue;
            }
            Event::Decl(_) => continue,
            other => panic!("{other:?}: {xml}"),
        };
        let name: String = AsRef::<str>::as_ref(&tag.name()).to_owned();
        inside(&open, &name);
        let (_, attributes, _) = JUNIT.iter().find(|(element, ..)| *element == name).unwrap();
        let mut found = Vec::new();
        for attribute in tag.attributes() {
            let attribute = attribute.unwrap_or_else(|error| panic!("{error}: {xml}"));
            let key: String = AsRef::<str>::as_ref(&attribute.key).to_owned();
            assert!(attributes.iter().any(|known| known.trim_end_matches('!') == key), "`{key}` of `{name}`: {xml}");
            found.push(key);
        }
        for required in attributes.iter().filter_map(|known| known.strip_suffix('!')) {
            assert!(found.iter().any(|key| key == required), "`{name}` without `{required}`: {xml}");
        }
        *counts.entry(name.clone()).or_default() += 1;
        if !empty {
            open.push(name);
        }
    }
    assert_eq!(open.len(), 1, "{xml}");
    counts
}

#[test]
fn reports_hold_hostile_names_as_text() {
    let bench = Bench::new();
    let expectation = |target: &str, more: &str| {
        format!("(version: 1, target: \"{target}\", width: 8, height: 8, sha256: \"{}\"{more})", "0".repeat(64))
    };
    bench.write("target.ron", scene()).write("target.expect.ron", expectation(&format!("{HOSTILE}none"), ""));
    bench.write("differs.ron", scene()).write("differs.expect.ron", expectation(HOSTILE, ""));
    bench.write("needs.ron", scene()).write("needs.expect.ron", expectation(HOSTILE, ", needs: [\"captured/a.dds\"]"));
    bench.write("field.ron", scene().replace("width: 8", &format!("width: 8, \"{HOSTILE}\": 1")));
    if cfg!(unix) {
        let name = "f\n::error::injected\r##[error]old\u{1b}[31m\u{202e}]]><script>|";
        bench.write(&format!("{name}.ron"), scene()).write(&format!("{name}.expect.ron"), expectation("none", ""));
    }
    bench.write("summary.md", "");
    let mut command = bench.command("replay . --report github,junit=j.xml,html=h.html,json=j.json --artifacts found");
    let run = Run::from_output(command.env("GITHUB_STEP_SUMMARY", bench.path("summary.md")).output().unwrap());
    assert_eq!(run.status, 3, "{}", run.stderr);
    harmless_run("replay", &run, "::error file=");
    let all = if cfg!(unix) { 5 } else { 4 };
    assert_eq!(String::from_utf8(run.stdout).unwrap().matches("\n::error file=").count(), all - 1);

    let read = |name: &str| fs::read_to_string(bench.path(name)).unwrap();
    let counts = valid(&read("j.xml"));
    let of = |name: &str| counts.get(name).copied().unwrap_or(0);
    assert_eq!((of("testcase"), of("failure"), of("error"), of("skipped")), (all, 1, all - 2, 1));

    let html = read("h.html");
    harmless("html", &html, "");
    // The page's own script, which its policy allows.
    assert!(html.matches("<script").count() == 1 && html.contains("&lt;script&gt;"));

    let summary = read("summary.md");
    harmless("summary", &summary.replace("### ninebit replay", ""), "");
    assert!(!summary.contains("](") && !summary.contains("<script") && !summary.contains("http://"), "{summary}");
    assert!(
        summary
            .lines()
            .filter(|line| line.starts_with("| "))
            .all(|line| line.replace("\\|", "").matches('|').count() == 4)
    );

    harmless("json", &read("j.json"), "");
    let json: serde_json::Value = serde_json::from_str(&read("j.json")).unwrap();
    let targets = json["scenes"].as_array().unwrap().iter().filter_map(|one| one["difference"]["target"].as_str());
    assert!(targets.clone().count() == 1 && targets.clone().all(|name| name.starts_with("n\n::error::injected\r")));
    harmless("artifact", &read("found/differs.txt"), "");
}

/// The schema check of this test notices an element in the wrong place.
#[test]
#[should_panic(expected = "`skipped` of `testsuites`")]
fn the_schema_refuses_what_it_does_not_know() {
    valid("<testsuites tests=\"0\" skipped=\"0\"></testsuites>");
}

#[cfg(unix)]
#[test]
fn a_file_name_that_is_no_text_stops_nothing() {
    use std::ffi::OsStr;
    use std::os::unix::ffi::OsStrExt;
    let bench = Bench::new();
    let scene = scene().replace(HOSTILE, "frame").replace("frame2", "spare");
    for name in [&b"\xff.ron"[..], b"\xfe.ron", b"plain.ron"] {
        fs::write(bench.path("").join(OsStr::from_bytes(name)), &scene).unwrap();
    }
    let blessed = Run::from_output(bench.command("replay . --bless").env_remove("CI").output().unwrap());
    assert_eq!((blessed.status, blessed.stderr.as_str()), (0, ""));
    assert!(bench.path("").join(OsStr::from_bytes(b"\xff.expect.ron")).exists());
    let text = bench.run("replay . --pictures drawn --report junit=j.xml").text();
    assert_eq!(text, "3 scenes: 3 as expected\n");
    assert_eq!(valid(&fs::read_to_string(bench.path("j.xml")).unwrap())["testcase"], 3);
    assert!(bench.path(r"drawn/\xff.png").exists() && bench.path(r"drawn/\xfe.png").exists());
    fs::remove_file(bench.path("").join(OsStr::from_bytes(b"\xff.ron"))).unwrap();
    let run = bench.run("replay .");
    let text = String::from_utf8(run.stdout).unwrap();
    assert!(run.status == 4 && text.contains(r"`./\xff.expect.ron` has no scene beside it"), "{text}");
    assert!(text.ends_with("3 scenes: 2 as expected, 1 failed\n"), "{text}");
}
