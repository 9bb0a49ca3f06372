//! The files that the campaign corrupts, and the commands that read them.

use std::fs;
use std::path::{Path, PathBuf};

use ninebit::random::Random;
use ninebit_vectors::pack;
use sha2::{Digest, Sha256};

use super::mutate::mutated;

/// A file of the corpus. The path is relative to the working folder.
#[derive(Clone, Debug)]
struct Entry {
    path: PathBuf,
    bytes: Vec<u8>,
}

/// The corpus: the original of each file, copied to a working folder.
#[derive(Debug)]
pub struct Corpus {
    folder: PathBuf,
    scenes: Vec<Entry>,
    expectations: Vec<Entry>,
    /// Images, meshes, programs, families and raw texels, each with a scene that refers to it.
    assets: Vec<(Entry, PathBuf)>,
    images: Vec<Entry>,
    /// Files of vector packs and of results.
    vectors: Vec<Entry>,
    leaves: Vec<Entry>,
    tree: Entry,
    waivers: Entry,
    tables: Vec<(&'static str, Entry)>,
}

/// A run: a command, and the files that have to be restored after it.
#[derive(Debug)]
pub struct Case {
    pub arguments: Vec<String>,
    /// The scene that the command draws, if it draws one.
    pub scene: Option<PathBuf>,
    restore: Vec<Entry>,
    remove: Vec<PathBuf>,
}

const SCENES: [&str; 2] = ["vectors/scenes", "tests/bad"];
const WAIVERS: &str = r#"[{"unit": "product", "maximum": 1, "count": 7, "reason": "known"}, {"unit": "scale-bias", "maximum": 2, "count": 900, "reason": "known"}]"#;

/// Arguments of `ninebit op`, each with a table that the operation reads.
const TABLES: [(&str, &str); 6] = [
    (
        "combiner --a tex0:expand --b tex1 --c primary:half_bias --d const0",
        "tex0.r\ttex0.g\ttex1.r\tprimary.b\n128\t3\t-255\t255\n0\t1\t2\t255\n",
    ),
    ("final --a tex0 --b sum --c fog --d ef", "tex0.r\tspare0.g\tfog.a\n128\t3\t25\n0\t1\t255\n"),
    ("blend --source-factor sa --destination-factor 1-sa", "source.r\tsource.a\tdestination.r\n255\t128\t3\n1\t2\t3\n"),
    ("filter --texels 7,9", "u\n0\n128\n255\n"),
    ("address --mode mirror --size 8", "index\n-9\n0\n8\n16777215\n"),
    ("cube --size 64", "s\tt\tr\n1.0\t2.0\t-3.0\n0\t0\t0\n"),
];

const POLICIES: [&str; 6] = ["CMB-3=literal", "CMB-8=each", "CMB-9=after", "NUM-3=256", "FIN-1=clamp", "CMB-4=exact"];

fn pick<'l, T>(random: &mut Random, list: &'l [T]) -> &'l T {
    &list[random.below(list.len() as u128) as usize]
}

fn files(folder: &Path, found: &mut Vec<PathBuf>) {
    let mut entries: Vec<PathBuf> = fs::read_dir(folder).expect("the corpus").flatten().map(|e| e.path()).collect();
    entries.sort();
    for path in entries {
        if path.is_dir() { files(&path, found) } else { found.push(path) }
    }
}

fn write(folder: &Path, entry: &Entry) {
    let path = folder.join(&entry.path);
    fs::create_dir_all(path.parent().expect("a file lies in a folder")).expect("a folder");
    fs::write(path, &entry.bytes).expect("a file");
}

/// Reduces the frame size of a scene. Most frames of the corpus are 640 x 480; smaller ones test the readers equally well and take less
/// time.
fn small(text: &[u8]) -> Vec<u8> {
    let text = String::from_utf8_lossy(text);
    let text = text.replace("width: 640", "width: 64").replace("height: 480", "height: 48");
    text.replace("width: 512, height: 512", "width: 64, height: 64").into_bytes()
}

impl Corpus {
    /// Copies the corpus from the repository into `folder`, and creates the packs, results and leaves by running commands there. `run` runs
    /// the program.
    pub fn new(repository: &Path, folder: &Path, run: &dyn Fn(&[String])) -> Corpus {
        let mut all = Vec::new();
        for place in SCENES {
            files(&repository.join(place), &mut all);
        }
        let mut entries: Vec<Entry> = Vec::new();
        for path in all {
            let bytes = fs::read(&path).expect("a file of the corpus");
            let path = path.strip_prefix(repository).expect("in the repository").to_path_buf();
            let entry = Entry { path, bytes };
            write(folder, &entry);
            entries.push(entry);
        }
        let named = |entry: &Entry, end: &str| entry.path.to_string_lossy().ends_with(end);
        let is_scene =
            |entry: &&Entry| named(entry, ".ron") && !named(entry, ".expect.ron") && !named(entry, ".family.ron");
        let scenes: Vec<Entry> = entries.iter().filter(is_scene).cloned().collect();
        let expectations = entries.iter().filter(|entry| named(entry, ".expect.ron")).cloned().collect();
        let mut assets = Vec::new();
        for entry in entries
            .iter()
            .filter(|entry| !named(entry, ".md") && (!named(entry, ".ron") || named(entry, ".family.ron")))
        {
            let name = entry.path.file_name().unwrap_or_default().to_string_lossy().into_owned();
            let beside = scenes.iter().filter(|scene| {
                let folder = scene.path.parent().unwrap_or(Path::new(""));
                entry.path.starts_with(folder) && String::from_utf8_lossy(&scene.bytes).contains(&name)
            });
            assets.extend(beside.take(4).map(|scene| (entry.clone(), scene.path.clone())));
        }
        let is_image = |entry: &&Entry| [".png", ".tga", ".dds"].iter().any(|end| named(entry, end));
        let images = entries.iter().filter(is_image).cloned().collect();
        let mut corpus = Corpus {
            folder: folder.to_path_buf(),
            scenes,
            expectations,
            assets,
            images,
            vectors: Vec::new(),
            leaves: Vec::new(),
            tree: Entry { path: "tree.json".into(), bytes: Vec::new() },
            waivers: Entry { path: "waivers.json".into(), bytes: WAIVERS.into() },
            tables: Vec::new(),
        };
        for (n, (operation, text)) in TABLES.into_iter().enumerate() {
            corpus.tables.push((operation, Entry { path: format!("table-{n}.tsv").into(), bytes: text.into() }));
        }
        corpus.vectors(run);
        write(folder, &corpus.waivers);
        corpus.tables.iter().for_each(|(_, entry)| write(folder, entry));
        corpus
    }

    fn vectors(&mut self, run: &dyn Fn(&[String])) {
        let words = |text: &str| text.split(' ').map(str::to_owned).collect::<Vec<String>>();
        run(&words("vectors export --unit product --unit scale-bias --unit input-mapping -o pack"));
        run(&words("vectors sweep --unit input-mapping -o leaves"));
        run(&words("vectors merge leaves -o tree.json"));
        let (manifest, tables) = pack::open(&self.folder.join("pack")).expect("the pack that was exported");
        let device = serde_json::json!({
            "format": "ninebit-device-1", "pack": manifest.root, "vendor": "NVIDIA Corporation", "renderer": "GeForce 256/AGP", "version": "1.2",
            "surface": "window", "surface_format": "R8 G8 B8 A8", "extensions": "GL_NV_register_combiners",
        });
        fs::create_dir_all(self.folder.join("results")).expect("a folder");
        fs::write(self.folder.join("results/device.json"), device.to_string()).expect("a file");
        for table in &tables {
            let contents = table.writer.contents();
            let unit = contents.unit;
            let columns = unit.results();
            let out: Vec<usize> = (0..columns.len()).filter(|n| columns[*n].name.starts_with("out.")).collect();
            let names: Vec<&str> = out.iter().map(|n| columns[*n].name.as_str()).collect();
            let (profile, level) = (&manifest.profile, &manifest.level);
            let mut body = format!(
                "# ninebit-results 1\n# unit {}\n# profile {profile}\n# level {level}\n# seed {}\n# behaviour {}\nid\t{}\tstatus\n",
                unit.name(),
                contents.seed,
                table.behaviour,
                names.join("\t"),
            );
            for row in &table.rows {
                let texts: Vec<String> = out.iter().map(|n| columns[*n].kind.write(row.results[*n])).collect();
                body += &format!("{}\t{}\tok\n", row.id, texts.join("\t"));
            }
            body += "# unsupported 0\n";
            fs::write(self.folder.join(format!("results/{}.tsv", unit.name())), sealed(body.as_bytes()))
                .expect("a file");
        }
        let entries = |folder: &str| {
            let mut found = Vec::new();
            files(&self.folder.join(folder), &mut found);
            let entry = |path: PathBuf| Entry {
                bytes: fs::read(&path).expect("a file"),
                path: path.strip_prefix(&self.folder).expect("in the folder").to_path_buf(),
            };
            found.into_iter().map(entry).collect::<Vec<Entry>>()
        };
        self.vectors = [entries("pack"), entries("results")].concat();
        self.leaves = entries("leaves");
        self.tree.bytes = fs::read(self.folder.join("tree.json")).expect("the tree that was merged");
    }

    /// Returns a random case, whose corrupted files have been written.
    pub fn case(&self, random: &mut Random) -> Case {
        match random.below(100) {
            0..=54 => self.scene(random),
            55..=64 => self.replay(random),
            65..=79 => self.asset(random),
            80..=84 => self.image(random),
            85..=94 => self.vector(random),
            _ => self.table(random),
        }
    }

    /// Restores the files of a case and removes its outputs.
    pub fn restore(&self, case: &Case) {
        case.restore.iter().for_each(|entry| write(&self.folder, entry));
        for path in &case.remove {
            let path = self.folder.join(path);
            let _ = if path.is_dir() { fs::remove_dir_all(path) } else { fs::remove_file(path) };
        }
    }

    /// Returns a random command that reads a scene.
    fn command(&self, random: &mut Random, scene: &Path) -> Vec<String> {
        let name = scene.display().to_string();
        let mut words: Vec<String> = Vec::new();
        let mut add = |text: &str| words.extend(text.split(' ').map(str::to_owned));
        let takes_policy = match random.below(20) {
            0..=2 => {
                add("check");
                false
            }
            3..=6 => {
                add("render -o out.png");
                match random.below(4) {
                    0 => add("--engine scalar"),
                    1 => add("--threads 1"),
                    _ => {}
                }
                true
            }
            7..=9 => {
                let side = |random: &mut Random| {
                    let end = if random.once_in(2) { 64 } else { 8 };
                    random.below(end)
                };
                add(&format!("trace --pixel {},{}", side(random), side(random)));
                if random.once_in(2) {
                    add("--format json");
                }
                true
            }
            10 | 11 => {
                add(if random.once_in(2) { "explain" } else { "explain --count" });
                true
            }
            12 => {
                add("measure");
                true
            }
            13 | 14 => {
                add("compare --mode");
                let mode = *pick(random, &["chain", "steps", "follow"]);
                add(mode);
                true
            }
            15 => {
                add(if random.once_in(2) { "lower --to registers" } else { "lower --to combiners" });
                true
            }
            16 => {
                add("registers");
                true
            }
            17 => {
                let image = |random: &mut Random| pick(random, &self.images).path.display().to_string();
                let (a, b) = (image(random), image(random));
                return ["diff", &a, &b, "--scene", &name].map(str::to_owned).to_vec();
            }
            18 => {
                add("bench --frames 1");
                true
            }
            _ => {
                let texture = *pick(random, &["t", "rocks", "normal", "normals", "height", "sky"]);
                return ["texture", "--decode", "-o", "out.png", &format!("{name}:{texture}")]
                    .map(str::to_owned)
                    .to_vec();
            }
        };
        if takes_policy && random.once_in(4) {
            add("--policy");
            let policy = *pick(random, &POLICIES[..]);
            add(policy);
        }
        words.push(name);
        words
    }

    fn scene(&self, random: &mut Random) -> Case {
        let (entry, other) = (pick(random, &self.scenes), pick(random, &self.scenes));
        let large = random.once_in(16);
        let base = if large { entry.bytes.clone() } else { small(&entry.bytes) };
        let mutant =
            Entry { path: entry.path.with_file_name("mutant.ron"), bytes: mutated(random, &base, &other.bytes) };
        write(&self.folder, &mutant);
        let arguments = self.command(random, &mutant.path);
        Case {
            arguments,
            scene: Some(mutant.path.clone()),
            restore: Vec::new(),
            remove: vec![mutant.path, "out.png".into()],
        }
    }

    fn replay(&self, random: &mut Random) -> Case {
        let (entry, other) = (pick(random, &self.expectations), pick(random, &self.expectations));
        let name = entry.path.to_string_lossy().replace(".expect.ron", ".ron");
        let scene = self.scenes.iter().find(|scene| scene.path.to_string_lossy() == name).unwrap_or(&self.scenes[0]);
        let scene = Entry { path: scene.path.with_file_name("mutant.ron"), bytes: small(&scene.bytes) };
        let expectation = Entry {
            path: entry.path.with_file_name("mutant.expect.ron"),
            bytes: mutated(random, &small(&entry.bytes), &other.bytes),
        };
        write(&self.folder, &scene);
        write(&self.folder, &expectation);
        let mut arguments = vec!["replay".to_owned(), scene.path.display().to_string()];
        if random.once_in(3) {
            let report = *pick(random, &["junit=report", "html=report", "json=report", "github"]);
            arguments.extend(["--report", report].map(str::to_owned));
        }
        let remove = vec![scene.path.clone(), expectation.path, "report".into()];
        Case { arguments, scene: Some(scene.path), restore: Vec::new(), remove }
    }

    fn asset(&self, random: &mut Random) -> Case {
        let (entry, scene) = pick(random, &self.assets);
        let (other, _) = pick(random, &self.assets);
        write(&self.folder, &Entry { path: entry.path.clone(), bytes: mutated(random, &entry.bytes, &other.bytes) });
        let original = self.scenes.iter().find(|known| known.path == *scene).unwrap_or(&self.scenes[0]);
        let small = Entry { path: scene.with_file_name("mutant.ron"), bytes: small(&original.bytes) };
        write(&self.folder, &small);
        let arguments = self.command(random, &small.path);
        let remove = vec![small.path.clone(), "out.png".into()];
        Case { arguments, scene: Some(small.path), restore: vec![entry.clone()], remove }
    }

    fn image(&self, random: &mut Random) -> Case {
        let (entry, other) = (pick(random, &self.images), pick(random, &self.images));
        write(&self.folder, &Entry { path: entry.path.clone(), bytes: mutated(random, &entry.bytes, &other.bytes) });
        let name = entry.path.display().to_string();
        let text = match random.below(5) {
            0 => format!("texture {name}"),
            1 => format!("texture {name} --decode -o out.png --profile nv10"),
            2 => format!("generate normal-map {name} -o out.png --scale 4"),
            3 => format!("generate occlusion {name} -o out.png"),
            _ => format!("diff {name} {} -o out.png", other.path.display()),
        };
        let arguments = text.split(' ').map(str::to_owned).collect();
        Case { arguments, scene: None, restore: vec![entry.clone()], remove: vec!["out.png".into()] }
    }

    fn vector(&self, random: &mut Random) -> Case {
        let plain = |text: &str, restore: Entry, remove: Vec<PathBuf>| Case {
            arguments: text.split(' ').map(str::to_owned).collect(),
            scene: None,
            restore: vec![restore],
            remove,
        };
        let change = |random: &mut Random, entry: &Entry, other: &[u8]| {
            write(&self.folder, &Entry { path: entry.path.clone(), bytes: mutated(random, &entry.bytes, other) });
        };
        match random.below(8) {
            0 => {
                let entry = pick(random, &self.leaves);
                let other = pick(random, &self.leaves);
                change(random, entry, &other.bytes);
                plain("vectors merge leaves -o out.json", entry.clone(), vec!["out.json".into()])
            }
            1 => {
                change(random, &self.tree, &self.waivers.bytes);
                plain("vectors digest tree.json", self.tree.clone(), Vec::new())
            }
            2 => {
                change(random, &self.waivers, &self.tree.bytes);
                plain("vectors compare pack results --waivers waivers.json", self.waivers.clone(), Vec::new())
            }
            _ => {
                let (entry, other) = (pick(random, &self.vectors), pick(random, &self.vectors));
                let mut bytes = mutated(random, &entry.bytes, &other.bytes);
                let mut case = plain("", entry.clone(), vec!["adopted".into()]);
                // Half of the corrupted files get a correct checksum, so that the checks behind the checksum are reached.
                if random.once_in(2) {
                    if entry.path.starts_with("results") {
                        bytes = sealed(&bytes);
                    } else if let Some(manifest) =
                        self.vectors.iter().find(|entry| entry.path.ends_with("MANIFEST.json"))
                        && let Some(listed) = relisted(&manifest.bytes, &entry.path, &bytes)
                    {
                        write(&self.folder, &Entry { path: manifest.path.clone(), bytes: listed });
                        case.restore.push(manifest.clone());
                    }
                }
                write(&self.folder, &Entry { path: entry.path.clone(), bytes });
                let commands = [
                    "vectors check pack",
                    "vectors compare pack results",
                    "vectors compare pack results --format json --rows 9",
                    "vectors diff pack pack",
                    "vectors adopt pack results -o adopted",
                ];
                case.arguments = pick(random, &commands).split(' ').map(str::to_owned).collect();
                case
            }
        }
    }

    fn table(&self, random: &mut Random) -> Case {
        let ((operation, entry), (_, other)) = (pick(random, &self.tables), pick(random, &self.tables));
        write(&self.folder, &Entry { path: entry.path.clone(), bytes: mutated(random, &entry.bytes, &other.bytes) });
        let text = format!("op {operation} --inputs {} -o out.tsv", entry.path.display());
        let arguments = text.split(' ').map(str::to_owned).collect();
        Case { arguments, scene: None, restore: vec![entry.clone()], remove: vec!["out.tsv".into()] }
    }
}

/// Returns a table of results whose last line has the correct row count and checksum.
fn sealed(bytes: &[u8]) -> Vec<u8> {
    let text = String::from_utf8_lossy(bytes);
    let mut body: String =
        text.lines().filter(|line| !line.starts_with("# end")).flat_map(|line| [line, "\n"]).collect();
    let rows = body.lines().filter(|line| !line.starts_with('#')).count().saturating_sub(1);
    let crc = crc32fast::hash(body.as_bytes());
    body += &format!("# end {rows} {crc:08x}\n");
    body.into_bytes()
}

fn digest(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}

/// Returns a manifest with size and checksum of the changed file, or `None` if the manifest does not list the file.
fn relisted(manifest: &[u8], path: &Path, bytes: &[u8]) -> Option<Vec<u8>> {
    let mut value: serde_json::Value = serde_json::from_slice(manifest).ok()?;
    let name = path.strip_prefix("pack").ok()?.to_string_lossy().into_owned();
    let files = value["files"].as_array_mut()?;
    let file = files.iter_mut().find(|file| file["path"] == name.as_str())?;
    file["bytes"] = bytes.len().into();
    file["sha256"] = digest(bytes).into();
    let text = |value: &serde_json::Value| value.as_str().unwrap_or_default().to_owned();
    let sums: String =
        files.iter().map(|file| format!("{}  {}\n", text(&file["sha256"]), text(&file["path"]))).collect();
    value["root"] = digest(sums.as_bytes()).into();
    serde_json::to_vec_pretty(&value).ok()
}
