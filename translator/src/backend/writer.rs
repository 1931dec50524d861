//! Lines with indentation.

/// Collects lines of generated text with their indentation.
#[derive(Debug, Default)]
pub(super) struct Writer {
    text: String,
    depth: usize,
}

impl Writer {
    /// One line at the current depth; an empty one stays empty.
    pub(super) fn line(&mut self, line: impl AsRef<str>) {
        let line = line.as_ref();
        if !line.is_empty() {
            self.text.extend(std::iter::repeat_n("    ", self.depth));
            self.text.push_str(line);
        }
        self.text.push('\n');
    }

    /// `head` on a line, then `{` on its own, then one level deeper.
    pub(super) fn open(&mut self, head: impl AsRef<str>) {
        self.line(head);
        self.line("{");
        self.depth += 1;
    }

    /// `{` on its own, then one level deeper.
    pub(super) fn open_bare(&mut self) {
        self.line("{");
        self.depth += 1;
    }

    /// `head {` on one line, as Rust has it.
    pub(super) fn open_here(&mut self, head: impl AsRef<str>) {
        self.line(format!("{} {{", head.as_ref()));
        self.depth += 1;
    }

    /// `head [` on one line.
    pub(super) fn open_array(&mut self, head: impl AsRef<str>) {
        self.line(format!("{} [", head.as_ref()));
        self.depth += 1;
    }

    /// One level back and the closing line.
    pub(super) fn close(&mut self, closing: &str) {
        self.depth -= 1;
        self.line(closing);
    }

    /// Indents the following lines without braces, for the labels of a `switch`.
    pub(super) fn indent(&mut self) {
        self.depth += 1;
    }

    /// Ends the indentation of [`Self::indent`].
    pub(super) fn dedent(&mut self) {
        self.depth -= 1;
    }

    pub(super) fn finish(self) -> String {
        self.text
    }
}
