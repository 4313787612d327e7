//! Mode 0, "attributes": differences of bytes, plane by plane, in groups of 16.

/// The first byte of a stream.
const HEADER: u8 = 0xa0;
/// Bytes of a block at most, before it is compressed, and elements.
const BLOCK_BYTES: usize = 8192;
const BLOCK_ELEMENTS: usize = 256;
/// Elements of a group.
const GROUP: usize = 16;
/// The least length of what stands at the end: the element before the first one.
const LEAST_TAIL: usize = 32;

/// `count` elements of `stride` bytes; none if the stream is damaged.
pub(super) fn decode(stream: &[u8], count: usize, stride: usize) -> Option<Vec<u8>> {
    let tail = stride.max(LEAST_TAIL);
    let (&header, rest) = stream.split_first()?;
    let (mut data, end) = rest.split_at(rest.len().checked_sub(tail)?);
    if header != HEADER {
        return None;
    }
    let mut last = end[tail - stride..].to_vec();
    let mut elements = vec![0; count * stride];
    let block_elements = (BLOCK_BYTES / stride / GROUP * GROUP).min(BLOCK_ELEMENTS);
    for block in elements.chunks_mut(block_elements * stride) {
        for (plane, last) in last.iter_mut().enumerate() {
            decode_plane(&mut data, block, stride, plane, last)?;
        }
    }
    data.is_empty().then_some(elements)
}

/// The bytes of one plane of a block: two bits a group say how its differences are stored.
fn decode_plane(data: &mut &[u8], block: &mut [u8], stride: usize, plane: usize, last: &mut u8) -> Option<()> {
    let count = block.len() / stride;
    let modes = take(data, count.div_ceil(GROUP).div_ceil(4))?;
    for group in 0..count.div_ceil(GROUP) {
        let mode = modes[group / 4] >> (2 * (group % 4)) & 3;
        let differences = decode_group(data, mode)?;
        for (element, difference) in (group * GROUP..count).zip(differences) {
            *last = last.wrapping_add((difference >> 1) ^ (difference & 1).wrapping_neg());
            block[element * stride + plane] = *last;
        }
    }
    Some(())
}

/// 16 differences of 0, 2, 4 or 8 bits. The greatest of 2 or 4 bits stands for a byte that follows.
fn decode_group(data: &mut &[u8], mode: u8) -> Option<[u8; GROUP]> {
    let bits = match mode {
        0 => return Some([0; GROUP]),
        1 => 2,
        2 => 4,
        _ => return take(data, GROUP)?.try_into().ok(),
    };
    let stored = take(data, GROUP * bits / 8)?;
    let most = (1u8 << bits) - 1;
    let mut differences = [0; GROUP];
    for (index, difference) in differences.iter_mut().enumerate() {
        let place = index * bits;
        let number = stored[place / 8] >> (8 - bits - place % 8) & most;
        *difference = if number == most { take(data, 1)?[0] } else { number };
    }
    Some(differences)
}

fn take<'a>(data: &mut &'a [u8], count: usize) -> Option<&'a [u8]> {
    data.split_off(..count)
}
