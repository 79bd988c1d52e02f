//! Values against those of Mitsuba 3.9.1 (variant `scalar_rgb`, `BSDF.eval` in radiance mode), computed with its Python
//! module and re-typed: same parameters, same directions.
//!
//! Tolerances: 0.1 % where the formulas are the same; 0.5 % for Beckmann, where Mitsuba fits Smith's masking by a rational
//! function; 0.2 % for plastic, where it fits the diffuse Fresnel reflectance. Rough plastic differs by design, see its test.

use super::subjects::{metal, plastic, principled, rough_glass, rough_plastic};
use super::{direction, flat_point, prepare, rgb};
use crate::bsdf::{LobeSet, SurfaceModel, TransportMode};
use photinus_scene::Material;
use photinus_scene::MicrofacetModel::{self, Beckmann, Ggx};

/// Cosine and azimuth of wo, of wi, and the value per channel.
type Row = [f32; 7];

fn check(name: &str, tolerance: f32, material: Material, rows: &[Row]) {
    let (materials, id) = prepare(vec![material], vec![], SurfaceModel::Physical);
    for &[zo, po, zi, pi, r, g, b] in rows {
        let bsdf = materials.resolve(id, &flat_point(), direction(zo, po));
        let value = bsdf.eval(LobeSet::ALL, direction(zi, pi), TransportMode::Radiance);
        for (ours, theirs) in value.to_array().into_iter().zip([r, g, b]) {
            assert!((ours / theirs - 1.0).abs() < tolerance, "{name} {zo} {po} {zi} {pi}: {value} against {r} {g} {b}");
        }
    }
}

#[test]
fn metal_and_glass() {
    check(
        "metal ggx (0.3, 0.3)",
        0.001,
        metal(Ggx, [0.3; 2], false),
        &[
            [0.8, 0.3, 0.6, 2.0, 0.0597233, 0.0495491, 0.0202082],
            [0.8, 0.3, 0.75, 3.6, 0.927112, 0.769156, 0.317039],
            [0.3, 1.0, 0.4, 4.0, 1.13399, 0.96733, 0.504668],
        ],
    );
    check(
        "glass ggx (0.3, 0.3)",
        0.001,
        rough_glass(Ggx, [0.3; 2], 1.5),
        &[
            [0.8, 0.3, 0.6, 2.0, 0.0026096, 0.0026096, 0.0026096],
            [0.8, 0.3, 0.75, 3.6, 0.0432642, 0.0432642, 0.0432642],
            [0.3, 1.0, 0.4, 4.0, 0.18921, 0.18921, 0.18921],
            [0.8, 0.3, -0.7, 3.4, 0.156404, 0.156404, 0.156404],
            [-0.6, 1.0, 0.7, 4.3, 0.349314, 0.349314, 0.349314],
            [-0.7, 1.0, -0.6, 4.0, 0.962853, 0.962853, 0.962853],
        ],
    );
    check(
        "metal ggx (0.1, 0.6)",
        0.001,
        metal(Ggx, [0.1, 0.6], false),
        &[
            [0.8, 0.3, 0.6, 2.0, 0.114359, 0.0948776, 0.038695],
            [0.8, 0.3, 0.75, 3.6, 1.48994, 1.23609, 0.509506],
            [0.3, 1.0, 0.4, 4.0, 0.413537, 0.35276, 0.184039],
        ],
    );
    check(
        "glass ggx (0.1, 0.6)",
        0.001,
        rough_glass(Ggx, [0.1, 0.6], 1.5),
        &[
            [0.8, 0.3, 0.6, 2.0, 0.0049969, 0.0049969, 0.0049969],
            [0.8, 0.3, 0.75, 3.6, 0.0695288, 0.0695288, 0.0695288],
            [0.3, 1.0, 0.4, 4.0, 0.0689999, 0.0689999, 0.0689999],
            [0.8, 0.3, -0.7, 3.4, 0.00335712, 0.00335712, 0.00335712],
            [-0.6, 1.0, 0.7, 4.3, 0.0216762, 0.0216762, 0.0216762],
            [-0.7, 1.0, -0.6, 4.0, 0.376239, 0.376239, 0.376239],
        ],
    );
    check(
        "metal beckmann (0.3, 0.3)",
        0.005,
        metal(Beckmann, [0.3; 2], false),
        &[
            [0.8, 0.3, 0.6, 2.0, 0.0155636, 0.0129123, 0.00526616],
            [0.8, 0.3, 0.75, 3.6, 1.01345, 0.840781, 0.346563],
            [0.3, 1.0, 0.4, 4.0, 1.94904, 1.66259, 0.867396],
        ],
    );
    check(
        "glass beckmann (0.1, 0.6)",
        0.005,
        rough_glass(Beckmann, [0.1, 0.6], 1.5),
        &[
            [0.8, 0.3, 0.6, 2.0, 0.00241021, 0.00241021, 0.00241021],
            [0.8, 0.3, 0.75, 3.6, 0.0732067, 0.0732067, 0.0732067],
            [0.3, 1.0, 0.4, 4.0, 0.147886, 0.147886, 0.147886],
            [-0.7, 1.0, -0.6, 4.0, 0.637351, 0.637351, 0.637351],
        ],
    );
}

/// The inside's reflectance in Mitsuba, single scattering alone, solved from the three channels of the rows below; ours
/// keeps what single scattering loses, so that a white base loses nothing.
const MITSUBAS_INSIDE: [(MicrofacetModel, f32); 2] = [(Ggx, 0.48), (Beckmann, 0.555)];

#[test]
fn rough_plastic_differs_by_the_reflectance_of_its_inside_only() {
    let base = [0.8, 0.5, 0.2];
    let rows: [(MicrofacetModel, bool, [Row; 3]); 3] = [
        (
            Ggx,
            false,
            [
                [0.8, 0.3, 0.6, 2.0, 0.117492, 0.0739582, 0.0304248],
                [0.8, 0.3, 0.75, 3.6, 0.23146, 0.1758, 0.12014],
                [0.3, 1.0, 0.4, 4.0, 0.3185, 0.294904, 0.271309],
            ],
        ),
        (
            Ggx,
            true,
            [
                [0.8, 0.3, 0.6, 2.0, 0.0994009, 0.051047, 0.0180973],
                [0.8, 0.3, 0.75, 3.6, 0.20833, 0.146506, 0.104378],
                [0.3, 1.0, 0.4, 4.0, 0.308695, 0.282486, 0.264627],
            ],
        ),
        (
            Beckmann,
            true,
            [
                [0.8, 0.3, 0.6, 2.0, 0.110338, 0.0530698, 0.017254],
                [0.8, 0.3, 0.75, 3.6, 0.236142, 0.163018, 0.117285],
                [0.3, 1.0, 0.4, 4.0, 0.489142, 0.459131, 0.440362],
            ],
        ),
    ];
    for (model, nonlinear, rows) in rows {
        let material = rough_plastic(model, 0.2, rgb(base[0], base[1], base[2]), nonlinear);
        let (materials, id) = prepare(vec![material], vec![], SurfaceModel::Physical);
        let eta = 1.49 / 1.000277;
        let ours = materials.interface_table(model, eta).unwrap().coat(0.2).internal_reflectance;
        let (_, theirs) = MITSUBAS_INSIDE.into_iter().find(|(known, _)| *known == model).unwrap();
        for [zo, po, zi, pi, values @ ..] in rows {
            let bsdf = materials.resolve(id, &flat_point(), direction(zo, po));
            let part = |set| bsdf.eval(set, direction(zi, pi), TransportMode::Radiance).to_array();
            let (coat, below) = (part(LobeSet::CONTINUE), part(LobeSet::GATHER));
            for channel in 0..3 {
                let kept = |inside: f32| 1.0 - if nonlinear { base[channel] * inside } else { inside };
                let value = coat[channel] + below[channel] * kept(ours) / kept(theirs);
                let context = format!("{model:?} {nonlinear} {zo} {po} {zi} {pi} channel {channel}");
                assert!((value / values[channel] - 1.0).abs() < 0.01, "{context}: {value} for {}", values[channel]);
            }
        }
    }
}

#[test]
fn plastics() {
    let color = rgb(0.8, 0.5, 0.2);
    check(
        "plastic False",
        0.002,
        plastic(color, false),
        &[
            [0.8, 0.3, 0.6, 2.0, 0.150862, 0.0942888, 0.0377155],
            [0.8, 0.3, 0.75, 3.6, 0.192116, 0.120072, 0.0480289],
            [0.3, 1.0, 0.4, 4.0, 0.0774025, 0.0483766, 0.0193506],
        ],
    );
    check(
        "plastic True",
        0.002,
        plastic(color, true),
        &[
            [0.8, 0.3, 0.6, 2.0, 0.117095, 0.0547892, 0.0175136],
            [0.8, 0.3, 0.75, 3.6, 0.149115, 0.0697714, 0.0223027],
            [0.3, 1.0, 0.4, 4.0, 0.0600776, 0.0281106, 0.00898566],
        ],
    );
}

#[test]
fn the_principled_model() {
    let color = rgb(0.8, 0.5, 0.2);
    check(
        "principled",
        0.001,
        principled(color, 0.5, [0.0; 9]),
        &[
            [0.8, 0.3, 0.6, 2.0, 0.155169, 0.097747, 0.0403247],
            [0.8, 0.3, 0.75, 3.6, 0.250694, 0.179065, 0.107435],
            [0.3, 1.0, 0.4, 4.0, 0.321401, 0.286634, 0.251868],
        ],
    );
    check(
        "principled metal",
        0.001,
        principled(color, 0.6, [0.7, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]),
        &[
            [0.8, 0.3, 0.6, 2.0, 0.0123189, 0.00769988, 0.00308086],
            [0.8, 0.3, 0.75, 3.6, 0.453475, 0.283539, 0.113602],
            [0.3, 1.0, 0.4, 4.0, 0.499294, 0.337155, 0.175016],
        ],
    );
    check(
        "principled glass",
        0.001,
        principled(color, 0.5, [0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]),
        &[
            [0.8, 0.3, 0.6, 2.0, 0.00204321, 0.00204321, 0.00204321],
            [0.8, 0.3, 0.75, 3.6, 0.0596822, 0.0596822, 0.0596822],
            [0.3, 1.0, 0.4, 4.0, 0.228691, 0.228691, 0.228691],
            [0.8, 0.3, -0.7, 3.4, 0.0996646, 0.0787918, 0.0498323],
            [-0.6, 1.0, 0.7, 4.3, 0.222753, 0.176101, 0.111376],
            [-0.7, 1.0, -0.6, 4.0, 1.28414, 1.28414, 1.28414],
        ],
    );
    check(
        "principled all",
        0.001,
        principled(color, 0.4, [0.3, 0.3, 0.4, 0.5, 0.8, 0.5, 0.4, 1.0, 0.2]),
        &[
            [0.8, 0.3, 0.6, 2.0, 0.0663756, 0.0420026, 0.0176295],
            [0.8, 0.3, 0.75, 3.6, 0.748103, 0.495991, 0.243878],
            [0.3, 1.0, 0.4, 4.0, 0.600011, 0.453033, 0.306055],
            [0.8, 0.3, -0.7, 3.4, 0.0205102, 0.0162147, 0.0102551],
            [-0.6, 1.0, 0.7, 4.3, 0.0243589, 0.0192574, 0.0121795],
            [-0.7, 1.0, -0.6, 4.0, 0.719676, 0.719676, 0.719676],
        ],
    );
}
