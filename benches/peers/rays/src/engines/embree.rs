//! Embree 4 through its C interface, bound at run time: single rays and packets of sixteen, fast and robust.

use super::Engine;
use crate::Arguments;
use crate::meshes::Mesh;
use libloading::{Library, Symbol};
use photinus_geometry::{Hit, NO_HIT, Ray};
use std::ffi::{CString, c_char, c_void};

type Handle = *mut c_void;

/// As `RTCRayHit`; the last word is only there in some builds of the library, and room does no harm.
#[repr(C, align(16))]
#[derive(Clone, Copy, Default)]
struct RayHit {
    origin: [f32; 3],
    near: f32,
    dir: [f32; 3],
    time: f32,
    far: f32,
    mask: u32,
    id: u32,
    flags: u32,
    normal: [f32; 3],
    u: f32,
    v: f32,
    prim: u32,
    geometry: u32,
    instances: [u32; 2],
}

/// As `RTCRayHit16`.
#[repr(C, align(64))]
#[derive(Clone, Copy, Default)]
struct RayHit16 {
    origin: [[f32; 16]; 3],
    near: [f32; 16],
    dir: [[f32; 16]; 3],
    time: [f32; 16],
    far: [f32; 16],
    mask: [u32; 16],
    id: [u32; 16],
    flags: [u32; 16],
    normal: [[f32; 16]; 3],
    u: [f32; 16],
    v: [f32; 16],
    prim: [u32; 16],
    geometry: [u32; 16],
    instances: [[u32; 16]; 2],
}

/// `RTC_SCENE_FLAG_ROBUST`.
const ROBUST: u32 = 1 << 2;
/// `RTC_BUILD_QUALITY_MEDIUM` and `RTC_BUILD_QUALITY_HIGH`.
const MEDIUM: u32 = 1;
/// `RTC_BUFFER_TYPE_INDEX`, `RTC_BUFFER_TYPE_VERTEX`, `RTC_FORMAT_UINT3`, `RTC_FORMAT_FLOAT3`.
const INDEX: (u32, u32) = (0, 0x5003);
const VERTEX: (u32, u32) = (1, 0x9003);
/// As `RTCIntersectArguments` and `RTCOccludedArguments`.
#[repr(C)]
struct QueryArguments {
    flags: u32,
    features: u32,
    context: *mut c_void,
    filter: *mut c_void,
    intersect: *mut c_void,
    width_factor: f32,
}

/// `RTC_RAY_QUERY_FLAG_COHERENT`, with `RTC_FEATURE_FLAG_ALL`.
const COHERENT: QueryArguments = QueryArguments {
    flags: 1 << 16,
    features: u32::MAX,
    context: std::ptr::null_mut(),
    filter: std::ptr::null_mut(),
    intersect: std::ptr::null_mut(),
    width_factor: 0.0,
};

/// `RTC_INVALID_GEOMETRY_ID`.
const NONE: u32 = u32::MAX;

type Intersect = unsafe extern "C" fn(Handle, *mut RayHit, *mut c_void);
type Intersect16 = unsafe extern "C" fn(*const i32, Handle, *mut RayHit16, *mut c_void);

struct Embree {
    scene: Handle,
    packets: bool,
    intersect: Intersect,
    occluded: Intersect,
    intersect16: Intersect16,
    occluded16: Intersect16,
    /// Read by the scene as long as it lives.
    _vertices: Vec<[f32; 4]>,
    _indices: Vec<[u32; 3]>,
}

// Queries of a committed scene may come from any thread (rtcIntersect1, "thread safety").
unsafe impl Sync for Embree {}

/// Fast mode, single rays.
pub fn fast(mesh: &Mesh, arguments: &Arguments) -> Result<Box<dyn Engine>, String> {
    build(mesh, arguments, 0, false)
}

/// Robust (watertight) mode, single rays.
pub fn robust(mesh: &Mesh, arguments: &Arguments) -> Result<Box<dyn Engine>, String> {
    build(mesh, arguments, ROBUST, false)
}

/// Fast mode, packets of sixteen.
pub fn fast_packets(mesh: &Mesh, arguments: &Arguments) -> Result<Box<dyn Engine>, String> {
    build(mesh, arguments, 0, true)
}

/// Robust mode, packets of sixteen.
pub fn robust_packets(mesh: &Mesh, arguments: &Arguments) -> Result<Box<dyn Engine>, String> {
    build(mesh, arguments, ROBUST, true)
}

fn build(mesh: &Mesh, arguments: &Arguments, flags: u32, packets: bool) -> Result<Box<dyn Engine>, String> {
    let path = arguments.embree.as_ref().ok_or("no library was named (--embree)")?;
    let said = |error: libloading::Error| error.to_string();
    // Functions and constants as the headers of Embree 4 declare them.
    unsafe {
        // Its threads outlive scenes: it stays as long as the program.
        let library: &'static Library = Box::leak(Box::new(Library::new(path).map_err(said)?));
        let vertices: Vec<[f32; 4]> = mesh.primitives.positions.iter().map(|v| [v.x, v.y, v.z, 0.0]).collect();
        let indices = mesh.primitives.triangles.clone();
        let new_device: Symbol<unsafe extern "C" fn(*const c_char) -> Handle> =
            library.get(b"rtcNewDevice").map_err(said)?;
        let new_scene: Symbol<unsafe extern "C" fn(Handle) -> Handle> = library.get(b"rtcNewScene").map_err(said)?;
        let set_flags: Symbol<unsafe extern "C" fn(Handle, u32)> = library.get(b"rtcSetSceneFlags").map_err(said)?;
        let set_quality: Symbol<unsafe extern "C" fn(Handle, u32)> =
            library.get(b"rtcSetSceneBuildQuality").map_err(said)?;
        let new_geometry: Symbol<unsafe extern "C" fn(Handle, u32) -> Handle> =
            library.get(b"rtcNewGeometry").map_err(said)?;
        let set_buffer: Symbol<unsafe extern "C" fn(Handle, u32, u32, u32, *const c_void, usize, usize, usize)> =
            library.get(b"rtcSetSharedGeometryBuffer").map_err(said)?;
        let commit_geometry: Symbol<unsafe extern "C" fn(Handle)> = library.get(b"rtcCommitGeometry").map_err(said)?;
        let attach: Symbol<unsafe extern "C" fn(Handle, Handle) -> u32> =
            library.get(b"rtcAttachGeometry").map_err(said)?;
        let commit_scene: Symbol<unsafe extern "C" fn(Handle)> = library.get(b"rtcCommitScene").map_err(said)?;
        let config = CString::new(format!("threads={}", arguments.threads)).map_err(|error| error.to_string())?;
        let device = new_device(config.as_ptr());
        if device.is_null() {
            return Err("rtcNewDevice gave none".into());
        }
        let scene = new_scene(device);
        set_flags(scene, flags);
        set_quality(scene, MEDIUM);
        let geometry = new_geometry(device, 0);
        let (vertex_count, index_count) = (vertices.len(), indices.len());
        set_buffer(geometry, VERTEX.0, 0, VERTEX.1, vertices.as_ptr().cast(), 0, 16, vertex_count);
        set_buffer(geometry, INDEX.0, 0, INDEX.1, indices.as_ptr().cast(), 0, 12, index_count);
        commit_geometry(geometry);
        attach(scene, geometry);
        commit_scene(scene);
        let (intersect, occluded) = (
            *library.get::<Intersect>(b"rtcIntersect1").map_err(said)?,
            *library.get::<Intersect>(b"rtcOccluded1").map_err(said)?,
        );
        let (intersect16, occluded16) = (
            *library.get::<Intersect16>(b"rtcIntersect16").map_err(said)?,
            *library.get::<Intersect16>(b"rtcOccluded16").map_err(said)?,
        );
        Ok(Box::new(Embree {
            scene,
            packets,
            intersect,
            occluded,
            intersect16,
            occluded16,
            _vertices: vertices,
            _indices: indices,
        }))
    }
}

fn single(ray: &Ray) -> RayHit {
    RayHit {
        origin: ray.origin.to_array(),
        near: ray.t_min,
        dir: ray.dir.to_array(),
        far: ray.t_max,
        mask: u32::MAX,
        prim: NONE,
        geometry: NONE,
        instances: [NONE; 2],
        ..RayHit::default()
    }
}

fn packet(rays: &[Ray]) -> (RayHit16, [i32; 16]) {
    let mut out = RayHit16 {
        mask: [u32::MAX; 16],
        prim: [NONE; 16],
        geometry: [NONE; 16],
        instances: [[NONE; 16]; 2],
        ..Default::default()
    };
    let mut valid = [0; 16];
    for (i, ray) in rays.iter().enumerate() {
        valid[i] = -1;
        for axis in 0..3 {
            out.origin[axis][i] = ray.origin[axis];
            out.dir[axis][i] = ray.dir[axis];
        }
        (out.near[i], out.far[i]) = (ray.t_min, ray.t_max);
    }
    (out, valid)
}

impl Engine for Embree {
    fn closest(&self, rays: &[Ray], hits: &mut [Hit]) {
        if self.packets {
            for (rays, hits) in rays.chunks(16).zip(hits.chunks_mut(16)) {
                let ((mut query, valid), mut said) = (packet(rays), COHERENT);
                let said = (&raw mut said).cast();
                unsafe { (self.intersect16)(valid.as_ptr(), self.scene, &mut query, said) };
                for (i, hit) in hits.iter_mut().enumerate() {
                    let found = query.geometry[i] != NONE;
                    let prim = if found { query.prim[i] } else { NO_HIT };
                    let t = if found { query.far[i] } else { f32::INFINITY };
                    *hit = Hit { t, alpha: query.u[i], beta: query.v[i], prim };
                }
            }
            return;
        }
        for (ray, hit) in rays.iter().zip(hits) {
            let mut query = single(ray);
            unsafe { (self.intersect)(self.scene, &mut query, std::ptr::null_mut()) };
            let found = query.geometry != NONE;
            let prim = if found { query.prim } else { NO_HIT };
            let t = if found { query.far } else { f32::INFINITY };
            *hit = Hit { t, alpha: query.u, beta: query.v, prim };
        }
    }

    fn any(&self, rays: &[Ray], occluded: &mut [bool]) -> bool {
        if self.packets {
            for (rays, occluded) in rays.chunks(16).zip(occluded.chunks_mut(16)) {
                let ((mut query, valid), mut said) = (packet(rays), COHERENT);
                let said = (&raw mut said).cast();
                unsafe { (self.occluded16)(valid.as_ptr(), self.scene, &mut query, said) };
                for (i, occluded) in occluded.iter_mut().enumerate() {
                    *occluded = query.far[i] < 0.0;
                }
            }
            return true;
        }
        for (ray, occluded) in rays.iter().zip(occluded) {
            let mut query = single(ray);
            unsafe { (self.occluded)(self.scene, &mut query, std::ptr::null_mut()) };
            *occluded = query.far < 0.0;
        }
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::mem::{align_of, offset_of, size_of};

    /// Embree 4.4, rtcore_ray.h: a ray of twelve words, then normal, u, v, primitive, geometry and instances.
    #[test]
    fn records_lie_as_in_the_headers() {
        assert_eq!((offset_of!(RayHit, far), offset_of!(RayHit, normal)), (32, 48));
        assert_eq!((offset_of!(RayHit, u), offset_of!(RayHit, prim), offset_of!(RayHit, geometry)), (60, 68, 72));
        assert_eq!((align_of::<RayHit>(), align_of::<RayHit16>()), (16, 64));
        assert_eq!((offset_of!(RayHit16, far), offset_of!(RayHit16, prim)), (16 * 32, 16 * 68));
        assert!(size_of::<RayHit>() >= 84 && size_of::<RayHit16>() >= 16 * 84);
    }
}
