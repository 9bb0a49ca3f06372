//! Tests which files the program writes, where, and which ones it does not touch.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use crate::repository::at;
use std::fs;
use std::io::Write;
use std::path::Path;
use std::process::Stdio;

use ninebit_files::output::{Compression, encode_png};

use crate::bench::{Bench, Run, SCENE};

/// Returns a folder with the scene and its texture.
fn bench() -> Bench {
    let bench = Bench::new();
    bench.write("a.ron", SCENE).write("stone.png", picture([200, 100, 50, 255]));
    bench
}

fn picture(color: [u8; 4]) -> Vec<u8> {
    encode_png(8, 8, &[color; 64], Compression::Small).unwrap()
}

/// Returns the paths of the files in a folder and below.
fn files(folder: &Path) -> Vec<String> {
    let mut names = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let entry = entry.unwrap();
        let name = entry.file_name().to_string_lossy().into_owned();
        if entry.file_type().unwrap().is_dir() {
            names.extend(files(&entry.path()).into_iter().map(|below| format!("{name}/{below}")));
        } else {
            names.push(name);
        }
    }
    names.sort();
    names
}

#[test]
fn several_files_do_not_go_to_standard_output() {
    let bench = bench();
    for arguments in [
        "lower --generic --to c99 -o -",
        "gallery a.ron -o -",
        "vectors export --unit product -o -",
        "vectors sweep --unit product -o -",
    ] {
        bench
            .run(arguments)
            .failed(7, "error[NB0702]: `-` cannot be written: several files do not go to standard output");
        assert_eq!(files(&bench.path("")), ["a.ron", "stone.png"], "{arguments}");
    }
}

#[test]
fn no_output_takes_the_place_of_an_input() {
    let bench = bench();
    bench.write("other.png", picture([1, 2, 3, 4])).write("in.tsv", "tex0.r\n1\n");
    let mut names = vec!["stone.png", "./stone.png"];
    if cfg!(unix) {
        #[cfg(unix)]
        std::os::unix::fs::symlink("stone.png", bench.path("link.png")).unwrap();
        names.push("link.png");
    }
    let before = fs::read(bench.path("stone.png")).unwrap();
    for name in names {
        for command in [
            format!("render a.ron -o {name}"),
            format!("compare a.ron --heatmap {name}"),
            format!("diff other.png stone.png -o {name}"),
            format!("diff other.png other.png --scene a.ron -o {name}"),
            format!("texture a.ron:stone --decode -o {name}"),
            format!("generate normal-map stone.png -o {name}"),
            format!("generate half-component stone.png --axis x -o {name}"),
            format!("generate occlusion other.png --normal-map stone.png -o {name}"),
        ] {
            let run = bench.run(&command);
            assert_eq!((run.status, run.stdout.len()), (2, 0), "{command}: {}", run.stderr);
            assert!(run.stderr.contains("error[NB0705]") && run.stderr.contains("is the input"), "{}", run.stderr);
        }
        assert_eq!(fs::read(bench.path("stone.png")).unwrap(), before, "{name}");
    }
    for (command, input) in [
        ("render a.ron -o a.ron", "a.ron"),
        ("op combiner --inputs in.tsv -o in.tsv", "in.tsv"),
        ("replay a.ron --report json=a.ron", "a.ron"),
        ("replay . --report json=r.json,html=a.ron", "a.ron"),
    ] {
        let before = fs::read(bench.path(input)).unwrap();
        bench.run(command).failed(2, "error[NB0705]");
        assert_eq!(fs::read(bench.path(input)).unwrap(), before, "{command}");
    }
    assert!(!bench.path("r.json").exists());
    // These outputs are no inputs, although the second run finds the file of the first.
    bench.run("render a.ron -o frame.png").data();
    bench.run("render a.ron -o frame.png").data();
    bench.run("render a.ron -o /dev/null").data();
}

#[test]
fn reports_and_pictures_of_a_replay_have_places_of_their_own() {
    let bench = bench();
    let blessed = Run::from_output(bench.command("replay a.ron --bless").env_remove("CI").output().unwrap());
    assert_eq!(blessed.status, 0, "{}", blessed.stderr);
    for reports in ["json=r,junit=r", "json=r,junit=./r,html=r", "json=r.json,html=a.expect.ron"] {
        let run = bench.run(&format!("replay a.ron --report {reports}"));
        assert!(run.status == 2 && run.stderr.contains("error[NB070"), "{reports}: {}", run.stderr);
        assert!(!bench.path("r").exists() && !bench.path("r.json").exists(), "nothing was written");
    }
    // The texture has the name that the picture of its scene would get.
    fs::rename(bench.path("stone.png"), bench.path("a.png")).unwrap();
    bench.write("a.ron", SCENE.replace("stone.png", "a.png"));
    let before = fs::read(bench.path("a.png")).unwrap();
    let run = bench.run("replay a.ron --pictures .");
    let text = String::from_utf8(run.stdout).unwrap();
    assert!(run.status == 7 && text.contains("is the input"), "{text}");
    let expectation = fs::read_to_string(bench.path("a.expect.ron")).unwrap();
    let digest = expectation.split("sha256: \"").nth(1).unwrap().split('"').next().unwrap();
    let other = expectation.replace(digest, &"0".repeat(64)).replace("version: 1,", "version: 1, picture: \"a.png\",");
    bench.write("a.expect.ron", other);
    let run = Run::from_output(bench.command("replay a.ron --bless").env_remove("CI").output().unwrap());
    let text = String::from_utf8(run.stdout).unwrap();
    assert!(run.status == 7 && text.contains("NB0705"), "{text}");
    assert_eq!(fs::read(bench.path("a.png")).unwrap(), before);
}

#[test]
fn a_tree_does_not_take_the_place_of_a_leaf() {
    let bench = Bench::new();
    bench.run("vectors sweep --unit input-mapping -o leaves --threads 1").text();
    let leaves = files(&bench.path("leaves"));
    let leaf = format!("leaves/{}", leaves[0]);
    let before = fs::read(bench.path(&leaf)).unwrap();
    bench.run(&format!("vectors merge leaves -o {leaf}")).failed(2, "error[NB0705]");
    assert_eq!(fs::read(bench.path(&leaf)).unwrap(), before);
    bench.run("vectors merge leaves -o tree.json").text();
}

/// Exports a small pack to `pack`.
fn export(bench: &Bench) {
    bench.run("vectors export -o pack --unit input-mapping").text();
}

#[test]
fn what_a_killed_run_left_harms_nobody() {
    let bench = Bench::new();
    export(&bench);
    for name in ["pack/units/.ninebit-a1B2c3.part", "pack/schema/.ninebit-x.part", "pack/.ninebit-y.part"] {
        bench.write(name, "half a file");
    }
    assert!(bench.run("vectors check pack").text().contains("all as the model has them"));
    bench.write("pack/units/other.part", "");
    bench.run("vectors check pack").failed(3, "NB1012");
    fs::remove_file(bench.path("pack/units/other.part")).unwrap();
    export(&bench);
    assert!(files(&bench.path("pack")).iter().all(|name| !name.ends_with(".part")), "{:?}", files(&bench.path("pack")));
}

/// Starts an export over the pack of [`export`], and waits until it writes beside it.
#[cfg(target_os = "linux")]
fn begun_export(bench: &Bench) -> std::process::Child {
    use std::time::{Duration, Instant};
    let before = parts(bench);
    let mut command = bench.command("vectors export -o pack --level L1");
    let mut child = command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
    let start = Instant::now();
    while parts(bench).iter().all(|name| before.contains(name)) {
        assert!(start.elapsed() < Duration::from_secs(60) && child.try_wait().unwrap().is_none(), "it began nothing");
        std::thread::sleep(Duration::from_millis(2));
    }
    child
}

/// Returns the names of temporary files and folders beside the pack.
#[cfg(target_os = "linux")]
fn parts(bench: &Bench) -> Vec<String> {
    let names = fs::read_dir(bench.path("")).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap());
    names.filter(|name| name.ends_with(".part")).collect()
}

#[cfg(target_os = "linux")]
#[test]
fn an_export_that_is_killed_leaves_the_old_pack_whole() {
    let bench = bench();
    export(&bench);
    bench.write("pack/notes.txt", "mine").write("pack/units/notes.txt", "mine");
    let before = files(&bench.path("pack"));
    for _ in 0..3 {
        let mut child = begun_export(&bench);
        std::thread::sleep(std::time::Duration::from_millis(30));
        child.kill().unwrap();
        child.wait().unwrap();
        assert_eq!(files(&bench.path("pack")), before);
    }
    fs::remove_file(bench.path("pack/units/notes.txt")).unwrap();
    assert!(bench.run("vectors check pack").text().contains("all as the model has them"));
    // An export that is not killed takes its place, and leaves alone what is no file of a pack.
    bench.run("vectors export -o pack --unit sum").text();
    assert!(bench.run("vectors check pack").text().contains("all as the model has them"));
    let after = files(&bench.path("pack"));
    assert!(after.contains(&"notes.txt".to_owned()) && after.contains(&"units/sum.tsv".to_owned()), "{after:?}");
    assert!(!after.contains(&"units/input-mapping.tsv".to_owned()), "{after:?}");
    assert_eq!(parts(&bench), [""; 0], "the next export has cleared what the killed ones left");
}

#[cfg(target_os = "linux")]
#[test]
fn the_next_writer_clears_what_a_killed_one_left_and_nothing_else() {
    let bench = bench();
    export(&bench);
    let mut child = begun_export(&bench);
    let begun = parts(&bench);
    bench.write(".ninebit-of-another-machine.part", "half a file");
    // While it lives, what it writes is its own.
    let stopped = std::process::Command::new("kill").args(["-STOP", &child.id().to_string()]).status();
    assert!(stopped.unwrap().success());
    bench.run("render a.ron -o frame.png").data();
    assert!(begun.iter().all(|name| bench.path(name).exists()), "{begun:?}");
    child.kill().unwrap();
    child.wait().unwrap();
    bench.run("render a.ron -o frame.png").data();
    assert_eq!(parts(&bench), [".ninebit-of-another-machine.part"]);
    // Of that one only its age tells.
    let week = std::time::SystemTime::now() - std::time::Duration::from_secs(7 * 24 * 3600);
    let file = fs::File::options().write(true).open(bench.path(".ninebit-of-another-machine.part")).unwrap();
    file.set_times(fs::FileTimes::new().set_modified(week)).unwrap();
    bench.run("render a.ron -o frame.png").data();
    assert_eq!(parts(&bench), [""; 0]);
}

#[cfg(unix)]
#[test]
fn a_run_that_is_told_to_end_leaves_no_temporary_file() {
    use std::os::unix::process::ExitStatusExt;
    use std::time::{Duration, Instant};
    // The program keeps ignoring signals that are already ignored, for example under `nohup`, so these are skipped.
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let ignored = mask.map_or(0, |mask| u64::from_str_radix(mask.trim(), 16).unwrap());
    for (signal, number) in [("TERM", 15), ("INT", 2), ("HUP", 1)] {
        if ignored >> (number - 1) & 1 == 1 {
            continue;
        }
        let bench = Bench::new();
        let mut command = bench.command("vectors export -o pack --level L1");
        let mut child = command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
        let begun = || {
            let entries = fs::read_dir(bench.path("pack/units")).into_iter().flatten().flatten();
            entries.into_iter().any(|entry| entry.file_name().to_string_lossy().starts_with(".ninebit-"))
        };
        let start = Instant::now();
        while !begun() {
            assert!(
                start.elapsed() < Duration::from_secs(60) && child.try_wait().unwrap().is_none(),
                "it began no file"
            );
            std::thread::sleep(Duration::from_millis(2));
        }
        let kill = std::process::Command::new("kill").args([format!("-{signal}"), child.id().to_string()]).status();
        assert!(kill.unwrap().success());
        assert_eq!(child.wait().unwrap().signal(), Some(number), "it ends as programs end of {signal}");
        let left: Vec<String> = files(&bench.path("pack")).into_iter().filter(|name| name.ends_with(".part")).collect();
        assert_eq!(left, Vec::<String>::new(), "{signal}");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_signal_that_the_caller_ignores_stays_ignored() {
    let bench = Bench::new();
    let program = env!("CARGO_BIN_EXE_ninebit");
    let script = format!("trap '' HUP; '{program}' vectors export -o pack & sleep 0.05; kill -HUP $!; wait $!");
    let mut command = std::process::Command::new("sh");
    let run = Run::from_output(command.args(["-c", &script]).current_dir(bench.path("")).output().unwrap());
    assert_eq!((run.status, run.stderr.as_str()), (0, ""));
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_said_by_help_as_well() {
    let bench = Bench::new();
    for command in ["--help", "--version", "help render", "render --help", "limits", "check a.ron"] {
        bench.write("a.ron", "(version: 1, profile: Nv10)");
        let full = fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
        let run = Run::from_output(bench.command(command).stdout(full).output().unwrap());
        assert!(run.status == 7 && run.stderr.contains("error[NB0703]"), "{command}: {} {}", run.status, run.stderr);
    }
}

#[test]
fn help_that_nobody_reads_is_no_failure() {
    Bench::new().unread("--help");
}

#[test]
fn tables_come_through_pipes() {
    let bench = Bench::new();
    let table = "tex0.r\ttex0.g\ttex0.b\n10\t20\t0\n-256\t255\t1\n";
    bench.write("in.tsv", table);
    let command = "op combiner --a tex0 --b zero:invert --inputs";
    let expected = bench.run(&format!("{command} in.tsv")).data();
    let mut names = vec!["-"];
    if cfg!(unix) {
        names.push("/dev/stdin");
    }
    for name in names {
        let mut child = bench.command(&format!("{command} {name}"));
        let mut child = child.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        child.stdin.take().unwrap().write_all(table.as_bytes()).unwrap();
        assert_eq!(Run::from_output(child.wait_with_output().unwrap()).data(), expected, "{name}");
    }
}

#[test]
fn a_name_that_promises_another_format_is_refused() {
    let bench = bench();
    for command in [
        "render a.ron -o x.jpg",
        "compare a.ron --heatmap x.jpeg",
        "diff stone.png stone.png -o x.webp",
        "texture a.ron:stone --decode -o x.tga",
        "measure a.ron --picture x.bmp",
        "generate height-noise -o x.gif",
        "generate normal-map stone.png -o x.dds",
    ] {
        bench.run(command).failed(2, "this command writes PNG: write to `x.png` and convert that");
    }
    bench.run("generate normalisation-cube -o x.png").failed(2, "this command writes DDS: write to `x.dds`");
    assert_eq!(files(&bench.path("")), ["a.ron", "stone.png"]);
}

#[test]
fn json_is_one_option_and_its_old_names_still_work() {
    let bench = bench();
    let json = |command: &str| -> serde_json::Value { serde_json::from_str(&bench.run(command).text()).unwrap() };
    assert_eq!(json("compare a.ron --format json"), json("compare a.ron --json"));
    let formats = |command: &str| json(command)["format"].clone();
    assert_eq!(formats("bench a.ron --frames 1 --format json"), formats("bench a.ron --frames 1 --json"));
    assert_eq!(formats("render a.ron -o f.png --format json"), formats("render a.ron -o f.png --stats json"));
    for command in ["render", "compare", "bench"] {
        let help = bench.run(&format!("{command} --help")).text();
        assert!(help.contains("--format <FORMAT>") && !help.contains("--json") && !help.contains("--stats"), "{help}");
    }
}

#[test]
fn threads_are_counted() {
    let bench = bench();
    let text = bench.run("bench a.ron --frames 1").text();
    assert!(!text.contains(" 0 thread"), "{text}");
    assert!(bench.run("bench a.ron --frames 1 --threads 3").text().contains(", 3 threads."));
    let json: serde_json::Value =
        serde_json::from_str(&bench.run("bench a.ron --frames 1 --format json").text()).unwrap();
    assert!(json["threads"].as_u64().unwrap() > 0);
}

#[test]
fn one_bad_scene_does_not_keep_the_others_from_being_measured() {
    let bench = bench();
    bench.write("bad.ron", "(version: 2)");
    let run = bench.run("bench a.ron bad.ron a.ron --frames 1 --format json");
    let json: serde_json::Value = serde_json::from_slice(&run.stdout).unwrap();
    assert_eq!((run.status, json["scenes"].as_array().unwrap().len()), (3, 2));
    assert_eq!((&json["failed"][0]["scene"], &json["failed"][0]["exit"]), (&"bad.ron".into(), &3.into()));
    assert!(run.stderr.contains("bad.ron:1:"), "{}", run.stderr);
}

#[test]
fn charts_keep_what_is_under_version_control() {
    let bench = Bench::new();
    fs::create_dir_all(bench.path("techniques/flat")).unwrap();
    bench.write(
        "techniques/flat/tone.ron",
        "(version: 1, profile: Nv10, targets: [(width: 16, height: 16)], truth: (hemisphere: (sky: (51, 51, 51), ground: (51, 51, 51))), \
         draws: [(vertices: Matrix(matrix: Identity, mesh: Grid(columns: 1, rows: 1), diffuse: (55, 51, 51)))])",
    );
    fs::create_dir_all(bench.path("docs")).unwrap();
    fs::create_dir_all(bench.path(".git")).unwrap();
    bench.write("docs/speed-accuracy.md", "committed");
    bench.run("chart techniques --quick --only speed --out docs").failed(2, "error[NB0707]");
    assert_eq!(fs::read(bench.path("docs/speed-accuracy.md")).unwrap(), b"committed");
    assert_eq!(files(&bench.path("docs")), ["speed-accuracy.md"]);
    // The default folder contains a `.gitignore` for itself, and can be written to again.
    for _ in 0..2 {
        bench.run("chart techniques --quick --only speed").data();
    }
    let made = files(&bench.path("ninebit-chart"));
    assert!(made.contains(&"speed-accuracy.md".to_owned()) && made.contains(&".gitignore".to_owned()), "{made:?}");
    bench.run("chart techniques --quick --only speed --out docs --overwrite").data();
    assert_ne!(fs::read(bench.path("docs/speed-accuracy.md")).unwrap(), b"committed");
}

/// Checks a claim of the readme: "The first draws this picture, pixel for pixel."
#[test]
fn the_picture_of_the_readme_is_what_its_command_writes() {
    let bench = Bench::new();
    let readme = fs::read_to_string(at("README.md")).unwrap();
    let command = readme.split("$ cargo run -- ").nth(1).unwrap().lines().next().unwrap();
    let shown = readme.split("[this picture](docs/images/").nth(1).unwrap().split(')').next().unwrap();
    let scene = at("vectors/scenes");
    let command = command.replace("vectors/scenes", scene.to_str().unwrap());
    bench.run(&command).data();
    let pixels = |path| image::open(path).unwrap().to_rgba8();
    let committed = pixels(at("docs/images").join(shown));
    let written = pixels(bench.path(command.rsplit(' ').next().unwrap()));
    assert!(written == committed, "{command}: write it to docs/images/{shown} again");
}
