//! Typed access to the tables of a TOML file, with errors that say where.

use std::{fmt::Display, sync::Arc};

use glam::{Vec2, Vec3};
use toml::{
    Spanned,
    de::{DeTable, DeValue},
};

use super::overrides::Override;
use crate::{Error, Location, error::suggestion};

/// A parsed TOML file, with overrides.
pub(super) struct Document<'d> {
    file: Arc<str>,
    text: &'d str,
    /// Their values stand at the places that follow the end of the text, one each.
    overrides: &'d [Override],
    root: Spanned<DeTable<'d>>,
}

impl<'d> Document<'d> {
    pub(super) fn parse(text: &'d str, file: &str, overrides: &'d [Override]) -> Result<Self, Error> {
        let file: Arc<str> = file.into();
        let mut root = DeTable::parse(text).map_err(|error| {
            let at = location(&file, text, error.span().map_or(0, |span| span.start));
            Error::Syntax { at, problem: error.message().to_owned() }
        })?;
        for (number, changed) in overrides.iter().enumerate() {
            changed.apply(&mut root, text.len() + 1 + number)?;
        }
        Ok(Self { file, text, overrides, root })
    }

    pub(super) fn root(&'d self) -> Table<'d> {
        Table { document: self, entries: self.root.get_ref(), name: "the scene file".to_owned(), start: 0 }
    }

    /// The line and column of a byte of the text, or the override that stands for it.
    fn location(&self, offset: usize) -> Location {
        let beyond = offset.checked_sub(self.text.len() + 1);
        match beyond.and_then(|number| self.overrides.get(number)) {
            Some(changed) => Location { file: format!("the override {changed}").into(), line: 0, column: 0 },
            None => location(&self.file, self.text, offset),
        }
    }
}

/// The line and column of a byte of the text.
fn location(file: &Arc<str>, text: &str, offset: usize) -> Location {
    let before = text.get(..offset).unwrap_or(text);
    let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
    Location {
        file: Arc::clone(file),
        line: before.matches('\n').count() as u32 + 1,
        column: before[line_start..].chars().count() as u32 + 1,
    }
}

/// A table of the file, under the name that messages give it.
#[derive(Clone)]
pub(super) struct Table<'d> {
    document: &'d Document<'d>,
    entries: &'d DeTable<'d>,
    name: String,
    start: usize,
}

impl<'d> Table<'d> {
    /// The name that messages give the table.
    pub(super) fn name(&self) -> &str {
        &self.name
    }

    /// Where the table begins.
    pub(super) fn location(&self) -> Location {
        self.document.location(self.start)
    }

    /// Where a key stands, or the table if it has no such key.
    pub(super) fn location_of(&self, key: &str) -> Location {
        let offset = self.entries.iter().find(|(name, _)| name.get_ref() == key).map(|(name, _)| name.span().start);
        self.document.location(offset.unwrap_or(self.start))
    }

    /// Appends to the name that messages give the table.
    pub(super) fn describe(&mut self, description: &str) {
        self.name += description;
    }

    /// Refuses the first key that is not among those known.
    pub(super) fn allow_only(&self, known: &[&str]) -> Result<(), Error> {
        let unknown = self.entries.keys().filter(|key| !known.contains(&key.get_ref().as_ref()));
        let Some(key) = unknown.min_by_key(|key| key.span().start) else { return Ok(()) };
        Err(Error::UnknownKey {
            at: self.document.location(key.span().start),
            table: self.name.clone(),
            key: key.get_ref().to_string(),
            help: suggestion(key.get_ref(), known, "keys"),
        })
    }

    pub(super) fn get(&self, key: &str) -> Option<Entry<'d>> {
        let (name, value) = self.entries.iter().find(|(name, _)| name.get_ref() == key)?;
        Some(self.entry(name, value))
    }

    pub(super) fn require(&self, key: &'static str, expected: &'static str) -> Result<Entry<'d>, Error> {
        self.get(key).ok_or_else(|| Error::MissingKey { at: self.location(), table: self.name.clone(), key, expected })
    }

    /// The one of two keys that the table has; at least one is required.
    pub(super) fn either(
        &self,
        first: &'static str,
        second: &'static str,
        expected: &'static str,
    ) -> Result<Entry<'d>, Error> {
        match self.either_if_any(first, second)? {
            Some(entry) => Ok(entry),
            None => self.require(first, expected),
        }
    }

    /// The one of two keys that the table has, if any; both are refused.
    pub(super) fn either_if_any(&self, first: &str, second: &str) -> Result<Option<Entry<'d>>, Error> {
        match (self.get(first), self.get(second)) {
            (Some(_), Some(entry)) => Err(entry.error(format!("is set, and so is {first}; leave one of them out"))),
            (entry, other) => Ok(entry.or(other)),
        }
    }

    /// Every key, in the order of the file.
    pub(super) fn entries(&self) -> Vec<Entry<'d>> {
        let mut entries: Vec<_> = self.entries.iter().collect();
        entries.sort_by_key(|(name, _)| name.span().start);
        entries.into_iter().map(|(name, value)| self.entry(name, value)).collect()
    }

    /// An error about the table as a whole.
    pub(super) fn error(&self, problem: impl Into<String>) -> Error {
        Error::BadValue { at: self.location(), table: self.name.clone(), problem: problem.into() }
    }

    fn entry(&self, key: &'d Spanned<toml::de::DeString<'d>>, value: &'d Spanned<DeValue<'d>>) -> Entry<'d> {
        Entry { document: self.document, value, table: self.name.clone(), key: key.get_ref().to_string() }
    }
}

/// A key and its value.
#[derive(Clone)]
pub(super) struct Entry<'d> {
    document: &'d Document<'d>,
    value: &'d Spanned<DeValue<'d>>,
    table: String,
    key: String,
}

impl<'d> Entry<'d> {
    /// The key.
    pub(super) fn key(&self) -> &str {
        &self.key
    }

    /// The value as TOML has it.
    pub(super) fn value(&self) -> &'d DeValue<'d> {
        self.value.get_ref()
    }

    /// Where the value stands.
    pub(super) fn location(&self) -> Location {
        self.document.location(self.value.span().start)
    }

    /// The table and the key, as messages name them.
    pub(super) fn place(&self) -> String {
        format!("{}: {}", self.table, self.key)
    }

    /// An error about the value; the problem goes on from the key's name.
    pub(super) fn error(&self, problem: impl Display) -> Error {
        let problem = format!("{} {problem}", self.key);
        Error::BadValue { at: self.location(), table: self.table.clone(), problem }
    }

    pub(super) fn unknown_name(&self, what: &'static str, name: &str, known: &[&str], plural: &str) -> Error {
        Error::UnknownName {
            at: self.location(),
            place: self.place(),
            what,
            name: name.to_owned(),
            help: suggestion(name, known, plural),
        }
    }

    fn wrong_type(&self, expected: &'static str) -> Error {
        Error::WrongType { at: self.location(), place: self.place(), expected, found: describe(self.value.get_ref()) }
    }

    /// A finite number.
    pub(super) fn number(&self) -> Result<f32, Error> {
        self.finite("a number")
    }

    /// A finite number where a picture could stand as well.
    pub(super) fn number_without_picture(&self) -> Result<f32, Error> {
        self.finite("a number or a picture { image = \"FILE\" }")
    }

    fn finite(&self, expected: &'static str) -> Result<f32, Error> {
        let written = match self.value.get_ref() {
            DeValue::Float(float) => float.as_str(),
            DeValue::Integer(integer) if integer.radix() == 10 => integer.as_str(),
            _ => return Err(self.wrong_type(expected)),
        };
        match written.parse::<f32>() {
            Ok(number) if number.is_finite() => Ok(number),
            _ => Err(self.error(format!("is {written}; it must be finite and less than 3.4e38"))),
        }
    }

    /// A whole number that is not negative.
    pub(super) fn whole(&self) -> Result<u64, Error> {
        let expected = "a whole number, 0 or greater";
        let DeValue::Integer(integer) = self.value.get_ref() else { return Err(self.wrong_type(expected)) };
        u64::from_str_radix(integer.as_str(), integer.radix()).map_err(|_| self.wrong_type(expected))
    }

    /// A whole number of 32 bits.
    pub(super) fn whole32(&self) -> Result<u32, Error> {
        let whole = self.whole()?;
        u32::try_from(whole).map_err(|_| self.error(format!("is {whole}; it must be at most {}", u32::MAX)))
    }

    /// A whole number of 32 bits, which may be negative.
    pub(super) fn integer32(&self) -> Result<i32, Error> {
        let expected = "a whole number";
        let DeValue::Integer(integer) = self.value.get_ref() else { return Err(self.wrong_type(expected)) };
        let (least, most) = (i32::MIN, i32::MAX);
        i32::from_str_radix(integer.as_str(), integer.radix())
            .map_err(|_| self.error(format!("is {}; it must be from {least} to {most}", integer.as_str())))
    }

    /// `true` or `false`.
    pub(super) fn boolean(&self) -> Result<bool, Error> {
        self.boolean_or("true or false")
    }

    /// A switch where something else, which `expected` names as well, could stand.
    pub(super) fn boolean_or(&self, expected: &'static str) -> Result<bool, Error> {
        let DeValue::Boolean(boolean) = self.value.get_ref() else { return Err(self.wrong_type(expected)) };
        Ok(*boolean)
    }

    /// Three numbers.
    pub(super) fn vector(&self) -> Result<Vec3, Error> {
        self.three("3 numbers [x, y, z]")
    }

    /// Three numbers, or one that stands for all three.
    pub(super) fn color(&self) -> Result<Vec3, Error> {
        self.one_or_three("a colour: 3 numbers [r, g, b] or one number for gray")
    }

    /// Three numbers, or one that stands for all three, where a picture could stand as well.
    pub(super) fn color_without_picture(&self) -> Result<Vec3, Error> {
        self.one_or_three("a colour: 3 numbers [r, g, b], one number for gray or a picture { image = \"FILE\" }")
    }

    /// Two numbers.
    pub(super) fn pair(&self) -> Result<Vec2, Error> {
        self.numbers("2 numbers [u, v]").map(Vec2::from_array)
    }

    /// Two numbers, or one that stands for both.
    pub(super) fn one_or_pair(&self) -> Result<Vec2, Error> {
        let expected = "one number or 2 numbers [u, v]";
        match self.value.get_ref() {
            DeValue::Array(_) => self.numbers(expected).map(Vec2::from_array),
            _ => self.finite(expected).map(Vec2::splat),
        }
    }

    /// A factor for each axis, or one for all of them.
    pub(super) fn scale(&self) -> Result<Vec3, Error> {
        self.one_or_three("one number or 3 numbers [x, y, z]")
    }

    fn one_or_three(&self, expected: &'static str) -> Result<Vec3, Error> {
        match self.value.get_ref() {
            DeValue::Array(_) => self.three(expected),
            _ => self.finite(expected).map(Vec3::splat),
        }
    }

    fn three(&self, expected: &'static str) -> Result<Vec3, Error> {
        self.numbers(expected).map(Vec3::from_array)
    }

    fn numbers<const N: usize>(&self, expected: &'static str) -> Result<[f32; N], Error> {
        let elements = match self.value.get_ref() {
            DeValue::Array(array) if array.len() == N => self.elements(expected)?,
            _ => return Err(self.wrong_type(expected)),
        };
        let mut numbers = [0.0; N];
        for (number, element) in numbers.iter_mut().zip(elements) {
            *number = element.number()?;
        }
        Ok(numbers)
    }

    pub(super) fn string(&self, expected: &'static str) -> Result<&'d str, Error> {
        self.value.get_ref().as_str().ok_or_else(|| self.wrong_type(expected))
    }

    /// What one of a few names stands for.
    pub(super) fn choice<T: Copy>(&self, what: &'static str, options: &[(&'static str, T)]) -> Result<T, Error> {
        let known: Vec<_> = options.iter().map(|(name, _)| *name).collect();
        let name = self.string("a string")?;
        let chosen = options.iter().find(|(option, _)| *option == name).map(|(_, meaning)| *meaning);
        chosen.ok_or_else(|| self.unknown_name(what, name, &known, "names"))
    }

    pub(super) fn elements(&self, expected: &'static str) -> Result<Vec<Self>, Error> {
        let array = self.value.get_ref().as_array().ok_or_else(|| self.wrong_type(expected))?;
        let element = |(index, value)| Self { value, key: format!("{}[{index}]", self.key), ..self.clone() };
        Ok(array.iter().enumerate().map(element).collect())
    }

    /// Whether the value is an array.
    pub(super) fn is_array(&self) -> bool {
        self.value.get_ref().is_array()
    }

    /// Whether the value is a table.
    pub(super) fn is_table(&self) -> bool {
        self.value.get_ref().is_table()
    }

    /// Whether the value is a table with this key.
    pub(super) fn is_table_with(&self, key: &str) -> bool {
        self.value.get_ref().as_table().is_some_and(|entries| entries.keys().any(|name| name.get_ref() == key))
    }

    /// The table that is the value, under the given name.
    pub(super) fn table(&self, name: String, expected: &'static str) -> Result<Table<'d>, Error> {
        let entries = self.value.get_ref().as_table().ok_or_else(|| self.wrong_type(expected))?;
        Ok(Table { document: self.document, entries, name, start: self.value.span().start })
    }
}

/// A TOML value, as messages name what they found.
fn describe(value: &DeValue<'_>) -> String {
    match value {
        DeValue::String(string) => format!("the string {string:?}"),
        DeValue::Integer(integer) => format!("the whole number {integer}"),
        DeValue::Float(float) => format!("the number {float}"),
        DeValue::Boolean(boolean) => boolean.to_string(),
        DeValue::Datetime(_) => "a date".to_owned(),
        DeValue::Array(array) => format!("an array of {}", array.len()),
        DeValue::Table(_) => "a table".to_owned(),
    }
}
