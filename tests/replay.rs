//! Tests `ninebit replay` from outside, and checks what must not change its results.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use crate::bench;

use std::fs;
use std::path::Path;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use ninebit::engine::{RenderOptions, render};
use ninebit::expectation::{Allowance, Expectation};
use ninebit::limits::Limits;
use ninebit::replay::{Options, Outcome, find, replay, report};
use ninebit::shard::Shard;
use ninebit::state::Policies;
use ninebit_files::output::{Compression, encode_png};
use ninebit_scene as scene;
use ninebit_scene::image::{ImageLimits, load};
use sha2::{Digest, Sha256};
use snapbox::{assert_data_eq, file};

use bench::{Bench, Run};

/// Returns a scene of a triangle lit by a dot product, 3 * 100 * `light` / 255 in red, green and blue.
fn lit(light: u8) -> String {
    format!(
        r#"(version: 1, profile: Nv10, targets: [(name: "frame", width: 24, height: 16), (name: "other", width: 4, height: 4)],
draws: [(
    vertices: Window([(position: (2, 2)), (position: (22, 2)), (position: (2, 14))]),
    program: CombinerText(r"
        const0 = bytes(100, 100, 100, 255);
        const1 = bytes({light}, {light}, {light}, 255);
        {{ rgb {{ spare0 = const0 . const1; }} }}
        out.rgb = spare0;
        out.a = unsigned_invert(zero);
    "),
)])"#
    )
}

/// Draws a scene under some policies. Returns its expectation and its picture as PNG.
fn drawn(bench: &Bench, name: &str, policies: &[&str]) -> (Expectation, Vec<u8>) {
    let loaded = scene::load(&bench.path(name), &Limits::default()).unwrap_or_else(|e| panic!("{}", e.render(false)));
    let mut chosen = Policies::DEFAULT;
    policies.iter().for_each(|policy| chosen.set(policy).unwrap());
    let surface = render(&loaded.plan.under(chosen), &RenderOptions::default()).surfaces.swap_remove(0);
    let png = encode_png(surface.width, surface.height, &surface.rgba8(), Compression::Small).unwrap();
    (Expectation::from_surface("frame", &surface), png)
}

/// Returns a folder with three scenes: `a/one` is as expected, `a/two` was drawn under a policy, and `b` has only a digest, of something
/// else.
fn three() -> Bench {
    let bench = Bench::new();
    fs::create_dir(bench.path("a")).unwrap();
    bench.write("a/one.ron", lit(40)).write("a/two.ron", lit(42)).write("b.ron", lit(41));
    let (one, _) = drawn(&bench, "a/one.ron", &[]);
    let (two, _) = drawn(&bench, "a/two.ron", &["CMB-8=each"]);
    assert_ne!(two, drawn(&bench, "a/two.ron", &[]).0, "the scene must tell the policies apart");
    bench.write("a/one.expect.ron", one.to_text()).write("a/two.expect.ron", two.to_text());
    bench.write("b.expect.ron", Expectation { sha256: "0".repeat(64), ..one }.to_text());
    bench
}

/// Checks the status and that stderr is empty. Returns stdout.
fn said(run: Run, status: i32) -> String {
    assert_eq!((run.status, run.stderr.as_str()), (status, ""));
    String::from_utf8(run.stdout).unwrap()
}

#[test]
fn help_is_as_pinned() {
    assert_data_eq!(Bench::new().run("replay --help").text(), file!["cli/help-replay.txt"]);
}

#[test]
fn differences_are_told_and_explained() {
    let bench = three();
    let text = said(bench.run("replay . --artifacts found --report json=r.json"), 1);
    let lines: Vec<&str> = text.lines().collect();
    let [two, b, sum] = lines[..] else { panic!("{text}") };
    assert!(two.starts_with("differs  ./a/two.ron: ") && two.ends_with("; CMB-8=each draws what is expected"), "{two}");
    assert!(two.contains(" of 384 pixels (") && two.contains("by 1 at most; first 2,2: R 4"), "{two}");
    assert!(b.starts_with("differs  ./b.ron: digest 000000000000 expected, "), "{b}");
    assert_eq!(sum, "3 scenes: 1 as expected, 2 different");

    let picture = |name: &str| load(&bench.path(name), &ImageLimits::default()).unwrap();
    let panels = picture("found/a/two.difference.png");
    assert_eq!((panels.width(), panels.height()), (3 * 24 + 16, 16));
    assert_eq!((picture("found/a/two.drawn.png").width(), picture("found/b.drawn.png").width()), (24, 24));
    assert!(!bench.path("found/b.difference.png").exists() && !bench.path("found/a/one.txt").exists());
    let explained = fs::read_to_string(bench.path("found/a/two.txt")).unwrap();
    for part in ["  > stage0.rgb.AB.r", "CMB-8", "drawn less expected", "largest", "as expected, and as it is drawn"] {
        assert!(explained.contains(part), "{part}: {explained}");
    }
    assert!(fs::read_to_string(bench.path("found/b.txt")).unwrap().contains("Only the digest"));

    let json: serde_json::Value = serde_json::from_slice(&fs::read(bench.path("r.json")).unwrap()).unwrap();
    assert_eq!((&json["summary"]["scenes"], &json["summary"]["differs"]), (&3.into(), &2.into()));
    let difference = &json["scenes"][1]["difference"];
    assert_eq!(difference["cause"]["policy"], "CMB-8");
    let pixels = &difference["pixels"];
    assert_eq!(pixels["trace"]["shown"], pixels["first"]["drawn"]);
    assert_eq!(pixels["expected_trace"]["shown"], pixels["first"]["expected"]);
    assert_eq!(json["scenes"][2]["difference"]["pixels"], serde_json::Value::Null);
}

#[test]
fn a_policy_can_be_held_against_the_expectations() {
    let bench = three();
    let text = said(bench.run("replay a --policy CMB-8=each"), 1);
    assert!(text.contains("differs  a/one.ron") && text.contains("CMB-8=once draws what is expected"), "{text}");
    assert!(!text.contains("a/two.ron"), "{text}");
}

#[test]
fn pictures_of_an_earlier_run_show_where() {
    let bench = three();
    let (expected, png) = drawn(&bench, "a/one.ron", &[]);
    fs::create_dir(bench.path("earlier")).unwrap();
    bench.write("b.expect.ron", expected.to_text()).write("earlier/b.png", png);
    let text = said(bench.run("replay b.ron --expected earlier"), 1);
    assert!(text.contains("by 1 at most") && text.contains("no single policy explains it"), "{text}");
    // Pictures that `--pictures` writes can be read by `--expected`.
    said(bench.run("replay . --pictures written"), 1);
    assert_eq!(said(bench.run("replay a/one.ron --expected written"), 0), "1 scene: 1 as expected\n");
    // A picture that does not match the digest is not used as evidence.
    let text = said(bench.run("replay b.ron --expected written --artifacts found"), 1);
    assert!(text.contains("digest "), "{text}");
    let remark = "written/b.png is another picture than the expected one";
    assert!(fs::read_to_string(bench.path("found/b.txt")).unwrap().contains(remark));
    // The expectation itself may name a picture.
    let named = Expectation { picture: Some("earlier/b.png".to_owned()), ..expected };
    bench.write("b.expect.ron", named.to_text());
    assert!(said(bench.run("replay b.ron"), 1).contains("by 1 at most"));
}

#[test]
fn results_do_not_depend_on_threads_order_or_shards() {
    let bench = three();
    for n in 0..8 {
        bench.write(&format!("a/more{n}.ron"), lit(n));
    }
    let report = |arguments: &str| {
        let run = bench.run(&format!("replay {arguments} --report json=-"));
        assert_eq!(run.stderr, "");
        serde_json::from_slice::<serde_json::Value>(&run.stdout).unwrap()["scenes"].as_array().unwrap().clone()
    };
    let whole = report("a b.ron");
    assert_eq!(whole.len(), 11);
    for arguments in ["b.ron a", "a b.ron --threads 1", "b.ron a --threads 3 --engine scalar", "a a/one.ron b.ron a"] {
        assert!(report(arguments) == whole, "{arguments}");
    }
    for count in [2, 3, 16] {
        let mut joined: Vec<_> = (1..=count).flat_map(|n| report(&format!("a b.ron --shard {n}/{count}"))).collect();
        joined.sort_by_key(|scene| scene["name"].as_str().unwrap().to_owned());
        assert!(joined == whole, "{count} shards");
    }
    assert!(Shard::new(2, 1).is_none());
}

#[test]
fn expectations_are_written_on_request_only() {
    let bench = Bench::new();
    bench.write("scene.ron", lit(40));
    let text = said(bench.run("replay scene.ron"), 4);
    assert!(
        text.contains("missing  scene.ron\n    error[NB1202]") && !bench.path("scene.expect.ron").exists(),
        "{text}"
    );
    let mut command = bench.command("replay . --bless");
    Run::from_output(command.env("CI", "true").output().unwrap()).failed(2, "CI is set");
    assert!(!bench.path("scene.expect.ron").exists());
    let bless = |arguments: &str| {
        let mut command = bench.command(arguments);
        Run::from_output(command.env("CI", "false").output().unwrap())
    };
    bless("replay . --bless --policy CMB-8=each").failed(2, "default policies");
    let (expected, png) = drawn(&bench, "scene.ron", &[]);
    assert!(said(bless("replay . --bless"), 0).contains("none before"));
    assert_eq!(fs::read_to_string(bench.path("scene.expect.ron")).unwrap(), expected.to_text());
    assert_eq!(said(bless("replay . --bless"), 0), "1 scene: 1 as expected\n");

    // Other fields of an expectation are kept. The picture that it names is drawn again.
    let (other, mask) = (drawn(&bench, "scene.ron", &["CMB-8=each"]).0, vec![[255; 4]; 24 * 16]);
    bench.write("mask.png", encode_png(24, 16, &mask, Compression::Small).unwrap());
    let kept =
        Expectation { mask: Some("mask.png".into()), pixels: Some(384), picture: Some("p.png".into()), ..expected };
    bench.write("scene.expect.ron", Expectation { sha256: "1".repeat(64), ..kept.clone() }.to_text());
    assert!(said(bless("replay . --bless"), 0).contains("111111111111 before"));
    assert_eq!(fs::read_to_string(bench.path("scene.expect.ron")).unwrap(), kept.to_text());
    let pixels = |png: &[u8]| {
        bench.write("compared.png", png);
        load(&bench.path("compared.png"), &ImageLimits::default()).unwrap()
    };
    assert!(pixels(&fs::read(bench.path("p.png")).unwrap()) == pixels(&png));

    // A picture must not lie outside the folder. If it does, nothing is written.
    let outside = Expectation { picture: Some("../p.png".into()), sha256: "1".repeat(64), ..kept.clone() }.to_text();
    bench.write("scene.expect.ron", &outside);
    assert!(said(bless("replay . --bless"), 3).contains("NB0501"));
    assert_eq!(fs::read_to_string(bench.path("scene.expect.ron")).unwrap(), outside);

    // Pictures that were captured elsewhere are not overwritten.
    let allowance = Allowance { picture: "p.png".into(), pixels: 0, difference: 0, reason: "a test".into() };
    let zero = Expectation { sha256: "2".repeat(64), ..other };
    bench.write("p.png", encode_png(24, 16, &mask, Compression::Small).unwrap());
    for foreign in [
        Expectation { capture: Some("a capture".into()), ..zero.clone() },
        Expectation { allowance: Some(allowance), ..zero },
    ] {
        bench.write("scene.expect.ron", foreign.to_text());
        said(bless("replay . --bless"), 1);
        assert_eq!(fs::read_to_string(bench.path("scene.expect.ron")).unwrap(), foreign.to_text());
    }
}

#[test]
fn what_is_missing_or_broken_stops_nothing_else() {
    let bench = three();
    bench.write("broken.ron", "(version: 1, profile: Nv11)").write("orphan.expect.ron", "()");
    bench.write("c.ron", lit(1)).write("c.expect.ron", "(version: 1, colour: 2)");
    let (one, _) = drawn(&bench, "a/one.ron", &[]);
    bench
        .write("d.ron", lit(1))
        .write("d.expect.ron", Expectation { target: "elsewhere".into(), ..one.clone() }.to_text());
    bench
        .write("e.ron", lit(1))
        .write("e.expect.ron", Expectation { mask: Some("none.png".into()), ..one.clone() }.to_text());
    let needs = Expectation { needs: vec!["captured/x.dds".into()], ..one.clone() };
    bench.write("f.ron", "nobody reads this").write("f.expect.ron", needs.to_text());
    bench.write("g.ron", lit(1)).write("g.expect.ron", Expectation { width: 7, ..one }.to_text());
    #[cfg(unix)]
    std::os::unix::fs::symlink(bench.path("."), bench.path("a/round")).unwrap();
    let text = said(bench.run("replay . --report junit=j.xml"), 4);
    for part in [
        "failed   ./broken.ron",
        "NB1203",
        "NB1205",
        "has no target `elsewhere`",
        "its targets: `frame`, `other`",
        "NB0502",
        "skipped  ./f.ron: needs `captured/x.dds`, which is not here",
        "differs  ./g.ron: the picture is 24 x 16",
        "differs  ./a/two.ron",
    ] {
        assert!(text.contains(part), "{part}: {text}");
    }
    assert!(!cfg!(unix) || text.contains("NB1204") && text.contains("leads back"), "{text}");
    assert!(text.contains(": 1 as expected, 3 different, "), "{text}");
    assert_eq!(
        said(bench.run("replay . --filter f"), 0),
        "skipped  ./f.ron: needs `captured/x.dds`, which is not here\n1 scene: 0 as expected, 1 skipped\n"
    );
    assert!(said(bench.run("replay c.ron"), 3).contains("failed   c.ron"));
    said(bench.run("replay nowhere"), 4);
    bench.run("replay . --filter nothing").failed(4, "NB1201");
    fs::create_dir(bench.path("empty")).unwrap();
    bench.run("replay empty").failed(4, "there are no scenes here");
}

#[test]
fn what_cannot_be_written_is_said_and_the_rest_is_written() {
    let bench = three();
    bench.write("file", "");
    let run = bench.run("replay . --artifacts file/below --report junit=no/such/folder.xml,json=r.json");
    assert_eq!(run.status, 7);
    assert!(run.stderr.contains("NB0702") && run.stderr.contains("no/such"), "{}", run.stderr);
    let text = String::from_utf8(run.stdout).unwrap();
    assert!(
        text.contains("NB0702 `file/below/a` cannot be written")
            && text.contains("3 scenes: 1 as expected, 2 different"),
        "{text}"
    );
    let json: serde_json::Value = serde_json::from_slice(&fs::read(bench.path("r.json")).unwrap()).unwrap();
    assert_eq!(json["scenes"][1]["unwritten"][0]["exit"], 7);
    assert_eq!(fs::read(bench.path("file")).unwrap(), b"");
}

#[test]
fn wrong_command_lines_are_refused() {
    let bench = three();
    bench.run("replay").failed(2, "<DIR|SCENE>...");
    for shard in ["0/2", "3/2", "1", "1/0", "a/b"] {
        bench.run(&format!("replay . --shard {shard}")).failed(2, "I from 1 to N");
    }
    for report in ["xml=x", "json", "json=", "github=x"] {
        bench.run(&format!("replay . --report {report}")).failed(2, "not one of json=FILE");
    }
    bench.run("replay . --report json=-,junit=-").failed(2, "cannot all go to stdout");
    bench.run("replay . --filter a[").failed(2, "is not a pattern");
    bench.run("replay . --profile Nv30").failed(2, "Nv10");
    // Two files would have the same name, because leading `..` parts are not part of a name.
    fs::create_dir_all(bench.path("b/a")).unwrap();
    bench.write("b/a/one.ron", "");
    let mut command = bench.command("replay a/one.ron ../a/one.ron");
    Run::from_output(command.current_dir(bench.path("b")).output().unwrap()).failed(2, "would both be called");
}

#[test]
fn profiles_select() {
    let bench = three();
    let text = said(bench.run("replay . --profile Nv2a"), 0);
    assert!(text.contains("is a scene of Nv10, not Nv2a") && text.contains("3 skipped"), "{text}");
    assert!(said(bench.run("replay . --profile Nv10"), 1).contains("2 different"));
}

#[test]
fn services_and_browsers_read_the_reports() {
    let bench = three();
    bench.write("a/three <&\">.ron", "(version: 1,\n profile: Nv11)");
    said(bench.run("replay . --report junit=j.xml,html=h.html"), 3);
    let xml = fs::read_to_string(bench.path("j.xml")).unwrap();
    let mut reader = quick_xml::Reader::from_str(&xml);
    let (mut cases, mut failures, mut errors) = (0, 0, 0);
    loop {
        match reader.read_event().unwrap_or_else(|error| panic!("{error}: {xml}")) {
            quick_xml::events::Event::Eof => break,
            quick_xml::events::Event::Start(tag) | quick_xml::events::Event::Empty(tag) => {
                assert!(tag.attributes().all(|attribute| attribute.is_ok()), "{xml}");
                match tag.name().as_ref() {
                    "testcase" => cases += 1,
                    "failure" => failures += 1,
                    "error" => errors += 1,
                    _ => {}
                }
            }
            _ => {}
        }
    }
    assert_eq!((cases, failures, errors), (4, 2, 1));
    assert!(xml.contains(r#"<testcase classname="a" name="one" file="./a/one.ron"/>"#), "{xml}");

    // A failure has the trace from where it parts on.
    let failure = xml.split_once("<failure").unwrap().1.split_once("</failure>").unwrap().0;
    assert!(failure.contains("  &gt; stage0.rgb.AB.r") && failure.contains(" lines before, which"), "{failure}");
    assert!(!failure.contains("rasteriser") && failure.len() < 8000, "{failure}");

    let html = fs::read_to_string(bench.path("h.html")).unwrap();
    assert_eq!(html.matches("src=\"data:image/png;base64,").count(), 2, "panels of one, the picture of the other");
    let columns = "minmax(0, 24fr) minmax(0, 8fr) minmax(0, 24fr) minmax(0, 8fr) minmax(0, 24fr)";
    assert!(html.contains(columns), "each title is as wide as its panel");
    // Its own script is all that runs: the policy names it by its hash.
    assert_eq!(html.matches("src=").count() + html.matches("<link").count(), 2);
    assert_eq!((html.matches("<script>").count(), html.matches(" style=").count()), (1, 0));
    for (source, end) in [("<script>", "</script>"), ("<style>", "</style>")] {
        let text = html.split_once(source).unwrap().1.split_once(end).unwrap().0;
        let hash = STANDARD.encode(Sha256::digest(text));
        let kind = source.trim_matches(['<', '>']);
        assert!(html.contains(&format!("{kind}-src 'sha256-{hash}'")), "{kind} {hash}");
    }
    assert!(html.contains("three &lt;&amp;&quot;&gt;"));
    assert_eq!(html.matches("CMB-8=each draws what is expected").count(), 1, "what is said of a scene is said once");
}

#[test]
fn github_shows_annotations() {
    let bench = three();
    bench.write("a/three, a%.ron", "(version: 1,\n profile: Nv11)");
    let mut command = bench.command("replay . --report github");
    bench.write("summary.md", "before\n");
    let run = Run::from_output(command.env("GITHUB_STEP_SUMMARY", bench.path("summary.md")).output().unwrap());
    let text = said(run, 3);
    assert!(
        text.contains("::error file=./a/three%2C a%25.ron,line=2,col=11,title=a/three%2C a%25 failed::NB"),
        "{text}"
    );
    assert_eq!(text.matches("::error ").count(), 3);
    let summary = fs::read_to_string(bench.path("summary.md")).unwrap();
    assert!(
        summary.starts_with("before\n### ninebit replay\n\n4 scenes: ") && summary.contains("| a/two | differs | "),
        "{summary}"
    );
    for n in 0..9 {
        bench.write(&format!("more{n}.ron"), "(");
    }
    let text = said(bench.run("replay . --report github"), 3);
    assert!(text.matches("::error ").count() == 10 && text.contains("3 more scenes are not as expected"), "{text}");
}

/// If there are differences, the library reports the same as the program.
#[test]
fn the_library_says_the_same() {
    let bench = three();
    let entries = find(&[bench.path(".")]).unwrap();
    let replayed = replay(&entries, &Options::default(), &|_| {});
    let Outcome::Differs(difference) = &replayed[1].outcome else { panic!("{:?}", replayed[1]) };
    assert!(difference.picture.starts_with(b"\x89PNG") && Path::new(&replayed[1].path).ends_with("a/two.ron"));
    assert!(report::text(&replayed).ends_with("3 scenes: 1 as expected, 2 different\n"));
}
