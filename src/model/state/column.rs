//! A list of values that stores one value if all are equal.

use std::sync::Arc;

use super::VertexColor;

/// A value that a [`Column`] can hold.
pub(super) trait Value: Copy {
    /// Returns whether the two values have the same bits, so that -0 and 0 differ.
    fn same(&self, other: &Self) -> bool;
}

impl Value for f32 {
    fn same(&self, other: &Self) -> bool {
        self.to_bits() == other.to_bits()
    }
}

impl Value for Option<f32> {
    fn same(&self, other: &Self) -> bool {
        self.map(f32::to_bits) == other.map(f32::to_bits)
    }
}

impl Value for [u8; 4] {
    fn same(&self, other: &Self) -> bool {
        self == other
    }
}

impl Value for VertexColor {
    fn same(&self, other: &Self) -> bool {
        match (self, other) {
            (VertexColor::Bytes(a), VertexColor::Bytes(b)) => a == b,
            (VertexColor::Floats(a), VertexColor::Floats(b)) => a.iter().zip(b).all(|(a, b)| a.same(b)),
            _ => false,
        }
    }
}

/// A column of values. Its owner keeps the length, which a column of equal values does not know. Clones share their
/// values until one of them changes.
#[derive(Clone)]
pub(super) enum Column<T> {
    /// All values equal this one.
    Same(T),
    /// Each element has its own value.
    Each(Arc<Vec<T>>),
}

impl<T: Value> Column<T> {
    /// Returns the value at `index`, which must be within the column.
    #[inline(always)]
    pub(super) fn at(&self, index: usize) -> T {
        match self {
            Column::Same(value) => *value,
            Column::Each(values) => values[index],
        }
    }

    /// Returns the values at the three indices of a triangle's vertices.
    #[inline(always)]
    pub(super) fn three(&self, [a, b, c]: [u32; 3]) -> [T; 3] {
        match self {
            Column::Same(value) => [*value; 3],
            Column::Each(values) => [values[a as usize], values[b as usize], values[c as usize]],
        }
    }

    /// Appends values to a column of `count` elements, and reserves room for `capacity` elements if it allocates.
    pub(super) fn extend(&mut self, count: usize, capacity: usize, values: impl Iterator<Item = T> + Clone) {
        if let (0, Some(first)) = (count, values.clone().next()) {
            *self = Column::Same(first);
        }
        match self {
            Column::Same(one) => {
                let one = *one;
                if values.clone().any(|value| !value.same(&one)) {
                    let mut each = Vec::with_capacity(capacity);
                    each.resize(count, one);
                    each.extend(values);
                    *self = Column::Each(Arc::new(each));
                }
            }
            Column::Each(each) => Arc::make_mut(each).extend(values),
        }
    }

    /// Returns the bytes that the values take on the heap.
    pub(super) fn bytes(&self) -> usize {
        match self {
            Column::Same(_) => 0,
            Column::Each(each) => each.capacity() * size_of::<T>(),
        }
    }
}
