//! The lines of MTL that name pictures.

use glam::Vec2;

use super::entry::number;

/// A picture as an MTL file names it.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Map {
    /// The name of its file.
    pub(super) file: String,
    /// `-s`: how often it is repeated along u and v.
    pub(super) scale: Vec2,
    /// `-o`: by how much texture coordinates are moved, in pictures.
    pub(super) offset: Vec2,
    /// `-clamp on`.
    pub(super) is_clamped: bool,
    /// `-bm`: factor on a normal map's tilt.
    pub(super) strength: f32,
    /// `-imfchan`: the channel, from 0, that a number is read from.
    pub(super) channel: Option<usize>,
}

/// The picture that stands after a keyword: options, and a file's name that may have spaces.
///
/// # Errors
/// What is wrong with the line.
pub(super) fn read_map(keyword: &str, text: &str) -> Result<Map, String> {
    let mut map = Map {
        file: String::new(),
        scale: Vec2::ONE,
        offset: Vec2::ZERO,
        is_clamped: false,
        strength: 1.0,
        channel: None,
    };
    let mut rest = text.trim();
    while let Some((option, after)) = split_word(rest).filter(|(word, _)| is_option(word)) {
        let option_name = format!("{keyword} {option}");
        rest = match option {
            "-s" => {
                let (scale, after) = vector(&option_name, after, Vec2::ONE)?;
                if scale.cmpeq(Vec2::ZERO).any() {
                    return Err(format!("{option_name} with 0; a scale must not be 0"));
                }
                map.scale = scale;
                after
            }
            "-o" => {
                let (offset, after) = vector(&option_name, after, Vec2::ZERO)?;
                map.offset = offset;
                after
            }
            "-t" => vector(&option_name, after, Vec2::ZERO)?.1,
            _ => {
                let (value, after) = split_word(after).unwrap_or_default();
                map.set(&option_name, option, value)?;
                if option == "-mm" { split_word(after).unwrap_or_default().1 } else { after }
            }
        };
    }
    if rest.is_empty() {
        return Err(format!("{keyword} without the name of a picture"));
    }
    map.file = rest.trim_matches('"').replace('\\', "/");
    Ok(map)
}

impl Map {
    fn set(&mut self, option_name: &str, option: &str, value: &str) -> Result<(), String> {
        match option {
            "-clamp" => self.is_clamped = value == "on",
            "-bm" => self.strength = number(option_name, &[value], f32::MIN..=f32::MAX)?,
            "-imfchan" => {
                let channels = [("r", 0), ("g", 1), ("b", 2), ("m", 3), ("l", 0), ("z", 0)];
                let known = channels.iter().find(|(name, _)| *name == value);
                self.channel =
                    Some(known.ok_or_else(|| format!("{option_name} with {value:?}; it takes r, g, b, m, l or z"))?.1);
            }
            _ => {}
        }
        Ok(())
    }
}

/// Those of one value, of two, or of up to three.
fn is_option(word: &str) -> bool {
    let known = ["-blendu", "-blendv", "-boost", "-cc", "-clamp", "-texres", "-type", "-bm", "-imfchan", "-mm"];
    known.contains(&word) || ["-s", "-o", "-t"].contains(&word)
}

/// Up to three numbers, of which the first two count.
fn vector<'a>(option_name: &str, text: &'a str, default: Vec2) -> Result<(Vec2, &'a str), String> {
    let mut numbers = Vec::new();
    let mut rest = text;
    while let Some((word, after)) =
        split_word(rest).filter(|(word, _)| numbers.len() < 3 && word.parse::<f32>().is_ok())
    {
        numbers.push(number(option_name, &[word], f32::MIN..=f32::MAX)?);
        rest = after;
    }
    match numbers[..] {
        [] => Err(format!("{option_name} without a number")),
        [u] => Ok((Vec2::new(u, default.y), rest)),
        [u, v, ..] => Ok((Vec2::new(u, v), rest)),
    }
}

/// The first word, and what stands after it.
fn split_word(text: &str) -> Option<(&str, &str)> {
    let text = text.trim_start();
    let end = text.find(char::is_whitespace).unwrap_or(text.len());
    (end > 0).then(|| (&text[..end], text[end..].trim_start()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn options_come_before_a_name_with_spaces() {
        let map =
            read_map("map_Kd", "-s 2 3 1 -o 0.5 -blendu on -clamp on -mm 0 1 -imfchan m -bm 0.25 My Pictures\\a b.png");
        let expected = Map {
            file: "My Pictures/a b.png".to_owned(),
            scale: Vec2::new(2.0, 3.0),
            offset: Vec2::new(0.5, 0.0),
            is_clamped: true,
            strength: 0.25,
            channel: Some(3),
        };
        assert_eq!(map, Ok(expected));
        assert_eq!(read_map("map_Kd", "-odd.png").map(|map| map.file), Ok("-odd.png".to_owned()));
        assert_eq!(
            read_map("map_Kd", "-s 2 7.png").map(|map| (map.scale, map.file)),
            Ok((Vec2::new(2.0, 1.0), "7.png".to_owned()))
        );
        for (text, problem) in [
            ("", "map_Kd without the name of a picture"),
            ("-s a.png", "map_Kd -s without a number"),
            ("-s 0 1 a.png", "map_Kd -s with 0; a scale must not be 0"),
            ("-bm x a.png", "map_Kd -bm with \"x\", which is not a number"),
            ("-o inf a.png", "map_Kd -o with inf; it must be finite"),
            ("-imfchan q a.png", "map_Kd -imfchan with \"q\"; it takes r, g, b, m, l or z"),
            ("-clamp on", "map_Kd without the name of a picture"),
        ] {
            assert_eq!(read_map("map_Kd", text), Err(problem.to_owned()));
        }
    }
}
