//! Renders a built-in scene into a PNG picture: `cargo run --release -p photinus --example render_builtin [FOLDER]`.

#![expect(clippy::print_stdout, reason = "an example talks to its reader")]

use photinus::render::{RenderOptions, Session, Silent, Stop};
use photinus::{LoadOptions, Tonemap};
use std::path::PathBuf;

fn main() -> photinus::Result<()> {
    let folder = PathBuf::from(std::env::args().nth(1).unwrap_or_else(|| ".".into()));
    let scene = photinus::open("two-spheres", &LoadOptions::default())?;
    let options = RenderOptions {
        size: Some([160, 160]),
        stop: Stop { passes: Some(4), ..Stop::default() },
        ..RenderOptions::default()
    };
    let rendered = Session::new(scene, options)?.render(&Silent)?;
    if let Some(picture) = &rendered.picture {
        picture.write_png(folder.join("two-spheres.png"), Tonemap::default(), 0.0)?;
    }
    let stats = &rendered.stats;
    println!("{} photons, {} rays, {:.1} s", stats.photons.emitted, stats.rays.total, stats.seconds.wall_secs);
    Ok(())
}
