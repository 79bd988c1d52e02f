//! Scene and mesh files, read by name as the program reads them.

use super::files;
use super::sound::check_scene;
use photinus_scene::{LoadError, LoadOptions, Scene, load, load::mitsuba_plugins};
use std::path::Path;

/// Loads a file and checks what comes of it. The limit keeps single inputs short.
fn load_checked(path: &Path) {
    let options = LoadOptions { max_triangles: 1 << 20, ..LoadOptions::default() };
    let loaded: Result<Scene, LoadError> = load(path, &options);
    match loaded {
        Ok(scene) => check_scene(&scene),
        Err(error) => assert!(!error.to_string().is_empty()),
    }
}

/// Loads a mesh as a scene of its own, and as a shape of a Mitsuba scene where other rules hold.
fn load_mesh(extension: &str, data: &[u8]) {
    let name = format!("mesh.{extension}");
    let path = files::put(&name, data);
    if extension != "serialized" {
        load_checked(&path);
    }
    let shape =
        |more: &str| format!("<shape type='{extension}'><string name='filename' value='{name}'/>{more}</shape>");
    let scene = format!(
        "<scene version='3.0.0'>{}{}</scene>",
        shape(""),
        shape("<float name='max_smooth_angle' value='30'/><integer name='shape_index' value='1'/>")
    );
    load_checked(&files::put("mesh.xml", scene.as_bytes()));
}

/// The scene; after a zero byte the file `part.xml`, which it may include.
pub fn mitsuba(data: &[u8]) {
    let (scene, part) = split(data);
    if let Some(part) = part {
        files::put("part.xml", part);
    }
    load_checked(&files::put("scene.xml", scene));
}

/// A file of wavelengths and values.
pub fn spectrum(data: &[u8]) {
    files::put("mine.spd", data);
    let scene = "<scene version='3.0.0'><bsdf type='diffuse'><spectrum name='reflectance' filename='mine.spd'/></bsdf>\
         <emitter type='point'><spectrum name='intensity' filename='mine.spd'/></emitter></scene>";
    load_checked(&files::put("spectrum.xml", scene.as_bytes()));
}

/// The mesh; after a zero byte its library `a.mtl`.
pub fn obj(data: &[u8]) {
    let (mesh, library) = split(data);
    files::put("a.mtl", library.unwrap_or(files::MTL.as_bytes()));
    load_mesh("obj", mesh);
}

/// A library whose materials `m0` to `m3` are used.
pub fn mtl(data: &[u8]) {
    files::put("mine.mtl", data);
    let mut text = "mtllib mine.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvt 0 0\n".to_owned();
    for i in 0..4 {
        text += &format!("usemtl m{i}\nf 1/1 2/1 3/1\nf 1 3 4\n");
    }
    load_checked(&files::put("mtl.obj", text.as_bytes()));
}

pub fn ply(data: &[u8]) {
    load_mesh("ply", data);
}

pub fn stl(data: &[u8]) {
    load_mesh("stl", data);
}

/// A file; or after a star the content of version 3 or 4 that is compressed here, as no change survives in packed data.
pub fn serialized(data: &[u8]) {
    match data {
        [b'*', version, content @ ..] => load_mesh("serialized", &files::serialized(3 + version % 2, content)),
        file => load_mesh("serialized", file),
    }
}

fn split(data: &[u8]) -> (&[u8], Option<&[u8]>) {
    match data.iter().position(|&b| b == 0) {
        Some(at) => (&data[..at], Some(&data[at + 1..])),
        None => (data, None),
    }
}

pub fn spectrum_seeds() -> Vec<Vec<u8>> {
    vec![files::SPECTRUM.into(), b"400:0.5\n".to_vec(), b"400 1\r\n500 2\r\n".to_vec()]
}

pub fn obj_seeds() -> Vec<Vec<u8>> {
    let with_library = [files::OBJ, "\0", files::MTL].concat();
    let polygon = "v 0 0 0\nv 4 0 0\nv 4 4 0\nv 2 1 0\nv 0 4 0\nf 1 2 3 4 5\nf 5 4 3 2 1\nf 1 1 2 2\n";
    vec![files::OBJ.into(), with_library.into(), polygon.into()]
}

pub fn mtl_seeds() -> Vec<Vec<u8>> {
    vec![files::MTL.into(), "newmtl m0\nKd 1 1 1\n".into(), "# Blender MTL\nnewmtl m1\nKs 1 1 1\nNs 200\n".into()]
}

pub fn ply_seeds() -> Vec<Vec<u8>> {
    let text = files::ply_text().into_bytes();
    let packed = files::gzipped(&text);
    vec![text, files::ply_binary(false), files::ply_binary(true), packed]
}

pub fn stl_seeds() -> Vec<Vec<u8>> {
    vec![files::STL.into(), files::stl_binary()]
}

pub fn serialized_seeds() -> Vec<Vec<u8>> {
    let mut seeds = Vec::new();
    for (version, flags) in [(3, 0x1000), (4, 0x1001), (4, 0x200b), (3, 0x1012)] {
        let content = files::serialized_content(version, flags);
        seeds.push(files::serialized(version, &content));
        seeds.push([&[b'*', version - 3][..], &content].concat());
    }
    seeds
}

/// A scene with something of everything, scenes of older versions, and one for every plug-in.
pub fn mitsuba_seeds() -> Vec<Vec<u8>> {
    let mut seeds: Vec<Vec<u8>> =
        vec![FULL.into(), OLD.into(), PRINCIPLED.into(), [FULL, "\0<bsdf type='plastic' id='part'/>"].concat().into()];
    for plugin in mitsuba_plugins::SUPPORTED {
        let file = match plugin.kind {
            kind @ ("obj" | "ply" | "stl" | "serialized") => format!("<string name='filename' value='a.{kind}'/>"),
            "bitmap" | "envmap" => "<string name='filename' value='a.png'/>".to_owned(),
            _ => String::new(),
        };
        let object = format!("<{0} type='{1}'>{file}</{0}>", plugin.tag, plugin.kind);
        let body = match plugin.tag {
            "bsdf" => format!("<shape type='sphere'>{object}</shape>"),
            "texture" => format!("<shape type='rectangle'><bsdf type='diffuse'>{object}</bsdf></shape>"),
            "emitter" if plugin.kind == "area" => format!("<shape type='rectangle'>{object}</shape>"),
            "rfilter" => format!("<sensor type='perspective'><film type='hdrfilm'>{object}</film></sensor>"),
            "film" => format!("<sensor type='perspective'>{object}</sensor>"),
            _ => object,
        };
        seeds.push(format!("<scene version='3.0.0'>{body}<shape type='cube'/></scene>").into());
    }
    seeds
}

const FULL: &str = r##"<?xml version="1.0"?>
<scene version="3.0.0">
<default name="n" value="8"/>
<integrator type="path"><integer name="max_depth" value="$n"/><boolean name="hide_emitters" value="true"/></integrator>
<sensor type="thinlens"><float name="fov" value="40"/><string name="fov_axis" value="smaller"/>
<float name="aperture_radius" value="0.01"/><float name="focus_distance" value="3"/>
<transform name="to_world"><scale x="-1"/><lookat origin="0,1,4" target="0,0,0" up="0,1,0"/></transform>
<film type="hdrfilm"><integer name="width" value="16"/><integer name="height" value="12"/>
<integer name="crop_offset_x" value="2"/><integer name="crop_width" value="8"/><rfilter type="gaussian"/></film>
<sampler type="independent"/></sensor>
<include filename="part.xml"/>
<texture type="bitmap" id="t"><string name="filename" value="a.png"/><transform name="to_uv"><scale value="2"/>
<rotate z="1" angle="30"/></transform><string name="wrap_mode" value="mirror"/></texture>
<bsdf type="twosided" id="m"><bsdf type="blendbsdf"><float name="weight" value=".3"/>
<bsdf type="diffuse"><ref name="reflectance" id="t"/></bsdf>
<bsdf type="roughconductor"><string name="material" value="Cu"/><float name="alpha" value=".1"/></bsdf></bsdf></bsdf>
<bsdf type="mask" id="holes"><texture type="checkerboard" name="opacity"><rgb name="color0" value="1"/></texture>
<bsdf type="bumpmap"><texture type="bitmap"><string name="filename" value="a.exr"/></texture>
<bsdf type="roughplastic"><rgb name="diffuse_reflectance" value="#ff8000"/></bsdf></bsdf></bsdf>
<shape type="obj"><string name="filename" value="a.obj"/><ref id="m"/></shape>
<shape type="ply"><string name="filename" value="a.ply"/><ref id="holes"/><boolean name="face_normals" value="true"/></shape>
<shape type="sphere"><point name="center" x="0" y="1" z="0"/><float name="radius" value="0.5"/><bsdf type="dielectric">
<string name="int_ior" value="bk7"/></bsdf></shape>
<shape type="shapegroup" id="g"><shape type="cylinder"><point name="p1" value="0,0,2"/></shape><shape type="disk"/></shape>
<shape type="instance"><ref id="g"/><transform name="to_world"><matrix value="1 0 0 1 0 1 0 0 0 0 1 0 0 0 0 1"/></transform></shape>
<shape type="rectangle"><emitter type="area"><spectrum name="radiance" value="400:1, 500:2, 700:3"/></emitter></shape>
<emitter type="spot"><rgb name="intensity" value="1 2 3"/><float name="cutoff_angle" value="20"/></emitter>
<emitter type="envmap"><string name="filename" value="a.hdr"/><float name="scale" value="2"/></emitter>
</scene>"##;

const OLD: &str = r##"<scene version="0.5.0">
<integrator type="photonmapper"><integer name="maxDepth" value="-1"/></integrator>
<sensor type="perspective"><float name="focusDistance" value="6"/><transform name="toWorld">
<lookAt origin="0 0 5" target="0 0 0" up="0 1 0"/></transform><film type="ldrfilm"><rfilter type="mitchell"/></film></sensor>
<texture type="scale" id="s"><float name="scale" value="2"/><texture type="vertexcolors"/></texture>
<bsdf type="mixturebsdf" id="mix"><string name="weights" value="0.2, 0.3, 0.5"/><bsdf type="plastic"/><bsdf type="conductor"/>
<bsdf type="coating"><bsdf type="phong"/></bsdf></bsdf>
<shape type="serialized"><string name="filename" value="a.serialized"/><integer name="shapeIndex" value="0"/>
<bsdf type="diffuse"><ref id="s" name="reflectance"/></bsdf></shape>
<shape type="cube"><transform name="toWorld"><translate x="2"/><rotate y="1" angle="45"/></transform><ref id="mix"/></shape>
<shape type="stl"><string name="filename" value="a.stl"/></shape>
<emitter type="point"><point name="position" x="0" y="3" z="0"/><blackbody name="intensity" temperature="3000K"/></emitter>
<emitter type="directional"><vector name="direction" x="0" y="-1" z="0"/><spectrum name="irradiance" filename="a.spd"/></emitter>
</scene>"##;

const PRINCIPLED: &str = r##"<!DOCTYPE scene [<!ENTITY e "0.5">]>
<scene version="2.1.0">
<sensor type="orthographic"/>
<bsdf type="principled" id="p"><rgb name="base_color" value="0.8 0.3 0.1"/><float name="roughness" value="&e;"/>
<float name="metallic" value="0.3"/><float name="spec_trans" value="0.2"/><float name="clearcoat" value="1"/>
<float name="sheen" value="1"/><float name="anisotropic" value=".5"/><float name="flatness" value="0.1"/></bsdf>
<alias id="p" as="q"/>
<shape type="cube"><ref id="q"/></shape>
<shape type="rectangle"><bsdf type="photinus_thesis"/></shape>
<shape type="sphere"><transform name="to_world"><scale x="1" y="2" z="1"/></transform><bsdf type="normalmap">
<texture type="bitmap" name="normalmap"><string name="filename" value="a.png"/><boolean name="raw" value="true"/></texture>
<bsdf type="roughdielectric"><string name="distribution" value="ggx"/></bsdf></bsdf></shape>
<emitter type="constant"><spectrum name="radiance" type="blackbody"/></emitter>
<emitter type="sunsky"/><shape type="hair"/>
</scene>"##;
