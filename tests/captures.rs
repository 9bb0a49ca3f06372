//! Compares captured frames of a real NV2A with the frames that both engines draw.

use ninebit::engine::{Engine, RenderOptions};
use ninebit::state::Policies;
use ninebit_captures::SIZE;
use rayon::prelude::*;

/// Tests a sample of all suites, and every frame of the combiners' own: each shows a rule that no other frame does. `ninebit captures check` compares
/// all frames.
#[test]
fn every_frame_is_exact() {
    let all = |suites: &[&str]| ninebit_captures::frames(suites).unwrap_or_else(|unmatched| panic!("{unmatched:#?}"));
    let mut frames = ninebit_captures::sample(all(&[]), 300);
    frames.retain(|frame| frame.suite != "Combiner");
    frames.extend(all(&["Combiner"]));
    let wrong: Vec<String> = frames
        .par_iter()
        .enumerate()
        .filter_map(|(n, frame)| {
            // The scalar engine, which is slower, draws a tenth of the frames.
            let engine = if n % 10 == 0 { Engine::Scalar } else { Engine::Fast };
            let pixels = frame
                .render(&RenderOptions { engine, threads: 1, ..RenderOptions::default() }, Policies::DEFAULT)
                .unwrap();
            (frame.is(&pixels) == frame.open.is_some()).then(|| format!("{}/{} by {engine:?}", frame.suite, frame.name))
        })
        .collect();
    assert!(wrong.is_empty(), "{} of {} frames differ: {wrong:#?}", wrong.len(), frames.len());
    let compared: u64 = frames.iter().map(ninebit_captures::Frame::compared).sum();
    println!("{} frames, {compared} pixels", frames.len());
}

/// A sample contains frames of every suite, none of them twice. If more frames are asked for than there are, it contains all of them.
#[test]
fn samples_are_spread() {
    let all = || ninebit_captures::frames(&[]).unwrap();
    let names = |frames: Vec<ninebit_captures::Frame>| -> Vec<String> {
        frames.iter().map(|frame| format!("{}/{}", frame.suite, frame.name)).collect()
    };
    assert_eq!(names(ninebit_captures::sample(all(), usize::MAX / 10_000)), names(all()));
    let sample = ninebit_captures::sample(all(), 300);
    assert!((300..370).contains(&sample.len()), "{}", sample.len());
    let mut suites: Vec<&str> = sample.iter().map(|frame| frame.suite).collect();
    suites.dedup();
    assert_eq!(suites, ninebit_captures::suites().collect::<Vec<_>>());
    let mut sorted = names(sample);
    sorted.sort_unstable();
    let count = sorted.len();
    sorted.dedup();
    assert_eq!(sorted.len(), count);
}

/// No suite has more frames than were captured.
#[test]
fn suites_have_captured_frames() {
    let all = ninebit_captures::frames(&[]).unwrap();
    for suite in ninebit_captures::suites() {
        let drawn = all.iter().filter(|frame| frame.suite == suite).count();
        assert!(
            ninebit_captures::captured().any(|(name, captured)| name == suite && drawn <= captured),
            "{suite}: {drawn}"
        );
    }
    assert_eq!(ninebit_captures::captured().map(|(_, captured)| captured).sum::<usize>(), 5606);
}

/// Nothing but printed text is left out: every area lies within a line of the programs' text screen, whose characters of 16 rows stand 25 rows apart
/// from row 25 on.
#[test]
fn only_printed_text_is_left_out() {
    for frame in ninebit_captures::frames(&[]).unwrap() {
        for area in &frame.text {
            let below = area.y.checked_sub(25).map(|y| y % 25);
            let is_line = below.is_some_and(|below| below + area.height <= 16);
            assert!(is_line && area.x >= 20 && area.x + area.width <= SIZE.0, "{frame:?}: {area:?}");
        }
        assert!(frame.text.iter().map(|area| area.width).sum::<u32>() < 16 * SIZE.0, "{frame:?}");
    }
}

/// A single changed pixel is noticed, except under the printed text, which is not compared.
#[test]
fn one_pixel_makes_a_difference() {
    let frames = ninebit_captures::frames(&["Stencil"]).unwrap();
    let frame = &frames[0];
    let mut pixels = frame.render(&RenderOptions::default(), Policies::DEFAULT).unwrap();
    assert!(frame.is(&pixels));
    let text = frame.text.first().unwrap();
    let at = (text.y * SIZE.0 + text.x) as usize;
    pixels[at][0] ^= 1;
    assert!(frame.is(&pixels), "text is not compared");
    let last = pixels.len() - 1;
    pixels[last][3] ^= 1;
    assert!(!frame.is(&pixels));
    assert!(!frame.is(&pixels[..at]), "a part of the frame");
    assert_eq!(ninebit_captures::pixels(text).next(), Some(at));
}
