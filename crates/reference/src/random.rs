//! The random numbers of a photon, as `docs/photon-paths.md` defines them.

use crate::bsdf::Draw;

/// Wellons' low-bias hash of 32 bits.
pub fn hash(x: u32) -> u32 {
    let x = (x ^ (x >> 16)).wrapping_mul(0x21f0_aaad);
    let x = (x ^ (x >> 15)).wrapping_mul(0xd35a_2d97);
    x ^ (x >> 15)
}

/// A key from two.
pub fn combine(a: u32, b: u32) -> u32 {
    hash(a ^ hash(b.wrapping_add(0x9e37_79b9)))
}

/// A nested uniform scramble of x under the key s, by hashing (Laine and Karras 2011, constants by Vegdahl 2021).
pub fn owen(x: u32, s: u32) -> u32 {
    let x = x.reverse_bits();
    let x = x ^ x.wrapping_mul(0x3d20_adea);
    let x = x.wrapping_add(s);
    let x = x.wrapping_mul((s >> 16) | 1);
    let x = x ^ x.wrapping_mul(0x0552_6c56);
    let x = x ^ x.wrapping_mul(0x53a2_2864);
    x.reverse_bits()
}

/// How the direction numbers of a dimension go on from the first ones: v_b is the XOR of v_{b−lag} over `lags` and of
/// v_{b−degree} >> degree, `degree` being the number of first ones (Joe and Kuo 2008).
struct Direction {
    first: &'static [u32],
    lags: &'static [usize],
}

const DIRECTIONS: [Direction; 4] = [
    Direction { first: &[1 << 31], lags: &[1] },
    Direction { first: &[1 << 31, 3 << 30], lags: &[1, 2] },
    Direction { first: &[1 << 31, 3 << 30, 1 << 29], lags: &[2, 3] },
    Direction { first: &[1 << 31, 1 << 30, 1 << 29], lags: &[1, 3] },
];

const SOBOL: [[u32; 32]; 5] = [
    radical_inverse(),
    direction_numbers(&DIRECTIONS[0]),
    direction_numbers(&DIRECTIONS[1]),
    direction_numbers(&DIRECTIONS[2]),
    direction_numbers(&DIRECTIONS[3]),
];

const fn radical_inverse() -> [u32; 32] {
    let mut v = [0; 32];
    let mut b = 0;
    while b < 32 {
        v[b] = 1 << (31 - b);
        b += 1;
    }
    v
}

const fn direction_numbers(direction: &Direction) -> [u32; 32] {
    let degree = direction.first.len();
    let mut v = [0; 32];
    let mut b = 0;
    while b < 32 {
        if b < degree {
            v[b] = direction.first[b];
        } else {
            v[b] = v[b - degree] >> degree;
            let mut lag = 0;
            while lag < direction.lags.len() {
                v[b] ^= v[b - direction.lags[lag]];
                lag += 1;
            }
        }
        b += 1;
    }
    v
}

/// Coordinate `dimension` (0 to 4) of the x-th point of Sobol's sequence, as 32 bits after the binary point.
///
/// # Panics
/// If there is no such dimension.
pub fn sobol(x: u32, dimension: usize) -> u32 {
    let directions = &SOBOL[dimension];
    (0..32).filter(|b| x >> b & 1 == 1).fold(0, |sum, b| sum ^ directions[b])
}

/// The upper 24 bits as a number in [0, 1).
pub fn unit(x: u32) -> f64 {
    f64::from(x >> 8) / f64::from(1 << 24)
}

/// First key of the numbers of microfacets.
const MICROFACETS: u32 = 4096;

/// The numbers of one photon.
#[derive(Clone, Debug)]
pub struct PhotonNumbers {
    key: u32,
    photon: u32,
    casters: u32,
    /// Whether the first choice takes the fifth emission number.
    fifth_is_choice: bool,
}

impl PhotonNumbers {
    /// The numbers of a photon of the light of index `light`.
    pub fn new(seed: u32, light: u32, photon: u32) -> Self {
        Self { key: combine(combine(seed, 1), light), photon, casters: 0, fifth_is_choice: true }
    }

    /// The numbers in a scene with dispersion, whose fifth chooses the wavelength.
    #[must_use]
    pub fn with_wavelength(self) -> Self {
        Self { fifth_is_choice: false, ..self }
    }

    /// ξ, the number that draws the wavelength.
    pub fn wavelength(&self) -> f64 {
        self.emission(4)
    }

    /// The emission number u_k, k = 0 to 4.
    pub fn emission(&self, dimension: usize) -> f64 {
        unit(owen(sobol(self.photon, dimension), combine(self.key, dimension as u32)))
    }

    /// The numbers of the next caster.
    pub fn next_caster(&mut self) -> Draw {
        let caster = self.casters;
        self.casters += 1;
        Draw { choice: self.choice(caster), microfacet: self.microfacet(caster) }
    }

    fn choice(&self, caster: u32) -> f64 {
        if caster == 0 && self.fifth_is_choice {
            return self.emission(4);
        }
        let shuffled = owen(self.photon, combine(self.key, 16 + 2 * caster)).reverse_bits();
        unit(owen(shuffled, combine(self.key, 17 + 2 * caster)))
    }

    fn microfacet(&self, caster: u32) -> [f64; 2] {
        let k = MICROFACETS + 2 * caster;
        let shuffled = owen(self.photon, combine(self.key, 16 + 2 * k));
        [
            unit(owen(shuffled.reverse_bits(), combine(self.key, 17 + 2 * k))),
            unit(owen(sobol(shuffled, 1), combine(self.key, 18 + 2 * k))),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const DIMENSIONS: usize = 5;

    fn choice_of(photon: u32, choice: u32) -> f64 {
        let mut numbers = PhotonNumbers::new(7, 2, photon);
        (0..=choice).fold(0.0, |_, _| numbers.next_caster().choice)
    }

    /// Whether each of 2^k intervals [i, i + 1)/2^k holds one of the 2^k values.
    fn is_net(values: impl Iterator<Item = u32>, k: u32) -> bool {
        let mut filled = vec![false; 1 << k];
        values.for_each(|x| filled[(u64::from(x) >> (32 - k)) as usize] = true);
        filled.iter().all(|&f| f)
    }

    /// Whether each elementary rectangle of area 2^−k holds one of the 2^k points.
    fn is_net_2d(points: &[(u32, u32)], k: u32) -> bool {
        (0..=k).all(|a| {
            let rectangle = |&(x, y): &(u32, u32)| {
                let (column, row) = (u64::from(x) >> (32 - a), u64::from(y) >> (32 - (k - a)));
                (column << (k - a) | row) as usize
            };
            let mut filled = vec![false; 1 << k];
            points.iter().for_each(|point| filled[rectangle(point)] = true);
            filled.iter().all(|&f| f)
        })
    }

    /// χ² of 16 × 16 bins against even filling, over its mean for independent numbers.
    fn chi_squared_ratio(points: impl Iterator<Item = (f64, f64)>) -> f64 {
        let mut bins = [0u32; 256];
        points.for_each(|(x, y)| bins[(x * 16.0) as usize * 16 + (y * 16.0) as usize] += 1);
        let expected = f64::from(bins.iter().sum::<u32>()) / 256.0;
        let chi_squared: f64 = bins.iter().map(|&n| (f64::from(n) - expected).powi(2) / expected).sum();
        chi_squared / 255.0
    }

    #[test]
    fn every_sobol_dimension_is_a_net_from_any_aligned_start() {
        for k in 0..=14 {
            for dimension in 0..DIMENSIONS {
                for start in [0, 5 << k, 0xa5 << (k + 2)] {
                    let points = (start..start + (1 << k)).map(|x| sobol(x, dimension));
                    assert!(is_net(points, k), "dimension {dimension}, 2^{k} points from {start}");
                }
            }
        }
    }

    #[test]
    fn first_two_sobol_dimensions_are_a_net() {
        for k in 0..=12 {
            let points: Vec<_> = (0..1 << k).map(|x| (sobol(x, 0), sobol(x, 1))).collect();
            assert!(is_net_2d(&points, k), "2^{k} points");
        }
    }

    #[test]
    fn scrambling_keeps_nets() {
        for key in [0, 1, 0xdead_beef] {
            for k in 0..=12 {
                let scrambled = |x, dimension| owen(sobol(x, dimension), combine(key, dimension as u32));
                for dimension in 0..DIMENSIONS {
                    assert!(is_net((0..1 << k).map(|x| scrambled(x, dimension)), k), "dimension {dimension}");
                }
                let points: Vec<_> = (0..1 << k).map(|x| (scrambled(x, 0), scrambled(x, 1))).collect();
                assert!(is_net_2d(&points, k));
            }
        }
    }

    #[test]
    fn choices_are_nets_one_by_one() {
        let k = 10;
        for choice in 0..4 {
            let numbers = (0..1 << k).map(|photon| (choice_of(photon, choice) * 2f64.powi(32)) as u32);
            assert!(is_net(numbers, k), "choice {choice}");
        }
    }

    // Hashed scrambles are not quite independent: over the keys, χ² is half as large again as for independent numbers
    // and its tail is fatter.
    #[test]
    fn choices_are_nearly_independent_of_each_other_and_of_emission() {
        let count = 1 << 16;
        for choice in 1..6 {
            for dimension in 0..DIMENSIONS {
                let emission = |photon| PhotonNumbers::new(7, 2, photon).emission(dimension);
                let ratio = chi_squared_ratio((0..count).map(|j| (emission(j), choice_of(j, choice))));
                assert!(ratio < 2.0, "emission {dimension}, choice {choice}: χ² is {ratio} times its mean");
            }
            let ratio = chi_squared_ratio((0..count).map(|j| (choice_of(j, choice), choice_of(j, choice + 1))));
            assert!(ratio < 2.0, "choices {choice} and {}: χ² is {ratio} times its mean", choice + 1);
        }
    }

    #[test]
    fn microfacet_numbers_are_nets_in_the_plane() {
        let k = 10;
        for caster in 0..4 {
            let points: Vec<_> = (0..1 << k)
                .map(|photon| PhotonNumbers::new(7, 2, photon).microfacet(caster))
                .map(|[x, y]| ((x * 2f64.powi(32)) as u32, (y * 2f64.powi(32)) as u32))
                .collect();
            assert!(is_net_2d(&points, k), "caster {caster}");
        }
    }

    #[test]
    fn hash_spreads_neighbours() {
        let points = (0..1 << 16).map(|x| (unit(hash(x)), unit(combine(x, 1))));
        assert!((chi_squared_ratio(points) - 1.0).abs() < 0.4);
    }

    #[test]
    fn choice_zero_is_the_fifth_emission_number() {
        let numbers = PhotonNumbers::new(11, 3, 12345);
        assert_eq!(numbers.clone().next_caster().choice, numbers.emission(4));
    }

    #[test]
    fn wavelength_takes_the_fifth_number_from_choice_zero() {
        let k = 10;
        let of = |photon| PhotonNumbers::new(7, 2, photon).with_wavelength();
        let numbers = (0..1 << k).map(|photon| (of(photon).next_caster().choice * 2f64.powi(32)) as u32);
        assert!(is_net(numbers, k));
        let pairs = (0..1 << 16).map(|photon| (of(photon).wavelength(), of(photon).next_caster().choice));
        assert!(chi_squared_ratio(pairs) < 2.0);
        // Later choices are what they are without dispersion.
        let (mut with, mut without) = (of(99), PhotonNumbers::new(7, 2, 99));
        assert_ne!(with.next_caster().choice, without.next_caster().choice);
        assert_eq!(with.next_caster(), without.next_caster());
        assert_eq!(with.wavelength(), without.emission(4));
    }

    #[test]
    fn unit_stays_below_one() {
        assert_eq!(unit(0), 0.0);
        assert_eq!(unit(u32::MAX), 1.0 - f64::exp2(-24.0));
    }
}
