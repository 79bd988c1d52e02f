//! The engines of the equal-time table: ours, and what a user would pick instead, each in the methods that suit the scene.

/// An engine in one of its methods.
pub struct Engine {
    /// Its name in rows.
    pub name: &'static str,
    /// The package it is installed from.
    pub package: Package,
    /// Its driver in `benches/peers/pictures`, and which of the driver's methods; empty for ours.
    pub driver: &'static str,
    pub variant: &'static str,
    /// Whether the driver must measure its costs first, because the engine wants all samples named at once.
    pub calibrated: bool,
    /// Processor seconds of the small picture that shows whether it agrees.
    pub trial_seconds: u32,
    /// Why it is left out of one budget, if it is.
    pub left_out: Option<(u32, &'static str)>,
}

impl Engine {
    /// Why it does not run at a budget of so many seconds, if it does not.
    pub fn left_out_of(&self, seconds: u32) -> Option<&'static str> {
        self.left_out.filter(|(budget, _)| *budget == seconds).map(|(_, why)| why)
    }
}

/// Where an engine comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Package {
    /// This repository.
    Ours,
    /// The Python package index.
    Python(&'static str),
    /// Nowhere that would help: why it is named and does not run.
    Unfit(&'static str),
}

const SLOWER_TWIN: &str = "left out at this budget: the vectorised variant does the same, faster";

const NO_SCALE: &str = "left out: how its lights fall off and how its photons are weighed are conventions of its own, so brightness would have to be fitted";

/// An engine that pip installs and that takes its budget as it comes.
const fn python(name: &'static str, package: &'static str, driver: &'static str, variant: &'static str) -> Engine {
    let package = Package::Python(package);
    Engine { name, package, driver, variant, calibrated: false, trial_seconds: 3, left_out: None }
}

/// All of them, in the order in which they run.
pub const ENGINES: &[Engine] = &[
    Engine {
        name: super::super::report::OURS,
        package: Package::Ours,
        driver: "",
        variant: "",
        calibrated: false,
        trial_seconds: 3,
        left_out: None,
    },
    python("mitsuba-path", "mitsuba", "run_mitsuba.py", "path"),
    Engine {
        left_out: Some((60, SLOWER_TWIN)),
        ..python("mitsuba-path-scalar", "mitsuba", "run_mitsuba.py", "path-scalar")
    },
    python("mitsuba-ptracer", "mitsuba", "run_mitsuba.py", "ptracer"),
    python("luxcore-path", "pyluxcore", "run_luxcore.py", "path"),
    python("luxcore-hybrid", "pyluxcore", "run_luxcore.py", "hybrid"),
    python("luxcore-bidirectional", "pyluxcore", "run_luxcore.py", "bidirectional"),
    Engine {
        trial_seconds: 8,
        ..python("luxcore-photongi-caustic", "pyluxcore", "run_luxcore.py", "photongi-caustic")
    },
    Engine {
        trial_seconds: 25,
        left_out: Some((10, "left out at this budget: its caches alone take longer")),
        ..python("luxcore-photongi-both", "pyluxcore", "run_luxcore.py", "photongi-both")
    },
    Engine { calibrated: true, ..python("radiance-photon-map", "pyradiance", "run_radiance.py", "photon-map") },
    Engine { calibrated: true, trial_seconds: 5, ..python("cycles-path", "bpy", "run_cycles.py", "path") },
    Engine { package: Package::Unfit(NO_SCALE), ..python("povray-photons", "", "", "") },
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_single_and_drivers_exist() {
        let root = crate::root();
        for (i, engine) in ENGINES.iter().enumerate() {
            assert!(ENGINES[..i].iter().all(|other| other.name != engine.name), "{}", engine.name);
            let driver = root.join("benches/peers/pictures").join(engine.driver);
            let needed = matches!(engine.package, Package::Python(_));
            assert!(!needed || driver.is_file(), "{}", driver.display());
        }
    }

    #[test]
    fn every_package_is_pinned() {
        let lock = include_str!("../../../../benches/peers/pictures/requirements.lock");
        for engine in ENGINES {
            if let Package::Python(package) = engine.package {
                assert!(lock.lines().any(|line| line.starts_with(&format!("{package}=="))), "{package}");
            }
        }
    }
}
