//! How far two images are apart: relMSE, PSNR and FLIP, over all pixels or those that a mask counts.

mod compare;
mod flip;
mod pixels;
mod psnr;
mod relmse;

pub use compare::{Comparison, compare, compare_files};
pub use flip::{flip, flip_map};
pub use psnr::psnr;
pub use relmse::{relmse, relmse_trimmed};
