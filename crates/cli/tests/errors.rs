//! Exit codes, and errors as one clear line.

mod common;

use common::{SMALL, json, refused, run, run_in, stderr, stdout, success};
use std::process::Stdio;

#[test]
fn wrong_usage_is_exit_code_two() {
    let cases: &[&[&str]] = &[
        &[],
        &["paint"],
        &["info"],
        &["render", "--passes", "0"],
        &["render", "--passes", "-3"],
        &["render", "--size", "0x5"],
        &["render", "--size", "12"],
        &["render", "--time", "soon"],
        &["render", "--camera", "1,2,3"],
        &["render", "--crop", "1,2,0,4"],
        &["render", "--threads", "0"],
        &["render", "--unheard-of"],
        &["render", "-o", "picture.jpg"],
        &["render", "--mode", "progresive"],
        &["render", "--support", "cube"],
        &["render", "--kernel", "tent"],
        &["render", "--caustic-radius", "0"],
        &["compare", "a.exr"],
        &["tree", "cornell", "--node-cost", "nan"],
    ];
    for arguments in cases {
        let output = run(arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {}", stderr(&output));
        assert_eq!(stdout(&output), "", "{arguments:?}");
    }
}

#[test]
fn a_misspelt_member_gets_a_suggestion() {
    for (option, typed, meant) in [
        ("--mode", "progresive", "progressive"),
        ("--accel", "wide-bhv", "wide-bvh"),
        ("--intersect", "baduel", "badouel"),
        ("--search", "kd-balancd", "kd-balanced"),
        ("--support", "box-poligon", "box-polygon"),
        ("--kernel", "gausian", "gaussian"),
        ("--tonemap", "film", "filmic"),
    ] {
        let said = stderr(&run(&["render", option, typed]));
        assert!(said.contains(&format!("'{meant}'")), "{option} {typed}: {said}");
    }
}

#[test]
fn underscores_are_accepted_in_names() {
    let folder = tempfile::tempdir().unwrap();
    let arguments = [&["render", "two_spheres", "--accel", "brute_force", "--search", "kd_balanced"], SMALL].concat();
    success(&run_in(folder.path(), &arguments));
    assert!(folder.path().join("two-spheres.png").exists());
}

#[test]
fn estimates_that_do_not_go_together_are_refused_or_said() {
    let folder = tempfile::tempdir().unwrap();
    let with = |more: &[&str]| run_in(folder.path(), &[&["render"], SMALL, more].concat());
    let said = refused(&with(&["--mode", "path", "--support", "disc"]), 1);
    assert!(said.starts_with("photinus: --support: "), "{said}");
    let said = refused(&with(&["--support", "disc", "--record-queries", "q.bin"]), 1);
    assert!(said.starts_with("photinus: --support: "), "{said}");
    // Edges are corrected for balls only; direct mode corrects none.
    for (mode, support, is_said) in
        [("gather", "disc", true), ("gather", "box_trimmed", false), ("direct", "disc", false)]
    {
        let small = &SMALL[..SMALL.len() - 1];
        assert_eq!(SMALL.last(), Some(&"--quiet"));
        let arguments = [&["render", "--mode", mode, "--support", support], small].concat();
        let output = run_in(folder.path(), &arguments);
        success(&output);
        assert_eq!(stderr(&output).contains("dark at edges"), is_said, "{mode} {support}: {}", stderr(&output));
    }
}

#[test]
fn what_estimates_were_made_over_is_written_down() {
    let folder = tempfile::tempdir().unwrap();
    for (more, support, kernel) in [
        (&["--mode", "direct", "--support", "ellipsoid", "--kernel", "cone"][..], "ellipsoid", "cone"),
        (&[], "ball", "epanechnikov"),
    ] {
        let found = json(&run_in(folder.path(), &[&["render", "-o", "a.exr", "--json"], SMALL, more].concat()));
        assert_eq!((&found["settings"]["support"], &found["settings"]["kernel"]), (&support.into(), &kernel.into()));
        let bytes = std::fs::read(folder.path().join("a.exr")).unwrap();
        for (name, value) in [("support", support), ("kernel", kernel)] {
            // An attribute is its name, its type, its length and its value.
            let attribute = [name.as_bytes(), b"\0string\0", &(value.len() as u32).to_le_bytes(), value.as_bytes()];
            let attribute = attribute.concat();
            assert!(bytes.windows(attribute.len()).any(|w| w == attribute), "{name} {value}");
        }
    }
}

#[test]
fn an_unknown_scene_gets_a_suggestion() {
    let said = refused(&run(&["render", "two-sphere"]), 1);
    assert_eq!(
        said,
        "photinus: two-sphere: no such file and no built-in scene of that name; did you mean two-spheres?"
    );
    let said = refused(&run(&["info", "qqqq"]), 1);
    assert!(said.contains("there are two-spheres, small-lamp, "), "{said}");
}

#[test]
fn bad_files_are_exit_code_one_with_their_name() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("scene.pbrt"), "WorldBegin\n").unwrap();
    std::fs::write(folder.path().join("scene.blend"), "BLENDER\n").unwrap();
    std::fs::write(folder.path().join("scene.xyzzy"), "plugh\n").unwrap();
    std::fs::create_dir(folder.path().join("folder.xml")).unwrap();
    let info = |name| refused(&run_in(folder.path(), &["info", name]), 1);
    assert!(info("scene.pbrt").contains("scene.pbrt: the pbrt format is not supported; supported are Mitsuba XML"));
    assert!(info("scene.blend").contains("a Blender file is not supported"));
    assert!(info("scene.xyzzy").contains("the format .xyzzy is not supported"));
    assert_eq!(info("missing.xml"), "photinus: missing.xml: there is no such file; check the path");
    assert!(info("folder.xml").contains("not a regular file"));
    let said = refused(&run_in(folder.path(), &["compare", "a.exr", "b.exr"]), 1);
    assert!(said.contains("a.exr"), "{said}");
}

/// A pipe that nobody writes to blocks whoever opens it.
#[cfg(target_os = "linux")]
#[test]
fn pipes_and_devices_are_refused_before_they_are_opened() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["pipe.xml", "pipe.ply", "pipe"] {
        let made = std::process::Command::new("mkfifo").arg(folder.path().join(name)).status().unwrap();
        assert!(made.success());
        for command in ["info", "render", "tree"] {
            let said = refused(&run_in(folder.path(), &[command, name]), 1);
            assert!(said.ends_with("this is a device or pipe, not a regular file; give a file"), "{said}");
        }
        let said = refused(&run_in(folder.path(), &["compare", name, name]), 1);
        assert!(said.contains("this is a device or pipe"), "{said}");
    }
}

#[test]
fn places_that_cannot_be_written_are_refused_before_the_work() {
    let said = refused(&run(&["render", "--passes", "1000000", "-o", "missing/folder/a.png"]), 1);
    assert!(said.contains("missing/folder/a.png: cannot be written"), "{said}");
    let said = refused(&run(&["render", "--passes", "1000000", "--stats", "missing/a.json"]), 1);
    assert!(said.contains("missing/a.json: cannot be written"), "{said}");
}

#[test]
fn windows_outside_the_picture_are_refused() {
    let said = refused(&run(&["render", "--size", "32x32", "--crop", "20,20,20,20"]), 1);
    assert!(said.contains("--crop: the window 20,20,20,20 does not lie in the picture of 32 x 32 pixels"), "{said}");
}

#[test]
fn what_is_not_built_is_refused_and_never_ignored() {
    for (arguments, word) in [
        (&["--denoise"][..], "--denoise"),
        (&["--resume", "x.exr"], "--resume"),
        (&["--hardware", "thesis"], "--hardware"),
        (&["--backend", "lns"], "--backend"),
        (&["--backend", "cycle"], "--backend"),
        (&["--backend", "rtl"], "--backend"),
    ] {
        let said = refused(&run(&[&["render"], arguments].concat()), 2);
        assert!(said.contains(word) && said.contains("not built yet"), "{said}");
    }
    let said = refused(&run(&["render", "--aov", "depth", "-o", "a.png"]), 2);
    assert!(said.contains("--aov: PNG files hold no layers"), "{said}");
}

#[test]
fn messages_stay_on_one_line_whatever_a_name_holds() {
    let said = refused(&run(&["info", "two\nlines\u{1b}[31m.xml"]), 1);
    assert!(!said.contains('\u{1b}'), "{said:?}");
}

/// A decoder that panics on a damaged file: one line, without the panic's own.
#[test]
fn a_decoder_that_gives_up_is_one_line() {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fuzz/found/jpeg/rows-that-do-not-fit-their-scratch.jpg");
    let message = refused(&run(&["compare", file, file]), 1);
    assert!(message.contains("its decoder gave up"), "{message}");
}

#[test]
fn a_reader_that_goes_away_is_no_error() {
    let folder = tempfile::tempdir().unwrap();
    let mut command = common::photinus(folder.path());
    let mut child = command.args(["scenes"]).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    drop(child.stdout.take());
    let output = child.wait_with_output().unwrap();
    assert_eq!((output.status.code(), stderr(&output).as_str()), (Some(0), ""));
}

#[test]
fn every_command_that_reads_scenes_asks_before_it_reads_outside_their_folder() {
    let folder = tempfile::tempdir().unwrap();
    let inner = folder.path().join("inner");
    std::fs::create_dir(&inner).unwrap();
    std::fs::write(folder.path().join("m.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").unwrap();
    let scene =
        "<scene version='3.0.0'>\n<shape type='obj'><string name='filename' value='../m.obj'/></shape>\n</scene>\n";
    std::fs::write(inner.join("scene.xml"), scene).unwrap();
    let commands: [&[&str]; 3] = [
        &["info", "scene.xml"],
        &["tree", "scene.xml"],
        &["render", "scene.xml", "--size", "8x8", "--photons", "100", "--passes", "1", "--quiet"],
    ];
    for command in commands {
        let said = refused(&run_in(&inner, command), 1);
        assert_eq!(
            said,
            "photinus: scene.xml:2: ../m.obj lies outside the scene's folder; \
             pass --allow-outside to let this scene read it"
        );
        success(&run_in(&inner, &[command, &["--allow-outside"]].concat()));
    }
}
