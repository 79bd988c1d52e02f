//! The plug-ins of each kind that are read, and those that are known and replaced. One table for code, docs and tests.

/// A plug-in that is read.
pub struct Supported {
    /// Element name.
    pub tag: &'static str,
    /// Its `type`.
    pub kind: &'static str,
    /// What differs from Mitsuba 3, if anything.
    pub note: &'static str,
}

const fn s(tag: &'static str, kind: &'static str, note: &'static str) -> Supported {
    Supported { tag, kind, note }
}

/// All plug-ins that are read.
pub const SUPPORTED: &[Supported] = &[
    s("shape", "obj", ""),
    s("shape", "ply", ""),
    s("shape", "serialized", ""),
    s("shape", "stl", "not in Mitsuba"),
    s("shape", "rectangle", ""),
    s("shape", "cube", ""),
    s("shape", "sphere", "exact; triangles under a transform that makes it an ellipsoid"),
    s("shape", "disk", "256 triangles"),
    s("shape", "cylinder", "256 triangles with smooth normals"),
    s("shape", "shapegroup", ""),
    s("shape", "instance", "expanded into world space"),
    s("shape", "merge", "children are kept apart"),
    s("bsdf", "diffuse", ""),
    s("bsdf", "dielectric", ""),
    s("bsdf", "thindielectric", ""),
    s("bsdf", "roughdielectric", ""),
    s("bsdf", "conductor", ""),
    s("bsdf", "roughconductor", ""),
    s("bsdf", "plastic", ""),
    s("bsdf", "roughplastic", ""),
    s("bsdf", "principled", ""),
    s("bsdf", "twosided", "around a transparent material: no effect, with a warning"),
    s("bsdf", "mask", ""),
    s("bsdf", "blendbsdf", ""),
    s("bsdf", "mixturebsdf", "of Mitsuba 0.x; becomes nested blends"),
    s("bsdf", "bumpmap", ""),
    s("bsdf", "normalmap", ""),
    s("bsdf", "null", ""),
    s("bsdf", "photinus_thesis", "not in Mitsuba: the surface of the thesis"),
    s("emitter", "area", ""),
    s("emitter", "point", ""),
    s("emitter", "spot", "without a projected texture"),
    s("emitter", "directional", ""),
    s("emitter", "constant", ""),
    s("emitter", "envmap", ""),
    s("texture", "bitmap", "filters of Mitsuba 0.x are read as bilinear"),
    s("texture", "checkerboard", ""),
    s("texture", "scale", "of Mitsuba 0.x"),
    s("texture", "vertexcolors", "of Mitsuba 0.x"),
    s("texture", "mesh_attribute", "vertex_color only"),
    s("sensor", "perspective", ""),
    s("sensor", "thinlens", ""),
    s("sensor", "orthographic", ""),
    s("rfilter", "box", ""),
    s("rfilter", "tent", ""),
    s("rfilter", "gaussian", ""),
    s("rfilter", "mitchell", ""),
    s("rfilter", "catmullrom", ""),
    s("rfilter", "lanczos", ""),
    s("film", "hdrfilm", ""),
    s("film", "ldrfilm", "of Mitsuba 0.x: size, crop and filter"),
    s("film", "tiledhdrfilm", "of Mitsuba 0.x: size, crop and filter"),
    s("film", "mfilm", "of Mitsuba 0.x: size, crop and filter"),
    s("film", "specfilm", "rendered as RGB"),
];

/// Plug-ins that are known and not rendered, with what happens instead.
pub const REPLACED: &[(&str, &str, &str)] = &[
    ("bsdf", "roughdiffuse", "diffuse is used"),
    ("bsdf", "coating", "the nested BSDF is used"),
    ("bsdf", "roughcoating", "the nested BSDF is used"),
    ("bsdf", "pplastic", "roughplastic is used"),
    ("bsdf", "principledthin", "principled is used"),
    ("bsdf", "phong", "a grey diffuse surface is used"),
    ("bsdf", "ward", "a grey diffuse surface is used"),
    ("bsdf", "difftrans", "a grey diffuse surface is used"),
    ("bsdf", "hk", "a grey diffuse surface is used"),
    ("bsdf", "irawan", "a grey diffuse surface is used"),
    ("bsdf", "hair", "a grey diffuse surface is used"),
    ("bsdf", "measured", "a grey diffuse surface is used"),
    ("bsdf", "measured_polarized", "a grey diffuse surface is used"),
    ("bsdf", "polarizer", "light passes unchanged"),
    ("bsdf", "retarder", "light passes unchanged"),
    ("bsdf", "circular", "light passes unchanged"),
    ("emitter", "sky", "left out"),
    ("emitter", "sun", "left out"),
    ("emitter", "sunsky", "left out"),
    ("emitter", "timed_sunsky", "left out"),
    ("emitter", "projector", "left out"),
    ("emitter", "directionalarea", "left out"),
    ("emitter", "collimated", "left out"),
    ("shape", "hair", "left out"),
    ("shape", "heightfield", "left out"),
    ("shape", "linearcurve", "left out"),
    ("shape", "bsplinecurve", "left out"),
    ("shape", "sdfgrid", "left out"),
    ("shape", "ellipsoids", "left out"),
    ("shape", "ellipsoidsmesh", "left out"),
    ("shape", "deformable", "left out"),
    ("texture", "gridtexture", "mid-grey is used"),
    ("texture", "wireframe", "mid-grey is used"),
    ("texture", "curvature", "mid-grey is used"),
    ("texture", "volume", "mid-grey is used"),
    ("sensor", "distant", "a camera that frames the scene is used"),
    ("sensor", "radiancemeter", "a camera that frames the scene is used"),
    ("sensor", "irradiancemeter", "a camera that frames the scene is used"),
    ("sensor", "fluencemeter", "a camera that frames the scene is used"),
    ("sensor", "spherical", "a camera that frames the scene is used"),
    ("sensor", "batch", "a camera that frames the scene is used"),
];

/// Whether a plug-in is read.
pub fn is_supported(tag: &str, kind: &str) -> bool {
    SUPPORTED.iter().any(|s| s.tag == tag && s.kind == kind)
}

/// One line about a plug-in that is not read.
pub fn refusal(tag: &str, kind: &str) -> String {
    let instead = REPLACED.iter().find(|r| r.0 == tag && r.1 == kind).map(|r| r.2);
    match (instead, tag) {
        (Some(instead), _) => format!("{tag} \"{kind}\" is not supported: {instead}"),
        (None, "bsdf") => format!("unknown bsdf \"{kind}\": a grey diffuse surface is used"),
        (None, "texture") => format!("unknown texture \"{kind}\": mid-grey is used"),
        (None, "sensor") => format!("unknown sensor \"{kind}\": a camera that frames the scene is used"),
        (None, _) => format!("unknown {tag} \"{kind}\": left out"),
    }
}
