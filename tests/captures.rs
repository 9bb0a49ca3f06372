//! Captured frames of a real NV2A: every one that is drawn here is the captured one, by both engines.

use ninebit::engine::{Engine, RenderOptions};
use ninebit_vectors::captures::{self, SIZE};
use rayon::prelude::*;

#[test]
fn every_frame_is_exact() {
    let frames = captures::frames(&[]).unwrap_or_else(|unmatched| panic!("{unmatched:#?}"));
    assert_eq!((captures::suites().count(), frames.len()), (7, 1069));
    // The frames of Depth_buffer are one geometry in four formats: two of each 98 are drawn here, colours and words, all by `ninebit captures check`.
    let frames: Vec<_> = frames
        .into_iter()
        .enumerate()
        .filter(|(n, frame)| frame.suite() != "Depth_buffer" || n % 49 == 3)
        .map(|(_, frame)| frame)
        .collect();
    let wrong: Vec<String> = frames
        .par_iter()
        .enumerate()
        .filter_map(|(n, frame)| {
            // The definition draws a tenth of them.
            let engine = if n % 10 == 0 { Engine::Scalar } else { Engine::Fast };
            let pixels = frame.render(&RenderOptions { engine, threads: 1, ..RenderOptions::default() }).unwrap();
            (frame.is(&pixels) == frame.open().is_some())
                .then(|| format!("{}/{} by {engine:?}", frame.suite(), frame.name()))
        })
        .collect();
    assert!(wrong.is_empty(), "{} of {} frames differ: {wrong:#?}", wrong.len(), frames.len());
    let compared: u64 = frames.iter().map(captures::Frame::compared).sum();
    println!("{} frames, {compared} pixels", frames.len());
}

/// The comparison can fail: one pixel makes the difference, and one under the text makes none.
#[test]
fn one_pixel_makes_a_difference() {
    let frames = captures::frames(&["Stencil"]).unwrap();
    let frame = &frames[0];
    let mut pixels = frame.render(&RenderOptions::default()).unwrap();
    assert!(frame.is(&pixels));
    let text = frame.text().first().unwrap();
    let at = (text.y * SIZE.0 + text.x) as usize;
    pixels[at][0] ^= 1;
    assert!(frame.is(&pixels), "text is not compared");
    let last = pixels.len() - 1;
    pixels[last][3] ^= 1;
    assert!(!frame.is(&pixels));
    assert_eq!(captures::pixels(text).next(), Some(at));
}
