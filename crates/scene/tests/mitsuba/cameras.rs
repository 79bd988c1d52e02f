//! Sensors, films, filters, integrators.

use crate::common::*;
use photinus_geometry::Vec3;
use photinus_scene::{Camera, Filter, FovAxis, IntegratorKind, Projection};

const VIEW: &str = "<transform name='to_world'><lookat origin='1 2 3' target='1 2 13' up='0 2 0'/></transform>";

fn camera(xml: &str) -> Camera {
    let s = scene(xml);
    assert!(!s.warnings.iter().any(|w| w.message.starts_with("no camera")));
    clean(&s);
    s.camera
}

#[test]
fn perspective() {
    let c = camera(&format!("<sensor type='perspective'>{VIEW}<float name='fov' value='40'/></sensor>"));
    assert_eq!(
        (c.origin, c.target, c.up),
        (Vec3::new(1.0, 2.0, 3.0), Vec3::new(1.0, 2.0, 13.0), Vec3::new(0.0, 2.0, 0.0))
    );
    assert_eq!(c.projection, Projection::Perspective { fov_degrees: 40.0, axis: FovAxis::X });
    assert_eq!((c.near_clip, c.far_clip, c.mirrored, c.principal_point), (0.01, 10000.0, false, [0.0, 0.0]));
    for (name, axis) in [
        ("x", FovAxis::X),
        ("y", FovAxis::Y),
        ("diagonal", FovAxis::Diagonal),
        ("smaller", FovAxis::Smaller),
        ("larger", FovAxis::Larger),
    ] {
        let c = camera(&format!(
            "<sensor type='perspective'><float name='fov' value='40'/><string name='fov_axis' value='{name}'/></sensor>"
        ));
        assert_eq!(c.projection, Projection::Perspective { fov_degrees: 40.0, axis });
    }
}

#[test]
fn focal_lengths_and_clips() {
    let fov = |xml: &str| match camera(&format!("<sensor type='perspective'>{xml}</sensor>")).projection {
        Projection::Perspective { fov_degrees, axis: FovAxis::Diagonal } => fov_degrees,
        other => panic!("{other:?}"),
    };
    // 2 atan(43.267 / 2 f).
    assert!((fov("") - 46.793).abs() < 1e-2, "{}", fov(""));
    assert!((fov("<string name='focal_length' value='35mm'/>") - 63.44).abs() < 1e-2);
    let c = camera(
        "<sensor type='perspective'><float name='near_clip' value='1'/><float name='far_clip' value='50'/>\
         <float name='principal_point_offset_x' value='0.1'/><float name='principal_point_offset_y' value='-0.2'/></sensor>",
    );
    assert_eq!((c.near_clip, c.far_clip, c.principal_point), (1.0, 50.0, [0.1, -0.2]));
    for bad in [
        "<float name='fov' value='180'/>",
        "<float name='fov' value='0'/>",
        "<float name='near_clip' value='0'/>",
        "<float name='near_clip' value='5'/><float name='far_clip' value='4'/>",
        "<string name='focal_length' value='long'/>",
        "<string name='fov_axis' value='z'/>",
    ] {
        error(&format!("<sensor type='perspective'>{bad}</sensor>"));
    }
}

#[test]
fn a_matrix_places_the_camera_and_a_mirror_mirrors_it() {
    // Bitterli's Cornell box: looks along -z, x to the left of the picture is world -x.
    let c = camera(
        "<sensor type='perspective'><transform name='to_world'>\
         <matrix value='-1 0 0 0 0 1 0 1 0 0 -1 6.8 0 0 0 1'/></transform></sensor>",
    );
    assert_eq!((c.origin, c.up, c.mirrored), (Vec3::new(0.0, 1.0, 6.8), Vec3::Y, false));
    assert!(((c.target - c.origin) - Vec3::NEG_Z).length() < 1e-6);
    let c =
        camera(&format!("<sensor type='perspective'>{}</sensor>", VIEW.replace("<lookat", "<scale x='-1'/><lookat")));
    assert!(c.mirrored);
    assert_eq!(c.target, Vec3::new(1.0, 2.0, 13.0));
}

#[test]
fn thin_lens_and_orthographic() {
    let c = camera(
        "<sensor type='thinlens'><float name='fov' value='30'/><float name='aperture_radius' value='0.2'/>\
         <float name='focus_distance' value='4'/></sensor>",
    );
    let expected =
        Projection::ThinLens { fov_degrees: 30.0, axis: FovAxis::X, aperture_radius: 0.2, focus_distance: 4.0 };
    assert_eq!(c.projection, expected);
    assert!(error("<sensor type='thinlens'/>").contains("aperture_radius"));
    let c = camera(&format!(
        "<sensor type='orthographic'>{}</sensor>",
        VIEW.replace("<lookat", "<scale x='10' y='10'/><lookat")
    ));
    assert_eq!(c.projection, Projection::Orthographic { half_width: 10.0 });
    assert_eq!(c.origin, Vec3::new(1.0, 2.0, 3.0));
}

#[test]
fn films_and_filters() {
    let film = |xml: &str| {
        let s = scene(&format!("<sensor type='perspective'><film type='hdrfilm'>{xml}</film></sensor>"));
        clean(&s);
        s.film
    };
    let plain = film("");
    assert_eq!(
        (plain.width, plain.height, plain.crop, plain.filter),
        (768, 576, None, Filter::Gaussian { stddev: 0.5 })
    );
    let f = film(
        "<integer name='width' value='100'/><integer name='height' value='50'/><integer name='crop_offset_x' value='10'/>\
         <integer name='crop_width' value='20'/><string name='pixel_format' value='rgb'/>",
    );
    assert_eq!((f.width, f.height, f.crop), (100, 50, Some([10, 0, 20, 50])));
    for (xml, filter) in [
        ("type='box'/>", Filter::Box),
        ("type='tent'/>", Filter::Tent { radius: 1.0 }),
        ("type='tent'><float name='radius' value='1.25'/></rfilter>", Filter::Tent { radius: 1.25 }),
        ("type='gaussian'><float name='stddev' value='0.7'/></rfilter>", Filter::Gaussian { stddev: 0.7 }),
        ("type='mitchell'/>", Filter::Mitchell { b: 1.0 / 3.0, c: 1.0 / 3.0 }),
        (
            "type='mitchell'><float name='B' value='0.2'/><float name='C' value='0.4'/></rfilter>",
            Filter::Mitchell { b: 0.2, c: 0.4 },
        ),
        ("type='catmullrom'/>", Filter::CatmullRom),
        ("type='lanczos'/>", Filter::Lanczos { lobes: 3 }),
        ("type='lanczos'><integer name='lobes' value='4'/></rfilter>", Filter::Lanczos { lobes: 4 }),
    ] {
        assert_eq!(film(&format!("<rfilter {xml}")).filter, filter, "{xml}");
    }
    for bad in [
        "width' value='0",
        "width' value='-3",
        "width' value='70000",
        "width' value='1.5",
        "width' value='1e30",
        "crop_width' value='1000",
        "crop_offset_x' value='-1",
    ] {
        error(&format!("<sensor type='perspective'><film type='hdrfilm'><integer name='{bad}'/></film></sensor>"));
    }
}

#[test]
fn integrators() {
    let hint = |xml: &str| {
        let s = scene(xml);
        clean(&s);
        (s.integrator.kind, s.integrator.max_depth, s.integrator.hide_emitters)
    };
    assert_eq!(hint("<integrator type='path'/>"), (IntegratorKind::Full, None, false));
    assert_eq!(hint("<integrator type='path'><integer name='max_depth' value='-1'/></integrator>").1, None);
    assert_eq!(hint("<integrator type='volpath'><integer name='maxDepth' value='8'/></integrator>").1, Some(8));
    assert_eq!(hint("<integrator type='direct'/>"), (IntegratorKind::Direct, Some(2), false));
    let nested = "<integrator type='moment'><integrator type='path'><integer name='max_depth' value='5'/>\
        <boolean name='hide_emitters' value='true'/></integrator></integrator>";
    assert_eq!(hint(nested), (IntegratorKind::Full, Some(5), true));
    let deep = "<integrator type='aov'><string name='aovs' value='dd.y:depth'/><integrator type='moment'>\
        <integrator type='direct'/></integrator></integrator>";
    assert_eq!(hint(deep), (IntegratorKind::Direct, Some(2), false));
    for kind in ["ptracer", "photonmapper", "bdpt", "prb", "volpathmis"] {
        assert_eq!(hint(&format!("<integrator type='{kind}'/>")).0, IntegratorKind::Full);
    }
    let s = scene("<integrator type='depth'/>");
    assert!(warnings(&s)[0].contains("depth"));
    error("<integrator type='path'><integer name='max_depth' value='-2'/></integrator>");
    error("<integrator type='path'><integer name='max_depth' value='many'/></integrator>");
}

#[test]
fn samplers_are_noted_without_a_word_and_other_sensors_with_one() {
    let s = scene(
        "<sensor type='perspective'><sampler type='independent'><integer name='sample_count' value='16'/></sampler></sensor>",
    );
    clean(&s);
    let s = scene("<sensor type='radiancemeter'/>");
    assert!(warnings(&s)[0].contains("radiancemeter"));
    let s = scene("<sensor type='perspective'/><sensor type='perspective'/>");
    assert!(warnings(&s)[0].contains("first"));
}

#[test]
fn a_camera_that_is_not_there_frames_the_scene() {
    let s = scene("<shape type='cube'><transform name='to_world'><translate x='100'/></transform></shape>");
    assert!(s.warnings.iter().any(|w| w.message.starts_with("no camera")));
    let forward = (s.camera.target - s.camera.origin).normalize();
    let half = 22.5f32.to_radians();
    for corner in [-1.0f32, 1.0].iter().flat_map(|&x| [-1.0f32, 1.0].iter().map(move |&y| Vec3::new(100.0 + x, y, -x)))
    {
        let to = (corner - s.camera.origin).normalize();
        assert!(to.dot(forward) > libm::cosf(half), "{corner} is out of view");
    }
}
