//! A render with any ray-triangle method and any acceleration structure gives the picture that the method gives in the
//! default structure.

use photinus::names;
use photinus::render::{Mode, RenderOptions, Session, Settings, Silent, Stop};
use photinus::{LoadOptions, Result};

/// Pixels of a picture.
const SIZE: [u32; 2] = [24, 18];

/// The pixels of a small picture.
fn render(scene: &str, accel: &str, intersect: &str) -> Result<Vec<[f32; 3]>> {
    let options = RenderOptions {
        settings: Settings { mode: Mode::Direct, photons: Some(300), ..Settings::default() },
        accel: accel.into(),
        intersect: intersect.into(),
        size: Some(SIZE),
        stop: Stop { passes: Some(1), ..Stop::default() },
        ..RenderOptions::default()
    };
    let session = Session::new(photinus::open(scene, &LoadOptions::default())?, options)?;
    let picture = session.render(&Silent)?.picture.expect("one pass was asked for");
    Ok(picture.image().pixels)
}

/// Whether two pixels differ: in any bit, or by more than a share of them.
fn differ(a: [f32; 3], b: [f32; 3], share: f32) -> bool {
    let far =
        |(a, b): (f32, f32)| if share > 0.0 { (a - b).abs() > share * (a + b) } else { a.to_bits() != b.to_bits() };
    a.into_iter().zip(b).any(far)
}

#[test]
fn every_method_gives_its_picture_in_every_structure() {
    for scene in ["two-spheres", "water-lily-1426"] {
        let mut pairs = 0;
        for method in names::INTERSECT.members() {
            let expected = render(scene, names::ACCEL.default, method.name).unwrap();
            assert!(expected.iter().any(|pixel| *pixel != expected[0]), "{scene}: nothing to be seen");
            for structure in names::ACCEL.members() {
                let found = render(scene, structure.name, method.name).unwrap();
                // Angle sums accept points beside their triangle, so that the volumes around it decide, and a photon that goes
                // elsewhere changes the last bits of all pixels around it.
                let (share, allowed) = if method.name == "angle-summation" { (0.02, SIZE[0]) } else { (0.0, 0) };
                let pixels = found.iter().zip(&expected);
                let different = pixels.filter(|(a, b)| differ(**a, **b, share)).count();
                let pair = format!("{scene}, {} in {}", method.name, structure.name);
                assert!(different <= allowed as usize, "{pair}: {different} of {} pixels differ", expected.len());
                pairs += 1;
            }
        }
        assert!(pairs >= 12 * 15, "{scene}: only {pairs} pairs");
    }
}
