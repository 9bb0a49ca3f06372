//! Draws scenes by the generic text of whole pixels, which is compiled once for each chip and each set of policies.

use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::process::Command;

use ninebit::engine::cleared;
use ninebit::frame::Frames;
use ninebit::state::{Policies, Profile};
use ninebit_lower::{Generic, Sources};
use ninebit_methods::export::draw_words;

use crate::compiled::MAIN;
use crate::drawn::Printed;
use crate::setting::{bytes, compiler, run};

/// Largest number of lines that the text may have.
const LINES: usize = 3500;

/// The programs that are compiled, by chip and policies.
#[derive(Default)]
pub struct Programs(HashMap<String, tempfile::TempDir>);

const HEAD: &str = "
static uint32_t *given;
static struct nb_state state;
/* Reads methods and words. Those of addresses and vertices are no state of a pixel. */
static void read_state(void)
{
    memset(&state, 0, sizeof state);
    for (uint32_t count = *given++; count > 0; count--) {
        const uint32_t method = *given++, word = *given++;
        nb_method(&state, method, word);
    }
}
#define BEGIN_DRAW read_state()
#define SET_UP(n, vertex, triangle) nb_set_up(&state, vertex, triangle)
#define COVERS nb_covers
#define DRAW(n, ...) nb_draw_pixel(&state, __VA_ARGS__)
";

/// Returns the compiled text.
///
/// # Errors
/// What the compiler says.
fn program(chip: Profile, policies: Policies, Programs(programs): &mut Programs) -> Result<PathBuf, String> {
    let key = format!("{chip:?} {policies:?}");
    if let Some(folder) = programs.get(&key) {
        return Ok(folder.path().join("drawn"));
    }
    let Sources { header, source, name } = Generic { chip, policies }.whole_c99();
    let lines = header.lines().count() + source.lines().count();
    assert!(lines <= LINES, "{lines} lines");
    let folder = tempfile::tempdir().unwrap();
    let main =
        format!("#include \"{name}.h\"\n#include <string.h>\n{HEAD}{}", MAIN.replace("static uint32_t *given;", ""));
    for (file, text) in [(format!("{name}.h"), header), (format!("{name}.c"), source), ("main.c".to_string(), main)] {
        std::fs::write(folder.path().join(file), text).unwrap();
    }
    let flags = std::env::var("NINEBIT_LOWER_CFLAGS").unwrap_or_else(|_| "-O1".to_string());
    let mut command = Command::new(compiler());
    command.args("-std=c99 -Wall -Wextra -Werror -pedantic".split(' ')).args(flags.split_whitespace());
    run(command.args(["main.c", &format!("{name}.c"), "-o", "drawn"]), folder.path())?;
    let path = folder.path().join("drawn");
    programs.insert(key, folder);
    Ok(path)
}

impl Printed<'_> {
    /// Draws by the generic text. The plan must leave out nothing.
    ///
    /// # Errors
    /// Why a draw has no words, if the first value is true; otherwise what the compiler or the program says.
    pub fn generic(&self, folder: &Path, programs: &mut Programs) -> Result<Frames, (bool, String)> {
        let mut states = Vec::new();
        for (number, planned) in self.plan.draws().iter().enumerate() {
            let words = draw_words(self.scene, planned, number).map_err(|error| (true, error.message))?;
            let mut state = vec![words.len() as u32];
            state.extend(words.iter().flat_map(|(method, word)| [*method, *word]));
            states.push(state);
        }
        let program = program(self.plan.profile, self.plan.policies, programs).map_err(|error| (false, error))?;
        std::fs::write(folder.join("given.bin"), bytes(&self.given(Some(&states)))).unwrap();
        run(Command::new(program).args(["given.bin", "drawn.bin"]), folder).map_err(|error| (false, error))?;
        let mut frames = cleared(self.plan);
        self.read(folder, &mut frames);
        Ok(frames)
    }
}
