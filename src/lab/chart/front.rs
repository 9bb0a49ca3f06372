//! Which of several ways nothing else beats at both.

/// Indices of the points that no other point equals or beats in both coordinates, smaller being better, from the smallest first coordinate
/// to the largest. Of equal points the first counts; points with a NaN never do.
pub fn front(points: &[[f64; 2]]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..points.len()).filter(|n| points[*n].iter().all(|v| !v.is_nan())).collect();
    order.sort_by(|a, b| {
        let ([ax, ay], [bx, by]) = (points[*a], points[*b]);
        ax.total_cmp(&bx).then(ay.total_cmp(&by))
    });
    let mut least = f64::INFINITY;
    order.retain(|n| {
        let better = points[*n][1] < least;
        least = least.min(points[*n][1]);
        better
    });
    order
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_nothing_beats_is_left() {
        let points = [[3.0, 1.0], [1.0, 5.0], [2.0, 5.0], [2.0, 2.0], [4.0, 1.0], [1.0, 5.0], [f64::NAN, 0.0]];
        assert_eq!(front(&points), [1, 3, 0]);
        assert!(front(&[]).is_empty());
    }

    proptest::proptest! {
        #[test]
        fn every_point_is_on_the_front_or_beaten(points: Vec<(u8, u8)>) {
            let points: Vec<[f64; 2]> = points.iter().map(|(x, y)| [f64::from(*x), f64::from(*y)]).collect();
            let front = front(&points);
            for (n, [x, y]) in points.iter().enumerate() {
                let beaten = front.iter().any(|k| *k != n && points[*k][0] <= *x && points[*k][1] <= *y);
                proptest::prop_assert!(front.contains(&n) != beaten);
            }
        }
    }
}
