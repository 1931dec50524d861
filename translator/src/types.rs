//! C types.

/// First words of numeric C types, including those without arithmetic support.
pub(crate) const C_NUMBERS: [&str; 18] = [
    "bool",
    "char",
    "short",
    "int",
    "long",
    "signed",
    "unsigned",
    "float",
    "double",
    "size_t",
    "ptrdiff_t",
    "wchar_t",
    "intptr_t",
    "uintptr_t",
    "intmax_t",
    "uintmax_t",
    "time_t",
    "clock_t",
];

/// The type of peers in C.
const PEER: &str = "peer_t";

/// A C type as named in the configuration.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CType {
    /// The type's name with single blanks, `unsigned int`.
    pub name: String,
    /// Operations on its values.
    pub kind: TypeKind,
}

/// Kinds of types by their operations.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TypeKind {
    /// No value.
    Void,
    /// `bool`
    Bool,
    /// Two's complement integers.
    Signed {
        /// Width in bits on the supported targets.
        bits: u32,
    },
    /// Unsigned integers.
    Unsigned {
        /// Width in bits on the supported targets.
        bits: u32,
    },
    /// `float`
    Float32,
    /// `double`
    Float64,
    /// `const char *`
    Text,
    /// A struct declared in the configuration: compared field by field.
    Struct,
    /// Any other type: can be passed on, but neither written as a constant nor compared.
    Opaque,
}

impl CType {
    /// The type named `name`, with single blanks between its words. Other names than those of C's numbers, `bool` and
    /// strings are [`TypeKind::Opaque`]: only the configuration knows its structs.
    pub fn named(name: &str) -> Self {
        let kind = match name {
            "void" => TypeKind::Void,
            "bool" | "_Bool" => TypeKind::Bool,
            "int8_t" | "signed char" => TypeKind::Signed { bits: 8 },
            "int16_t" | "short" | "short int" | "signed short" | "signed short int" => {
                TypeKind::Signed { bits: 16 }
            }
            "int32_t" | "int" | "signed" | "signed int" => TypeKind::Signed { bits: 32 },
            "int64_t"
            | "long long"
            | "long long int"
            | "signed long long"
            | "signed long long int" => TypeKind::Signed { bits: 64 },
            "uint8_t" | "unsigned char" => TypeKind::Unsigned { bits: 8 },
            "uint16_t" | "unsigned short" | "unsigned short int" => TypeKind::Unsigned { bits: 16 },
            "uint32_t" | "unsigned" | "unsigned int" => TypeKind::Unsigned { bits: 32 },
            "uint64_t" | "unsigned long long" | "unsigned long long int" => {
                TypeKind::Unsigned { bits: 64 }
            }
            "float" => TypeKind::Float32,
            "double" => TypeKind::Float64,
            "const char *" | "char const *" => TypeKind::Text,
            _ => TypeKind::Opaque,
        };
        Self { name: name.to_owned(), kind }
    }

    /// Whether it may be a type of strings, judging by its name: `name_t`, `char *`.
    pub fn may_be_text(&self) -> bool {
        let mut words = self.name.split(' ').filter(|word| *word != "const");
        match (words.next(), self.name.matches('*').count()) {
            (Some("char" | "void"), 1) => true,
            (Some("struct" | "union" | "enum" | "void" | "char"), _) => false,
            (Some(name), 0) => !C_NUMBERS.contains(&name),
            _ => false,
        }
    }

    /// Whether two values can be compared with `==`.
    pub fn has_equality(&self) -> bool {
        !matches!(self.kind, TypeKind::Void | TypeKind::Text | TypeKind::Opaque)
    }

    /// The type of peers: a number in C, and no number in the agent.
    pub fn peer() -> Self {
        Self { name: PEER.to_owned(), kind: TypeKind::Unsigned { bits: 8 } }
    }

    /// Whether it is the type of peers.
    pub fn is_peer(&self) -> bool {
        self.name == PEER && self.kind == TypeKind::Unsigned { bits: 8 }
    }

    /// Whether arithmetic is possible.
    pub fn is_numeric(&self) -> bool {
        self.is_float() || (self.integer_bits().is_some() && !self.is_peer())
    }

    /// The width of an integer type in bits, and whether it has a sign; `None` for other types.
    pub fn integer_bits(&self) -> Option<(u32, bool)> {
        match self.kind {
            TypeKind::Signed { bits } => Some((bits, true)),
            TypeKind::Unsigned { bits } => Some((bits, false)),
            _ => None,
        }
    }

    /// The lowest and the highest value of an integer type; `None` for other types.
    pub fn integer_range(&self) -> Option<(i128, i128)> {
        let (bits, signed) = self.integer_bits()?;
        Some(if signed {
            (-(1 << (bits - 1)), (1 << (bits - 1)) - 1)
        } else {
            (0, (1 << bits) - 1)
        })
    }

    /// The zero constant of the type, or the initializer that makes it; `None` for `void`.
    pub fn zero(&self) -> Option<&'static str> {
        match self.kind {
            TypeKind::Bool => Some("false"),
            TypeKind::Signed { .. } => Some("0"),
            TypeKind::Unsigned { .. } => Some("0U"),
            TypeKind::Float32 => Some("0.0F"),
            TypeKind::Float64 => Some("0.0"),
            TypeKind::Text => Some("\"\""),
            // In C this initializes any type.
            TypeKind::Struct | TypeKind::Opaque => Some("{ 0 }"),
            TypeKind::Void => None,
        }
    }

    /// Whether the type is a binary floating-point type.
    pub fn is_float(&self) -> bool {
        matches!(self.kind, TypeKind::Float32 | TypeKind::Float64)
    }

    /// The Rust type of a number or `bool`, with the same representation; `None` for other types.
    pub fn rust_name(&self) -> Option<&'static str> {
        match self.kind {
            TypeKind::Bool => Some("bool"),
            TypeKind::Signed { bits: 8 } => Some("i8"),
            TypeKind::Signed { bits: 16 } => Some("i16"),
            TypeKind::Signed { bits: 32 } => Some("i32"),
            TypeKind::Signed { .. } => Some("i64"),
            TypeKind::Unsigned { bits: 8 } => Some("u8"),
            TypeKind::Unsigned { bits: 16 } => Some("u16"),
            TypeKind::Unsigned { bits: 32 } => Some("u32"),
            TypeKind::Unsigned { .. } => Some("u64"),
            TypeKind::Float32 => Some("f32"),
            TypeKind::Float64 => Some("f64"),
            TypeKind::Void | TypeKind::Text | TypeKind::Struct | TypeKind::Opaque => None,
        }
    }
}
