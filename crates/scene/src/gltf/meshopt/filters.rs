//! What is done to decoded attributes.

/// Unit vectors of bytes: from the octahedron, on which the third number is one, to the sphere.
pub(super) fn octahedral_8(bytes: &mut [u8]) {
    for element in bytes.as_chunks_mut::<4>().0 {
        let [x, y, one, _] = element.map(|byte| f32::from(byte as i8));
        let vector = on_sphere(x, y, one, f32::from(i8::MAX));
        for (byte, number) in element.iter_mut().zip(vector) {
            *byte = number as i8 as u8;
        }
    }
}

/// The same of numbers of 16 bits.
pub(super) fn octahedral_16(bytes: &mut [u8]) {
    for element in bytes.as_chunks_mut::<8>().0 {
        let [x, y, one, _] = shorts(element).map(f32::from);
        let vector = on_sphere(x, y, one, f32::from(i16::MAX));
        for (pair, number) in element.as_chunks_mut::<2>().0.iter_mut().zip(vector) {
            *pair = (number as i16).to_le_bytes();
        }
    }
}

fn on_sphere(x: f32, y: f32, one: f32, most: f32) -> [f32; 3] {
    let z = one - x.abs() - y.abs();
    let fold = z.min(0.0);
    let (x, y) = (x + if x >= 0.0 { fold } else { -fold }, y + if y >= 0.0 { fold } else { -fold });
    let length = (x * x + y * y + z * z).sqrt();
    let scale = if length > 0.0 { most / length } else { 0.0 };
    [x, y, z].map(|number| (number * scale).round())
}

/// Rotations: three numbers of which the fourth, the greatest, follows; which that is stands in the last two bits.
pub(super) fn quaternion(bytes: &mut [u8]) {
    for element in bytes.as_chunks_mut::<8>().0 {
        let [x, y, z, w] = shorts(element);
        let one = f32::from(w | 3);
        let scale = std::f32::consts::FRAC_1_SQRT_2 / one;
        let [x, y, z] = [x, y, z].map(|number| f32::from(number) * scale);
        let greatest = (1.0 - x * x - y * y - z * z).max(0.0).sqrt();
        let places = [1, 2, 3, 0].map(|step| (w as usize + step) % 4);
        for (place, number) in places.into_iter().zip([x, y, z, greatest]) {
            let number = (number * f32::from(i16::MAX)).round() as i16;
            element.as_chunks_mut::<2>().0[place] = number.to_le_bytes();
        }
    }
}

/// Floating-point numbers: a whole number of 24 bits times a power of two.
pub(super) fn exponential(bytes: &mut [u8]) {
    for word in bytes.as_chunks_mut::<4>().0 {
        let number = i32::from_le_bytes(*word);
        let (exponent, mantissa) = (number >> 24, (number << 8) >> 8);
        let value = f64::from(mantissa) * f64::from(exponent).exp2();
        *word = (value as f32).to_le_bytes();
    }
}

fn shorts(element: &[u8; 8]) -> [i16; 4] {
    let (pairs, _) = element.as_chunks::<2>();
    std::array::from_fn(|k| i16::from_le_bytes(pairs[k]))
}
