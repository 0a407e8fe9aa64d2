//! Changes to a text that leave every other byte where it is.

use super::literal;
use crate::scene::document::{Fault, Node, Span, Value};

/// Changes to a TOML text, made all at once.
#[derive(Debug)]
pub(super) struct Patch<'a> {
    text: &'a str,
    /// Ranges of the text and what to put there; empty ranges insert.
    splices: Vec<(Span, String)>,
    /// Empty inline tables, and what to put into them.
    filled: Vec<(Span, Vec<String>)>,
}

/// How a table is written down.
enum Form {
    /// `[name]` or `[[name]]` above its keys.
    Header,
    /// `{ key = value }`.
    Inline,
    /// Only as a part of the names of others: `name.key = value` or `[name.other]`.
    Implied,
}

impl<'a> Patch<'a> {
    pub(super) fn new(text: &'a str) -> Self {
        Self { text, splices: Vec::new(), filled: Vec::new() }
    }

    /// The changed text.
    pub(super) fn apply(mut self) -> String {
        let filled = self.filled.into_iter().map(|(span, entries)| (span, format!("{{ {} }}", entries.join(", "))));
        self.splices.extend(filled);
        // Stable: what is inserted at one place keeps its order, and comes before what is replaced there.
        self.splices.sort_by_key(|(span, _)| (span.start, span.end));
        let (mut out, mut done) = (String::with_capacity(self.text.len()), 0);
        for (span, new) in self.splices {
            out.push_str(&self.text[done..span.start]);
            out.push_str(&new);
            done = span.end;
        }
        out.push_str(&self.text[done..]);
        out
    }

    /// Give a key of a table another value.
    pub(super) fn set(&mut self, table: &Node<'_>, key: &str, value: String) -> Result<(), Fault> {
        match table.get(key) {
            None => self.insert(table, key, &value),
            Some(old) if matches!(self.form(old), Some(Form::Header | Form::Implied)) => {
                let what =
                    format!("{} is a section of its own and cannot be written back as {value}", literal::key(key));
                Err(Fault::new(old.span.clone(), what))
            }
            Some(old) => {
                self.splices.push((old.span.clone(), value));
                Ok(())
            }
        }
    }

    /// Replace one value by another.
    pub(super) fn replace(&mut self, node: &Node<'_>, value: String) {
        self.splices.push((node.span.clone(), value));
    }

    /// Append a section at the end of the text.
    pub(super) fn append(&mut self, header: &str, entries: &[(&str, String)]) {
        let (end, newline) = (self.text.len(), self.newline());
        let first = if self.text.is_empty() || self.text.ends_with('\n') { "" } else { newline };
        self.splices.push((end..end, format!("{first}{newline}{}", self.section(header, entries))));
    }

    /// Insert a section below another one.
    pub(super) fn insert_after(
        &mut self,
        table: &Node<'_>,
        header: &str,
        entries: &[(&str, String)],
    ) -> Result<(), Fault> {
        let end = self.lines(table)?.end;
        let newline = self.newline();
        let section = self.section(header, entries);
        self.splices.push((end..end, format!("{newline}{newline}{}", section.trim_end())));
        Ok(())
    }

    /// Insert a section above another one.
    pub(super) fn insert_before(
        &mut self,
        table: &Node<'_>,
        header: &str,
        entries: &[(&str, String)],
    ) -> Result<(), Fault> {
        let start = self.lines(table)?.start;
        self.splices.push((start..start, format!("{}{}", self.section(header, entries), self.newline())));
        Ok(())
    }

    /// Remove a section: all lines from its header to its last key, and one that is blank below.
    pub(super) fn remove(&mut self, table: &Node<'_>) -> Result<(), Fault> {
        let Span { start, mut end } = self.lines(table)?;
        for _ in 0..2 {
            let next = self.text[end..].strip_prefix("\r\n").or_else(|| self.text[end..].strip_prefix('\n'));
            end = next.map_or(end, |rest| self.text.len() - rest.len());
        }
        self.splices.push((start..end, String::new()));
        Ok(())
    }

    /// The lines from the header of a section to its last key, without the last line break.
    fn lines(&self, table: &Node<'_>) -> Result<Span, Fault> {
        let (Some(Form::Header), Value::Table(entries)) = (self.form(table), &table.value) else {
            let what = "this is not a section with a header of its own: nothing is added or removed beside it";
            return Err(Fault::new(table.span.clone(), what));
        };
        let start = self.text[..table.span.start].rfind('\n').map_or(0, |newline| newline + 1);
        let end = entries.iter().map(|(_, node)| self.end(node)).max().unwrap_or(table.span.end);
        Ok(start..self.line_end(end))
    }

    fn section(&self, header: &str, entries: &[(&str, String)]) -> String {
        let newline = self.newline();
        let entries: String = entries.iter().map(|(key, value)| format!("{key} = {value}{newline}")).collect();
        format!("{header}{newline}{entries}")
    }

    /// How a node is written if it is a table.
    fn form(&self, node: &Node<'_>) -> Option<Form> {
        let Value::Table(_) = node.value else { return None };
        Some(match self.text[node.span.clone()].as_bytes().first() {
            Some(b'[') => Form::Header,
            Some(b'{') => Form::Inline,
            _ => Form::Implied,
        })
    }

    fn insert(&mut self, table: &Node<'_>, key: &str, value: &str) -> Result<(), Fault> {
        let entry = format!("{} = {value}", literal::key(key));
        // Sections below the table come after its own keys.
        let entries: &[_] = if let Value::Table(entries) = &table.value { entries } else { &[] };
        let own = entries.iter().filter(|(_, node)| !self.is_section(node));
        let last = own.max_by_key(|(_, node)| self.end(node));
        let splice = match (self.form(table), last) {
            (Some(Form::Inline), Some((_, node))) => (self.end(node), format!(", {entry}")),
            (Some(Form::Inline), None) => {
                self.fill(&table.span, entry);
                return Ok(());
            }
            (Some(Form::Header), Some((first, node))) => {
                (self.line_end(self.end(node)), format!("{}{}{entry}", self.newline(), self.indent(first.span.start)))
            }
            (Some(Form::Header), None) => (self.line_end(table.span.end), format!("{}{entry}", self.newline())),
            (Some(Form::Implied) | None, _) => {
                let what = format!("this is not a section to which {} can be added", literal::key(key));
                return Err(Fault::new(table.span.clone(), what).hint(Some(format!("add {entry} by hand"))));
            }
        };
        self.splices.push((splice.0..splice.0, splice.1));
        Ok(())
    }

    /// Put an entry into an empty inline table.
    fn fill(&mut self, table: &Span, entry: String) {
        match self.filled.iter_mut().find(|(span, _)| span == table) {
            Some((_, entries)) => entries.push(entry),
            None => self.filled.push((table.clone(), vec![entry])),
        }
    }

    /// True for `[table.node]` and `[[table.node]]`.
    fn is_section(&self, node: &Node<'_>) -> bool {
        match &node.value {
            Value::List(items) => items.first().is_some_and(|item| matches!(self.form(item), Some(Form::Header))),
            Value::Table(entries) => match self.form(node) {
                Some(Form::Header) => true,
                Some(Form::Implied) => entries.iter().any(|(_, node)| self.is_section(node)),
                _ => false,
            },
            _ => false,
        }
    }

    /// Where what is written of a node ends.
    fn end(&self, node: &Node<'_>) -> usize {
        match (&node.value, self.form(node)) {
            (Value::Table(entries), Some(Form::Implied)) => {
                entries.iter().map(|(_, node)| self.end(node)).max().unwrap_or(node.span.end)
            }
            _ => node.span.end,
        }
    }

    /// The end of the line of the byte `at`, before its line break.
    fn line_end(&self, at: usize) -> usize {
        let rest = &self.text[at..];
        let line = rest.find('\n').map_or(rest, |end| &rest[..end]);
        at + line.strip_suffix('\r').unwrap_or(line).len()
    }

    fn newline(&self) -> &'static str {
        if self.text.contains("\r\n") { "\r\n" } else { "\n" }
    }

    /// The blanks before the byte `at`, if nothing else stands before it in its line.
    fn indent(&self, at: usize) -> &'a str {
        let start = self.text[..at].rfind('\n').map_or(0, |newline| newline + 1);
        let before = &self.text[start..at];
        if before.trim().is_empty() { before } else { "" }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::toml::parse;

    /// `text` after `a.b` (or the root's `b` if `a` is empty) was set to 7.
    fn set(text: &str, a: &str) -> Result<String, Fault> {
        let document = parse(text).unwrap();
        let table = document.get(a).unwrap();
        let mut patch = Patch::new(text);
        patch.set(table, "b", "7".to_owned())?;
        let text = patch.apply();
        let document = parse(&text).unwrap();
        let number = document.get(a).and_then(|a| a.get("b")).map(|b| &b.value);
        assert_eq!(number, Some(&Value::Integer(7)), "{text}");
        Ok(text)
    }

    #[test]
    fn values_are_replaced_where_they_are() {
        for (before, after) in [
            ("[a]\nb = 1 # one\nc = 2\n", "[a]\nb = 7 # one\nc = 2\n"),
            ("a = { c = 2, b=[1,\n 2] } # x", "a = { c = 2, b=7 } # x"),
            ("a.b = 'x'\r\na.c = 1\r\n", "a.b = 7\r\na.c = 1\r\n"),
            ("[a]\nb = { x = 1 }\n", "[a]\nb = 7\n"),
            ("[a]\n\"b\" = 1", "[a]\n\"b\" = 7"),
        ] {
            assert_eq!(set(before, "a").unwrap(), after);
        }
    }

    #[test]
    fn new_keys_go_below_the_last_of_their_section() {
        for (before, after) in [
            ("[a]", "[a]\nb = 7"),
            ("[a] # empty\n\n[c]\n", "[a] # empty\nb = 7\n\n[c]\n"),
            ("[a]\nc = 1 # one\n# about d\n[d]\n", "[a]\nc = 1 # one\nb = 7\n# about d\n[d]\n"),
            ("[a]\r\n  c = 1\r\n\r\n[d]\r\n", "[a]\r\n  c = 1\r\n  b = 7\r\n\r\n[d]\r\n"),
            ("[a]\nc = [\n  1,\n]\n[a.d]\ne = 1\n", "[a]\nc = [\n  1,\n]\nb = 7\n[a.d]\ne = 1\n"),
            ("[a]\nc.x = 1\nc.y = 2\n", "[a]\nc.x = 1\nc.y = 2\nb = 7\n"),
            ("a = {}\n", "a = { b = 7 }\n"),
            ("a = { c = 1 }\n", "a = { c = 1, b = 7 }\n"),
            ("a = { c = 1, d = { e = 2 } } # x\n", "a = { c = 1, d = { e = 2 }, b = 7 } # x\n"),
        ] {
            assert_eq!(set(before, "a").unwrap(), after, "{before}");
        }
    }

    #[test]
    fn what_has_no_place_is_refused() {
        for text in ["a.c = 1\n", "[a.b]\nc = 1\n", "[a.c]\nx = 1\n"] {
            assert!(set(text, "a").is_err(), "{text}");
        }
    }

    #[test]
    fn one_place_takes_several() {
        for (before, after) in [("a = {}\n", "a = { b = 7, c = 8 }\n"), ("[a]\nx = 1", "[a]\nx = 1\nb = 7\nc = 8")] {
            let document = parse(before).unwrap();
            let mut patch = Patch::new(before);
            for (key, value) in [("b", "7"), ("c", "8")] {
                patch.set(document.get("a").unwrap(), key, value.to_owned()).unwrap();
            }
            assert_eq!(patch.apply(), after);
        }
    }

    #[test]
    fn sections_are_appended() {
        for (before, after) in
            [("", "\n[s]\nb = 7\n"), ("x = 1", "x = 1\n\n[s]\nb = 7\n"), ("x = 1\r\n", "x = 1\r\n\r\n[s]\r\nb = 7\r\n")]
        {
            let mut patch = Patch::new(before);
            patch.append("[s]", &[("b", "7".to_owned())]);
            assert_eq!(patch.apply(), after);
        }
    }
}
