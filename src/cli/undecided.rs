//! Rules that nothing decides, and what they would change: one text for the command line and for the page of `ninebit inspect`.

/// Says which undecided rules would change something, such as `this pixel`.
pub(crate) fn sentence<'r>(rules: impl IntoIterator<Item = &'r str>, what: &str) -> String {
    let mut named: Vec<&str> = rules.into_iter().collect();
    named.dedup();
    match named.as_slice() {
        [] => format!("No undecided rule would change {what}."),
        _ => format!("Of the undecided rules {} would change {what}.", named.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::sentence;

    #[test]
    fn a_rule_is_named_once() {
        assert_eq!(sentence([], "this pixel"), "No undecided rule would change this pixel.");
        let said = sentence(["CMB-4", "CMB-4", "CMB-8"], "this result");
        assert_eq!(said, "Of the undecided rules CMB-4, CMB-8 would change this result.");
    }
}
