//! TOML as a document.

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::document::{DEEPEST, Fault, Key, Node, Value};

/// Parse a text.
pub(super) fn parse(text: &str) -> Result<Node, Fault> {
    let table = DeTable::parse(text).map_err(|e| Fault {
        span: e.span(),
        what: e.message().trim().replace('\n', "; "),
        hint: None,
    })?;
    let value = convert_table(table.get_ref(), 0)?;
    Ok(Node { span: 0..0, value })
}

fn convert(node: &Spanned<DeValue<'_>>, depth: usize) -> Result<Node, Fault> {
    let span = node.span();
    if depth > DEEPEST {
        return Err(Fault::new(span, format!("lists and tables are nested deeper than {DEEPEST}")));
    }
    let value = match node.get_ref() {
        DeValue::String(text) => Value::Text(text.to_string()),
        DeValue::Boolean(value) => Value::Bool(*value),
        DeValue::Integer(integer) => {
            let value = i64::from_str_radix(integer.as_str(), integer.radix());
            Value::Integer(value.map_err(|_| Fault::new(span.clone(), "the number does not fit 64 bits"))?)
        }
        DeValue::Float(float) => {
            let value = float.as_str().parse();
            Value::Float(value.map_err(|_| Fault::new(span.clone(), "this is not a number"))?)
        }
        DeValue::Datetime(_) => return Err(Fault::new(span, "a scene has no dates")),
        DeValue::Array(items) => {
            Value::List(items.iter().map(|item| convert(item, depth + 1)).collect::<Result<_, _>>()?)
        }
        DeValue::Table(table) => convert_table(table, depth + 1)?,
    };
    Ok(Node { span, value })
}

fn convert_table(table: &DeTable<'_>, depth: usize) -> Result<Value, Fault> {
    let entry = |(key, value): (&Spanned<_>, &Spanned<DeValue<'_>>)| {
        let key = Key { span: key.span(), name: AsRef::<str>::as_ref(key.get_ref()).to_owned() };
        Ok((key, convert(value, depth)?))
    };
    let mut entries = table.iter().map(entry).collect::<Result<Vec<_>, _>>()?;
    // The parser sorts by name; the first fault to be told is the first of the text.
    entries.sort_by_key(|(key, _)| key.span.start);
    Ok(Value::Table(entries))
}
