//! nanoflann through a shim in C++: its result sets sum flux without a list, and can leave out what does not face the query.

use super::{Answer, Cloud, Engine, Load, Reach};
use crate::Arguments;
use crate::clock::timed;
use crate::sets::{K, Question, Set};
use libloading::Library;
use rayon::prelude::*;
use std::ffi::c_void;

/// Photons in a leaf: the best of 8, 10, 16, 24 and 32 to search.
const LEAF: usize = 32;
/// Queries that a thread takes at a time.
const SHARE: usize = 4096;

/// As the shim's.
#[repr(C)]
#[derive(Clone, Copy)]
struct Query {
    position: [f32; 3],
    radius: f32,
    normal: [f32; 3],
}

/// As the shim's.
#[repr(C)]
#[derive(Clone, Copy, Default)]
struct Found {
    flux: [f32; 3],
    count: u32,
    farthest_sq: f32,
}

type New = unsafe extern "C" fn(*const [f32; 3], *const Load, usize, usize) -> *mut c_void;
type Change = unsafe extern "C" fn(*mut c_void) -> bool;
type Free = unsafe extern "C" fn(*mut c_void);
type Flux = unsafe extern "C" fn(*const c_void, *const Query, usize, *mut Found);
type Nearest = unsafe extern "C" fn(*const c_void, *const Query, usize, usize, *mut Found);

#[derive(Clone, Copy)]
struct Functions {
    new: New,
    build: Change,
    settle: Change,
    free: Free,
    flux: Flux,
    nearest: Nearest,
}

/// A tree of the shim's, or none.
struct Tree {
    functions: Functions,
    handle: *mut c_void,
}

// SAFETY: a tree belongs to whoever has it, and searches do not change it.
unsafe impl Send for Tree {}
// SAFETY: see above.
unsafe impl Sync for Tree {}

impl Drop for Tree {
    fn drop(&mut self) {
        // SAFETY: the handle is the shim's, and nobody else has it; it takes null, too.
        unsafe { (self.functions.free)(self.handle) }
    }
}

impl Tree {
    fn new(functions: Functions, cloud: &Cloud) -> Result<Self, String> {
        let count = cloud.positions.len().min(cloud.loads.len());
        // SAFETY: both arrays hold `count` records, of the shim's layout; they are copied.
        let handle = unsafe { (functions.new)(cloud.positions.as_ptr(), cloud.loads.as_ptr(), count, LEAF) };
        if handle.is_null() { Err("memory is short".into()) } else { Ok(Self { functions, handle }) }
    }

    fn change(&mut self, change: Change) -> Result<(), String> {
        // SAFETY: the handle is the shim's, and nobody else has it now.
        if unsafe { change(self.handle) } { Ok(()) } else { Err("memory is short".into()) }
    }

    fn ask(&self, question: Question, queries: &[Query], out: &mut [Found]) {
        let count = queries.len().min(out.len());
        // SAFETY: both arrays hold `count` records of the shim's layout, and it has room for K nearest.
        unsafe {
            match question {
                Question::Flux => (self.functions.flux)(self.handle, queries.as_ptr(), count, out.as_mut_ptr()),
                Question::Nearest => {
                    (self.functions.nearest)(self.handle, queries.as_ptr(), count, K as usize, out.as_mut_ptr())
                }
            }
        }
    }
}

struct Nanoflann {
    functions: Functions,
    tree: Option<Tree>,
}

/// The engine, where the shim is there.
pub fn open(arguments: &Arguments) -> Result<Box<dyn Engine>, String> {
    let path = arguments.nanoflann.as_ref().ok_or("no library was named (--nanoflann)")?;
    let said = |error: libloading::Error| error.to_string();
    // SAFETY: the shim's functions have these types (`nanoflann.cpp`); it stays as long as the program.
    let functions = unsafe {
        let library: &'static Library = Box::leak(Box::new(Library::new(path).map_err(said)?));
        Functions {
            new: *library.get::<New>(b"peer_new").map_err(said)?,
            build: *library.get::<Change>(b"peer_build").map_err(said)?,
            settle: *library.get::<Change>(b"peer_settle").map_err(said)?,
            free: *library.get::<Free>(b"peer_free").map_err(said)?,
            flux: *library.get::<Flux>(b"peer_flux").map_err(said)?,
            nearest: *library.get::<Nearest>(b"peer_nearest").map_err(said)?,
        }
    };
    Ok(Box::new(Nanoflann { functions, tree: None }))
}

impl Engine for Nanoflann {
    fn build(&mut self, cloud: &Cloud, threads: usize) -> Result<f64, String> {
        self.tree = None;
        let mut tree = Tree::new(self.functions, cloud)?;
        let (seconds, built) = timed(threads, || tree.change(self.functions.build));
        built?;
        self.tree = Some(tree);
        Ok(seconds)
    }

    fn builds_in_parallel(&self) -> bool {
        false
    }

    fn settle(&mut self) -> Result<(), String> {
        let settle = self.functions.settle;
        self.tree.as_mut().ok_or("nothing was built")?.change(settle)
    }

    fn ask(&mut self, set: &Set, threads: usize) -> Result<(f64, Vec<Answer>), String> {
        let tree = self.tree.as_ref().ok_or("nothing was built")?;
        let query = |query: &photinus_photons::GatherQuery| Query {
            position: query.position.to_array(),
            radius: query.radius,
            normal: query.normal.to_array(),
        };
        let queries: Vec<Query> = set.queries.iter().map(query).collect();
        let mut out = vec![Found::default(); queries.len()];
        let parts = queries.par_chunks(SHARE).zip(out.par_chunks_mut(SHARE));
        let (seconds, ()) = timed(threads, || parts.for_each(|(queries, out)| tree.ask(set.question, queries, out)));
        let answer =
            |found: &Found| Answer { count: found.count, flux: Some(found.flux), farthest_sq: found.farthest_sq };
        Ok((seconds, out.iter().map(answer).collect()))
    }

    fn reach(&self, _: &Set) -> Reach {
        Reach::Facing
    }

    fn about(&self, _: &Set) -> &'static str {
        "flux, facing normals"
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::mem::{offset_of, size_of};

    /// nanoflann.cpp: floats and a u32, without padding.
    #[test]
    fn records_lie_as_in_the_shim() {
        assert_eq!((size_of::<Query>(), offset_of!(Query, radius), offset_of!(Query, normal)), (28, 12, 16));
        assert_eq!((size_of::<Found>(), offset_of!(Found, count), offset_of!(Found, farthest_sq)), (20, 12, 16));
        assert_eq!((size_of::<Load>(), offset_of!(Load, normal)), (24, 12));
        // Its arrays of the nearest.
        assert!((1..=256).contains(&K));
    }
}
