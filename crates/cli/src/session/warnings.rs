//! Plain words for caustics that could not form, and why.

use diacaustic::{
    SceneReport, Statistics,
    scene::{Scene, Warning},
};

/// The least share of the photons' flux that is worth a warning when paths are cut off.
const CUT_OFF_SHARE: f64 = 0.01;

/// What the photon pass says about the caustics. `noted` is what was said about the scene before.
pub(crate) fn about_photons(
    scene: &Scene,
    noted: &[Warning],
    report: &SceneReport,
    statistics: &Statistics,
) -> Vec<String> {
    if report.photon_turns == 0 {
        let explained = |warning: &Warning| matches!(warning, Warning::NoCaster | Warning::NoLight | Warning::Dark);
        return if noted.iter().any(explained) { Vec::new() } else { vec![NOT_EMITTED.to_owned()] };
    }
    if statistics.photons == 0 {
        return vec!["no caustic can form: no photons were asked for; give --photons more than 0".to_owned()];
    }
    let fates = Fates::of(statistics);
    let mut warnings = Vec::new();
    if statistics.deposits == 0 && !noted.contains(&Warning::NoReceiver) {
        warnings.push(format!(
            "no caustic formed: none of {} photons reached a diffuse or phong surface through glass or a mirror; of their \
             flux, {} met such a surface before any glass or mirror, {} left the scene, {} was absorbed, {} was cut off after \
             {} surfaces",
            statistics.photons,
            Percent(fates.direct),
            Percent(fates.escaped),
            Percent(fates.absorbed),
            Percent(fates.cut_off),
            scene.settings.max_depth
        ));
    }
    if fates.cut_off > CUT_OFF_SHARE {
        warnings.push(format!(
            "{} of the photons' flux was cut off after {} surfaces, and its caustics are missing: raise max_depth in [render]",
            Percent(fates.cut_off),
            scene.settings.max_depth
        ));
    }
    warnings
}

const NOT_EMITTED: &str =
    "no caustic can form: no light shines on anything that casts light on, such as glass or metal";

/// The shares of the photons' flux, over all lights and channels.
struct Fates {
    direct: f64,
    escaped: f64,
    absorbed: f64,
    cut_off: f64,
}

impl Fates {
    fn of(statistics: &Statistics) -> Self {
        let share = |account: fn(&diacaustic::Ledger) -> [i64; 3]| -> f64 {
            let units = |account: [i64; 3]| account.into_iter().map(|units| units as f64).sum::<f64>();
            let emitted: f64 = statistics.ledgers.iter().map(|ledger| units(ledger.emitted)).sum();
            let part: f64 = statistics.ledgers.iter().map(|ledger| units(account(ledger))).sum();
            part / emitted.max(1.0)
        };
        Self {
            direct: share(|ledger| ledger.direct),
            escaped: share(|ledger| ledger.escaped),
            absorbed: share(|ledger| ledger.absorbed),
            cut_off: share(|ledger| ledger.cut_off),
        }
    }
}

struct Percent(f64);

impl std::fmt::Display for Percent {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{:.1} %", 100.0 * self.0)
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use diacaustic::Ledger;

    use super::*;

    const SCENE: &str = r#"
        [camera]
        position = [0, 2, 3]
        look_at = [0, 0, 0]
        vertical_fov = 40
        [materials]
        glass = { type = "dielectric", ior = 1.5 }
        [[lights]]
        type = "sphere"
        center = [1, 2.5, 0.6]
        radius = 0.05
        flux = 35
        [[objects]]
        sphere = { center = [0, 0.3, 0], radius = 0.3, subdivisions = 1 }
        material = "glass"
    "#;

    fn about(photon_turns: u64, noted: &[Warning], statistics: &Statistics) -> Vec<String> {
        let scene = diacaustic::scene::parse_scene(SCENE, Path::new("."), "scene.toml").unwrap().scene;
        let mut report = SceneReport::default();
        report.photon_turns = photon_turns;
        about_photons(&scene, noted, &report, statistics)
    }

    fn fates(deposits: u64, direct: i64, escaped: i64, cut_off: i64) -> Statistics {
        let mut ledger = Ledger::default();
        ledger.emitted = [1000, 1000, 0];
        ledger.direct = [direct, direct, 0];
        ledger.escaped = [escaped, escaped, 0];
        ledger.cut_off = [cut_off, cut_off, 0];
        let mut statistics = Statistics::default();
        statistics.photons = 100;
        statistics.deposits = deposits;
        statistics.ledgers = vec![ledger, Ledger::default()];
        statistics
    }

    #[test]
    fn a_good_caustic_has_no_warning() {
        assert!(about(1, &[], &fates(5, 400, 100, 10)).is_empty());
    }

    #[test]
    fn missed_receivers_are_told_with_the_fate_of_the_light() {
        let missed = fates(0, 400, 600, 0);
        let [warning] = about(1, &[], &missed).try_into().unwrap();
        assert!(warning.starts_with("no caustic formed: none of 100 photons"), "{warning}");
        assert!(warning.contains("40.0 % met such a surface before any glass"), "{warning}");
        assert!(warning.contains("60.0 % left the scene, 0.0 % was absorbed, 0.0 % was cut off"), "{warning}");
        assert!(about(1, &[Warning::NoReceiver], &missed).is_empty());
    }

    #[test]
    fn cut_off_paths_name_the_key_to_raise() {
        let [warning] = about(1, &[], &fates(5, 0, 0, 25)).try_into().unwrap();
        assert!(warning.starts_with("2.5 % of the photons' flux was cut off after 32 surfaces"), "{warning}");
        assert!(warning.contains("raise max_depth"), "{warning}");
    }

    #[test]
    fn photons_that_were_not_emitted_are_told_once() {
        let none = Statistics::default();
        assert_eq!(about(0, &[], &none).len(), 1);
        assert!(about(0, &[Warning::NoCaster], &none).is_empty());
        assert!(about(1, &[], &none)[0].contains("--photons"));
    }
}
