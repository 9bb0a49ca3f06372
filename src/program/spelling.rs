//! Finds the known word that was probably meant by an unknown one.

/// Returns the candidate that is most similar to `word`, if any is similar enough.
pub fn closest<'n>(word: &str, candidates: impl IntoIterator<Item = &'n str>) -> Option<&'n str> {
    if word.len() > 64 {
        return None;
    }
    let mut allowed = ((word.chars().count() + 1) / 3).max(1);
    let word = word.to_lowercase();
    let letters: Vec<char> = word.chars().collect();
    let mut best = None;
    for candidate in candidates.into_iter().filter(|candidate| candidate.len() <= 64) {
        let like = candidate.to_lowercase();
        let begun = word.len() >= 4 && like.starts_with(&word);
        let distance = if begun { Some(1) } else { distance(&letters, &like, allowed) };
        if let Some(distance) = distance.filter(|distance| *distance <= allowed) {
            best = Some(candidate);
            // Of equally similar candidates the first wins.
            let Some(nearer) = distance.checked_sub(1) else { break };
            allowed = nearer;
        }
    }
    best
}

/// Returns the Levenshtein distance, in which a swap of neighbours counts two; `None` if it is more than `most`.
fn distance(a: &[char], b: &str, most: usize) -> Option<usize> {
    let b: Vec<char> = b.chars().collect();
    if a.len().abs_diff(b.len()) > most {
        return None;
    }
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, x) in a.iter().enumerate() {
        // Cells further from the diagonal hold more than `most`.
        let (from, to) = (i.saturating_sub(most), b.len().min(i + most + 1));
        let mut diagonal = row[from];
        row[from] = if from == 0 { i + 1 } else { most + 1 };
        for j in from..to {
            let cost = diagonal + usize::from(*x != b[j]);
            diagonal = row[j + 1];
            row[j + 1] = cost.min(row[j] + 1).min(diagonal + 1);
        }
        if row[from..=to].iter().all(|distance| *distance > most) {
            return None;
        }
    }
    Some(row[b.len()]).filter(|distance| *distance <= most)
}
