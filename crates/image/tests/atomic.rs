//! Files appear whole or not at all: permissions, errors, nothing left behind, a kill at any moment.

use photinus_image::tonemap::Tonemap;
use photinus_image::{
    Image, ImageErrorKind, Layers, encode_exr, read_image, remove_abandoned, temporary_in, write_atomic, write_exr,
    write_png,
};
use std::path::Path;
use std::time::{Duration, SystemTime};

fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<_> =
        std::fs::read_dir(folder).unwrap().map(|e| e.unwrap().file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

#[test]
fn writing_replaces_and_leaves_nothing_behind() {
    let folder = tempfile::tempdir().unwrap();
    let exr = folder.path().join("a.exr");
    let png = folder.path().join("a.png");
    for value in [0.25, 1.0] {
        let image = Image::filled(5, 4, [value; 3]);
        write_exr(&exr, &Layers::from_image(&image)).unwrap();
        write_png(&png, &image, Tonemap::default(), 0.0).unwrap();
        assert_eq!(read_image(&exr).unwrap(), image);
        assert!((read_image(&png).unwrap().at(0, 0)[0] - value).abs() < 0.01);
        assert_eq!(names(folder.path()), ["a.exr", "a.png"]);
    }
}

#[test]
fn a_name_without_folder_means_the_current_one() {
    // The only test that needs the current folder; its name is unlike any other's.
    let name = "photinus-atomic-test-file.tmp";
    write_atomic(name, b"x").unwrap();
    assert_eq!(std::fs::read(name).unwrap(), b"x");
    std::fs::remove_file(name).unwrap();
}

#[cfg(unix)]
#[test]
fn permissions_are_the_usual_ones() {
    use std::os::unix::fs::PermissionsExt;
    let folder = tempfile::tempdir().unwrap();
    let mode = |name: &str| std::fs::metadata(folder.path().join(name)).unwrap().permissions().mode() & 0o777;
    // What the system gives a new file under the umask of this process.
    std::fs::write(folder.path().join("plain"), b"x").unwrap();
    write_atomic(folder.path().join("ours"), b"x").unwrap();
    assert_eq!(mode("ours"), mode("plain"));
    // A file that was there keeps what it had.
    std::fs::set_permissions(folder.path().join("ours"), std::fs::Permissions::from_mode(0o640)).unwrap();
    write_atomic(folder.path().join("ours"), b"y").unwrap();
    assert_eq!(mode("ours"), 0o640);
}

#[test]
fn places_that_cannot_be_written_are_one_clear_error() {
    let folder = tempfile::tempdir().unwrap();
    let missing = folder.path().join("missing/a.exr");
    let check = |path: &Path, word: &str| {
        let error = write_exr(path, &Layers::from_image(&Image::filled(2, 2, [1.0; 3]))).unwrap_err();
        let line = error.to_string();
        assert_eq!(error.kind, ImageErrorKind::Unwritable, "{line}");
        assert!(line.starts_with(&path.display().to_string()) && line.contains(word), "{line}");
        assert_eq!(line.lines().count(), 1);
    };
    check(&missing, "does not exist");
    check(folder.path(), "folder");
    let file = folder.path().join("file");
    std::fs::write(&file, b"x").unwrap();
    check(&file.join("a.exr"), "does not exist");
    // Write-protected files are respected, also by those who may do everything.
    let mut permissions = std::fs::metadata(&file).unwrap().permissions();
    permissions.set_readonly(true);
    std::fs::set_permissions(&file, permissions).unwrap();
    check(&file, "write-protected");
    assert_eq!(std::fs::read(&file).unwrap(), b"x");
    assert_eq!(names(folder.path()), ["file"]);
}

#[test]
fn an_error_while_encoding_keeps_the_old_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.exr");
    write_exr(&path, &Layers::from_image(&Image::filled(2, 2, [1.0; 3]))).unwrap();
    let before = std::fs::read(&path).unwrap();
    let mut bad = Layers::new(2, 2);
    bad.push_channel("depth", "Z", vec![0.0; 3]);
    assert!(write_exr(&path, &bad).is_err());
    assert_eq!(std::fs::read(&path).unwrap(), before);
    assert_eq!(names(folder.path()), ["a.exr"]);
}

/// A child process rewrites one file for ever and is killed at some moment, again and again: the file is always whole.
#[cfg(unix)]
#[test]
fn a_killed_writer_leaves_the_old_or_the_new_file() {
    const CHILD: &str = "PHOTINUS_TEST_REWRITE";
    let candidates: Vec<Vec<u8>> =
        (0..2).map(|i| encode_exr(&Layers::from_image(&Image::filled(64, 64, [i as f32 + 0.5; 3]))).unwrap()).collect();
    if let Some(path) = std::env::var_os(CHILD) {
        // Ends by itself should the parent be gone.
        for i in 0..100_000 {
            write_atomic(&path, &candidates[i % 2]).unwrap();
        }
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.exr");
    write_atomic(&path, &candidates[0]).unwrap();
    for round in 0..10u64 {
        let mut child = std::process::Command::new(std::env::current_exe().unwrap())
            .args(["--exact", "a_killed_writer_leaves_the_old_or_the_new_file"])
            .env(CHILD, &path)
            .stdout(std::process::Stdio::null())
            .spawn()
            .unwrap();
        std::thread::sleep(std::time::Duration::from_millis(20 + 7 * round));
        child.kill().unwrap();
        child.wait().unwrap();
        let found = std::fs::read(&path).unwrap();
        assert!(candidates.contains(&found), "half a file of {} bytes after round {round}", found.len());
    }
}

#[test]
fn only_old_temporary_files_that_nobody_holds_are_removed() {
    let folder = tempfile::tempdir().unwrap();
    let age = |name: &str, seconds: u64| {
        let file = std::fs::File::options().create(true).append(true).open(folder.path().join(name)).unwrap();
        file.set_modified(SystemTime::now() - Duration::from_secs(seconds)).unwrap();
    };
    let old =
        ["a.png", ".photinus-.tmp", ".photinus-abcdef.exr", ".photinus-abcdefg.tmp", ".photinus-ab-def.tmp", "x.tmp"];
    old.iter().for_each(|name| age(name, 7200));
    age(".photinus-abc123.tmp", 7200);
    age(".photinus-ABC123.tmp", 70);
    age(".photinus-young1.tmp", 5);
    std::fs::create_dir(folder.path().join(".photinus-folder.tmp")).unwrap();
    let held = temporary_in(folder.path()).unwrap();
    held.as_file().set_modified(SystemTime::now() - Duration::from_secs(7200)).unwrap();
    let held_name = held.path().file_name().unwrap().to_str().unwrap().to_owned();

    assert_eq!(remove_abandoned(folder.path()), 2);
    let mut left: Vec<&str> = [&old[..], &[".photinus-young1.tmp", ".photinus-folder.tmp", &held_name]].concat();
    left.sort_unstable();
    assert_eq!(names(folder.path()), left);
    drop(held);
    assert_eq!(remove_abandoned(&folder.path().join("missing")), 0);
}
