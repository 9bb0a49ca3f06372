//! Enumerations whose variants have names. The scene reader, traces and messages share one list of them.

/// An enumeration whose variants can be listed and named.
pub trait Named: Copy + PartialEq + 'static {
    /// The name of the enumeration itself.
    const TYPE: &'static str;
    /// Every variant, in the order in which they are declared.
    const ALL: &'static [Self];
    /// The names of [`ALL`](Self::ALL) in the same order, spelled as in the source and in scene files.
    const NAMES: &'static [&'static str];

    /// Returns the name of this variant.
    fn name(self) -> &'static str {
        Self::ALL.iter().position(|v| *v == self).map_or("", |i| Self::NAMES[i])
    }

    /// Returns the variant of that name, or `None` if there is none.
    fn from_name(name: &str) -> Option<Self> {
        Self::NAMES.iter().position(|n| *n == name).map(|i| Self::ALL[i])
    }
}

/// Declares a field-less enumeration and implements [`Named`] for it. A variant's name is its spelling, or the text
/// that follows as `= "name"`. With `=> method: Type` after the enumeration's name each variant also has a value of
/// that type, which the method returns.
#[macro_export]
macro_rules! named {
    (@name $variant:ident) => { stringify!($variant) };
    (@name $variant:ident $text:literal) => { $text };
    ($(#[$meta:meta])* $vis:vis enum $name:ident => $(#[$doc:meta])* $method:ident: $type:ty {
        $($(#[$vmeta:meta])* $variant:ident $(= $text:literal)? => $value:expr),+ $(,)?
    }) => {
        $crate::named! { $(#[$meta])* $vis enum $name { $($(#[$vmeta])* $variant $(= $text)?),+ } }
        impl $name {
            $(#[$doc])*
            pub fn $method(self) -> $type {
                match self { $($name::$variant => $value),+ }
            }
        }
    };
    ($(#[$meta:meta])* $vis:vis enum $name:ident { $($(#[$vmeta:meta])* $variant:ident $(= $text:literal)?),+ $(,)? }) => {
        $(#[$meta])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        $vis enum $name { $($(#[$vmeta])* $variant),+ }
        impl $crate::state::Named for $name {
            const TYPE: &'static str = stringify!($name);
            const ALL: &'static [Self] = &[$($name::$variant),+];
            const NAMES: &'static [&'static str] = &[$($crate::named!(@name $variant $($text)?)),+];
        }
    };
}
