//! Uses the model as a page does: opens a scene and draws it.
//!
//! `cargo run -p ninebit-web --example session`

use ninebit_web::Session;

fn main() {
    let mut session = Session::default();
    let open = r#"{ "do": "open", "name": "a.ron", "text": "(version: 1, profile: Nv2a, targets: [(width: 2, height: 2, clear: (color: (9, 9, 9)))], draws: [])" }"#;
    for request in [open, r#"{ "do": "draw", "target": 0, "until": null }"#] {
        println!("{}", session.answer(request.as_bytes(), Vec::new()));
    }
    assert_eq!(session.picture(), [[9, 9, 9, 255]; 4]);
}
