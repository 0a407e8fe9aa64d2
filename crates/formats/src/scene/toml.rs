//! TOML as a document.

use toml::Spanned;
use toml::de::{DeString, DeTable, DeValue};

use super::document::{DEEPEST, Fault, Key, Node, Value};

/// Parse a text.
pub(super) fn parse(text: &str) -> Result<Node<'_>, Fault> {
    let table = DeTable::parse(text).map_err(|e| Fault {
        span: e.span(),
        what: e.message().trim().replace('\n', "; "),
        hint: None,
    })?;
    let value = convert_table(table.get_ref(), 0)?;
    Ok(Node { span: 0..0, value })
}

/// The value of a lone number, text in quotes, true or false; none if that is not all there is, or wrong.
pub(super) fn scalar(text: &str) -> Option<Value<'_>> {
    let value = convert(&DeValue::parse(text).ok()?, 0).ok()?.value;
    (!matches!(value, Value::List(_) | Value::Table(_))).then_some(value)
}

fn convert<'t>(node: &Spanned<DeValue<'t>>, depth: usize) -> Result<Node<'t>, Fault> {
    let span = node.span();
    if depth > DEEPEST {
        return Err(Fault::new(span, format!("lists and tables are nested deeper than {DEEPEST}")));
    }
    let value = match node.get_ref() {
        DeValue::String(text) => Value::Text(text.clone()),
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

fn convert_table<'t>(table: &DeTable<'t>, depth: usize) -> Result<Value<'t>, Fault> {
    let entry = |(key, value): (&Spanned<DeString<'t>>, &Spanned<DeValue<'t>>)| {
        let key = Key { span: key.span(), name: key.get_ref().clone() };
        Ok((key, convert(value, depth)?))
    };
    let mut entries = table.iter().map(entry).collect::<Result<Vec<_>, _>>()?;
    // The parser sorts by name; the first fault to be told is the first of the text.
    entries.sort_by_key(|(key, _)| key.span.start);
    Ok(Value::Table(entries))
}
