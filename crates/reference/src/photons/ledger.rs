//! Where the photons' flux goes.

use std::ops::AddAssign;

use glam::DVec3;

/// Flux by its fate, W times the number of photons per channel.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Ledger {
    /// What the light sent out.
    pub emitted: DVec3,
    /// What receivers took after a caster: the energy maps' share.
    pub deposited: DVec3,
    /// What receivers took straight from the light: the camera pass's share.
    pub direct: DVec3,
    /// What media, tints, mirrors and lights swallowed.
    pub absorbed: DVec3,
    /// What left the scene.
    pub escaped: DVec3,
    /// What still flew when its path became too long.
    pub cut_off: DVec3,
    /// What factors of shading normals took away; negative where they added.
    pub shading_normals: DVec3,
    /// What was lost where photons took a wavelength, negative where they won; its mean is 0.
    pub dispersion: DVec3,
}

impl Ledger {
    /// The sum of all fates, which is what was emitted but for rounding.
    pub fn accounted(&self) -> DVec3 {
        let flown = self.deposited + self.direct + self.absorbed + self.escaped + self.cut_off;
        flown + self.shading_normals + self.dispersion
    }
}

impl AddAssign for Ledger {
    fn add_assign(&mut self, other: Self) {
        self.emitted += other.emitted;
        self.deposited += other.deposited;
        self.direct += other.direct;
        self.absorbed += other.absorbed;
        self.escaped += other.escaped;
        self.cut_off += other.cut_off;
        self.shading_normals += other.shading_normals;
        self.dispersion += other.dispersion;
    }
}
