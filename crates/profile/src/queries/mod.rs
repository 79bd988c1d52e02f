//! Recorded queries: every ray and photon search of a render with what asked for it and its answer, and the photons that
//! were searched. Input for simulations, placement studies, hardware and anyone outside; `docs/queries.md` has the format.

mod bytes;
mod reader;
mod record;
mod writer;

pub use reader::{QueryFile, QueryFileError};
pub use record::{
    Block, BlockKey, MapKind, NO_PARENT, QuerySink, RayAnswer, RayHit, RayKind, RayRecord, SearchAnswer, SearchKernel,
    SearchRecord, Stage,
};
pub use writer::{QueryFileWriter, QueryTotals};
