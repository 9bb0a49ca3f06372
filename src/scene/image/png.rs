//! Reads the outer structure of a PNG file: its chunks.

use super::Header;

/// The first eight bytes of every PNG.
pub(super) const SIGNATURE: [u8; 8] = *b"\x89PNG\r\n\x1a\n";

/// A PNG reduced to the chunks that decide its pixels.
#[derive(Debug)]
pub(super) struct Essential {
    /// Contents of the chunk IHDR.
    pub(super) header: Header,
    /// Signature, IHDR, PLTE, tRNS, IDAT and IEND, unchanged.
    pub(super) bytes: Vec<u8>,
}

/// Walks the chunks and keeps the essential ones.
///
/// Compressed text and colour profiles are left out: they can unpack to a thousand times their size and do not affect the
/// pixels. A palette that is not a whole number of colours is refused here, because it makes decoders index past its end. If the
/// last chunk is cut off, what there is of it is kept; the decoder reports it.
///
/// # Errors
/// A description of what is wrong.
pub(super) fn essential(bytes: &[u8]) -> Result<Essential, &'static str> {
    let mut rest = bytes.strip_prefix(&SIGNATURE).ok_or("the signature is missing")?;
    let mut header = None;
    let mut kept = SIGNATURE.to_vec();
    while let Some((&[a, b, c, d, kind @ ..], _)) = rest.split_first_chunk::<8>() {
        let length = u32::from_be_bytes([a, b, c, d]) as usize;
        // A chunk is its length, kind, data and checksum.
        let whole = length.saturating_add(12);
        let chunk = &rest[..whole.min(rest.len())];
        let data = &chunk[8..chunk.len().min(length.saturating_add(8))];
        match &kind {
            b"IHDR" => {
                let fields: &[u8; 13] = data.first_chunk().ok_or("the header is cut off")?;
                let side = |at: usize| u32::from_be_bytes([fields[at], fields[at + 1], fields[at + 2], fields[at + 3]]);
                if header.replace(Header { width: side(0), height: side(4), bits: fields[8] }).is_some() {
                    return Err("it has two headers");
                }
                kept.extend_from_slice(chunk);
            }
            _ if header.is_none() => return Err("it does not begin with its header"),
            b"PLTE" => {
                if length == 0 || length > 768 || !length.is_multiple_of(3) {
                    return Err("the palette is not a whole number of colours, 1 to 256");
                }
                kept.extend_from_slice(chunk);
            }
            b"tRNS" | b"IDAT" | b"IEND" => kept.extend_from_slice(chunk),
            // Bit 5 of the first letter marks chunks that a reader may skip.
            _ if kind[0] & 0x20 == 0 => return Err("it has a chunk that may not be skipped and that no reader knows"),
            _ => {}
        }
        rest = &rest[chunk.len()..];
        if &kind == b"IEND" {
            break;
        }
    }
    Ok(Essential { header: header.ok_or("the header is cut off")?, bytes: kept })
}
