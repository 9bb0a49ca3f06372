//! What C hands over: texts, arrays, and places for results.

use std::ffi::{CStr, CString, c_char};
use std::ptr;

use super::failure::Failure;

/// Writes through a pointer, unless it is null.
///
/// # Safety
/// `place` is null or may be written.
pub(crate) unsafe fn put<T>(place: *mut T, value: T) {
    if !place.is_null() {
        // SAFETY: the caller promises that it may be written, and it is not null.
        unsafe { place.write(value) };
    }
}

/// Allocates a text for C, which `ninebit_text_free` frees. A zero would end it, so zeros are replaced.
pub(crate) fn text(text: String) -> *mut c_char {
    CString::new(text.replace('\0', "\u{fffd}")).map_or(ptr::null_mut(), CString::into_raw)
}

/// Borrows a text of C; null and text that is not UTF-8 are errors.
///
/// # Safety
/// `text` is null or points to bytes that end with a zero and live as long as the result is used.
pub(crate) unsafe fn text_of<'a>(text: *const c_char, what: &str) -> Result<&'a str, Failure> {
    if text.is_null() {
        return Err(Failure::argument(format!("{what} is null")));
    }
    // SAFETY: the caller promises that it ends with a zero, and it is not null.
    let text = unsafe { CStr::from_ptr(text) };
    text.to_str().map_err(|_| Failure::argument(format!("{what} is not UTF-8")))
}

/// Borrows an array of C.
///
/// # Safety
/// `first` is null, or points to `count` values that live and are not changed for as long as the result is used.
pub(crate) unsafe fn array<'a, T>(first: *const T, count: usize, what: &str) -> Result<&'a [T], Failure> {
    checked(first, count, what)?;
    if count == 0 {
        return Ok(&[]);
    }
    // SAFETY: it is not null, is aligned, and its bytes are no more than an isize holds; the caller promises the rest.
    Ok(unsafe { std::slice::from_raw_parts(first, count) })
}

/// Borrows an array of C for writing.
///
/// # Safety
/// `first` is null, or points to `count` values that may be written and are not used by anybody else for as long as the result is used.
pub(crate) unsafe fn array_mut<'a, T>(first: *mut T, count: usize, what: &str) -> Result<&'a mut [T], Failure> {
    checked(first, count, what)?;
    if count == 0 {
        return Ok(&mut []);
    }
    // SAFETY: as in `array`.
    Ok(unsafe { std::slice::from_raw_parts_mut(first, count) })
}

/// Checks what can be known about an array without reading it.
pub(crate) fn checked<T>(first: *const T, count: usize, what: &str) -> Result<(), Failure> {
    if count == 0 {
        return Ok(());
    }
    if first.is_null() || !first.is_aligned() {
        return Err(Failure::argument(format!("{what} is null or not aligned")));
    }
    match count.checked_mul(size_of::<T>()) {
        Some(bytes) if isize::try_from(bytes).is_ok() => Ok(()),
        _ => Err(Failure::argument(format!("{what} cannot have {count} elements"))),
    }
}
