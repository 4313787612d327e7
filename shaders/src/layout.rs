//! Rust twins of the structs in `shaders/layout/`. `tests/layout.rs` compares every name, offset, size and doc line.

use bytemuck::{Pod, Zeroable};

/// A field of a struct that both sides know.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SharedField {
    /// Its name on both sides.
    pub name: &'static str,
    /// Its documentation on both sides, one entry a line.
    pub docs: &'static [&'static str],
    /// Bytes from the struct's start.
    pub offset: usize,
    /// Bytes.
    pub size: usize,
}

/// A struct that both sides know.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SharedStruct {
    /// Its name on both sides.
    pub name: &'static str,
    /// Bytes.
    pub size: usize,
    /// Its fields, in order.
    pub fields: &'static [SharedField],
}

macro_rules! shared_structs {
    ($($(#[doc = $doc:literal])+ struct $name:ident { $($(#[doc = $field_doc:literal])+ $field:ident: $kind:ty,)+ })+) => {
        $(
            $(#[doc = $doc])+
            #[repr(C)]
            #[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
            pub struct $name {
                $($(#[doc = $field_doc])+ pub $field: $kind,)+
            }
        )+
        /// Every struct that both sides know.
        pub const SHARED_STRUCTS: &[SharedStruct] = &[$(SharedStruct {
            name: stringify!($name),
            size: size_of::<$name>(),
            fields: &[$(SharedField {
                name: stringify!($field),
                docs: &[$($field_doc),+],
                offset: std::mem::offset_of!($name, $field),
                size: size_of::<$kind>(),
            }),+],
        }),+];
    };
}

shared_structs! {
    /// A node of the eight-wide compressed BVH (Ylitie, Karras and Laine 2017), as obvhs lays it out.
    struct BvhNode {
        /// Origin of the node's grid, metres (bits of three f32); then three grid exponents and the mask of inner children, 8 bits each.
        grid: [u32; 4],
        /// First child node, first triangle, and eight 8-bit child descriptions.
        children: [u32; 4],
        /// Lower, then upper grid planes of the eight children along x, 8 bits each.
        planes_x: [u32; 4],
        /// The same along y.
        planes_y: [u32; 4],
        /// The same along z.
        planes_z: [u32; 4],
    }
    /// A triangle, world frame, in the order of the BVH's leaves.
    struct Triangle {
        /// First corner, metres.
        corner: [f32; 3],
        /// Index of its object.
        object: u32,
        /// Second corner minus the first, metres.
        edge_1: [f32; 3],
        /// Index of its material.
        material: u32,
        /// Third corner minus the first, metres.
        edge_2: [f32; 3],
        /// The TRIANGLE_ bits that apply.
        flags: u32,
    }
    /// What a triangle's corners carry, in the order of the triangles.
    struct TriangleCorners {
        /// Unit normal at the first corner, world frame.
        normal_0: [f32; 3],
        /// Texel column of the third corner.
        texel_x_2: f32,
        /// Unit normal at the second corner, world frame.
        normal_1: [f32; 3],
        /// Texel row of the third corner.
        texel_y_2: f32,
        /// Unit normal at the third corner, world frame.
        normal_2: [f32; 3],
        /// Charts of the object's map; 0 without one.
        charts: u32,
        /// Texel column and row of the first corner, then of the second.
        texel_01: [f32; 4],
    }
    /// Texture coordinates of a triangle's corners, in the order of the triangles.
    struct TextureCoordinates {
        /// Those of the first corner, then of the second.
        uv_01: [f32; 4],
        /// Those of the third corner.
        uv_2: [f32; 2],
        /// Unit tangents of the corners, world frame, along s of the normal map's picture; 0 without. Six octahedral coordinates of TANGENT_BITS bits, three in the first word,
        /// with TANGENT_PRESENT, and with TANGENT_LEFT where t grows against normal × tangent, and three in the second.
        tangents: [u32; 2],
    }
    /// Factors on the colour and the opacity of a triangle at its corners, in the order of the triangles: red and green, then blue and opacity, in half precision.
    struct VertexColors {
        /// That of the first corner.
        color_0: [u32; 2],
        /// That of the second corner.
        color_1: [u32; 2],
        /// That of the third corner.
        color_2: [u32; 2],
        /// Unused.
        padding: [u32; 2],
    }
    /// The pictures of a material: indices of SurfaceTexture records, or NONE.
    struct MaterialTextures {
        /// Factor on the material's colour.
        color: u32,
        /// Factor on its roughness.
        roughness: u32,
        /// Factor on its share of metal.
        metallic: u32,
        /// Factor on its emission.
        emission: u32,
        /// Its normal map.
        normal: u32,
        /// Factor on a normal map's components along the surface.
        normal_strength: f32,
        /// Factor on its opacity.
        opacity: u32,
        /// Opacity before the picture.
        opacity_factor: f32,
        /// Opacity from which on a surface is whole, and below which it is a hole; negative where it is neither.
        opacity_cutoff: f32,
        /// Index of the material that the surface is for the rest of the light, or NONE.
        rest: u32,
        /// Share of the light that meets this material and not the rest, before its picture.
        share: f32,
        /// Factor on that share.
        share_picture: u32,
    }
    /// A picture as it lies on a surface.
    struct SurfaceTexture {
        /// Index of the picture's first texel, which is even.
        first_texel: u32,
        /// Texels along its upper side.
        width: u32,
        /// Texels along its left side.
        height: u32,
        /// How it wraps, a WRAP_ constant for each axis of two bits each; TEXTURE_NEAREST; from TEXTURE_CHANNEL_SHIFT on the channel that a number is read from.
        flags: u32,
        /// s on the picture: factors of u, v and 1.
        s_from_uv: [f32; 3],
        /// Unused.
        padding_s: u32,
        /// t on the picture: factors of u, v and 1.
        t_from_uv: [f32; 3],
        /// Unused.
        padding_t: u32,
    }
    /// A layer of an object's energy map, whose plane is divided into squares.
    struct MapLayer {
        /// Index of the first MapSquare record, row by row.
        first_square: u32,
        /// Squares along x, and from bit 16 on along y.
        squares: u32,
        /// Squares along x for each unit of the plane.
        scale_x: f32,
        /// The same along y.
        scale_y: f32,
    }
    /// A square of a map's plane, which is divided into parts.
    struct MapSquare {
        /// Index of the first part's MapTile record, row by row.
        first_part: u32,
        /// Parts along each side: a power of two.
        side: u32,
        /// Unused.
        padding: [u32; 2],
    }
    /// The tile that a part of a square lies on.
    struct MapTile {
        /// Index of its first texel, row by row.
        first_texel: u32,
        /// Cells along x and, from bit MAP_TILE_ROWS_SHIFT on, along y: one less than texels. From MAP_TILE_LEVEL_SHIFT on its level against the squares, plus MAP_TILE_LEVEL_BIAS.
        cells: u32,
        /// Where its first texel stands, in squares.
        origin_x: f32,
        /// The same along y.
        origin_y: f32,
    }
    /// What a surface does to light; docs/materials.md. Which fields count depends on `kind`.
    struct Material {
        /// Effective albedo ρ* of the base: what a diffuse surface reflects, or what lies under a coat or gloss. Of a textured surface the colour before its picture. Of a dielectric its indices for red, green and blue.
        base: [f32; 3],
        /// One of the MATERIAL_ constants, with the bits MATERIAL_CASTER and MATERIAL_RECEIVER; from MATERIAL_GROUP_SHIFT on the index of its light group.
        kind: u32,
        /// A mirror's reflectance, a conductor's real index, Schlick's reflectance along the normal (of a textured surface that of what is no metal), Phong's specular share. Of a dielectric, x is the row of its indices among the spectra, or negative without dispersion.
        specular: [f32; 3],
        /// Index of refraction; exponent of Phong's specular lobe.
        ior: f32,
        /// Absorption coefficient of a dielectric's interior, 1/m; a conductor's imaginary index. Of coats x is their reflectance from within, of textured surfaces of glTF's model the share of metal.
        extinction: [f32; 3],
        /// Width α of the microfacets' distribution, 0 for a smooth surface. Of a textured surface the roughness before its picture.
        gloss: f32,
        /// Factor on light that is transmitted; Phong's factor on ambient light.
        tint: [f32; 3],
        /// A dielectric's key in lists of media: its rank plus 1 in the upper half, its material's index in the lower.
        medium: u32,
        /// Radiance of the front, W/(m² sr).
        emission: [f32; 3],
        /// Density with which next-event estimation chooses a point of the surface, 1/m²; 0 without emission.
        emission_pdf_area: f32,
    }
    /// An emitter. Which fields count depends on `kind`.
    struct Light {
        /// Centre or position, metres; of a distant light the unit direction toward it. World frame.
        position: [f32; 3],
        /// Radius of a sphere, metres; area of a surface, m²; of a distant disc 1 − cos of its angular radius, 0 for parallel light.
        extent: f32,
        /// Radiance, W/(m² sr), or of points and spots intensity, W/sr, or of parallel light irradiance, W/m²; factor on an environment's radiance.
        strength: [f32; 3],
        /// Probability with which the camera pass chooses a light up to and including this one.
        cumulative_probability: f32,
        /// Unit axis of a spot, or of the sphere of the profile `paper`; cosine and sine of an environment's turn about +y.
        axis: [f32; 3],
        /// One of the LIGHT_ constants; from LIGHT_GROUP_SHIFT on the index of its group.
        kind: u32,
        /// Cosine of the angle up to which a spot shines fully.
        cos_inner: f32,
        /// Cosine of the angle beyond which a spot is dark.
        cos_outer: f32,
        /// A surface's first entry among the emitting triangles; an environment's width, texels.
        first: u32,
        /// A surface's number of emitting triangles; an environment's height, texels.
        count: u32,
    }
    /// What a light aims at: for a sphere, a disc that every ray from it to some casters crosses; for other lights, a bounding sphere of casters.
    struct AimTarget {
        /// Centre, metres, world frame.
        center: [f32; 3],
        /// Radius, metres; of a sphere's target 0 if it is every direction.
        radius: f32,
        /// Unit normal of a disc, pointing away from the light.
        axis: [f32; 3],
        /// Unused.
        padding: u32,
    }
    /// One dispatch of the photon pass: an aligned block of one light's photons.
    struct PhotonParams {
        /// Index of the light.
        light: u32,
        /// Index of the block's first photon; a multiple of the block's length where that is a power of two.
        first_photon: u32,
        /// Photons in the block.
        photon_count: u32,
        /// Invocations of the dispatch that take photons; each takes every `lane_count`-th.
        lane_count: u32,
        /// Seed of the light's random numbers.
        seed: u32,
        /// The most surfaces that a photon meets before it is cut off.
        max_depth: u32,
        /// Targets in use.
        target_count: u32,
        /// 1 if `order` applies.
        ordered: u32,
        /// Units of the fixed-point sums in a watt.
        units_per_watt: f32,
        /// Factor on every photon's flux: 1 / (the light's share of all photons).
        flux_factor: f32,
        /// Spheres among the lights, which come first.
        sphere_count: u32,
        /// Index of the light's accounts in the ledger.
        account: u32,
        /// Columns of the guide of the first two emission numbers.
        guide_columns: u32,
        /// Its rows.
        guide_rows: u32,
        /// Columns, and rows, of the guide of the next two emission numbers.
        guide_side: u32,
        /// 1 in a pilot, which notes where photons land and leaves maps and ledger alone.
        pilot: u32,
        /// The media that the light stands in, as keys.
        media: [u32; 4],
        /// Centre of a sphere around everything, metres.
        scene_center: [f32; 3],
        /// Its radius, metres.
        scene_radius: f32,
        /// In the profile `paper`, the energy of each ray.
        ray_energy: [f32; 3],
        /// In the profile `paper`, the steps of each angle; 0 for random angles.
        grid_side: u32,
        /// Columns of the bit matrix that takes a place in the block to a photon, so that neighbours in the dispatch are aimed
        /// at neighbouring points.
        order: [[u32; 4]; 8],
        /// What the light aims at.
        targets: [AimTarget; MAX_AIM_TARGETS as usize],
    }
    /// Where a pilot's photon went.
    struct Landing {
        /// The layer that it landed on, two for each object; LOST if it met a caster and landed on none, NONE if it met no caster.
        layer: u32,
        /// Where on the map's plane it landed.
        x: f32,
        /// The same along y.
        y: f32,
        /// Flux that it brought there, W, mean of the channels.
        flux: f32,
        /// Density of its emission under the guide, over that without one.
        density: f32,
        /// The cell of the guide of its first two emission numbers.
        aim_cell: u32,
        /// The cell of the guide of the next two.
        place_cell: u32,
    }
    /// One dispatch of such a pass: one sample of every pixel.
    struct PathParams {
        /// Centre of the lens, metres, world frame.
        position: [f32; 3],
        /// Index of the sample, where the film does not count them.
        sample_index: u32,
        /// Unit direction of view.
        forward: [f32; 3],
        /// Seed of the pass.
        seed: u32,
        /// Radiance beyond every object, W/(m² sr).
        background: [f32; 3],
        /// The most casters that a path meets before it is cut off.
        max_depth: u32,
        /// Ambient radiance of the Phong model, W/(m² sr).
        ambient: [f32; 3],
        /// Lights on the device.
        light_count: u32,
        /// The media that the camera stands in, as keys.
        media: [u32; 4],
        /// Spheres among the lights, which come first.
        sphere_count: u32,
        /// The first light that is infinitely far; those after it are too.
        first_sky_light: u32,
        /// The diffuse surfaces that a path meets after its first one.
        max_bounces: u32,
        /// Factor on everything seen: 1/n² in a medium of index n.
        exposure: f32,
    }
    /// The lens and the picture.
    struct CameraParams {
        /// From the centre of the picture to its right edge, at distance 1.
        half_right: [f32; 3],
        /// Radius of the lens, metres.
        aperture_radius: f32,
        /// From the centre of the picture to its upper edge, at distance 1.
        half_up: [f32; 3],
        /// Distance at which the picture is sharp, metres.
        focus_distance: f32,
        /// The lens axis that is to the right in the picture, unit length, world frame.
        lens_right: [f32; 3],
        /// Width of the picture, pixels.
        width: u32,
        /// The lens axis that is up in the picture, unit length, world frame.
        lens_up: [f32; 3],
        /// Height of the picture, pixels.
        height: u32,
        /// Listed tiles that the dispatch takes a sample of; 0 if it takes the whole picture.
        tile_count: u32,
        /// Unused.
        padding_0: u32,
        /// Unused.
        padding_1: u32,
        /// Unused.
        padding_2: u32,
        /// The inverse cumulative distribution of the pixel filter at (1 − cos(πk/63))/2 for k = 0 … 63, pixels from the centre.
        filter_inverse_cdf: [[f32; 4]; 16],
    }
    /// One dispatch of the pass that looks at what the maps hold.
    struct ProbeParams {
        /// Places to look at.
        count: u32,
        /// Entries of irradiance of each texel, of which the first is of all light.
        entries: u32,
        /// Unused.
        padding_0: u32,
        /// Unused.
        padding_1: u32,
    }
    /// One dispatch of the pass that estimates errors.
    struct ErrorParams {
        /// Width of the picture, pixels.
        width: u32,
        /// Height of the picture, pixels.
        height: u32,
        /// Mean radiance of the picture, W/(m² sr).
        mean_radiance: f32,
        /// Unused.
        padding: u32,
    }
    /// What the samples of a tile of 8 × 8 pixels come to.
    struct TileError {
        /// Mean over pixels of the squared error of the radiance, mean of the channels, relative to the pixel's brightness; at most 1 each.
        squared_error: f32,
        /// Mean radiance, W/(m² sr), of pixels and channels.
        radiance: f32,
        /// Samples of a pixel, the least of all.
        samples: u32,
        /// Pixels within the picture.
        pixels: u32,
        /// Rays of all samples of all its pixels.
        rays: u32,
    }
    /// Which texels of a lightmap a dispatch samples.
    struct BakeParams {
        /// Index of the object.
        object: u32,
        /// Texels among the object's that hold surface before the dispatch's first.
        first_texel: u32,
        /// Texels that the dispatch samples.
        texel_count: u32,
        /// Workgroups along x.
        groups_x: u32,
        /// Texels of the lightmap along x.
        width: u32,
        /// Texels of the lightmap along y.
        height: u32,
        /// Texels over the area of their surface, 1/m², on average over the map.
        texel_density: f32,
    }
    /// A texel that holds surface.
    struct BakeTexel {
        /// Its column.
        column: u32,
        /// Its row.
        row: u32,
        /// 0 on the front, 1 on the back.
        side: u32,
        /// Unused.
        padding: u32,
        /// The media in front of it, as keys.
        media: [u32; 4],
    }
    /// What a path saw of the energy maps.
    struct Sighting {
        /// The layer that it met first, two for each object, or NONE.
        layer: u32,
        /// Where on the map's plane it met it.
        x: f32,
        /// The same along y.
        y: f32,
        /// The layer that it met last, after diffuse surfaces, or NONE.
        bounced_layer: u32,
        /// Where on the map's plane it met that.
        bounced_x: f32,
        /// The same along y.
        bounced_y: f32,
        /// Radiance in the picture for an irradiance of 1 W/m² at the first place, 1/sr, mean of the channels.
        weight: f32,
        /// Radiance that the path gathered, W/(m² sr), mean of the channels.
        radiance: f32,
        /// Radiance that came to the first place by the path's next direction, W/(m² sr), but for what next-event estimation and the maps bring
        /// there. Directions are drawn in proportion to the cosine, so that its mean times π is irradiance.
        bounced: [f32; 3],
        /// One over the distance to what was met there, 1/m; 0 for nothing, negative if the path did not go on from its first place.
        inverse_distance: f32,
    }
    /// Sums over a pixel's samples of what they met first, and their deviations.
    struct DataLayers {
        /// Share of light that the surface sends on.
        albedo: [f32; 3],
        /// Samples that met a surface.
        surfaces: f32,
        /// Unit shading normal, world frame, on the side of the camera.
        normal: [f32; 3],
        /// Number, from 1, of the object that the pixel's first sample met; 0 without one.
        object: u32,
        /// Place, metres, world frame.
        position: [f32; 3],
        /// Number, from 1, of the material that the pixel's first sample met; 0 without one.
        material: u32,
        /// Squared deviations of the samples' radiance from their mean, (W/(m² sr))².
        squares: [f32; 3],
        /// Distance from the lens along the view, metres.
        depth: f32,
    }
    /// A texel of the maps.
    struct MapTexel {
        /// Area of its surface, m². In the profile `paper`, what its sum is divided by. 0 without surface.
        area: f32,
        /// What it lies between, if it gets its irradiance from welds: 1 more than the index of a MapWeldPart that holds how many of these
        /// follow; else 0.
        link: u32,
        /// The chart that its surface belongs to, from 1; 0 without surface, NONE where it belongs to several.
        chart: u32,
        /// Index of its MapTileRecord.
        tile: u32,
    }

    /// A place at which texels of several tiles meet.
    struct MapWeld {
        /// The texel of the coarsest tile there.
        owner: u32,
        /// Index of the first of the parts whose flux it takes.
        first_part: u32,
        /// Parts.
        part_count: u32,
        /// The area of these parts, m².
        area: f32,
    }

    /// A part of a weld or a texel.
    struct MapWeldPart {
        /// Its index: of a texel, if it is of a weld; of a weld, if it is of a texel.
        index: u32,
        /// Its share.
        weight: f32,
    }
    /// One dispatch of the resolve pass.
    struct ResolveParams {
        /// Watts in a unit of the sums, divided by the photons emitted.
        watts_per_unit: f32,
        /// Texels, or welds, that the dispatch resolves.
        count: u32,
        /// Workgroups along x.
        groups_x: u32,
        /// Light groups whose maps there are.
        light_groups: u32,
        /// Texels from a light group's maps to the next one's.
        group_texels: u32,
        /// Sums of a texel: of three channels, and a fourth of squares where they are kept.
        sums: u32,
        /// 1 for a dispatch over welds, which comes first.
        of_welds: u32,
        /// Unused.
        padding: u32,
    }
    /// A tile of the maps.
    struct MapTileRecord {
        /// Index of its first texel, row by row.
        first_texel: u32,
        /// Cells along x.
        columns: u32,
        /// Cells along y.
        rows: u32,
        /// Index of its MapLayer.
        layer: u32,
        /// Where its first texel stands on the map's plane.
        origin_x: f32,
        /// The same along y.
        origin_y: f32,
        /// Width of a cell on the plane.
        cell_x: f32,
        /// Its height.
        cell_y: f32,
    }

    /// One dispatch of the smooth pass.
    struct SmoothParams {
        /// Texels, or welds, that the dispatch smooths.
        count: u32,
        /// Workgroups along x.
        groups_x: u32,
        /// 1 for a dispatch over welds, which comes first.
        of_welds: u32,
        /// Cells from a texel to those that it is compared with.
        distance: i32,
        /// Factor on the variance that the smoothed texels have if their errors do not depend on each other.
        variance_factor: f32,
        /// 1 for a dispatch that makes the guide of a step: what texels are compared by.
        makes_guide: u32,
        /// 1 if the guide's variance is the mean around a texel: few photons say little of it.
        averages_variance: u32,
        /// Entries of the texture before those of the guides.
        first_guide: u32,
    }
    /// A ray asked about.
    struct QueryRay {
        /// Origin, metres, world frame.
        origin: [f32; 3],
        /// How far it goes, metres.
        t_max: f32,
        /// Unit direction.
        direction: [f32; 3],
        /// 1 if any triangle will do, 0 for the nearest.
        any_hit: u32,
    }
    /// What a ray met.
    struct QueryHit {
        /// Index of the triangle in the order of the hierarchy's leaves, or NONE.
        triangle: u32,
        /// Distance along the ray, metres.
        t: f32,
        /// Barycentric weight of the second corner.
        barycentric_1: f32,
        /// Barycentric weight of the third corner.
        barycentric_2: f32,
    }
    /// How the film is shown.
    struct DisplayParams {
        /// Factor on radiance.
        exposure: f32,
        /// 1 for the filmic curve, 0 for none.
        filmic: u32,
        /// 1 if the shader encodes sRGB, 0 if the target does.
        encode_srgb: u32,
        /// Width of the film, pixels.
        width: u32,
        /// Height of the film, pixels.
        height: u32,
        /// Unused.
        padding_0: u32,
        /// Unused.
        padding_1: u32,
        /// Unused.
        padding_2: u32,
    }
}

/// Marks the absence of an index.
pub const NONE: u32 = u32::MAX;
/// Marks a photon that met a caster and landed on no receiver.
pub const LOST: u32 = u32::MAX - 1;
/// The most targets that a light aims at.
pub const MAX_AIM_TARGETS: u32 = 16;
/// Steps of what the spectra's tables hold, evenly in ξ.
pub const WAVELENGTH_STEPS: u32 = 512;

/// Width of the textures that hold records, texels, as a power of two.
pub const RECORDS_WIDTH_BITS: u32 = 13;
/// Entries of the traversal stack: the deepest BVH that the kernels follow.
pub const STACK_SIZE: u32 = 24;

/// Parts of [`MapTile::cells`].
pub mod map_tile {
    /// Where the rows stand.
    pub const ROWS_SHIFT: u32 = 13;
    /// Where the level stands.
    pub const LEVEL_SHIFT: u32 = 26;
    /// What is added to the level.
    pub const LEVEL_BIAS: u32 = 16;
}

/// Values of [`Material::kind`].
pub mod material_kind {
    /// Lambertian.
    pub const DIFFUSE: u32 = 0;
    /// The 2016 paper's local model.
    pub const PHONG: u32 = 1;
    /// Perfect mirror.
    pub const MIRROR: u32 = 2;
    /// Dielectric boundary.
    pub const DIELECTRIC: u32 = 3;
    /// Metal.
    pub const CONDUCTOR: u32 = 4;
    /// Sheet of glass without thickness.
    pub const THIN_WALLED: u32 = 5;
    /// Diffuse base under a clear coat.
    pub const COATED: u32 = 6;
    /// glTF's model.
    pub const METALLIC_ROUGHNESS: u32 = 7;
    /// Set where light that meets the surface is sent on by photons.
    pub const CASTER: u32 = 0x100;
    /// Set where the surface has a diffuse lobe and an energy map.
    pub const RECEIVER: u32 = 0x200;
    /// Set where pictures or vertex colours make the surface differ from point to point.
    pub const TEXTURED: u32 = 0x400;
    /// Where the index of the light group stands.
    pub const GROUP_SHIFT: u32 = 16;
}

/// Bits of [`Triangle::flags`].
pub mod triangle_flag {
    /// Set where the corners' normals are interpolated.
    pub const SMOOTH: u32 = 1;
    /// Set where rays may pass through.
    pub const HAS_HOLES: u32 = 2;
    /// Set where the material has a rest.
    pub const BLENDED: u32 = 4;
}

/// What [`TextureCoordinates::tangents`] is made of.
pub mod tangent {
    /// Bits of a tangent's coordinate.
    pub const BITS: u32 = 10;
    /// What a coordinate of 1 is, and what is added to it.
    pub const SCALE: u32 = 511;
    /// Set in the first word of tangents that there are.
    pub const PRESENT: u32 = 0x8000_0000;
    /// Set there where t grows against normal × tangent.
    pub const LEFT: u32 = 0x4000_0000;
}

/// Bits of [`SurfaceTexture::flags`].
pub mod texture_flag {
    /// It begins again.
    pub const WRAP_REPEAT: u32 = 0;
    /// It goes back, and then begins again.
    pub const WRAP_MIRROR: u32 = 1;
    /// Its last texel goes on.
    pub const WRAP_CLAMP: u32 = 2;
    /// Set where a place has the texel that it lies in.
    pub const NEAREST: u32 = 16;
    /// Where the channel stands.
    pub const CHANNEL_SHIFT: u32 = 8;
}

/// The layers of light, in the order in which a pixel's sums stand in the film.
pub mod light_layer {
    /// Light seen straight or through casters.
    pub const EMISSION: u32 = 0;
    /// Light that a receiver reflects straight from a light.
    pub const DIRECT: u32 = 1;
    /// What energy maps show.
    pub const CAUSTIC: u32 = 2;
    /// All other light.
    pub const INDIRECT: u32 = 3;
    /// Layers of light.
    pub const COUNT: u32 = 4;
}

/// Values of [`Light::kind`].
pub mod light_kind {
    /// Lambertian sphere.
    pub const SPHERE: u32 = 0;
    /// Point of even intensity.
    pub const POINT: u32 = 1;
    /// Point that shines into a cone.
    pub const SPOT: u32 = 2;
    /// Lambertian triangles.
    pub const SURFACE: u32 = 3;
    /// Parallel light or a disc in the sky.
    pub const DISTANT: u32 = 4;
    /// Light from everywhere.
    pub const ENVIRONMENT: u32 = 5;
    /// Where the index of the group stands.
    pub const GROUP_SHIFT: u32 = 16;
}

/// Accounts of a light's ledger, in the order of the kernel's sums.
pub mod ledger {
    /// Flux that left the light.
    pub const EMITTED: u32 = 0;
    /// Flux in energy maps.
    pub const DEPOSITED: u32 = 1;
    /// Flux that met a receiver before any caster.
    pub const DIRECT: u32 = 2;
    /// Flux lost to tints, media, mirrors and lights.
    pub const ABSORBED: u32 = 3;
    /// Flux that left the scene.
    pub const ESCAPED: u32 = 4;
    /// Flux of paths that grew too long.
    pub const CUT_OFF: u32 = 5;
    /// Flux taken (negative: given) by interpolated normals.
    pub const SHADING_NORMALS: u32 = 6;
    /// Flux taken (negative: given) by the colours of single wavelengths.
    pub const DISPERSION: u32 = 7;
    /// Accounts in a ledger.
    pub const ACCOUNTS: u32 = 8;
}

/// Values of the override constant `paper_refraction`.
pub mod paper_refraction {
    /// Light is physical.
    pub const NONE: u32 = 0;
    /// The paper's model, refraction by its equation 3 as printed.
    pub const PRINTED: u32 = 1;
    /// The paper's model, refraction by Snell's law.
    pub const EXACT: u32 = 2;
}

/// Constants that both sides know: name in WGSL, value.
pub const SHARED_CONSTANTS: &[(&str, u32)] = &[
    ("NONE", NONE),
    ("LOST", LOST),
    ("MAX_AIM_TARGETS", MAX_AIM_TARGETS),
    ("STACK_SIZE", STACK_SIZE),
    ("WAVELENGTH_STEPS", WAVELENGTH_STEPS),
    ("RECORDS_WIDTH_BITS", RECORDS_WIDTH_BITS),
    ("MAP_TILE_ROWS_SHIFT", map_tile::ROWS_SHIFT),
    ("MAP_TILE_LEVEL_SHIFT", map_tile::LEVEL_SHIFT),
    ("MAP_TILE_LEVEL_BIAS", map_tile::LEVEL_BIAS),
    ("MATERIAL_DIFFUSE", material_kind::DIFFUSE),
    ("MATERIAL_PHONG", material_kind::PHONG),
    ("MATERIAL_MIRROR", material_kind::MIRROR),
    ("MATERIAL_DIELECTRIC", material_kind::DIELECTRIC),
    ("MATERIAL_CONDUCTOR", material_kind::CONDUCTOR),
    ("MATERIAL_THIN_WALLED", material_kind::THIN_WALLED),
    ("MATERIAL_COATED", material_kind::COATED),
    ("MATERIAL_METALLIC_ROUGHNESS", material_kind::METALLIC_ROUGHNESS),
    ("MATERIAL_CASTER", material_kind::CASTER),
    ("MATERIAL_RECEIVER", material_kind::RECEIVER),
    ("MATERIAL_TEXTURED", material_kind::TEXTURED),
    ("MATERIAL_GROUP_SHIFT", material_kind::GROUP_SHIFT),
    ("TRIANGLE_SMOOTH", triangle_flag::SMOOTH),
    ("TRIANGLE_HAS_HOLES", triangle_flag::HAS_HOLES),
    ("TRIANGLE_BLENDED", triangle_flag::BLENDED),
    ("TANGENT_BITS", tangent::BITS),
    ("TANGENT_SCALE", tangent::SCALE),
    ("TANGENT_PRESENT", tangent::PRESENT),
    ("TANGENT_LEFT", tangent::LEFT),
    ("WRAP_REPEAT", texture_flag::WRAP_REPEAT),
    ("WRAP_MIRROR", texture_flag::WRAP_MIRROR),
    ("WRAP_CLAMP", texture_flag::WRAP_CLAMP),
    ("TEXTURE_NEAREST", texture_flag::NEAREST),
    ("TEXTURE_CHANNEL_SHIFT", texture_flag::CHANNEL_SHIFT),
    ("PAPER_NONE", paper_refraction::NONE),
    ("PAPER_PRINTED", paper_refraction::PRINTED),
    ("PAPER_EXACT", paper_refraction::EXACT),
    ("LIGHT_SPHERE", light_kind::SPHERE),
    ("LIGHT_POINT", light_kind::POINT),
    ("LIGHT_SPOT", light_kind::SPOT),
    ("LIGHT_SURFACE", light_kind::SURFACE),
    ("LIGHT_DISTANT", light_kind::DISTANT),
    ("LIGHT_ENVIRONMENT", light_kind::ENVIRONMENT),
    ("LIGHT_GROUP_SHIFT", light_kind::GROUP_SHIFT),
    ("LAYER_EMISSION", light_layer::EMISSION),
    ("LAYER_DIRECT", light_layer::DIRECT),
    ("LAYER_CAUSTIC", light_layer::CAUSTIC),
    ("LAYER_INDIRECT", light_layer::INDIRECT),
    ("LIGHT_LAYERS", light_layer::COUNT),
    ("LEDGER_EMITTED", ledger::EMITTED),
    ("LEDGER_DEPOSITED", ledger::DEPOSITED),
    ("LEDGER_DIRECT", ledger::DIRECT),
    ("LEDGER_ABSORBED", ledger::ABSORBED),
    ("LEDGER_ESCAPED", ledger::ESCAPED),
    ("LEDGER_CUT_OFF", ledger::CUT_OFF),
    ("LEDGER_SHADING_NORMALS", ledger::SHADING_NORMALS),
    ("LEDGER_DISPERSION", ledger::DISPERSION),
    ("LEDGER_ACCOUNTS", ledger::ACCOUNTS),
];
