//! Scores a folder of pictures against captures, and prints the causes.

use std::path::Path;

use ninebit_score::{captured, find, run};

fn report(captures: &Path, results: &Path) -> Result<String, String> {
    let chip = find(captures).map_err(|error| error.to_string())?.pop().ok_or("there are no captures")?;
    let other = find(results).map_err(|error| error.to_string())?.pop().ok_or("there are no pictures")?;
    let subjects = captured(&chip.folder, &chip.files).map_err(|error| error.to_string())?;
    let scored = run(&subjects, &other, true, &|_, _| {}).map_err(|error| error.to_string())?;
    let total = scored.total();
    let mut text = format!("{} of {} frames are exact", total.exact, total.frames);
    for cause in scored.causes.iter().flat_map(|causes| &causes.causes) {
        text += &format!("\n{:>10}  {}", cause.pixels, cause.variant.names());
    }
    Ok(text)
}

fn main() {
    let mut folders = std::env::args_os().skip(1);
    let (Some(captures), Some(results)) = (folders.next(), folders.next()) else {
        return eprintln!("name the folder of captures, and a folder of another renderer's pictures");
    };
    println!("{}", report(captures.as_ref(), results.as_ref()).unwrap_or_else(|error| error));
}
