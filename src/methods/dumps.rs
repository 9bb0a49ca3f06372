//! The dumps that a hardware tracer writes beside its log: textures before each draw, and surfaces after each draw and clear.
//!
//! ```text
//! PACKET_DRAW_DUMP_Texture_UNIT_LAYER.bin      level 0 of a layer, as it lies in memory
//! PACKET_DRAW_DUMP_Surface_Color.bin, _Depth   the surface from its first row on, as it lies in memory; .txt beside it describes it
//! PACKET_DRAW_PGRAPH.bin                       the registers after the draw
//! PACKET_DRAW_RDI_Constants_0.bin              the 192 constants of vertex programs after the draw, each w, z, y, x
//! PACKET_DRAW_RDI_Shader.bin                   the 136 slots of the vertex program, each from its last word to its first
//! ```
//!
//! DRAW is the number of draws that had ended, DUMP that of surfaces that had been written. Sources: the tracer's own file names
//! (abaire/xbdm_gdb_bridge, Unlicense), and for the order of words envytools' hardware tests (MIT), which write the chip's memories through the same
//! registers and compare what they read back.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use ninebit::limits::{MEMORY_IMAGE, PAGE};
use ninebit::state::Buffer;
use ninebit_files::read::{self, Kind, ReadError};

/// The log among the dumps.
pub const LOG_FILE: &str = "nv2a_log.txt";

/// A file with the name of a dump.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Dump {
    /// Number of draws that had ended.
    draw: u64,
    content: Content,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Content {
    Texture {
        unit: usize,
        layer: u32,
    },
    /// A surface, with the number of surfaces that had been written.
    Surface(Buffer, u64),
    Registers,
    Ram(Ram),
}

/// A memory of the transform unit, whose entries are four words.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ram {
    /// Slots of vertex programs.
    Program,
    /// Their constants.
    Constants,
}

impl Dump {
    /// Reads a file's name; `None` if it is that of another file.
    fn from_name(name: &str) -> Option<Dump> {
        let stem = name.strip_suffix(".bin")?;
        let parts: Vec<&str> = stem.split('_').collect();
        let content = match parts.get(2..)? {
            [_, "Texture", unit, layer] => Content::Texture { unit: unit.parse().ok()?, layer: layer.parse().ok()? },
            [dump, "Surface", "Color"] => Content::Surface(Buffer::Color, dump.parse().ok()?),
            [dump, "Surface", "Depth"] => Content::Surface(Buffer::Depth, dump.parse().ok()?),
            ["PGRAPH"] => Content::Registers,
            ["RDI", "Shader"] => Content::Ram(Ram::Program),
            ["RDI", "Constants", "0"] => Content::Ram(Ram::Constants),
            _ => return None,
        };
        Some(Dump { draw: parts.get(1)?.parse().ok()?, content })
    }
}

/// A layer of a texture as it lay in memory before a draw.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TextureDump {
    /// The unit that it was bound to.
    pub unit: usize,
    /// Number of the layer.
    pub layer: u32,
    /// Level 0.
    pub bytes: Vec<u8>,
}

/// The dumps in a folder.
#[derive(Clone, Debug, Default)]
pub struct Dumps {
    folder: PathBuf,
    /// Names of textures by draw.
    textures: BTreeMap<u64, Vec<(usize, u32, String)>>,
    /// Names of surfaces by draw and dump, which grow together, for each [`Buffer`].
    surfaces: [BTreeMap<(u64, u64), String>; 2],
    /// Names of registers by draw, and those of each [`Ram`].
    registers: BTreeMap<u64, String>,
    rams: [BTreeMap<u64, String>; 2],
}

impl Dumps {
    /// Lists the dumps in a folder. None of them is read yet.
    ///
    /// # Errors
    /// The folder cannot be read.
    pub fn open(folder: &Path) -> std::io::Result<Dumps> {
        let mut dumps = Dumps { folder: folder.to_owned(), ..Dumps::default() };
        for entry in fs::read_dir(folder)? {
            let name = entry?.file_name();
            let Some(name) = name.to_str() else { continue };
            match Dump::from_name(name) {
                Some(Dump { draw, content: Content::Texture { unit, layer } }) => {
                    dumps.textures.entry(draw).or_default().push((unit, layer, name.to_owned()));
                }
                Some(Dump { draw, content: Content::Surface(buffer, dump) }) => {
                    dumps.surfaces[buffer as usize].insert((draw, dump), name.to_owned());
                }
                Some(Dump { draw, content: Content::Registers }) => {
                    dumps.registers.insert(draw, name.to_owned());
                }
                Some(Dump { draw, content: Content::Ram(ram) }) => {
                    dumps.rams[ram as usize].insert(draw, name.to_owned());
                }
                None => {}
            }
        }
        dumps.textures.values_mut().for_each(|names| names.sort());
        Ok(dumps)
    }

    /// Returns the textures of a draw that can be read, by unit and layer.
    pub fn textures(&self, draw: u64) -> Vec<TextureDump> {
        let names = self.textures.get(&draw).into_iter().flatten();
        let dump = |(unit, layer, name): &(usize, u32, String)| {
            Some(TextureDump { unit: *unit, layer: *layer, bytes: self.read(name).ok()? })
        };
        names.filter_map(dump).collect()
    }

    /// Returns the registers after a draw, which are those that it had.
    pub fn registers(&self, draw: u64) -> Option<Vec<u8>> {
        self.read(self.registers.get(&draw)?).ok()
    }

    /// Returns the entries of a memory after a draw, each as methods send its words.
    pub fn ram(&self, draw: u64, ram: Ram) -> Option<Vec<[u32; 4]>> {
        let bytes = self.read(self.rams[ram as usize].get(&draw)?).ok()?;
        let entry = |bytes: &[[u8; 4]; 4]| [3, 2, 1, 0].map(|n: usize| u32::from_le_bytes(bytes[n]));
        Some(bytes.as_chunks::<4>().0.as_chunks::<4>().0.iter().map(entry).collect())
    }

    /// Returns what a buffer of the bound surface held after a draw.
    pub fn after(&self, draw: u64, buffer: Buffer) -> Option<Vec<u8>> {
        self.read(self.last(draw, buffer)?.1).ok()
    }

    /// Returns what a buffer of the surface that a draw goes into held before it, if an earlier draw or clear of the log had it dumped.
    pub fn before(&self, draw: u64, buffer: Buffer) -> Option<Vec<u8>> {
        let (place, after) = self.last(draw, buffer)?;
        let address = self.address(after);
        let earlier = self.surfaces[buffer as usize].range(..place).rev();
        let (_, name) = earlier.take(LOOK_BACK).find(|(_, name)| self.address(name) == address)?;
        self.read(name).ok()
    }

    /// Returns the dump that the end of a draw had written: the last of its number, because clears before the draw have the same.
    fn last(&self, draw: u64, buffer: Buffer) -> Option<(&(u64, u64), &String)> {
        self.surfaces[buffer as usize].range((draw, 0)..=(draw, u64::MAX)).next_back()
    }

    /// Returns where the surface of a dump lies, which its description says: `640 x 480 [pitch = 2560 (0xA00)], at 0x01A5C000, format ...`.
    fn address(&self, name: &str) -> Option<u32> {
        let text = read::bytes(&self.folder.join(name).with_extension("txt"), Kind::Regular, PAGE).ok()?;
        let text = String::from_utf8_lossy(&text);
        let (_, rest) = text.split_once(" at 0x")?;
        let end = rest.find(|c: char| !c.is_ascii_hexdigit()).unwrap_or(rest.len());
        u32::from_str_radix(&rest[..end], 16).ok()
    }

    fn read(&self, name: &str) -> Result<Vec<u8>, ReadError> {
        read::bytes(&self.folder.join(name), Kind::Regular, MEMORY_IMAGE)
    }
}

/// Most dumps that are looked through for the one before a draw.
const LOOK_BACK: usize = 256;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_told_apart() {
        let name = |name| Dump::from_name(name).map(|dump| (dump.draw, dump.content));
        assert_eq!(name("0000000210_3_7_Texture_2_1.bin"), Some((3, Content::Texture { unit: 2, layer: 1 })));
        assert_eq!(name("0000000211_3_8_Surface_Color.bin"), Some((3, Content::Surface(Buffer::Color, 8))));
        assert_eq!(name("0000000211_3_8_Surface_Depth.bin"), Some((3, Content::Surface(Buffer::Depth, 8))));
        assert_eq!(name("0000000211_3_PGRAPH.bin"), Some((3, Content::Registers)));
        assert_eq!(name("0000000211_4_RDI_Constants_0.bin"), Some((4, Content::Ram(Ram::Constants))));
        assert_eq!(name("0000000211_4_RDI_Shader.bin"), Some((4, Content::Ram(Ram::Program))));
        for other in [
            "0000000211_3_PFB.bin",
            "0000000211_3_8_Surface_Color.txt",
            "a.bin",
            "1_2_3.bin",
            "1_x_3_Surface_Color.bin",
        ] {
            assert_eq!(name(other), None, "{other}");
        }
    }

    /// The clear before the draw has the draw's number; another surface lies elsewhere.
    #[test]
    fn a_draw_has_surfaces_before_and_after() {
        let folder = tempfile::tempdir().unwrap();
        let surface = |name: &str, at: u32, byte: u8| {
            fs::write(folder.path().join(format!("{name}_Surface_Color.bin")), [byte; 4]).unwrap();
            let text =
                format!("{{\"surface\": {{\"description\": \"2 x 2 [pitch = 8 (0x8)], at 0x{at:08X}, format 0xC\"}}}}");
            fs::write(folder.path().join(format!("{name}_Surface_Color.txt")), text).unwrap();
        };
        surface("0000000001_0_0", 0x1000, 1); // a clear
        surface("0000000002_0_1", 0x1000, 2); // draw 0
        surface("0000000003_1_2", 0x2000, 3); // a clear of another surface
        surface("0000000004_1_3", 0x1000, 4); // draw 1
        fs::write(folder.path().join("0000000002_0_1_Texture_0_0.bin"), [9; 3]).unwrap();
        let dumps = Dumps::open(folder.path()).unwrap();
        let byte = |bytes: Option<Vec<u8>>| bytes.map(|bytes| bytes[0]);
        assert_eq!([0, 1, 2].map(|draw| byte(dumps.after(draw, Buffer::Color))), [Some(2), Some(4), None]);
        assert_eq!([0, 1].map(|draw| byte(dumps.before(draw, Buffer::Color))), [Some(1), Some(2)]);
        assert_eq!(dumps.before(0, Buffer::Depth), None);
        assert_eq!(dumps.textures(0), [TextureDump { unit: 0, layer: 0, bytes: vec![9; 3] }]);
        assert_eq!(dumps.textures(1), []);
        assert_eq!((dumps.surfaces.each_ref().map(BTreeMap::len), dumps.textures.len()), ([4, 0], 1));
    }
}
