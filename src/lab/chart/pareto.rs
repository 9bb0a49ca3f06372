//! The Pareto front of several points.

/// Returns the indices of the points on the Pareto front: no other point equals or beats them in every coordinate, where smaller is better. They are
/// sorted by the first coordinate. Of equal points only the first is on the front; points with a NaN never are.
pub(super) fn pareto_front<const N: usize>(points: &[[f64; N]]) -> Vec<usize> {
    let valid = |n: &usize| points[*n].iter().all(|value| !value.is_nan());
    let covers = |a: usize, b: usize| points[a].iter().zip(&points[b]).all(|(a, b)| a <= b);
    let beaten = |n: usize| (0..points.len()).filter(valid).any(|k| k != n && covers(k, n) && (!covers(n, k) || k < n));
    let mut order: Vec<usize> = (0..points.len()).filter(valid).filter(|n| !beaten(*n)).collect();
    order.sort_by(|a, b| {
        let by_coordinate = points[*a].iter().zip(&points[*b]).map(|(a, b)| a.total_cmp(b));
        by_coordinate.fold(std::cmp::Ordering::Equal, std::cmp::Ordering::then)
    });
    order
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_nothing_beats_is_left() {
        let points = [[3.0, 1.0], [1.0, 5.0], [2.0, 5.0], [2.0, 2.0], [4.0, 1.0], [1.0, 5.0], [f64::NAN, 0.0]];
        assert_eq!(pareto_front(&points), [1, 3, 0]);
        assert_eq!(pareto_front(&[[1.0, 2.0, 3.0], [1.0, 3.0, 2.0], [1.0, 3.0, 3.0]]), [0, 1]);
        assert!(pareto_front::<2>(&[]).is_empty());
    }

    proptest::proptest! {
        #[test]
        fn every_point_is_on_the_front_or_beaten(points: Vec<(u8, u8)>) {
            let points: Vec<[f64; 2]> = points.iter().map(|(x, y)| [f64::from(*x), f64::from(*y)]).collect();
            let front = pareto_front(&points);
            for (n, [x, y]) in points.iter().enumerate() {
                let beaten = front.iter().any(|k| *k != n && points[*k][0] <= *x && points[*k][1] <= *y);
                proptest::prop_assert!(front.contains(&n) != beaten);
            }
        }
    }
}
