//! From the chosen tiles to maps that lie one after the other, within what the device can hold.

use std::sync::Arc;

use diacaustic_surface::{MapLayout, MapTiles, TexelSurface, Welds};

use crate::{Error, MapSize, map_plan::MapPlan, map_sums::SumsFormat, tile_choice::TileChoice};

/// One object's map within the buffers of all maps.
#[derive(Clone, Debug)]
pub(crate) struct MapPlacement {
    pub layout: MapLayout,
    pub tiles: MapTiles,
    pub first_texel: u64,
    /// The surface behind each texel.
    pub surfaces: Vec<TexelSurface>,
    /// How its tiles join.
    pub welds: Arc<Welds>,
    /// What sums are divided by in place of areas, in the profile `paper`.
    pub paper_size: Option<f64>,
}

impl MapPlacement {
    /// What the sums of each texel are divided by; 0 where there is no surface.
    pub fn divisors(&self) -> impl Iterator<Item = f32> {
        let divisor = |area: f64| if area > 0.0 { self.paper_size.unwrap_or(area) as f32 } else { 0.0 };
        self.surfaces.iter().map(move |texel| divisor(texel.area))
    }
}

/// Texels that the maps whose size the scene leaves open may have in each light group.
pub(crate) fn texel_budget(plans: &[Option<MapPlan>], bytes: u64, limits: &wgpu::Limits, format: SumsFormat) -> u64 {
    let stated: u64 = plans.iter().flatten().filter(|plan| plan.is_stated).map(|plan| plan.layout.texel_count()).sum();
    (bytes / format.bytes() / format.groups).min(format.most_texels(limits).saturating_sub(stated))
}

/// What is told of each map.
pub(crate) fn map_sizes(plans: &[Option<MapPlan>], choice: &TileChoice) -> Vec<MapSize> {
    let planned = plans.iter().zip(&choice.tiles).zip(&choice.widths).enumerate();
    planned
        .filter_map(|(object, ((plan, tiles), width))| {
            let (plan, tiles) = (plan.as_ref()?, tiles.as_ref()?);
            let metres = f64::from(plan.layout.metres_per_texel);
            Some(MapSize {
                object,
                width: plan.layout.width,
                height: plan.layout.height,
                layers: plan.layout.layers,
                tiles: tiles.tiles.len() as u64,
                texels: tiles.texel_count(),
                texel_width: width.given * metres,
                wanted_texel_width: width.wanted * metres,
                finest_texel_width: width.finest * metres,
            })
        })
        .collect()
}

/// Places the maps one after the other, and integrates the areas of their texels.
pub(crate) fn place_maps(
    plans: Vec<Option<MapPlan>>,
    choice: TileChoice,
    format: SumsFormat,
    limits: &wgpu::Limits,
) -> Result<Vec<Option<MapPlacement>>, Error> {
    let asked: u64 = choice.tiles.iter().flatten().map(|tiles| tiles.texel_count()).sum();
    let most = format.most_texels(limits);
    if asked > most {
        return Err(Error::MapsTooLarge { asked: asked * format.bytes(), available: most * format.bytes() });
    }
    let mut next_texel = 0;
    let placed = plans.into_iter().zip(choice.tiles).map(|(plan, tiles)| {
        let (plan, tiles) = (plan?, tiles?);
        let first_texel = next_texel;
        next_texel += tiles.texel_count();
        let surfaces = plan.texel_surfaces(&tiles);
        // The paper divides every texel's sum by the same.
        let welds = match plan.paper_size {
            Some(_) => Welds::default(),
            None => Welds::new(&plan.layout, &tiles, &surfaces, &plan.receivers),
        };
        let welds = Arc::new(welds);
        Some(MapPlacement { first_texel, surfaces, welds, tiles, layout: plan.layout, paper_size: plan.paper_size })
    });
    Ok(placed.collect())
}
