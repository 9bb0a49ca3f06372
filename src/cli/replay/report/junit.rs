//! Report as JUnit XML, which continuous integration services read.

use std::io;

use quick_xml::Writer;
use quick_xml::events::{BytesDecl, BytesText, Event};

use crate::replay::{Outcome, SceneReplay, Summary};
use ninebit::shown;

/// Returns one test case for each scene: its folder is the class, its verdict the message. The text is empty if the writer fails, which it does not
/// in memory.
pub(crate) fn junit(all: &[SceneReplay]) -> String {
    let mut writer = Writer::new_with_indent(Vec::new(), b' ', 2);
    let written = write(&mut writer, all).map(|()| writer.into_inner());
    written.ok().and_then(|bytes| String::from_utf8(bytes).ok()).map_or(String::new(), |text| text + "\n")
}

fn write(writer: &mut Writer<Vec<u8>>, all: &[SceneReplay]) -> io::Result<()> {
    let summary = Summary::from_replays(all);
    let errors = all.iter().filter(|one| matches!(one.outcome, Outcome::Failed(_))).count();
    let counts =
        [("tests", summary.scenes), ("failures", summary.differing), ("errors", errors), ("skipped", summary.skipped)]
            .map(|(name, count)| (name, count.to_string()));
    let counts = || counts.iter().map(|(name, count)| (*name, count.as_str()));
    writer.write_event(Event::Decl(BytesDecl::new("1.0", Some("utf-8"), None)))?;
    // Jenkins' schema has no `skipped` here.
    let suites = writer.create_element("testsuites").with_attributes(counts().filter(|(name, _)| *name != "skipped"));
    suites.write_inner_content(|writer| {
        let suite =
            writer.create_element("testsuite").with_attribute(("name", "ninebit replay")).with_attributes(counts());
        suite.write_inner_content(|writer| all.iter().try_for_each(|one| case(writer, one)))?;
        Ok(())
    })?;
    Ok(())
}

fn case(writer: &mut Writer<Vec<u8>>, one: &SceneReplay) -> io::Result<()> {
    let (folder, name) = one.name.rsplit_once('/').unwrap_or(("", &one.name));
    let (folder, name, path) = (shown::name(folder), shown::name(name), shown::path(&one.path));
    let (message, code) = (one.message(), one.exit_code().to_string());
    let case = writer.create_element("testcase").with_attributes([
        ("classname", &*folder),
        ("name", &*name),
        ("file", &*path),
    ]);
    let (element, told) = match &one.outcome {
        Outcome::Match | Outcome::Blessed { .. } => {
            case.write_empty()?;
            return Ok(());
        }
        Outcome::Skipped(_) => ("skipped", None),
        Outcome::Differs(difference) => ("failure", Some(("difference".to_owned(), difference.brief()))),
        Outcome::Failed(problem) => ("error", Some((format!("exit {code}"), problem.text.clone()))),
    };
    case.write_inner_content(|writer| {
        let element = writer.create_element(element).with_attribute(("message", &*message));
        match told {
            Some((kind, text)) => {
                let text = shown::lines(&text);
                element.with_attribute(("type", &*kind)).write_text_content(BytesText::new(&text))?
            }
            None => element.write_empty()?,
        };
        Ok(())
    })?;
    Ok(())
}
