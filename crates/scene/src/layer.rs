//! The layers of a picture.

/// A layer of the picture beside the picture itself; `docs/layers.md` says what each holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Layer {
    /// Light seen straight or through casters.
    Emission,
    /// Light that a receiver reflects straight from a light.
    Direct,
    /// What the energy maps of receivers show.
    Caustic,
    /// Light after it was reflected by two receivers or more.
    Indirect,
    /// Share of the light that the first surface sends on.
    Albedo,
    /// Shading normal of the first surface.
    Normal,
    /// Distance along the view to the first surface.
    Depth,
    /// Place of the first surface.
    Position,
    /// Number of the first object.
    ObjectId,
    /// Number of the first material.
    MaterialId,
    /// Samples of the pixel.
    Samples,
    /// Variance of the pixel's mean.
    Variance,
}

impl Layer {
    /// Every layer, in the order of files.
    pub const ALL: [Self; 12] = [
        Self::Emission,
        Self::Direct,
        Self::Caustic,
        Self::Indirect,
        Self::Albedo,
        Self::Normal,
        Self::Depth,
        Self::Position,
        Self::ObjectId,
        Self::MaterialId,
        Self::Samples,
        Self::Variance,
    ];

    /// Its name in scene files and in OpenEXR.
    pub fn name(self) -> &'static str {
        match self {
            Self::Emission => "emission",
            Self::Direct => "direct",
            Self::Caustic => "caustic",
            Self::Indirect => "indirect",
            Self::Albedo => "albedo",
            Self::Normal => "normal",
            Self::Depth => "depth",
            Self::Position => "position",
            Self::ObjectId => "object_id",
            Self::MaterialId => "material_id",
            Self::Samples => "samples",
            Self::Variance => "variance",
        }
    }
}
