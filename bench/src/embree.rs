//! Embree 4, loaded at run time: the foreign edge of the benchmark and the only file of it with `unsafe`.
//!
//! # What this module knows
//! The part of Embree's C interface (version 4.4, `rtcore.h`) that the benchmark calls, and how to set the flags of the
//! floating-point unit that its manual advises.
//!
//! # Invariants
//! * Nothing outside sees a raw pointer. A scene keeps its device alive, and the library is never unloaded.
//! * Queries run with subnormal numbers flushed to zero, as Embree's manual advises, and only they do: the flags are
//!   put back before any of our own arithmetic.

#![expect(unsafe_code, reason = "Embree's interface is C; every call goes through the table below")]

use libloading::Library;
use std::ffi::{CString, c_char, c_int, c_uint, c_void};
use std::fmt;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicI64, Ordering};
use whitted::geometry::Sphere;
use whitted::math::Vec3f;

/// Embree's number for "no geometry" and "no primitive".
pub(crate) const INVALID: u32 = u32::MAX;

/// Lanes of the widest packet.
const MAX_WIDTH: usize = 16;

/// Which lanes of a packet are in use: −1 for those that are.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
pub(crate) struct Lanes([i32; MAX_WIDTH]);

impl Lanes {
    /// The first `count` lanes.
    pub(crate) fn first(count: usize) -> Self {
        Self(std::array::from_fn(|lane| if lane < count { -1 } else { 0 }))
    }
}

type Handle = *mut c_void;
type MemoryMonitor = extern "C" fn(*mut c_void, isize, bool) -> bool;

/// Fills the struct of function pointers from a library, by their C names.
macro_rules! functions {
    ($($name:ident($($argument:ty),*) $(-> $result:ty)?;)*) => {
        #[expect(non_snake_case, reason = "the names of the C interface")]
        struct Functions { $($name: unsafe extern "C" fn($($argument),*) $(-> $result)?,)* }

        impl Functions {
            /// # Safety
            /// `library` must be an Embree 4, whose functions have these signatures.
            unsafe fn load(library: &Library) -> Result<Self, libloading::Error> {
                // SAFETY: the caller vouches for the library, and with it for the signatures.
                unsafe { Ok(Self { $($name: *library.get(stringify!($name))?,)* }) }
            }
        }
    };
}

functions! {
    rtcNewDevice(*const c_char) -> Handle;
    rtcReleaseDevice(Handle);
    rtcGetDeviceError(Handle) -> c_int;
    rtcGetDeviceProperty(Handle, c_int) -> isize;
    rtcSetDeviceMemoryMonitorFunction(Handle, MemoryMonitor, *mut c_void);
    rtcNewGeometry(Handle, c_int) -> Handle;
    rtcSetNewGeometryBuffer(Handle, c_int, c_uint, c_int, usize, usize) -> *mut c_void;
    rtcSetGeometryBuildQuality(Handle, c_int);
    rtcCommitGeometry(Handle);
    rtcReleaseGeometry(Handle);
    rtcNewScene(Handle) -> Handle;
    rtcSetSceneBuildQuality(Handle, c_int);
    rtcAttachGeometry(Handle, Handle) -> c_uint;
    rtcCommitScene(Handle);
    rtcReleaseScene(Handle);
    rtcIntersect1(Handle, *mut c_void, *mut Arguments);
    rtcIntersect8(*const c_int, Handle, *mut c_void, *mut Arguments);
    rtcIntersect16(*const c_int, Handle, *mut c_void, *mut Arguments);
    rtcOccluded1(Handle, *mut c_void, *mut Arguments);
    rtcOccluded8(*const c_int, Handle, *mut c_void, *mut Arguments);
    rtcOccluded16(*const c_int, Handle, *mut c_void, *mut Arguments);
}

/// `RTCIntersectArguments` and `RTCOccludedArguments`, which are laid out alike.
#[repr(C)]
struct Arguments {
    flags: c_uint,
    features: c_uint,
    context: *mut c_void,
    filter: *mut c_void,
    function: *mut c_void,
    /// Builds of Embree with a minimal curve width read one float more.
    room: [u64; 2],
}

impl Arguments {
    fn new(coherent: bool) -> Self {
        const COHERENT: c_uint = 1 << 16;
        const ALL_FEATURES: c_uint = u32::MAX;
        let none = std::ptr::null_mut();
        let flags = if coherent { COHERENT } else { 0 };
        Self { flags, features: ALL_FEATURES, context: none, filter: none, function: none, room: [0; 2] }
    }
}

/// `RTCRay`, `RTCRay8`, `RTCRay16`: N rays, row by row; `A` gives the alignment that Embree asks for.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub(crate) struct Rays<A, const N: usize> {
    pub alignment: [A; 0],
    pub origin: [[f32; N]; 3],
    pub t_min: [f32; N],
    pub direction: [[f32; N]; 3],
    pub time: [f32; N],
    pub t_max: [f32; N],
    pub mask: [u32; N],
    pub id: [u32; N],
    pub flags: [u32; N],
}

/// `RTCRayHit` and its wide kin: rays with the answers of Embree beside them.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub(crate) struct RayHits<A, const N: usize> {
    pub rays: Rays<A, N>,
    pub normal: [[f32; N]; 3],
    pub u: [f32; N],
    pub v: [f32; N],
    pub primitive: [u32; N],
    pub geometry: [u32; N],
    /// Instance, and since 4.3 the primitive within an instance array.
    pub instance: [[u32; N]; 2],
}

/// Alignment of single rays.
#[derive(Clone, Copy, Debug)]
#[repr(align(16))]
pub(crate) struct Align16;
/// Alignment of packets of 8.
#[derive(Clone, Copy, Debug)]
#[repr(align(32))]
pub(crate) struct Align32;
/// Alignment of packets of 16.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
pub(crate) struct Align64;

const _: () = assert!(size_of::<Rays<Align16, 1>>() == 48 && size_of::<RayHits<Align16, 1>>() == 96);
const _: () = assert!(size_of::<Rays<Align32, 8>>() == 384 && align_of::<RayHits<Align32, 8>>() == 32);
const _: () = assert!(size_of::<Rays<Align64, 16>>() == 768 && align_of::<RayHits<Align64, 16>>() == 64);

/// How much work Embree puts into its tree.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Quality {
    /// `RTC_BUILD_QUALITY_MEDIUM`, the default.
    Medium = 1,
    /// `RTC_BUILD_QUALITY_HIGH`: with spatial splits.
    High = 2,
}

impl fmt::Display for Quality {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Medium => "medium",
            Self::High => "high",
        })
    }
}

/// What went wrong with Embree, in words.
#[derive(Debug)]
pub(crate) struct EmbreeError(String);

impl fmt::Display for EmbreeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Embree: {}", self.0)
    }
}

impl std::error::Error for EmbreeError {}

/// A loaded Embree library.
#[derive(Clone, Copy)]
pub(crate) struct Embree(&'static Functions);

impl Embree {
    /// Load the library at `path`, or the one in the folder `path`. It stays loaded for good.
    ///
    /// # Errors
    /// [`EmbreeError`] if there is none, or it is not an Embree 4.
    pub(crate) fn load(path: &Path) -> Result<Self, EmbreeError> {
        let path = if path.is_dir() { beside(path, "libembree4") } else { Some(path.to_owned()) };
        let path = path.ok_or_else(|| EmbreeError("no libembree4* in that folder".into()))?;
        let wrong = |error: libloading::Error| EmbreeError(format!("{}: {error}", path.display()));
        // Wheels and archives put TBB beside Embree, where the loader does not look by itself.
        if let Some(tbb) =
            path.parent().and_then(|folder| beside(folder, "libtbb.").or_else(|| beside(folder, "libtbb-")))
        {
            std::mem::forget(open(&tbb).map_err(wrong)?);
        }
        let library = Box::leak(Box::new(open(&path).map_err(wrong)?));
        // SAFETY: the user names this library as Embree 4; every function of version 4 has had these signatures.
        let functions = unsafe { Functions::load(library) }.map_err(wrong)?;
        Ok(Self(Box::leak(Box::new(functions))))
    }

    /// Open a device that builds with `threads` threads; `isa` limits its instruction set, as `avx2`.
    ///
    /// # Errors
    /// [`EmbreeError`] if Embree refuses the configuration.
    pub(crate) fn device(self, threads: usize, isa: Option<&str>) -> Result<Device, EmbreeError> {
        let isa = isa.map_or(String::new(), |isa| format!(",isa={isa}"));
        let configuration = format!("threads={threads},set_affinity=0{isa}");
        let text =
            CString::new(configuration.as_str()).map_err(|_| EmbreeError("a NUL in the configuration".into()))?;
        // SAFETY: `text` is a C string that outlives the call.
        let handle = unsafe { (self.0.rtcNewDevice)(text.as_ptr()) };
        if handle.is_null() {
            return Err(EmbreeError(format!("no device with {configuration}")));
        }
        let bytes: &'static AtomicI64 = Box::leak(Box::default());
        // SAFETY: the device is valid, the function has the type of a monitor, and the counter is never freed.
        unsafe {
            (self.0.rtcSetDeviceMemoryMonitorFunction)(
                handle,
                count_bytes,
                std::ptr::from_ref(bytes).cast_mut().cast(),
            );
        }
        let device = Device { functions: self.0, handle, bytes };
        device.check()?;
        Ok(device)
    }
}

fn open(path: &Path) -> Result<Library, libloading::Error> {
    // SAFETY: loading runs the library's initialisers; the user names a library that he trusts.
    #[cfg(unix)]
    unsafe {
        use libloading::os::unix::{Library, RTLD_GLOBAL, RTLD_NOW};
        Library::open(Some(path), RTLD_NOW | RTLD_GLOBAL).map(Into::into)
    }
    // SAFETY: as above.
    #[cfg(not(unix))]
    unsafe {
        Library::new(path)
    }
}

/// The file in `folder` whose name begins with `prefix`; the first of several by name.
fn beside(folder: &Path, prefix: &str) -> Option<PathBuf> {
    let entries = std::fs::read_dir(folder).ok()?.flatten();
    let named = entries.filter(|entry| entry.file_name().to_string_lossy().starts_with(prefix));
    named.map(|entry| entry.path()).min()
}

extern "C" fn count_bytes(counter: *mut c_void, bytes: isize, _: bool) -> bool {
    // SAFETY: `counter` is the leaked counter that was registered together with this function.
    let counter = unsafe { &*counter.cast::<AtomicI64>() };
    counter.fetch_add(bytes as i64, Ordering::Relaxed);
    true
}

/// An open device.
pub(crate) struct Device {
    functions: &'static Functions,
    handle: Handle,
    bytes: &'static AtomicI64,
}

impl Device {
    /// The version as `4.4.0`.
    pub(crate) fn version(&self) -> String {
        const VERSION: c_int = 0;
        // SAFETY: the device is valid until dropped.
        let number = unsafe { (self.functions.rtcGetDeviceProperty)(self.handle, VERSION) };
        format!("{}.{}.{}", number / 10000, number / 100 % 100, number % 100)
    }

    /// Bytes that Embree holds now.
    pub(crate) fn bytes(&self) -> i64 {
        self.bytes.load(Ordering::Relaxed)
    }

    fn check(&self) -> Result<(), EmbreeError> {
        // SAFETY: the device is valid until dropped.
        match unsafe { (self.functions.rtcGetDeviceError)(self.handle) } {
            0 => Ok(()),
            code => Err(EmbreeError(format!("error code {code}"))),
        }
    }

    /// Hand Embree triangles and spheres; nothing is built yet.
    ///
    /// # Errors
    /// [`EmbreeError`] if Embree refuses them.
    pub(crate) fn scene(
        &self,
        vertices: &[Vec3f],
        triangles: &[[u32; 3]],
        spheres: &[Sphere],
        quality: Quality,
    ) -> Result<Scene<'_>, EmbreeError> {
        // SAFETY: the device is valid until dropped, which the scene's lifetime forbids.
        let scene = Scene { device: self, handle: unsafe { (self.functions.rtcNewScene)(self.handle) } };
        // SAFETY: the scene was just made; the number is one of RTCBuildQuality.
        unsafe { (self.functions.rtcSetSceneBuildQuality)(scene.handle, quality as c_int) };
        if !triangles.is_empty() {
            let points: Vec<[f32; 3]> = vertices.iter().map(|v| v.to_array()).collect();
            scene.attach(TRIANGLES, quality, &[(INDEX, UINT3, triangles.into()), (VERTEX, FLOAT3, points[..].into())]);
        }
        if !spheres.is_empty() {
            let points: Vec<[f32; 4]> =
                spheres.iter().map(|s| [s.center.x, s.center.y, s.center.z, s.radius]).collect();
            scene.attach(SPHERES, quality, &[(VERTEX, FLOAT4, points[..].into())]);
        }
        self.check()?;
        Ok(scene)
    }
}

/// `RTC_GEOMETRY_TYPE_TRIANGLE` and `_SPHERE_POINT`.
const TRIANGLES: c_int = 0;
const SPHERES: c_int = 50;
/// `RTC_BUFFER_TYPE_INDEX` and `_VERTEX`.
const INDEX: c_int = 0;
const VERTEX: c_int = 1;
/// `RTC_FORMAT_UINT3`, `_FLOAT3`, `_FLOAT4`.
const UINT3: c_int = 0x5003;
const FLOAT3: c_int = 0x9003;
const FLOAT4: c_int = 0x9004;

/// Bytes of an array of plain numbers.
struct Bytes {
    start: *const u8,
    stride: usize,
    count: usize,
}

impl<T: Copy, const N: usize> From<&[[T; N]]> for Bytes {
    fn from(items: &[[T; N]]) -> Self {
        Self { start: items.as_ptr().cast(), stride: size_of::<[T; N]>(), count: items.len() }
    }
}

impl Drop for Device {
    fn drop(&mut self) {
        // SAFETY: made by rtcNewDevice and released once; scenes borrow the device and are gone.
        unsafe { (self.functions.rtcReleaseDevice)(self.handle) };
    }
}

/// A scene of Embree.
pub(crate) struct Scene<'d> {
    device: &'d Device,
    handle: Handle,
}

impl Scene<'_> {
    fn attach(&self, kind: c_int, quality: Quality, buffers: &[(c_int, c_int, Bytes)]) {
        let functions = self.device.functions;
        // SAFETY: device, geometry and scene are valid; Embree returns room for `count` items of `stride` bytes (or
        // null, having recorded an error), and each source has exactly as many.
        unsafe {
            let geometry = (functions.rtcNewGeometry)(self.device.handle, kind);
            for (buffer, format, source) in buffers {
                let room =
                    (functions.rtcSetNewGeometryBuffer)(geometry, *buffer, 0, *format, source.stride, source.count);
                if !room.is_null() {
                    std::ptr::copy_nonoverlapping(source.start, room.cast(), source.stride * source.count);
                }
            }
            (functions.rtcSetGeometryBuildQuality)(geometry, quality as c_int);
            (functions.rtcCommitGeometry)(geometry);
            (functions.rtcAttachGeometry)(self.handle, geometry);
            (functions.rtcReleaseGeometry)(geometry);
        }
    }

    /// Build the tree.
    ///
    /// # Errors
    /// [`EmbreeError`] if Embree reports one.
    pub(crate) fn commit(&self) -> Result<(), EmbreeError> {
        // SAFETY: the scene is valid and nothing else uses it.
        unsafe { (self.device.functions.rtcCommitScene)(self.handle) };
        self.device.check()
    }

    /// Find the closest hits of all packets; `last` says which lanes of the last packet are in use.
    pub(crate) fn closest_hits<A, const N: usize>(&self, packets: &mut [RayHits<A, N>], last: &Lanes, coherent: bool) {
        let functions = self.device.functions;
        self.query::<_, N>(
            packets,
            last,
            coherent,
            functions.rtcIntersect1,
            match N {
                8 => functions.rtcIntersect8,
                _ => functions.rtcIntersect16,
            },
        );
    }

    /// Find which rays are blocked: their `t_max` becomes −∞.
    pub(crate) fn occluded<A, const N: usize>(&self, packets: &mut [Rays<A, N>], last: &Lanes, coherent: bool) {
        let functions = self.device.functions;
        self.query::<_, N>(
            packets,
            last,
            coherent,
            functions.rtcOccluded1,
            match N {
                8 => functions.rtcOccluded8,
                _ => functions.rtcOccluded16,
            },
        );
    }

    /// Call `single` for each ray (N = 1) or `wide` for each packet (N = 8 or 16).
    fn query<P, const N: usize>(
        &self,
        packets: &mut [P],
        last: &Lanes,
        coherent: bool,
        single: unsafe extern "C" fn(Handle, *mut c_void, *mut Arguments),
        wide: unsafe extern "C" fn(*const c_int, Handle, *mut c_void, *mut Arguments),
    ) {
        const { assert!(N == 1 || N == 8 || N == 16, "the packets of Embree") };
        const ALL: Lanes = Lanes([-1; MAX_WIDTH]);
        let mut arguments = Arguments::new(coherent);
        let arguments = &raw mut arguments;
        let count = packets.len();
        let _flushed = FlushSubnormals::new();
        for (index, packet) in packets.iter_mut().enumerate() {
            let packet = std::ptr::from_mut(packet).cast();
            let valid = if index + 1 == count { last } else { &ALL };
            // SAFETY: the scene is committed and valid; `packet` is an initialised packet of the layout and alignment
            // that the function for N lanes asks for (asserted above); `valid` has at least N numbers and the alignment
            // of the widest packet.
            unsafe {
                match N {
                    1 => single(self.handle, packet, arguments),
                    _ => wide(valid.0.as_ptr(), self.handle, packet, arguments),
                }
            }
        }
    }
}

impl Drop for Scene<'_> {
    fn drop(&mut self) {
        // SAFETY: made by rtcNewScene and released once.
        unsafe { (self.device.functions.rtcReleaseScene)(self.handle) };
    }
}

/// While it lives, subnormal inputs and results count as zero (DAZ and FTZ), where the processor has these flags.
struct FlushSubnormals(u32);

#[cfg(target_arch = "x86_64")]
impl FlushSubnormals {
    fn new() -> Self {
        const FTZ_AND_DAZ: u32 = 1 << 15 | 1 << 6;
        let before = read_flags();
        write_flags(before | FTZ_AND_DAZ);
        Self(before)
    }
}

#[cfg(target_arch = "x86_64")]
impl Drop for FlushSubnormals {
    fn drop(&mut self) {
        write_flags(self.0);
    }
}

#[cfg(not(target_arch = "x86_64"))]
impl FlushSubnormals {
    fn new() -> Self {
        Self(0)
    }
}

#[cfg(target_arch = "x86_64")]
fn read_flags() -> u32 {
    let mut flags = 0_u32;
    // SAFETY: every x86-64 has SSE; the instruction writes four bytes to a variable of four bytes.
    unsafe { std::arch::asm!("stmxcsr [{}]", in(reg) &raw mut flags, options(nostack, preserves_flags)) };
    flags
}

#[cfg(target_arch = "x86_64")]
fn write_flags(flags: u32) {
    // SAFETY: `flags` came from the processor, with at most the two flush bits set, which do not trap; no arithmetic of
    // ours runs between setting and resetting them.
    unsafe { std::arch::asm!("ldmxcsr [{}]", in(reg) &raw const flags, options(nostack, preserves_flags)) };
}
