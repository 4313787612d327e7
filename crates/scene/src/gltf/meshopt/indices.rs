//! Modes 1 and 2, "triangles" and "indices".

/// Entries of the lists of latest edges and vertices.
const LATEST: usize = 16;
/// The first bytes of streams.
const TRIANGLES_HEADER: u8 = 0xe1;
const SEQUENCE_HEADER: u8 = 0xd1;
/// Bytes at the end of a sequence.
const SEQUENCE_TAIL: usize = 4;

/// The corners of `count` / 3 triangles; none if the stream is damaged.
pub(super) fn decode_triangles(stream: &[u8], count: usize) -> Option<Vec<u32>> {
    let (&header, mut rest) = stream.split_first()?;
    let codes = rest.split_off(..count / 3)?;
    let (data, table) = rest.split_at(rest.len().checked_sub(LATEST)?);
    if header != TRIANGLES_HEADER {
        return None;
    }
    let mut reader = Triangles { data, next: 0, last: 0, edges: Recent::default(), vertices: Recent::default() };
    let mut indices = Vec::with_capacity(count);
    for code in codes {
        indices.extend(if *code < 0xf0 { reader.beside_an_edge(*code)? } else { reader.apart(*code, table)? });
    }
    reader.data.is_empty().then_some(indices)
}

/// The state of a stream of triangles.
struct Triangles<'a> {
    data: &'a [u8],
    /// The first index that has not been used.
    next: u32,
    /// The index that stood in the data last.
    last: u32,
    edges: Recent<[u32; 2]>,
    vertices: Recent<u32>,
}

impl Triangles<'_> {
    /// A triangle that shares one of the latest edges.
    fn beside_an_edge(&mut self, code: u8) -> Option<[u32; 3]> {
        let [a, b] = self.edges.back(usize::from(code >> 4));
        let c = match code & 15 {
            0 => self.unused(),
            back @ 1..13 => {
                let c = self.vertices.back(usize::from(back));
                return Some(self.finish([a, b, c], &[]));
            }
            13 => self.step(1u32.wrapping_neg()),
            14 => self.step(1),
            _ => self.stored()?,
        };
        Some(self.finish([a, b, c], &[c]))
    }

    /// A triangle that shares none.
    fn apart(&mut self, code: u8, table: &[u8]) -> Option<[u32; 3]> {
        let (first, codes) = match code {
            0xf0..0xfe => (0, table[usize::from(code & 15)]),
            _ => {
                let codes = self.byte()?;
                if codes == 0 {
                    self.next = 0;
                }
                (if code == 0xfe { 0 } else { 15 }, codes)
            }
        };
        let kinds = [first, codes >> 4, codes & 15];
        // Those that are new or recent come first, and then those that stand in the data.
        let mut corners = kinds.map(|_| 0);
        let mut unused = 0;
        for (corner, kind) in corners.iter_mut().zip(kinds) {
            *corner = match kind {
                0 => {
                    unused += 1;
                    self.next.wrapping_add(unused - 1)
                }
                15 => 0,
                back => self.vertices.back(usize::from(back) - 1),
            };
        }
        self.next = self.next.wrapping_add(unused);
        for (corner, kind) in corners.iter_mut().zip(kinds) {
            if kind == 15 {
                *corner = self.stored()?;
            }
        }
        let is_pushed = |kind: u8| kind == 0 || kind == 15;
        let pushed: Vec<_> =
            corners.iter().zip(kinds).filter(|(_, kind)| is_pushed(*kind)).map(|(corner, _)| *corner).collect();
        let [a, b, c] = corners;
        pushed.iter().for_each(|corner| self.vertices.push(*corner));
        [[b, a], [c, b], [a, c]].into_iter().for_each(|edge| self.edges.push(edge));
        Some(corners)
    }

    /// Notes a triangle beside an edge.
    fn finish(&mut self, [a, b, c]: [u32; 3], new_vertices: &[u32]) -> [u32; 3] {
        new_vertices.iter().for_each(|vertex| self.vertices.push(*vertex));
        [[c, b], [a, c]].into_iter().for_each(|edge| self.edges.push(edge));
        [a, b, c]
    }

    fn unused(&mut self) -> u32 {
        self.next = self.next.wrapping_add(1);
        self.next.wrapping_sub(1)
    }

    fn step(&mut self, difference: u32) -> u32 {
        self.last = self.last.wrapping_add(difference);
        self.last
    }

    fn stored(&mut self) -> Option<u32> {
        let number = variable_length(&mut self.data)?;
        Some(self.step((number >> 1) ^ (number & 1).wrapping_neg()))
    }

    fn byte(&mut self) -> Option<u8> {
        self.data.split_off_first().copied()
    }
}

/// The latest 16 of a list.
#[derive(Default)]
struct Recent<T> {
    entries: [T; LATEST],
    count: usize,
}

impl<T: Copy> Recent<T> {
    fn push(&mut self, entry: T) {
        self.entries[self.count % LATEST] = entry;
        self.count += 1;
    }

    /// The entry that came `back` pushes before the latest.
    fn back(&self, back: usize) -> T {
        self.entries[(self.count + 2 * LATEST - 1 - back) % LATEST]
    }
}

/// `count` indices, each a difference to one of two; none if the stream is damaged.
pub(super) fn decode_sequence(stream: &[u8], count: usize) -> Option<Vec<u32>> {
    let (&header, rest) = stream.split_first()?;
    let (mut data, _) = rest.split_at(rest.len().checked_sub(SEQUENCE_TAIL)?);
    if header != SEQUENCE_HEADER || count > data.len() {
        return None;
    }
    let mut last = [0u32; 2];
    let mut indices = Vec::with_capacity(count);
    for _ in 0..count {
        let number = variable_length(&mut data)?;
        let base = &mut last[number as usize & 1];
        let difference = number >> 1;
        *base = base.wrapping_add((difference >> 1) ^ (difference & 1).wrapping_neg());
        indices.push(*base);
    }
    data.is_empty().then_some(indices)
}

/// A number of seven bits a byte, the lowest first; the highest bit says that another byte follows.
fn variable_length(data: &mut &[u8]) -> Option<u32> {
    let mut number = 0;
    for shift in (0..35).step_by(7) {
        let byte = data.split_off_first()?;
        number |= u32::from(byte & 127) << shift;
        if *byte < 128 {
            return Some(number);
        }
    }
    None
}
