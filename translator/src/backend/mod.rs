//! Back ends: from the checked program to text in other languages.

pub(crate) mod c;
pub(crate) mod matrix;
pub(crate) mod promela;
pub(crate) mod rust;
mod writer;
