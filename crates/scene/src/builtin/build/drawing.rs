//! Pictures that other threads draw while a scene is put together.

use crate::Bitmap;
use rayon::Yield;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, TryRecvError, channel};

/// A picture that is being drawn.
pub struct Drawing(Receiver<Arc<Bitmap>>);

impl Drawing {
    /// Has `picture` drawn by the threads of the pool.
    pub fn begin(picture: impl FnOnce() -> Arc<Bitmap> + Send + 'static) -> Self {
        let (sender, receiver) = channel();
        rayon::spawn(move || {
            // Nobody waits for the pictures of a scene that was given up.
            let _ = sender.send(picture());
        });
        Self(receiver)
    }

    /// The picture, once it is there.
    ///
    /// # Panics
    /// Where drawing it did.
    pub fn finished(self) -> Arc<Bitmap> {
        loop {
            // A thread of the pool helps meanwhile: it may be the only one.
            match (self.0.try_recv(), rayon::yield_now()) {
                (Ok(picture), _) => return picture,
                (Err(TryRecvError::Empty), Some(Yield::Executed)) => {}
                (Err(TryRecvError::Empty), Some(Yield::Idle)) => std::thread::yield_now(),
                _ => return self.0.recv().expect("pictures are drawn without panics"),
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::bitmap::{hex, weave};
    use super::*;

    #[test]
    fn a_pool_of_one_thread_draws_what_it_waits_for() {
        let draw = || weave(1, hex(0xFFFFFF), hex(0x808080));
        let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
        let inside = pool.install(|| Drawing::begin(draw).finished());
        assert_eq!(inside, Drawing::begin(draw).finished());
    }
}
