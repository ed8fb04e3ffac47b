//! Values of optional keys, and values that need not be written.

/// Whether a value need not be written, since it is what an absent key means.
pub(super) fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}

/// Writes a method for each optional key: its value, or the default that its schema names too.
macro_rules! or_default {
    (impl $settings:ty { $($key:ident: $type:ty = $default:expr;)* }) => {
        impl $settings {
            $(
                #[doc = concat!("`", stringify!($key), "`, or its default.")]
                pub fn $key(&self) -> $type {
                    self.$key.unwrap_or($default)
                }
            )*
        }
    };
}

pub(super) use or_default;
