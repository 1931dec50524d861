//! Headers of an agent's own: declarations, and nothing that is another text for another compiler.
#![forbid(unsafe_code)]

use judged_c::{Rule, judge_header};

fn judged(header: &str) -> Result<(), Rule> {
    let used: std::collections::HashSet<String> =
        ["on", "own_t", "value"].map(str::to_owned).into();
    judge_header(header, &used).map_err(|refused| refused.rule)
}

#[test]
fn declarations_are_of_the_language() {
    for header in [
        "",
        "/* nothing */\n// http://example.org\n",
        "typedef int16_t own_t;",
        "#pragma once\n#include <stdint.h>\n# include \"sub/more.h\"\ntypedef uint8_t own_t;\n",
        "/* It is guarded. */\n#ifndef __OWN_H__\n#define __OWN_H__\ntypedef float own_t;\n#endif /* __OWN_H__ */\n",
        "#ifndef OWN\n#define OWN\n#endif",
        "#ifdef __cplusplus\nextern \"C\" {\n#endif\nint other(const own_t *of, ...);\n#ifdef __cplusplus\n}\n#endif\n",
        "enum { UP = 0x10, DOWN = 1 << 3 | 2 };\nextern volatile int ext;\nstatic const float K[2] = { 1.5f, 2e-3L };",
        "typedef struct { int16_t a : 3; union { double x; char *y; } b[4]; } own_t;",
        "typedef void (*callback_t)(int value, own_t);\nstruct s;\ntypedef struct s *own_t;",
        "#define MOST 0x7FUL\n#define HALF (-(MOST + 1) / 2)\n#define NAME \"lamp\"\n#define EMPTY\nint more[MOST];",
    ] {
        assert_eq!(judged(header), Ok(()), "{header}");
    }
}

#[test]
fn what_depends_on_the_reader_or_changes_what_follows_is_refused() {
    for (rule, headers) in [
        (
            Rule::Directive,
            &[
                "#ifndef __CPROVER__\n#define on off\n#endif",
                "#ifdef __CPROVER__\ntypedef int own_t;\n#endif",
                "#if 1\n#endif",
                "#ifndef OWN\n#define OTHER\n#endif",
                "#ifndef OWN\n#define OWN\n#endif\nint x;",
                "int x;\n#ifndef OWN\n#define OWN\n#endif",
                "#ifndef __OPTIMIZE__\n#define __OPTIMIZE__\n#endif",
                "#ifndef OWN\n#define OWN\n#else\nint x;\n#endif",
                "#undef EOF",
                "#pragma pack(1)",
                "#pragma redefine_extname on off",
                "#line 3",
                "#error no",
                "#include NAME",
                "#include <a.h> int x;",
                "#ifdef __cplusplus\n#else\nint x;\n#endif",
                "#ifdef __cplusplus\nint x;",
                "typedef struct {\n#define X 1\nint x; } own_t;",
            ][..],
        ),
        (
            Rule::Define,
            &[
                "#define X(a) a",
                "#define X() 1",
                "#define X int",
                "#define int32_t int",
                "#define X { 1 }",
                "#define X 1;",
                "#define X _Pragma(\"x\")",
                "#define __OPTIMIZE__ 1",
            ],
        ),
        (
            Rule::Header,
            &[
                "static inline int own(void) { return 1; }",
                "int own(void) { return 1; }",
                "int on(void) __asm__(\"off\");",
                "__attribute__((const)) int own(void);",
                "_Pragma(\"weak on\")",
                "asm(\".globl x\");",
                "typedef int own_t",
                "static",
                "static const int x = ({ 1; });",
                "int x; }",
                "typedef struct { int x; own_t;",
                "(int x);",
                "; typedef int x;",
                "typedef _Float128 own_t;",
                "int x = 1, goto;",
            ],
        ),
        (
            Rule::Used,
            &[
                "static void on(void);",
                "extern int value;",
                "int x, on;",
                "static const int value[1] = { 1 };",
                "typedef unsigned char uint32_t;",
                "typedef int x, int8_t;",
            ],
        ),
        (Rule::Comment, &["/* *\\\n/ #define on off\n/* */", "// a \\\nb", "//* x */ int y;"]),
        (Rule::Preprocessor, &["#define X a ## b", "int x; #define on off"]),
        (Rule::Trigraph, &["??=define on off"]),
        (Rule::Digraph, &["%:define on off"]),
        (Rule::LineEnd, &["int x;\r\n", "/* x\r\n*/"]),
        (Rule::Character, &["#define X \\\n 1", "#define on\u{e9} off"]),
        (Rule::Open, &["#define X 1 /* on\n*/"]),
    ] {
        for header in headers {
            assert_eq!(judged(header), Err(rule), "{header}");
        }
    }
}
