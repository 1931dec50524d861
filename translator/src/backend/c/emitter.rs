//! Incremental output of one plan: open blocks, locals and temporaries.

use super::helpers::Helpers;
use super::locals::{Local, Locals};
use super::names::{Names, constant, typed};
use super::spelling::parenthesised;
use crate::backend::writer::Writer;
use crate::program::{Plan, Program};
use crate::types::{CType, TypeKind};

/// Writes one plan. Each condition, and each formula that can fail, opens a block that stays open to the end
/// of the plan, so that every variable is a constant initialised where it is bound.
pub(super) struct PlanEmitter<'a> {
    pub(super) program: &'a Program,
    pub(super) names: &'a Names,
    pub(super) helpers: &'a mut Helpers,
    pub(super) plan: &'a Plan,
    pub(super) writer: Writer,
    /// Number of open blocks: of the plan, or of the current alternative or negation.
    pub(super) blocks: usize,
    /// Number of enclosing alternatives and negations.
    pub(super) level: usize,
    temporaries: usize,
    locals: Locals,
}

/// Maximum nesting of blocks before all are closed. C99 guarantees 127 levels, of which an alternative or
/// negation can take three.
const MOST_BLOCKS: usize = 16;
/// The same inside an alternative or a negation.
const MOST_BLOCKS_WITHIN: usize = 3;

impl<'a> PlanEmitter<'a> {
    pub(super) fn new(
        program: &'a Program,
        names: &'a Names,
        helpers: &'a mut Helpers,
        plan: &'a Plan,
    ) -> Self {
        let mut writer = Writer::default();
        writer.indent();
        let locals = Locals::default();
        Self { program, names, helpers, plan, writer, blocks: 0, level: 0, temporaries: 0, locals }
    }

    /// Opens a block with a condition.
    pub(super) fn open(&mut self, condition: &str) {
        let most = if self.level == 0 { MOST_BLOCKS } else { MOST_BLOCKS_WITHIN };
        if self.blocks >= most {
            self.flatten();
        }
        self.writer.open(format!("if {}", parenthesised(condition)));
        self.blocks += 1;
    }

    /// Closes all blocks and continues in one block whose condition is that all conditions held.
    pub(super) fn flatten(&mut self) {
        let reached = self.temporary("reached");
        self.writer.line(format!("{reached} = true;"));
        self.close_blocks();
        self.locals.before(format!("bool {reached} = false;"));
        self.writer.open(format!("if ({reached})"));
        self.blocks = 1;
    }

    /// A local constant.
    pub(super) fn constant(&mut self, ctype: &CType, name: &str, value: &str) {
        let local = Local {
            name: name.to_owned(),
            constant: constant(ctype, name),
            plain: typed(ctype, name),
            start: ctype.zero().unwrap_or("{ 0 }").to_owned(),
            value: Some(value.to_owned()),
        };
        self.local(local);
    }

    /// A local that is changed later.
    pub(super) fn variable(&mut self, ctype: &str, name: &str, start: &str) {
        let ctype = CType { name: ctype.to_owned(), kind: TypeKind::Opaque };
        let local = Local {
            name: name.to_owned(),
            constant: String::new(),
            plain: typed(&ctype, name),
            start: start.to_owned(),
            value: None,
        };
        self.local(local);
    }

    fn local(&mut self, local: Local) {
        let line = self.locals.add(local);
        self.writer.line(line);
    }

    pub(super) fn close_blocks(&mut self) {
        for _ in 0..std::mem::take(&mut self.blocks) {
            self.writer.close("}");
        }
    }

    pub(super) fn temporary(&mut self, stem: &str) -> String {
        self.temporaries += 1;
        format!("{stem}{}", self.temporaries)
    }

    /// The text, with all blocks closed and locals declared where C99 requires it.
    pub(super) fn finish(mut self) -> String {
        self.close_blocks();
        self.locals.resolve(&self.writer.finish())
    }
}
