//! The library for C: scenes, frames, traces, register words.
//!
//! `cbindgen` makes `include/ninebit.h` from this file; `docs/c.md` shows how it is used. Every function returns a status and writes its results
//! through pointers. It checks pointers that may be null and lengths that may be wrong, and returns a status for both. No panic crosses the
//! boundary. What one function allocates, another one frees. A scene never changes after it has been made, so any number of threads may use it at
//! the same time. Whatever depends on a scene runs on a thread with a stack of its own.

mod borrow;
mod call;
mod failure;

pub use failure::NinebitStatus;

use std::ffi::{CStr, CString, c_char};
use std::path::Path;
use std::ptr;

use ninebit::combiner::registers::Registers;
use ninebit::engine::{self, RenderOptions};
use ninebit::limits::Limits;
use ninebit::shown;
use ninebit::state::{Policies, Profile, Register};
use ninebit::threads;
use ninebit_program::registers::{RegisterWords, Word, decode};
use ninebit_report::trace_json;
use ninebit_scene::LoadedScene;

use borrow::{array, array_mut, put, text, text_of};
use call::{call, on_own_stack};
use failure::Failure;

/// The chip whose rules apply.
#[repr(i32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NinebitChip {
    /// GeForce 256: methods of the Celsius class.
    Nv10 = 0,
    /// GeForce 3 and Xbox: methods of the Kelvin class.
    Nv2a = 1,
}

/// A scene that has been read and checked. Threads may share it.
#[derive(Debug)]
pub struct NinebitScene {
    loaded: LoadedScene,
}

/// Inputs of the combiners for a pixel: R, G, B, A of each register. Textures are -256 to 255, colours and fog 0 to 255.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default)]
pub struct NinebitInputs {
    /// Interpolated diffuse colour.
    pub primary: [i32; 4],
    /// Interpolated specular colour.
    pub secondary: [i32; 4],
    /// Fog colour; alpha is the fog factor.
    pub fog: [i32; 4],
    /// Colour of each texture unit.
    pub texture: [[i32; 4]; 4],
}

/// A method of the chip's 3D class with the word written to it.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct NinebitMethod {
    /// Number of the method, for example 0x0ac0.
    pub method: u32,
    /// Word that is written to the method.
    pub word: u32,
}

/// Borrows a scene of C; null is an error.
///
/// # Safety
/// `scene` is null, or came from this library and has not been freed.
unsafe fn scene_of<'a>(scene: *const NinebitScene) -> Result<&'a NinebitScene, Failure> {
    // SAFETY: the caller promises that it is one of ours where it is not null; nobody ever changes one.
    unsafe { scene.as_ref() }.ok_or_else(|| Failure::argument("the scene is null"))
}

/// Returns the version of the library, for example `0.1.0`. Do not free it.
#[unsafe(no_mangle)]
pub extern "C" fn ninebit_version() -> *const c_char {
    const VERSION: &CStr = match CStr::from_bytes_with_nul(concat!(env!("CARGO_PKG_VERSION"), "\0").as_bytes()) {
        Ok(version) => version,
        Err(_) => c"",
    };
    VERSION.as_ptr()
}

/// Reads and checks the scene file at `path`. The files that it names are looked for in its folder. Free the scene with `ninebit_scene_free`.
///
/// If the call fails, `*scene` is null and `*message` says why, with places and stable codes. `message` may be null.
///
/// # Safety
/// `path` ends with a zero; `scene` and `message` are null or may be written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ninebit_scene_load(
    path: *const c_char,
    scene: *mut *mut NinebitScene,
    message: *mut *mut c_char,
) -> NinebitStatus {
    call(message, || {
        // SAFETY: the caller promises what both ask for.
        unsafe {
            begin(scene)?;
            let path = text_of(path, "the path")?;
            // `-` would be standard input, which is the calling program's.
            let path = if path == "-" { Path::new("./-") } else { Path::new(path) };
            finish(scene, on_own_stack(|| ninebit_scene::load(path, &Limits::default()).map_err(Failure::from))??);
        }
        Ok(())
    })
}

/// Reads and checks a scene from its text, which is `length` bytes of UTF-8. `origin` is its path: messages show it, and the files that the scene
/// names are looked for in its folder. Apart from that it is like `ninebit_scene_load`.
///
/// # Safety
/// `text` points to `length` bytes, `origin` ends with a zero; `scene` and `message` are null or may be written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ninebit_scene_parse(
    text: *const c_char,
    length: usize,
    origin: *const c_char,
    scene: *mut *mut NinebitScene,
    message: *mut *mut c_char,
) -> NinebitStatus {
    call(message, || {
        // SAFETY: the caller promises what each asks for.
        unsafe {
            begin(scene)?;
            let text = std::str::from_utf8(array(text.cast::<u8>(), length, "the text")?)
                .map_err(|error| Failure::argument(format!("the text is not UTF-8: {error}")))?;
            let origin = Path::new(text_of(origin, "the origin")?);
            finish(
                scene,
                on_own_stack(|| ninebit_scene::parse(text, origin, &Limits::default()).map_err(Failure::from))??,
            );
        }
        Ok(())
    })
}

/// Sets the caller's pointer to null; a null `scene` is an error.
///
/// # Safety
/// `scene` is null or may be written.
unsafe fn begin(scene: *mut *mut NinebitScene) -> Result<(), Failure> {
    // SAFETY: promised.
    unsafe { put(scene, ptr::null_mut()) };
    if scene.is_null() { Err(Failure::argument("there is no place for the scene")) } else { Ok(()) }
}

/// Hands a scene over to the caller.
///
/// # Safety
/// `scene` may be written.
unsafe fn finish(scene: *mut *mut NinebitScene, loaded: LoadedScene) {
    // SAFETY: promised.
    unsafe { put(scene, Box::into_raw(Box::new(NinebitScene { loaded }))) };
}

/// Frees a scene. Null is ignored.
///
/// # Safety
/// `scene` is null, or came from this library, has not been freed and is not used by another thread.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ninebit_scene_free(scene: *mut NinebitScene) {
    if !scene.is_null() {
        // SAFETY: promised: it came from `Box::into_raw` and is freed once.
        drop(unsafe { Box::from_raw(scene) });
    }
}

/// Frees a text that came from this library. Null is ignored.
///
/// # Safety
/// `text` is null, or came from this library and has not been freed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ninebit_text_free(text: *mut c_char) {
    if !text.is_null() {
        // SAFETY: promised: it came from `CString::into_raw` and is freed once.
        drop(unsafe { CString::from_raw(text) });
    }
}

/// Writes the number of columns and rows of the target with number `target`.
///
/// # Safety
/// `scene` came from this library; `width`, `height` and `message` are null or may be written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ninebit_target_size(
    scene: *const NinebitScene,
    target: usize,
    width: *mut u32,
    height: *mut u32,
    message: *mut *mut c_char,
) -> NinebitStatus {
    call(message, || {
        // SAFETY: the caller promises what it asks for.
        let loaded = &unsafe { scene_of(scene) }?.loaded;
        let target = target_of(loaded, target)?;
        // SAFETY: the caller promises that both are null or may be written.
        unsafe {
            put(width, target.width);
            put(height, target.height);
        }
        Ok(())
    })
}

fn target_of(loaded: &LoadedScene, target: usize) -> Result<&ninebit::state::Target, Failure> {
    let count = loaded.scene.targets.len();
    let none = || Failure::argument(format!("the scene has no target {target}: it has {count}, numbered from 0"));
    loaded.scene.targets.get(target).ok_or_else(none)
}

/// Renders the scene and writes the target with number `target`, row by row from the top: its stored words, and bytes R, G, B, A as a picture shows
/// them. Either may be null. `threads` is the number of threads, at most 1024, or 0 for one on each core; the result does not depend on it.
///
/// # Safety
/// `scene` came from this library; `words` is null or has room for `pixels` words, `rgba` is null or has room for 4 times as many bytes; `message` is
/// null or may be written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ninebit_render(
    scene: *const NinebitScene,
    target: usize,
    threads: usize,
    words: *mut u32,
    rgba: *mut u8,
    pixels: usize,
    message: *mut *mut c_char,
) -> NinebitStatus {
    call(message, || {
        // SAFETY: the caller promises what it asks for.
        let loaded = &unsafe { scene_of(scene) }?.loaded;
        let size = target_of(loaded, target)?;
        if threads > threads::MAXIMUM {
            return Err(Failure::argument(format!("threads are {threads}, {}", shown::not_up_to(threads::MAXIMUM))));
        }
        let wanted = size.width as usize * size.height as usize;
        if pixels != wanted {
            return Err(Failure::argument(format!("the target has {wanted} pixels, and there is room for {pixels}")));
        }
        let bytes = pixels.checked_mul(4).ok_or_else(|| Failure::argument("there cannot be as many bytes"))?;
        // The buffers are checked before anything is drawn, so that errors are reported at once.
        // SAFETY: the caller promises that each is null or has that room.
        let (words, rgba) = unsafe {
            let words = if words.is_null() { None } else { Some(array_mut(words, pixels, "the place of the words")?) };
            (words, if rgba.is_null() { None } else { Some(array_mut(rgba, bytes, "the place of the bytes")?) })
        };
        loaded.affordable(Limits::default().shaded_pixels)?;
        let options = RenderOptions { threads, ..RenderOptions::default() };
        let frames = on_own_stack(|| engine::render(&loaded.plan, &options))?;
        let surface = &frames.surfaces[target];
        if let Some(words) = words {
            words.copy_from_slice(&surface.words);
        }
        if let Some(rgba) = rgba {
            rgba.copy_from_slice(surface.rgba8().as_flattened());
        }
        Ok(())
    })
}

/// Writes the document of `ninebit trace --format json` for pixel (x, y) of the target with number `target`: every integer of its computation, with
/// its rule. Free it with `ninebit_text_free`.
///
/// # Safety
/// `scene` came from this library; `json` and `message` are null or may be written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ninebit_trace(
    scene: *const NinebitScene,
    target: usize,
    x: u32,
    y: u32,
    json: *mut *mut c_char,
    message: *mut *mut c_char,
) -> NinebitStatus {
    call(message, || {
        // SAFETY: the caller promises that it is null or may be written.
        unsafe { put(json, ptr::null_mut()) };
        // SAFETY: the caller promises what it asks for.
        let loaded = &unsafe { scene_of(scene) }?.loaded;
        target_of(loaded, target)?;
        if json.is_null() {
            return Err(Failure::argument("there is no place for the document"));
        }
        loaded.affordable(Limits::default().shaded_pixels)?;
        let traced = on_own_stack(|| {
            let trace = engine::trace(&loaded.plan, target, (x, y), None)?;
            Ok(trace_json(&loaded.plan, &trace))
        });
        let document = traced?.map_err(|error: engine::TraceError| Failure::argument(error.to_string()))?;
        // SAFETY: the caller promises that it may be written.
        unsafe { put(json, text(document)) };
        Ok(())
    })
}

/// Runs the program in register words on pixels, and writes the fragments as they reach the raster operations: R, G, B, A, four bytes a pixel.
/// Methods that do not belong to the combiners are ignored; words that are not written are 0.
///
/// # Safety
/// `methods` points to `method_count` pairs, `inputs` to `pixels` inputs, and `fragments` to room for 4 times as many bytes; `message` is null or may
/// be written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ninebit_evaluate(
    chip: i32,
    methods: *const NinebitMethod,
    method_count: usize,
    inputs: *const NinebitInputs,
    fragments: *mut u8,
    pixels: usize,
    message: *mut *mut c_char,
) -> NinebitStatus {
    call(message, || {
        let chip = match chip {
            0 => Profile::Nv10,
            1 => Profile::Nv2a,
            _ => return Err(Failure::argument("the chip is 0 (nv10) or 1 (nv2a)")),
        };
        let bytes = pixels.checked_mul(4).ok_or_else(|| Failure::argument("there cannot be as many bytes"))?;
        // SAFETY: the caller promises what each asks for.
        let (methods, inputs, fragments) = unsafe {
            let methods = array(methods, method_count, "the list of methods")?;
            let inputs = array(inputs, pixels, "the list of inputs")?;
            (methods, inputs, array_mut(fragments, bytes, "the place of the fragments")?)
        };
        let mut words = RegisterWords::new(chip);
        for NinebitMethod { method, word } in methods {
            if let Some((register, index)) = Word::of_method(*method, chip) {
                words.set(register, index, *word);
            }
        }
        let program = decode(&words).map_err(|refusals| {
            let lines = refusals.iter().map(|r| format!("error[{}]: {}\n  help: {}\n", r.code, r.message, r.help));
            Failure { status: NinebitStatus::Invalid, text: lines.collect() }
        })?;
        for (given, fragment) in inputs.iter().zip(fragments.as_chunks_mut::<4>().0) {
            *fragment = program.run(registers(given)?, &Policies::DEFAULT);
        }
        Ok(())
    })
}

fn registers(given: &NinebitInputs) -> Result<Registers<i32>, Failure> {
    let mut registers = Registers::new();
    let [t0, t1, t2, t3] = given.texture;
    for (register, values, least) in [
        (Register::PrimaryColor, given.primary, 0),
        (Register::SecondaryColor, given.secondary, 0),
        (Register::Fog, given.fog, 0),
        (Register::Texture0, t0, -256),
        (Register::Texture1, t1, -256),
        (Register::Texture2, t2, -256),
        (Register::Texture3, t3, -256),
    ] {
        if let Some(value) = values.iter().find(|value| !(least..=255).contains(*value)) {
            return Err(Failure::argument(format!("{register:?} is given {value}; it is {least} to 255")));
        }
        registers.load(register, values);
    }
    Ok(registers)
}

/// Checks that threads may share scenes.
const _: () = {
    const fn shared<T: Send + Sync>() {}
    shared::<NinebitScene>();
};

#[cfg(test)]
mod tests {
    use super::*;
    use ninebit::faults::{self, Operation};
    use std::sync::{Mutex, PoisonError};

    /// Held by tests that start threads, because a planted fault is the process's.
    static STARTING: Mutex<()> = Mutex::new(());

    /// A panic becomes a status and a text, and the next call works as usual.
    #[test]
    fn panics_do_not_cross() {
        let _alone = STARTING.lock().unwrap_or_else(PoisonError::into_inner);
        let mut message = ptr::null_mut();
        assert_eq!(call(&raw mut message, || panic!("a fault that is planted")), NinebitStatus::Internal);
        // SAFETY: `call` has made the text.
        let text = unsafe { CStr::from_ptr(message) }.to_string_lossy().into_owned();
        assert!(text.starts_with("error[NB0801]") && text.contains("a fault that is planted"), "{text}");
        // SAFETY: it is freed once.
        unsafe { ninebit_text_free(message) };
        assert_eq!(call(&raw mut message, || Ok(())), NinebitStatus::Ok);
        assert!(message.is_null());
        assert_eq!(call(&raw mut message, || on_own_stack(|| panic!("on another thread"))), NinebitStatus::Internal);
        // SAFETY: as above.
        let text = unsafe { CStr::from_ptr(message) }.to_string_lossy().into_owned();
        assert!(
            text.starts_with("error[NB0801]: internal error: src/c/lib.rs:") && text.contains("on another thread"),
            "{text}"
        );
        // SAFETY: as above.
        unsafe { ninebit_text_free(message) };
    }

    /// A system without threads left is a status: for the thread of the call. Helpers of a render are done without.
    #[test]
    fn a_thread_that_cannot_be_started_is_a_status() {
        let _alone = STARTING.lock().unwrap_or_else(PoisonError::into_inner);
        let scene = c"(version: 1, profile: Nv2a, targets: [(width: 64, height: 48)], draws: [])";
        for n in 1.. {
            faults::plant(Operation::Start, n);
            let (mut loaded, mut message, mut words) = (ptr::null_mut(), ptr::null_mut(), vec![0_u32; 64 * 48]);
            // SAFETY: the text is as long as said, and what is written is there.
            let status = unsafe {
                let text = scene.to_bytes();
                match ninebit_scene_parse(
                    text.as_ptr().cast(),
                    text.len(),
                    c"x.ron".as_ptr(),
                    &raw mut loaded,
                    &raw mut message,
                ) {
                    NinebitStatus::Ok => {
                        ninebit_render(loaded, 0, 3, words.as_mut_ptr(), ptr::null_mut(), words.len(), &raw mut message)
                    }
                    refused => refused,
                }
            };
            let has_failed = !faults::is_due(Operation::Start);
            faults::plant(Operation::Start, 0);
            if n <= 2 {
                assert_eq!(status, NinebitStatus::Limit);
                // SAFETY: it has failed and made the text.
                let text = unsafe { CStr::from_ptr(message) }.to_string_lossy().into_owned();
                assert!(text.starts_with("error[NB0802]: a thread cannot be started: "), "{text}");
            } else {
                assert_eq!((status, words[0]), (NinebitStatus::Ok, 0xff00_0000));
            }
            // SAFETY: both are null or were made above, and are freed once.
            unsafe {
                ninebit_scene_free(loaded);
                ninebit_text_free(message);
            }
            if !has_failed {
                assert!(n > 2, "the thread of a render is started");
                return;
            }
        }
    }
}
