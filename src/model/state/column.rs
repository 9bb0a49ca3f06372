//! A list of values that is held once where they are all the same.

use std::sync::Arc;

use super::VertexColor;

/// A value that a [`Column`] can hold.
pub(super) trait Value: Copy {
    /// Whether the two cannot be told apart: -0 and 0 can.
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

/// The list. How long it is only its owner knows. Copies share the values until one of them changes.
#[derive(Clone)]
pub(super) enum Column<T> {
    /// All are this one.
    Same(T),
    /// A value of its own for each.
    Each(Arc<Vec<T>>),
}

impl<T: Value> Column<T> {
    /// Value `index`, which lies in the list.
    #[inline(always)]
    pub(super) fn at(&self, index: usize) -> T {
        match self {
            Column::Same(value) => *value,
            Column::Each(values) => values[index],
        }
    }

    /// The values of a triangle's vertices.
    #[inline(always)]
    pub(super) fn three(&self, [a, b, c]: [u32; 3]) -> [T; 3] {
        match self {
            Column::Same(value) => [*value; 3],
            Column::Each(values) => [values[a as usize], values[b as usize], values[c as usize]],
        }
    }

    /// Appends values to a list of `count`; there is going to be room for `capacity` in all.
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

    /// Bytes that its values take beside the column itself.
    pub(super) fn bytes(&self) -> usize {
        match self {
            Column::Same(_) => 0,
            Column::Each(each) => each.capacity() * size_of::<T>(),
        }
    }
}
