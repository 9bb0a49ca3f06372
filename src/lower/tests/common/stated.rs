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
use crate::shaded::write_shaders;

/// Largest number of lines that the text may have.
const LINES: usize = 3480;

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
#define DRAW(n, triangle, texture, x, y, count, words, depths) \\
    for (int32_t k = 0; k < (count); k++) nb_draw_pixel(&state, triangle, texture, (x) + k, y, (words) + k, (depths) + k)
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
    let main = format!("#include \"{name}.h\"\n#include <string.h>\n{HEAD}{MAIN}");
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
    /// Returns the methods and words of each draw.
    ///
    /// # Errors
    /// Why a draw has no words.
    fn states(&self) -> Result<Vec<Vec<(u32, u32)>>, String> {
        let draws = self.plan.draws().iter().enumerate();
        draws.map(|(n, draw)| draw_words(self.scene, draw, n).map_err(|error| error.message)).collect()
    }

    /// Draws by OpenGL, with the same shaders for every draw.
    ///
    /// # Errors
    /// Why a draw has no words, if the first value is true; otherwise what the driver says.
    pub fn paired_generic(&self, folder: &Path) -> Result<Frames, (bool, String)> {
        let generic = Generic { chip: self.plan.profile, policies: self.plan.policies };
        let states = self.states().map_err(|error| (true, error))?.into_iter().map(|words| {
            let words: HashMap<u32, u32> = words.into_iter().collect();
            generic.state(|method| words.get(&method).copied().unwrap_or(0))
        });
        (0..states.len()).for_each(|n| write_shaders(folder, n, generic.whole_shaders()));
        self.drawn(folder, "pair.py", Some(&states.collect::<Vec<_>>())).map_err(|error| (false, error))
    }

    /// Draws by the generic text. The plan must leave out nothing.
    ///
    /// # Errors
    /// Why a draw has no words, if the first value is true; otherwise what the compiler or the program says.
    pub fn generic(&self, folder: &Path, programs: &mut Programs) -> Result<Frames, (bool, String)> {
        let counted = |words: Vec<(u32, u32)>| -> Vec<u32> {
            [words.len() as u32]
                .into_iter()
                .chain(words.into_iter().flat_map(|(method, word)| [method, word]))
                .collect()
        };
        let states: Vec<_> = self.states().map_err(|error| (true, error))?.into_iter().map(counted).collect();
        let program = program(self.plan.profile, self.plan.policies, programs).map_err(|error| (false, error))?;
        std::fs::write(folder.join("given.bin"), bytes(&self.given(Some(&states)))).unwrap();
        run(Command::new(program).args(["given.bin", "drawn.bin"]), folder).map_err(|error| (false, error))?;
        let mut frames = cleared(self.plan);
        self.read(folder, &mut frames);
        Ok(frames)
    }
}
