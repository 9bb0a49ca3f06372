//! A badge as a picture.

use maud::html;

/// Returns an SVG picture with a label and a value.
pub(super) fn badge(label: &str, value: &str) -> String {
    // Characters of the font are about so wide.
    let width = |text: &str| 7 * text.chars().count() + 12;
    let (left, right) = (width(label), width(value));
    let whole = left + right;
    let picture = html! {
        svg xmlns="http://www.w3.org/2000/svg" width=(whole) height="20" role="img" aria-label={ (label) ": " (value) } {
            title { (label) ": " (value) }
            rect width=(whole) height="20" rx="3" fill="#3b3f46" {}
            rect x=(left) width=(right) height="20" rx="3" fill="#0b5cad" {}
            g fill="#fff" font-family="Verdana,DejaVu Sans,sans-serif" font-size="11" text-anchor="middle" {
                text x=(left / 2) y="14" { (label) }
                text x=(left + right / 2) y="14" { (value) }
            }
        }
    };
    picture.into_string() + "\n"
}

#[cfg(test)]
mod tests {
    #[test]
    fn texts_are_escaped() {
        let badge = super::badge("exact <b>", "5 of 7");
        assert!(badge.contains("exact &lt;b&gt;") && badge.contains("5 of 7") && badge.starts_with("<svg"));
    }
}
