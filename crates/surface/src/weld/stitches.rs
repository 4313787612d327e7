//! Charts joined along their borders: where a surface goes on smoothly on another chart, texels at the border of one lie between texels of the other,
//! so that irradiance has no jump there.

use std::collections::{BTreeMap, HashMap};

use super::{
    Map, Weld, WeldPart, Welds,
    nodes::{Nodes, is_at_border},
    seams::{Beside, seams},
};

/// Cosine of the most that surfaces turn from each other that go on smoothly: 45°.
const SMOOTH: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// Lets texels at the borders of charts lie between those of a chart beside theirs that comes first: the larger.
pub(super) fn stitch(map: &Map<'_>, welds: Welds) -> Welds {
    let nodes = Nodes::new(map, &welds);
    let mut order: Vec<(f64, usize, u64)> = Vec::new();
    for tile in &map.tiles.tiles {
        for texel in tile.first_texel..tile.first_texel + tile.texel_count() {
            if let Some((rank, chart)) = nodes.large_chart(tile, texel).filter(|_| is_at_border(map, tile, texel)) {
                order.push((rank, chart, texel));
            }
        }
    }
    // Larger charts first, so that what a texel lies between is known.
    order.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)).then(a.2.cmp(&b.2)));
    let texels: Vec<u64> =
        order.iter().map(|&(.., texel)| texel).filter(|&texel| nodes.of_texel(texel) == [texel]).collect();
    if texels.is_empty() {
        return welds;
    }
    let mut hanging: BTreeMap<u64, Vec<WeldPart>> = BTreeMap::new();
    for seam in seams(map, &texels) {
        let tile = map.tile(seam.texel);
        let Some(own) = nodes.large_chart(tile, seam.texel) else { continue };
        let is_smooth = |beside: &&Beside| {
            let other = nodes.large_chart(map.tile(beside.texel), beside.texel);
            beside.normal.dot(seam.normal) >= SMOOTH && other.is_some_and(|other| (other.0, own.1) > (own.0, other.1))
        };
        let nearest = seam.beside.iter().filter(is_smooth).min_by(|a, b| a.distance.total_cmp(&b.distance));
        let Some(beside) = nearest else { continue };
        let mut parts: Vec<WeldPart> = Vec::new();
        for WeldPart { index, weight } in &beside.around {
            let known = hanging.get(index).cloned().unwrap_or_else(|| vec![WeldPart { index: *index, weight: 1.0 }]);
            for part in known {
                let new = WeldPart { weight: weight * part.weight, ..part };
                match parts.iter_mut().find(|known| known.index == new.index) {
                    Some(known) => known.weight += new.weight,
                    None => parts.push(new),
                }
            }
        }
        if !parts.is_empty() && parts.iter().all(|part| nodes.of_texel(part.index) == [part.index]) {
            hanging.insert(seam.texel, parts);
        }
    }
    add(map, welds, &hanging)
}

/// Adds texels that lie between others.
fn add(map: &Map<'_>, mut welds: Welds, hanging: &BTreeMap<u64, Vec<WeldPart>>) -> Welds {
    let mut weld_of: HashMap<u64, u64> = HashMap::new();
    let area = |texel: u64| map.surfaces[texel as usize].area;
    for (&texel, parts) in hanging {
        let mut links = Vec::with_capacity(parts.len());
        for &WeldPart { index, weight } in parts {
            let weld = *weld_of.entry(index).or_insert_with(|| {
                let sources = vec![WeldPart { index, weight: 1.0 }];
                welds.welds.push(Weld { owner: index, sources, area: area(index) });
                let weld = welds.welds.len() as u64 - 1;
                welds.linked.push((index, vec![WeldPart { index: weld, weight: 1.0 }]));
                weld
            });
            let weld_list = &mut welds.welds[weld as usize];
            weld_list.sources.push(WeldPart { index: texel, weight });
            weld_list.area += weight * area(texel);
            links.push(WeldPart { index: weld, weight });
        }
        welds.linked.push((texel, links));
    }
    welds.linked.sort_unstable_by_key(|(texel, _)| *texel);
    welds
}
