//! Built-in scenes written as files give the same picture when they are read back.

mod common;

use common::{SMALL, json, run, run_in, success};

#[test]
fn written_and_read_back_a_scene_gives_the_same_picture() {
    let folder = tempfile::tempdir().unwrap();
    let scenes = json(&run(&["scenes", "--json"]));
    let small = |scene: &&serde_json::Value| scene["triangles"].as_u64().unwrap() < 10_000;
    let mut tried = 0;
    for scene in scenes["scenes"].as_array().unwrap().iter().filter(small) {
        let name = scene["name"].as_str().unwrap();
        let file = success(&run_in(folder.path(), &["scenes", "write", name, "out"])).trim_end().to_owned();
        let info = json(&run_in(folder.path(), &["info", &file, "--json"]));
        assert_eq!(info["warnings"].as_array().map(Vec::len), Some(0), "{name}: {info:#}");
        let render = |scene: &str, picture: &str| {
            success(&run_in(folder.path(), &[&["render", scene, "-o", picture], SMALL].concat()));
            let read = photinus::image::read_image(folder.path().join(picture)).unwrap();
            assert!(read.pixels.iter().any(|pixel| pixel[0] > 0.0), "{scene} is black");
            read
        };
        assert!(render(name, "a.exr") == render(&file, "b.exr"), "{name}: another picture after reading back");
        tried += 1;
    }
    assert!(tried >= 4, "{tried} scenes tried");
}
