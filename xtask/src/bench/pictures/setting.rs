//! The settings of the equal-time table: which scene, how long, how often; and a scene's folder in every engine's words.

use super::scene::Scene;
use super::{luxcore, radiance};
use crate::Failure;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Sides of the pictures that are timed.
pub const SIZE: u32 = 512;

/// Sides of the small pictures in which agreement shows.
pub const TRIAL_SIZE: u32 = 128;

/// One of the two lamps.
pub struct Lamp {
    /// Its name in sets, and of the reference files.
    pub name: &'static str,
    /// The built-in scene.
    pub scene: &'static str,
    /// Whether path tracing is no help to a reference, because it hardly finds the caustic.
    pub by_light_alone: bool,
}

/// The two lamps.
pub const LAMPS: &[Lamp] = &[
    Lamp { name: "large-lamp", scene: "two-spheres", by_light_alone: false },
    Lamp { name: "small-lamp", scene: "small-lamp", by_light_alone: true },
];

/// A lamp and a budget.
pub struct Setting {
    pub lamp: &'static Lamp,
    /// Processor seconds.
    pub seconds: u32,
    /// How often each engine runs, unless the caller says otherwise.
    pub repeats: usize,
}

/// All settings, or those of a quick run.
pub fn settings(quick: bool) -> Vec<Setting> {
    let [large, small] = LAMPS else { unreachable!("there are two lamps") };
    let repeats = if quick { 1 } else { 3 };
    let mut settings =
        vec![Setting { lamp: large, seconds: 10, repeats }, Setting { lamp: small, seconds: 10, repeats }];
    if !quick {
        settings.push(Setting { lamp: large, seconds: 60, repeats: 1 });
    }
    settings
}

impl Setting {
    /// Its name in rows.
    pub fn name(&self) -> String {
        format!("{}-{}s", self.lamp.name, self.seconds)
    }
}

/// A lamp's scene at one size: a folder that holds it in every engine's words.
pub struct Prepared {
    pub folder: PathBuf,
    pub scene: Scene,
}

/// Writes a built-in scene by our own program and turns it into the words of the others.
pub fn prepare(photinus: &Path, lamp: &Lamp, size: u32, below: &Path) -> Result<Prepared, Failure> {
    let folder = below.join(format!("scenes/{}-{size}", lamp.name));
    std::fs::create_dir_all(&folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    let output = Command::new(photinus).args(["scenes", "write", lamp.scene]).arg(&folder).output();
    let output = output.map_err(|e| format!("{}: {e}", photinus.display()))?;
    if !output.status.success() {
        return Err(String::from_utf8_lossy(&output.stderr).trim().to_owned());
    }
    let written = folder.join(format!("{}.xml", lamp.scene));
    let text = std::fs::read_to_string(&written).map_err(|e| format!("{}: {e}", written.display()))?;
    let mut scene = Scene::read(&written)?;
    let sized = resized(&text, &scene, size)?;
    (scene.camera.width, scene.camera.height) = (size, size);
    let save = |name: &str, text: &str| -> Result<(), Failure> {
        let path = folder.join(name);
        std::fs::write(&path, text).map_err(|e| format!("{}: {e}", path.display()))
    };
    save("scene.xml", &sized)?;
    save("scene.json", &serde_json::to_string_pretty(&scene).map_err(|e| e.to_string())?)?;
    luxcore::write(&scene, &folder)?;
    radiance::write(&scene, &folder)?;
    Ok(Prepared { folder, scene })
}

/// The scene for Mitsuba with another size of its square picture.
fn resized(text: &str, scene: &Scene, size: u32) -> Result<String, Failure> {
    let mut sized = text.to_owned();
    for (name, from) in [("width", scene.camera.width), ("height", scene.camera.height)] {
        let (old, new) = [from, size].map(|n| format!("<integer name=\"{name}\" value=\"{n}\"/>")).into();
        if !sized.contains(&old) {
            return Err(format!("the written scene has no `{old}`"));
        }
        sized = sized.replace(&old, &new);
    }
    Ok(sized)
}

#[cfg(test)]
mod tests {
    use super::super::scene::{Camera, Material};
    use super::*;

    /// Our program, built as the bench builds it.
    fn written(lamp: &Lamp, size: u32) -> (tempfile::TempDir, Prepared) {
        let folder = tempfile::tempdir().unwrap();
        let photinus = super::super::build(&crate::root()).unwrap();
        let prepared = prepare(&photinus, lamp, size, folder.path()).unwrap();
        (folder, prepared)
    }

    fn read(prepared: &Prepared, name: &str) -> String {
        std::fs::read_to_string(prepared.folder.join(name)).unwrap()
    }

    #[test]
    fn settings_are_those_of_the_table() {
        let names = |quick| settings(quick).iter().map(Setting::name).collect::<Vec<_>>();
        assert_eq!(names(false), ["large-lamp-10s", "small-lamp-10s", "large-lamp-60s"]);
        assert_eq!(names(true), ["large-lamp-10s", "small-lamp-10s"]);
        assert!(settings(true).iter().all(|setting| setting.repeats == 1));
    }

    #[test]
    fn the_written_scene_is_read_back_whole() {
        for (lamp, half_width, radiance) in
            [(&LAMPS[0], 0.65, [18.387, 13.9873, 6.75357]), (&LAMPS[1], 0.065, [1838.7, 1398.73, 675.357])]
        {
            let (_kept, prepared) = written(lamp, 512);
            let scene = &prepared.scene;
            let camera = Camera {
                origin: [2.78, 2.73, -8.0],
                target: [2.78, 2.73, -7.0],
                up: [0.0, 1.0, 0.0],
                fov_degrees: 39.307648,
                width: 512,
                height: 512,
            };
            assert_eq!(scene.camera, camera);
            assert_eq!(scene.meshes.len(), 7);
            assert_eq!(scene.meshes.iter().map(|mesh| mesh.triangles.len()).sum::<usize>(), 22);
            let shown = scene.lamp().unwrap();
            assert_eq!(shown.radiance, Some(radiance));
            let width = shown.vertices.iter().map(|v| (v[0] - 2.78).abs()).fold(0.0, f32::max);
            assert!((width - half_width).abs() < 1e-5, "{width}");
            assert_eq!(shown.polygons().len(), 1, "its two halves are one lamp");
            assert_eq!(scene.meshes[5].polygons().len(), 5, "a block with four walls and a top");
            let spheres: Vec<([f32; 3], f32, &Material)> =
                scene.spheres.iter().map(|s| (s.center, s.radius, &scene.materials[&s.material])).collect();
            assert_eq!(spheres[0], ([1.75, 0.9, 1.9], 0.8999, &Material::Glass { ior: 1.5 }));
            assert_eq!(spheres[1], ([4.1, 0.7, 1.35], 0.6999, &Material::Mirror { reflectance: [0.95; 3] }));
        }
    }

    #[test]
    fn every_engine_is_told_the_same_numbers() {
        let (_kept, prepared) = written(&LAMPS[0], TRIAL_SIZE);
        let luxcore = read(&prepared, "scene.scn");
        for line in [
            "scene.camera.lookat.orig = 2.78 2.73 -8",
            "scene.camera.fieldofview = 39.307648",
            "scene.materials.green.kd = 0.14 0.45 0.091",
            "scene.materials.glass.interiorior = 1.5",
            "scene.materials.mirror.kr = 0.95 0.95 0.95",
            "scene.materials.lamp-emitter.emission = 18.387 13.9873 6.75357",
            "scene.objects.glass-sphere.material = \"glass\"",
        ] {
            assert!(luxcore.lines().any(|l| l == line), "{line}\n{luxcore}");
        }
        let bytes = std::fs::read(prepared.folder.join("luxcore-glass-sphere.ply")).unwrap();
        let (vertices, triangles) = super::super::ply::read(&bytes).unwrap();
        assert_eq!(triangles.len(), 81_920);
        for v in vertices {
            let from_center = [v[0] - 1.75, v[1] - 0.9, v[2] - 1.9];
            let radius = from_center.map(|x| x * x).iter().sum::<f32>().sqrt();
            assert!((radius - 0.8999).abs() < 1e-5, "{radius}");
        }
        let radiance = read(&prepared, "scene.rad");
        for paragraph in [
            "void plastic red\n0\n0\n5 0.63 0.065 0.05 0 0\n",
            "void dielectric glass\n0\n0\n5 1 1 1 1.5 0\n",
            "void metal mirror\n0\n0\n5 0.95 0.95 0.95 1 0\n",
            "void light lamp-emitter\n0\n0\n3 18.387 13.9873 6.75357\n",
            "glass sphere glass-sphere\n0\n0\n4 1.75 0.9 1.9 0.8999\n",
            "mirror sphere mirror-sphere\n0\n0\n4 4.1 0.7 1.35 0.6999\n",
        ] {
            assert!(radiance.contains(paragraph), "{paragraph}\n{radiance}");
        }
        // Floor, ceiling, back, right wall, block of five, lamp; the left wall is not flat and stays two triangles.
        assert_eq!(radiance.matches(" polygon ").count(), 12, "quadrilaterals are whole");
        let view = read(&prepared, "view.txt");
        assert_eq!(view, "-vtv -vp 2.78 2.73 -8 -vd 0 0 1 -vu 0 1 0 -vh 39.307648 -vv 39.307648 -x 128 -y 128\n");
        let xml = read(&prepared, "scene.xml");
        assert!(xml.contains("<integer name=\"width\" value=\"128\"/>") && xml.contains("18.387 13.9873 6.75357"));
        let json: serde_json::Value = serde_json::from_str(&read(&prepared, "scene.json")).unwrap();
        assert_eq!(json["camera"]["width"], 128);
        assert_eq!(json["materials"]["glass"]["kind"], "glass");
        assert_eq!(json["meshes"].as_array().unwrap().len(), 7);
    }
}
