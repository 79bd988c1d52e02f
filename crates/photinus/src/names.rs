//! Families and the names of their members, for the command line, its help and its errors.

use crate::{Error, Result};
use photinus_accel::{Clip, GridCells, SplitCandidates};
use photinus_image::tonemap::{TONEMAPS, Tonemap};
use photinus_render::bsdf::SurfaceModel;
use photinus_render::{Aov, INDIRECT as INDIRECT_MEMBERS, Indirect, Mode};

/// A member of a family.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Member {
    /// Name on the command line.
    pub name: &'static str,
    /// What it is, in one line.
    pub summary: &'static str,
}

/// A family whose members are chosen by name.
#[derive(Clone, Copy, Debug)]
pub struct Family {
    /// What a member is, for people.
    pub what: &'static str,
    /// The member that is used where none is named.
    pub default: &'static str,
    list: fn() -> Vec<Member>,
}

/// Built-in scenes.
pub const SCENES: Family = Family {
    what: "built-in scene",
    default: photinus_scene::builtin::DEFAULT,
    list: || {
        let scenes = photinus_scene::builtin::list().iter();
        scenes.map(|scene| Member { name: scene.name, summary: scene.description }).collect()
    },
};

/// Acceleration structures.
pub const ACCEL: Family = Family {
    what: "acceleration structure",
    default: photinus_accel::DEFAULT_STRUCTURE,
    list: || {
        let structures = photinus_accel::STRUCTURES.iter();
        structures.map(|member| Member { name: member.name, summary: member.summary }).collect()
    },
};

/// Ray-triangle methods.
pub const INTERSECT: Family = Family {
    what: "ray-triangle method",
    default: photinus_intersect::DEFAULT_METHOD,
    list: || {
        let methods = photinus_intersect::METHODS.iter();
        methods.map(|member| Member { name: member.name, summary: member.summary }).collect()
    },
};

/// Photon searches.
pub const SEARCH: Family = Family {
    what: "photon search",
    default: photinus_photons::DEFAULT_SEARCH,
    list: || {
        let searches = photinus_photons::SEARCHES.iter();
        searches.map(|member| Member { name: member.name, summary: member.about }).collect()
    },
};

/// Supports of photon estimates.
pub const SUPPORT: Family = Family {
    what: "support of estimates",
    default: photinus_photons::DEFAULT_SUPPORT,
    list: || {
        let supports = photinus_photons::SUPPORTS.iter();
        supports.map(|member| Member { name: member.name, summary: member.about }).collect()
    },
};

/// Kernels of photon estimates; which is used where none is named depends on the mode.
pub const KERNEL: Family = Family {
    what: "kernel of estimates",
    default: "epanechnikov",
    list: || {
        let kernels = photinus_photons::KERNELS.iter();
        kernels.map(|member| Member { name: member.name, summary: member.about }).collect()
    },
};

/// Ways to find light.
pub const MODE: Family =
    Family { what: "mode", default: "progressive", list: || MODES.iter().map(|(member, _)| *member).collect() };

const MODES: [(Member, Mode); 4] = [
    (
        Member { name: "progressive", summary: "photon passes whose radius shrinks, light sampled directly" },
        Mode::Progressive,
    ),
    (Member { name: "gather", summary: "one photon map of fixed radius, many eye passes" }, Mode::Gather),
    (
        Member { name: "direct", summary: "the thesis's renderer: one map, an estimate at every hit, no shadow rays" },
        Mode::Direct,
    ),
    (Member { name: "path", summary: "a path tracer: ground truth" }, Mode::Path),
];

/// Ways to estimate light after a diffuse bounce.
pub const INDIRECT: Family = Family {
    what: "way to estimate indirect light",
    default: INDIRECT_MEMBERS[0].name,
    list: || INDIRECT_MEMBERS.iter().map(|member| Member { name: member.name, summary: member.about }).collect(),
};

/// Layers of an EXR file.
pub const AOV: Family = Family {
    what: "layer",
    default: "albedo",
    list: || Aov::ALL.iter().map(|aov| Member { name: aov.name(), summary: aov.describe() }).collect(),
};

/// Tone curves.
pub const TONEMAP: Family = Family {
    what: "tone curve",
    default: TONEMAPS[0].name,
    list: || TONEMAPS.iter().map(|curve| Member { name: curve.name, summary: curve.summary }).collect(),
};

/// What surfaces do.
pub const SURFACE_MODEL: Family = Family {
    what: "surface model",
    default: SURFACE_MODELS[0].0.name,
    list: || SURFACE_MODELS.iter().map(|(member, _)| *member).collect(),
};

const SURFACE_MODELS: [(Member, SurfaceModel); 2] = [
    (Member { name: "physical", summary: "as the materials say" }, SurfaceModel::Physical),
    (
        Member { name: "fixed", summary: "Fresnel and microfacets bypassed, as the thesis factors them out" },
        SurfaceModel::Fixed,
    ),
];

/// Where a kd-tree may be split.
pub const CANDIDATES: Family = Family {
    what: "choice of split candidates",
    default: CANDIDATE_CHOICES[2].0.name,
    list: || CANDIDATE_CHOICES.iter().map(|(member, _)| *member).collect(),
};

const CANDIDATE_CHOICES: [(Member, SplitCandidates); 4] = [
    (Member { name: "uniform", summary: "equal steps: fastest to build, dearest tree" }, SplitCandidates::Uniform),
    (Member { name: "bounds", summary: "every primitive's bounds: the reverse" }, SplitCandidates::Bounds),
    (Member { name: "sampled", summary: "bounds, evenly picked where there are many" }, SplitCandidates::Sampled),
    (
        Member { name: "quadratic", summary: "lowest points of parabolas through 16 samples" },
        SplitCandidates::Quadratic,
    ),
];

/// What of a triangle is put into the cells of a structure.
pub const CLIP: Family = Family {
    what: "way to put triangles into cells",
    default: CLIPS[0].0.name,
    list: || CLIPS.iter().map(|(member, _)| *member).collect(),
};

const CLIPS: [(Member, Clip); 2] = [
    (Member { name: "box", summary: "its bounds: quick to build" }, Clip::Box),
    (Member { name: "exact", summary: "the part within the cell: fewer tests" }, Clip::Exact),
];

/// How a compact grid finds the list of a cell.
pub const GRID_CELLS: Family = Family {
    what: "kind of grid cells",
    default: GRID_CELL_KINDS[0].0.name,
    list: || GRID_CELL_KINDS.iter().map(|(member, _)| *member).collect(),
};

const GRID_CELL_KINDS: [(Member, GridCells); 2] = [
    (Member { name: "array", summary: "one offset for every cell" }, GridCells::Array),
    (Member { name: "hashed", summary: "offsets of filled cells only, by row displacement" }, GridCells::Hashed),
];

/// What answers ray and photon queries.
pub const BACKEND: Family = Family {
    what: "backend",
    default: "native",
    list: || {
        let planned = "not built yet";
        vec![
            Member { name: "native", summary: "this machine's processor" },
            Member { name: "lns", summary: planned },
            Member { name: "cycle", summary: planned },
            Member { name: "rtl", summary: planned },
        ]
    },
};

/// The mode called `name`.
///
/// # Errors
/// [`Error::UnknownName`], as for all that follow.
pub fn mode(name: &str) -> Result<Mode> {
    MODE.choose(name, &MODES.map(|(member, mode)| (member.name, mode)))
}

/// The way to estimate indirect light called `name`.
///
/// # Errors
/// [`Error::UnknownName`].
pub fn indirect(name: &str) -> Result<Indirect> {
    let choices: Vec<(&str, Indirect)> = INDIRECT_MEMBERS.iter().map(|member| (member.name, member.choice)).collect();
    INDIRECT.choose(name, &choices)
}

/// The layer called `name`.
///
/// # Errors
/// [`Error::UnknownName`].
pub fn aov(name: &str) -> Result<Aov> {
    AOV.choose(name, &Aov::ALL.map(|aov| (aov.name(), aov)))
}

/// The surface model called `name`.
///
/// # Errors
/// [`Error::UnknownName`].
pub fn surface_model(name: &str) -> Result<SurfaceModel> {
    SURFACE_MODEL.choose(name, &SURFACE_MODELS.map(|(member, model)| (member.name, model)))
}

/// The split candidates called `name`.
///
/// # Errors
/// [`Error::UnknownName`].
pub fn candidates(name: &str) -> Result<SplitCandidates> {
    CANDIDATES.choose(name, &CANDIDATE_CHOICES.map(|(member, choice)| (member.name, choice)))
}

/// The way to put triangles into cells called `name`.
///
/// # Errors
/// [`Error::UnknownName`].
pub fn clip(name: &str) -> Result<Clip> {
    CLIP.choose(name, &CLIPS.map(|(member, clip)| (member.name, clip)))
}

/// The kind of grid cells called `name`.
///
/// # Errors
/// [`Error::UnknownName`].
pub fn grid_cells(name: &str) -> Result<GridCells> {
    GRID_CELLS.choose(name, &GRID_CELL_KINDS.map(|(member, cells)| (member.name, cells)))
}

/// The tone curve called `name`.
///
/// # Errors
/// [`Error::UnknownName`].
pub fn tonemap(name: &str) -> Result<Tonemap> {
    let curves: Vec<(&str, Tonemap)> = TONEMAPS.iter().map(|curve| (curve.name, *curve)).collect();
    TONEMAP.choose(name, &curves)
}

impl Family {
    /// All members in the order of their list.
    pub fn members(&self) -> Vec<Member> {
        (self.list)()
    }

    /// The member called `name`; underscores count as hyphens.
    ///
    /// # Errors
    /// [`Error::UnknownName`] with the nearest name, or all names where none is near.
    pub fn find(&self, name: &str) -> Result<Member> {
        let wanted = name.replace('_', "-");
        self.members().into_iter().find(|member| member.name == wanted).ok_or_else(|| self.unknown(name))
    }

    /// The value that goes with the member called `name`.
    fn choose<T: Copy>(&self, name: &str, values: &[(&str, T)]) -> Result<T> {
        let wanted = name.replace('_', "-");
        let value = values.iter().find(|(name, _)| *name == wanted).map(|(_, value)| *value);
        value.ok_or_else(|| self.unknown(name))
    }

    /// The error for a name that no member has.
    pub(crate) fn unknown(&self, name: &str) -> Error {
        let members = self.members();
        let names: Vec<&str> = members.iter().map(|member| member.name).collect();
        Error::UnknownName { name: name.to_owned(), what: self.what, hint: hint(&name.replace('_', "-"), &names) }
    }
}

/// What to say to somebody who typed `wanted`: the nearest of `names`, or all of them.
pub(crate) fn hint(wanted: &str, names: &[&str]) -> String {
    match nearest(wanted, names) {
        Some(name) => format!("did you mean {name}?"),
        None => format!("there are {}", names.join(", ")),
    }
}

/// The name most like `wanted`, where one is alike enough to be meant; of equals the first.
fn nearest<'a>(wanted: &str, names: &[&'a str]) -> Option<&'a str> {
    // Below 0.8 of the Jaro-Winkler measure short names begin to match words that share two letters.
    const ALIKE: f64 = 0.8;
    let mut best: Option<(f64, &str)> = None;
    for &name in names {
        let likeness = strsim::jaro_winkler(wanted, name);
        if likeness >= ALIKE && best.is_none_or(|(most, _)| likeness > most) {
            best = Some((likeness, name));
        }
    }
    best.map(|(_, name)| name)
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: &[Family] = &[
        SCENES,
        ACCEL,
        INTERSECT,
        SEARCH,
        SUPPORT,
        KERNEL,
        MODE,
        INDIRECT,
        AOV,
        TONEMAP,
        SURFACE_MODEL,
        CANDIDATES,
        BACKEND,
    ];

    #[test]
    fn every_family_has_its_default_and_no_name_twice() {
        for family in ALL {
            let members = family.members();
            assert!(family.find(family.default).is_ok(), "{}: default {}", family.what, family.default);
            for (i, member) in members.iter().enumerate() {
                assert!(members[..i].iter().all(|other| other.name != member.name), "{}: {}", family.what, member.name);
                assert!(!member.summary.is_empty() && !member.name.contains(['_', ' ']), "{}", member.name);
            }
        }
    }

    #[test]
    fn names_are_found_with_either_separator() {
        assert_eq!(SCENES.find("two_spheres").unwrap().name, "two-spheres");
        assert_eq!(SCENES.find("cornell").unwrap().name, "cornell");
    }

    #[test]
    fn every_name_of_a_family_has_its_value() {
        let all = |family: Family, found: &dyn Fn(&str) -> bool| {
            for member in family.members() {
                assert!(found(member.name), "{}: {}", family.what, member.name);
            }
        };
        all(MODE, &|name| mode(name).is_ok_and(|mode| mode.name() == name));
        all(INDIRECT, &|name| indirect(name).is_ok());
        all(AOV, &|name| aov(name).is_ok_and(|aov| aov.name() == name));
        all(TONEMAP, &|name| tonemap(name).is_ok_and(|curve| curve.name == name));
        all(SURFACE_MODEL, &|name| surface_model(name).is_ok());
        all(CANDIDATES, &|name| candidates(name).is_ok());
        assert!(mode("progresive").unwrap_err().to_string().contains("did you mean progressive?"));
    }

    #[test]
    fn a_slip_of_the_pen_gets_a_suggestion_and_nonsense_the_list() {
        let message = SCENES.find("two-sphere").unwrap_err().to_string();
        assert_eq!(message, "two-sphere: no built-in scene of that name; did you mean two-spheres?");
        let message = SCENES.find("qqqq").unwrap_err().to_string();
        assert!(message.contains("there are two-spheres, "), "{message}");
    }
}
