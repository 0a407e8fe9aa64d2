//! Trees are the same for any number of threads, nearly as good as the exact sweep's, and small.

mod common;

use std::sync::Mutex;
use whitted::geometry::{Primitives, Sphere};
use whitted::math::{SplitMix64, Vec3, Vec3f};
use whitted::tree::{BuildOptions, Tree, TreeKind};

const KINDS: [TreeKind; 3] = [TreeKind::Kd, TreeKind::Fast, TreeKind::Best];

/// A rough surface of `side`² cells and long thin triangles across it.
fn surface(side: u32, thin: u32) -> Primitives {
    let mut rng = SplitMix64::new(u64::from(side));
    let row = side + 1;
    let at = |i: u32, rng: &mut SplitMix64| Vec3::new((i % row) as f32, rng.uniform(0.0, 2.0) as f32, (i / row) as f32);
    let mut positions: Vec<Vec3f> = (0..row * row).map(|i| at(i, &mut rng)).collect();
    let corner = |i: u32| i / side * row + i % side;
    let cells = (0..side * side).map(corner);
    let mut triangles: Vec<[u32; 3]> =
        cells.flat_map(|a| [[a, a + 1, a + row], [a + 1, a + row + 1, a + row]]).collect();
    for _ in 0..thin {
        let first = positions.len() as u32;
        let [a, b] = [0, 1].map(|_| common::point(&mut rng, side.into()));
        positions.extend([a, b, b + Vec3::new(0.1, 0.0, 0.0)]);
        triangles.push([first, first + 1, first + 2]);
    }
    let mut primitives = Primitives::new();
    primitives.push_mesh(&positions, &triangles, &[], &[]).expect("a sound mesh");
    primitives
}

#[test]
fn threads_do_not_change_a_tree() {
    let mut primitives = surface(120, 2000);
    let mut rng = SplitMix64::new(3);
    (0..5000).for_each(|_| {
        primitives.push_sphere(Sphere { center: common::point(&mut rng, 100.0), radius: rng.uniform(0.1, 3.0) as f32 });
    });
    for kind in KINDS {
        let with = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
            let tree = pool.install(|| Tree::build(&primitives, &kind.into()));
            tree.validate(&primitives).unwrap_or_else(|error| panic!("{kind:?}: {error}"));
            // NaN in unused lanes prevents an ordinary comparison.
            format!("{tree:?}")
        };
        let one = with(1);
        for threads in [2, 3, 8] {
            assert!(with(threads) == one, "{kind:?}, {threads} threads");
        }
    }
}

#[test]
fn a_build_tells_how_far_it_is_and_can_be_stopped() {
    let primitives = surface(120, 2000);
    for kind in KINDS {
        let told = Mutex::new(Vec::new());
        let tell = |share| told.lock().unwrap().push(share);
        let one_thread = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a pool");
        let build = |stop| one_thread.install(|| Tree::build_until(&primitives, &kind.into(), stop));
        let told_of = |share| {
            tell(share);
            false
        };
        let tree = build(&told_of).expect("nothing stopped it");
        assert_eq!(format!("{tree:?}"), format!("{:?}", Tree::build(&primitives, &kind.into())));
        let shares = std::mem::take(&mut *told.lock().unwrap());
        assert!(shares.len() > 5 && shares.is_sorted() && shares[0] > 0.0, "{kind:?}: {shares:?}");
        // The last but one: everything has grown and is to be written down.
        assert!(
            (0.89..0.91).contains(&shares[shares.len() - 2]) && shares.last() == Some(&1.0),
            "{kind:?}: {shares:?}"
        );
        let half = |share| {
            tell(share);
            share > 0.4
        };
        assert!(build(&half).is_none());
        let shares = told.into_inner().unwrap();
        assert!(shares.iter().filter(|&&share| share > 0.4).count() == 1, "asked again: {shares:?}");
    }
    let nothing = Tree::build_until(&primitives, &TreeKind::None.into(), &|share| share == 1.0);
    assert!(nothing.is_none(), "the last answer counts, too");
}

#[test]
fn bins_lose_little_against_the_exact_sweep() {
    for (name, primitives, loss) in [("surface", surface(100, 0), 1.03), ("thin", surface(40, 1500), 1.08)] {
        let cost = |options| Tree::build(&primitives, &options).expected_cost();
        let exact = cost(BuildOptions { exact: true, ..TreeKind::Fast.into() });
        let [fast, best] = [TreeKind::Fast, TreeKind::Best].map(|kind| cost(kind.into()) / exact);
        println!("{name}: exact sweep {exact:.2}, fast {fast:.3} of it, best {best:.3}");
        assert!(fast < loss, "{name}: fast costs {fast:.3} of the exact sweep");
        assert!(best < fast * 1.001, "{name}: best {best:.3}, fast {fast:.3}");
    }
}

#[test]
fn a_mesh_takes_sixty_bytes_a_triangle() {
    let primitives = surface(200, 0);
    let report = Tree::build(&primitives, &TreeKind::Best.into()).report();
    let bytes = report.bytes as f64 / primitives.len() as f64;
    assert!(bytes <= 60.0, "{bytes:.1} bytes per triangle: {report:?}");
}
