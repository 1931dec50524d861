//! Reserved names: those of C and its library, and those of generated C.
//!
//! Generated names never collide with others, because their name space is closed: such names are refused in a
//! configuration. In generated names, the user's part comes last, behind fixed words that identify its role.

/// C99 keywords, the names of `<stdbool.h>` and some that are not functions.
const WORDS: &str = "auto break case char const continue default do double else enum extern float for goto if \
    inline int long register restrict return short signed sizeof static struct switch typedef union unsigned \
    void volatile while bool true false main errno asm typeof NULL EOF BUFSIZ RAND_MAX FILE size_t ptrdiff_t \
    wchar_t wint_t max_align_t sig_atomic_t linux unix";

/// Mathematical functions; each has variants for other types, `sinf`, `sinl`.
const MATHEMATICS: &str = "acos acosh asin asinh atan atan2 atanh atol cabs cacos cacosh carg casin casinh catan catanh cbrt ccos ccosh \
    ceil cexp cimag clog clog10 conj copysign cos cosh cpow cproj creal csin csinh csqrt ctan ctanh drem erf \
    erfc exp exp10 exp2 expm1 fabs fdim ffs ffsl finite floor fma fmax fmin fmod frexp gamma hypot ilogb isinf \
    isnan j0 j1 jn ldexp lgamma llrint llround log log10 log1p log2 logb lrint lround modf nan nearbyint \
    nextafter nexttoward pow pow10 remainder remquo rint round roundeven scalb scalbln scalbn signbit \
    significand sin sincos sinh sqrt strtol strtoul tan tanh tgamma trunc wcstol wcstoul y0 y1 yn";

/// Other functions of the standard library, and builtins of compilers.
const LIBRARY: &str = "abort abs aligned_alloc alloca asctime assert at_quick_exit atexit atof atoi bcmp bcopy bsearch btowc bzero \
    calloc clearerr clock ctime dcgettext dgettext difftime div execl execle execlp execv execve execvp exit \
    fclose feclearexcept fegetenv fegetexceptflag fegetround feholdexcept feof feraiseexcept ferror fesetenv \
    fesetexceptflag fesetround fetestexcept feupdateenv fflush ffsimax fgetc fgetpos fgets fgetwc fgetws fopen \
    fork fpclassify fprintf fprintf_unlocked fputc fputc_unlocked fputs fputs_unlocked fputwc fputws fread free \
    freopen fscanf fseek fsetpos ftell fwide fwprintf fwrite fwrite_unlocked fwscanf getc getchar getenv gets \
    gettext getwc getwchar gmtime imaxabs imaxdiv index isalnum isalpha isascii isblank iscntrl isdigit isfinite \
    isgraph isgreater isgreaterequal isless islessequal islessgreater islower isnormal isprint ispunct isspace \
    isunordered isupper iswalnum iswalpha iswblank iswcntrl iswctype iswdigit iswgraph iswlower iswprint \
    iswpunct iswspace iswupper iswxdigit isxdigit labs ldiv llabs lldiv localeconv localtime longjmp malloc \
    mblen mbrlen mbrtowc mbsinit mbsrtowcs mbstowcs mbtowc memchr memcmp memcpy memmove mempcpy memset mktime \
    offsetof perror posix_memalign printf printf_unlocked putc putc_unlocked putchar putchar_unlocked puts \
    puts_unlocked putwc putwchar qsort quick_exit raise rand realloc remove rename rewind rindex scanf setbuf \
    setjmp setlocale setvbuf signal snprintf sprintf srand sscanf stderr stdin stdout stpcpy stpncpy strcasecmp \
    strcat strchr strcmp strcoll strcpy strcspn strdup strerror strfmon strftime strlen strncasecmp strncat \
    strncmp strncpy strndup strnlen strpbrk strrchr strspn strstr strtod strtof strtoimax strtok strtold \
    strtoumax strxfrm swprintf swscanf system thrd_create time tmpfile tmpnam toascii tolower toupper towctrans \
    towlower towupper ungetc ungetwc va_arg va_copy va_end va_start vfprintf vfscanf vfwprintf vfwscanf vprintf \
    vscanf vsnprintf vsprintf vsscanf vswprintf vswscanf vwprintf vwscanf wcrtomb wcscat wcschr wcscmp wcscoll \
    wcscpy wcscspn wcsftime wcslen wcsncat wcsncmp wcsncpy wcspbrk wcsrchr wcsrtombs wcsspn wcsstr wcstod wcstof \
    wcstok wcstold wcstombs wcsxfrm wctob wctomb wctrans wctype wmemchr wmemcmp wmemcpy wmemmove wmemset wprintf \
    wscanf";

/// Endings of the variants of mathematical functions.
const VARIANTS: [&str; 14] = [
    "f", "l", "f16", "f32", "f32x", "f64", "f64x", "f128", "d32", "d64", "d128", "_r", "f_r", "l_r",
];

/// Functions of the generated interface.
pub(crate) const INTERFACE: [&str; 9] = [
    "init",
    "next_step",
    "can_add_event",
    "unhandled_events",
    "refused_events",
    "aborted_events",
    "clear",
    "updateBeliefs",
    "update_beliefs",
];

/// Prefixes of interface functions that belong to a belief or goal.
pub(crate) const VERBS: [&str; 4] = ["achieve", "add", "del", "set"];

/// First words of generated names, before the first underscore; `plan` and `var` with a number.
const FIRST_WORDS: [&str; 12] = [
    "run", "post", "defer", "limit", "equal", "checked", "plan", "var", "calls", "due", "allowed",
    "any",
];

/// Other generated names: functions, types, variables, parameters.
const OWN: [&str; 9] = [
    "take_event",
    "handle_event",
    "forget_events",
    "agent_t",
    "event_t",
    "outcome_t",
    "agent",
    "self",
    "environment",
];

/// Functions of proofs, where actions have the agent's prefix: types must not have these names.
const PROOFS: [&str; 6] =
    ["base", "induction", "step", "transition", "check_invariant", "assume_invariant"];

/// Generated local variables; most of them are numbered.
const LOCALS: [&str; 14] = [
    "accepted",
    "answer",
    "answered",
    "argument",
    "changed",
    "current_time",
    "event",
    "handled",
    "holds",
    "outcome",
    "reached",
    "round",
    "slot",
    "value",
];

/// Prefixes of generated constants, and of names in programs that run the C.
const CONSTANTS: [&str; 4] = ["EVENT_", "OUTCOME_", "ASL2C_", "asl2c_"];

/// Whether C, its library or a compiler uses the name.
pub(crate) fn is_c(name: &str) -> bool {
    is_c_word(name) || is_library(name)
}

/// Whether the name has a meaning in any position, or is reserved in any: a keyword, a type or macro of the headers that
/// generated C includes, or a name that begins with an underscore.
pub fn is_c_word(name: &str) -> bool {
    let is_in = |words: &str| words.split_ascii_whitespace().any(|word| word == name);
    name.starts_with('_') || is_in(WORDS) || is_integer_type(name) || is_integer_macro(name)
}

/// Whether a function or stream of the library has the name, or a function that compilers know.
pub fn is_library(name: &str) -> bool {
    let is_in = |words: &str, name: &str| words.split_ascii_whitespace().any(|word| word == name);
    let variant =
        |ending: &&str| name.strip_suffix(ending).is_some_and(|stem| is_in(MATHEMATICS, stem));
    is_in(MATHEMATICS, name) || is_in(LIBRARY, name) || VARIANTS.iter().any(variant)
}

/// `int32_t`, `uint_fast8_t`, `intptr_t`: C reserves all names with this prefix and suffix.
fn is_integer_type(name: &str) -> bool {
    (name.starts_with("int") || name.starts_with("uint")) && name.ends_with("_t")
}

/// `INT32_MAX`, `UINT64_C`, `PTRDIFF_MIN`.
fn is_integer_macro(name: &str) -> bool {
    let begins = ["INT", "UINT", "PTRDIFF_", "SIG_ATOMIC_", "SIZE_", "WCHAR_", "WINT_"];
    let ends = ["_MAX", "_MIN", "_C", "_WIDTH"];
    begins.iter().any(|begin| name.starts_with(begin)) && ends.iter().any(|end| name.ends_with(end))
}

/// Whether generated C uses the name.
pub(crate) fn is_generated(name: &str) -> bool {
    let stem = name.trim_end_matches(|c: char| c.is_ascii_digit());
    let first =
        name.split_once('_').map(|(first, _)| first.trim_end_matches(|c: char| c.is_ascii_digit()));
    INTERFACE.contains(&name)
        || OWN.contains(&name)
        || LOCALS.contains(&stem)
        || first.is_some_and(|first| FIRST_WORDS.contains(&first) || VERBS.contains(&first))
        || CONSTANTS.iter().any(|start| name.starts_with(start))
}

/// Whether names with this prefix could be generated names: the prefix of an agent with its state passed in.
pub(crate) fn is_generated_prefix(prefix: &str) -> bool {
    let first = prefix.split('_').next().unwrap_or_default();
    let first = first.trim_end_matches(|c: char| c.is_ascii_digit());
    FIRST_WORDS.contains(&first) || CONSTANTS.iter().any(|start| prefix.starts_with(start))
}

/// Whether a type of this name would collide with a function of a proof.
pub(crate) fn is_of_proofs(name: &str) -> bool {
    PROOFS.contains(&name)
}

/// Description of the generated names, for error messages.
pub(crate) fn described() -> String {
    let listed = |words: &[&str]| words.join(", ");
    format!(
        "generated names are {}, {}, {} also with a number behind them, and those that start with {} or {} and an \
         underscore",
        listed(&INTERFACE),
        listed(&OWN),
        listed(&LOCALS),
        listed(&VERBS),
        listed(&FIRST_WORDS[..8])
    )
}

/// Keywords of Rust, including other editions and reserved words.
pub(crate) fn is_rust_word(name: &str) -> bool {
    const KEYWORDS: &str = "as break const continue crate else enum extern false fn for if impl in let loop match mod \
        move mut pub ref return self Self static struct super trait true type unsafe use where while async await dyn \
        abstract become box do final macro override priv typeof unsized virtual yield try gen union raw safe";
    KEYWORDS.split_ascii_whitespace().any(|word| word == name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_c_has_is_known() {
        for name in [
            "goto",
            "uint32_t",
            "INT32_MAX",
            "UINT8_C",
            "printf",
            "sinl",
            "log10f",
            "_x",
            "size_t",
            "memcpy",
            "time",
        ] {
            assert!(is_c(name), "{name}");
        }
        for name in ["sendLand", "land", "interval", "sinus", "INTERVAL", "maximum"] {
            assert!(!is_c(name), "{name}");
        }
    }

    #[test]
    fn what_is_generated_is_known() {
        for name in [
            "init",
            "agent_t",
            "EVENT_NONE",
            "ASL2C_A_H",
            "run_achieve_g",
            "plan12_achieve_g",
            "value1",
            "var2_X",
            "achieve_g",
            "outcome",
        ] {
            assert!(is_generated(name), "{name}");
        }
        for name in [
            "left", "step", "runner", "planner", "variance", "sendLand", "valued", "leftover",
            "adder",
        ] {
            assert!(!is_generated(name), "{name}");
        }
        assert!(is_generated_prefix("run_") && is_generated_prefix("plan1_x_"));
        assert!(!is_generated_prefix("pilot_") && !is_generated_prefix("runner_"));
    }
}
