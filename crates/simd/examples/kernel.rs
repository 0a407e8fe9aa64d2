//! How to write a kernel: distances from a point to many points, once, for every instruction set.
//!
//! `cargo run --release -p whitted-simd --example kernel [scalar|sse4.2|avx2|avx512]`

use simd::{F32Lanes, Kernel, Level, Simd, dispatch, lanes_from_fn};

/// Indices of points, as structure of arrays, of which the nearest to the origin is sought.
struct Nearest<'a> {
    points: &'a [[f32; 16]],
    scale: &'a [f32],
}

impl Kernel for Nearest<'_> {
    type Output = f32;

    #[inline(always)]
    fn run<S: Simd>(self, token: S) -> f32 {
        let mut nearest = S::F32x16::splat(token, f32::INFINITY);
        for block in self.points.chunks_exact(3) {
            let [x, y, z] = lanes_from_fn(|axis| S::F32x16::load(token, &block[axis]));
            let length = (x * x + y * y + z * z).sqrt();
            // The table is indexed by the rounded length, below its size.
            let last = S::F32x16::splat(token, (self.scale.len() - 1) as f32);
            let scale = S::F32x16::gather(self.scale, length.min(last).round_to_int());
            let distance = length * scale;
            let closer = distance.lt(nearest);
            nearest = S::F32x16::select(closer, distance, nearest);
        }
        nearest.reduce_min()
    }
}

fn main() {
    let level = match std::env::args().nth(1) {
        Some(name) => Level::by_name(&name).unwrap_or_else(|| panic!("this CPU has no {name}")),
        None => Level::best(),
    };
    let points: Vec<[f32; 16]> = (0..300).map(|i| std::array::from_fn(|j| ((i * 16 + j) % 97) as f32)).collect();
    let scale: Vec<f32> = (0..256).map(|i| 1.0 + i as f32 / 256.0).collect();
    println!("{level}: {}", dispatch(level, Nearest { points: &points, scale: &scale }));
}
