//! The command `ninebit planes`: values of all pixels as arrays.

use super::trace::{outside, rectangle_of};
use super::*;
use std::io::Cursor;

use ninebit::engine::{Plane, PlaneOptions, plane_names};
use ninebit::state::Rectangle;
use ninebit::threads::MAXIMUM as MAXIMUM_THREADS;
use ninebit::trace::Unit;
use ninebit_report::planes::{PlaneArray, Planes, PlanesError, plane_arrays};
use zip::result::ZipResult;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipWriter};

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    scene: SceneArguments,
    #[command(flatten)]
    work: WorkArguments,
    /// Names of values, as `ninebit trace` prints them: `stage0.rgb.AB.r`; `texture0.rgb` and `stage0.rgb.AB` stand for their channels. Without any the
    /// scene's names are listed
    #[arg(value_name = "NAME", requires = "output")]
    names: Vec<String>,
    /// The arrays, for `numpy.load`; `-` is stdout
    #[arg(short, long, value_name = "FILE.npz", value_parser = picture::output("npz"), requires = "names")]
    output: Option<Destination>,
    /// Only the pixels of a rectangle: its first column and row, columns and rows
    #[arg(long, value_name = "X,Y,COLUMNS,ROWS", value_parser = rectangle_of)]
    rectangle: Option<[u32; 4]>,
    /// Only fragments of this draw, numbered from 0
    #[arg(long, value_name = "N")]
    draw: Option<usize>,
    /// Which render target [default: the scene's first]
    #[arg(long, value_name = "NAME")]
    target: Option<String>,
    /// Count fragments, too, that a test drops
    #[arg(long)]
    dropped: bool,
    /// Write beside each array what float64 makes of it, NAME.ideal
    #[arg(long)]
    ideal: bool,
    /// Threads; 0 takes all cores
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = up_to::<MAXIMUM_THREADS>)]
    threads: usize,
}

/// Writes planes, or lists their names.
pub(crate) fn run(arguments: &Arguments, context: Context) -> Result<(), Failure> {
    let (scene, plan) = arguments.scene.load_to_draw(arguments.work, context)?;
    let options = PlaneOptions {
        target: chosen_target(&scene, arguments.target.as_deref())?,
        rectangle: arguments.rectangle.map(|[x, y, width, height]| Rectangle { x, y, width, height }),
        draw: arguments.draw,
        dropped: arguments.dropped,
        ideal: arguments.ideal,
        threads: arguments.threads,
    };
    let Some(output) = &arguments.output else {
        let names = plane_names(&plan, &options).map_err(|error| outside(&scene, &error))?;
        let lines = names.iter().map(|(name, block)| format!("{name:<32} {block}\n"));
        return Ok(write_text(&lines.collect::<String>())?);
    };
    output.check()?;
    let planes = plane_arrays(&plan, &arguments.names, &options).map_err(|error| match &error {
        PlanesError::Place(error) => outside(&scene, error),
        PlanesError::Unknown { .. } => {
            let report = Report::message(Some(PlanesError::UNKNOWN), &error.to_string(), &error.help());
            Failure { exit: Exit::Usage, report }
        }
    })?;
    let bytes = archive(&planes, arguments.ideal).map_err(|error| Failure::fault(&error.to_string()))?;
    Ok(output.write(&bytes)?)
}

/// Returns the archive of the arrays.
fn archive(planes: &Planes, ideal: bool) -> ZipResult<Vec<u8>> {
    let mut archive = ZipWriter::new(Cursor::new(Vec::new()));
    let Rectangle { width, height, .. } = planes.rectangle;
    for array in &planes.arrays {
        let shape = match array.planes.len() {
            1 => format!("{height}, {width}"),
            channels => format!("{height}, {width}, {channels}"),
        };
        let mut put = |suffix: &str, shape: &str, (kind, bytes): (&str, Vec<u8>)| {
            put(&mut archive, &format!("{}{suffix}", array.name), shape, kind, &bytes)
        };
        let values = match array.is_narrow() {
            true => ("<i4", little(array, |plane, pixel| (plane.values[pixel] as i32).to_le_bytes())),
            false => ("<i8", little(array, |plane, pixel| plane.values[pixel].to_le_bytes())),
        };
        put("", &shape, values)?;
        match array.per_one() {
            Some(per_one) => put(".per_one", "", ("<i8", per_one.to_le_bytes().to_vec()))?,
            None => put(
                ".per_one",
                &shape,
                ("<i8", little(array, |plane, pixel| unit(plane, pixel).per_one.to_le_bytes())),
            )?,
        }
        if array.has_exponents() {
            put(".exponent", &shape, ("<i4", little(array, |plane, pixel| unit(plane, pixel).exponent.to_le_bytes())))?;
        }
        if !array.is_whole() {
            put(".present", &shape, ("|b1", little(array, |plane, pixel| [u8::from(plane.unit(pixel).is_some())])))?;
        }
        if ideal {
            put(".ideal", &shape, ("<f8", little(array, |plane, pixel| plane.ideals[pixel].to_le_bytes())))?;
        }
    }
    Ok(archive.finish()?.into_inner())
}

/// Returns a pixel's unit, or that of a plain number if it has no value.
fn unit(plane: &Plane, pixel: usize) -> Unit {
    plane.unit(pixel).unwrap_or(Unit { per_one: 1, exponent: 0 })
}

/// Returns the bytes of an array, the channels innermost.
fn little<const N: usize>(array: &PlaneArray, bytes: impl Fn(&Plane, usize) -> [u8; N]) -> Vec<u8> {
    array.interleaved(bytes).into_flattened()
}

/// Writes an array in NumPy's format, version 1.0.
fn put(archive: &mut ZipWriter<Cursor<Vec<u8>>>, name: &str, shape: &str, kind: &str, bytes: &[u8]) -> ZipResult<()> {
    let header = format!("{{'descr': '{kind}', 'fortran_order': False, 'shape': ({shape}), }}");
    // Magic, version and length take ten bytes, and the data starts at a multiple of 64.
    let length = (10 + header.len() + 1).next_multiple_of(64) - 10;
    archive.start_file(
        format!("{name}.npy"),
        SimpleFileOptions::default().compression_method(CompressionMethod::Stored),
    )?;
    archive.write_all(b"\x93NUMPY\x01\x00")?;
    archive.write_all(&(length as u16).to_le_bytes())?;
    archive.write_all(format!("{header:<width$}\n", width = length - 1).as_bytes())?;
    archive.write_all(bytes)?;
    Ok(())
}
