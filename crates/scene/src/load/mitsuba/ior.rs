//! Named indices of refraction.

/// (name, index at about 589 nm and 0 to 20 degrees Celsius). Values from E. Hecht, "Optics", 4th edition, table 4.1,
/// and makers' sheets (BK7 by Schott, Pyrex by Corning, plastics); names and digits as Mitsuba lists them.
pub const INDICES: &[(&str, f32)] = &[
    ("vacuum", 1.0),
    ("helium", 1.000036),
    ("hydrogen", 1.000132),
    ("air", 1.000277),
    ("carbon dioxide", 1.00045),
    ("water", 1.3330),
    ("acetone", 1.36),
    ("ethanol", 1.361),
    ("carbon tetrachloride", 1.461),
    ("glycerol", 1.4729),
    ("benzene", 1.501),
    ("silicone oil", 1.52045),
    ("bromine", 1.661),
    ("water ice", 1.31),
    ("fused quartz", 1.458),
    ("pyrex", 1.470),
    ("acrylic glass", 1.49),
    ("polypropylene", 1.49),
    ("bk7", 1.5046),
    ("sodium chloride", 1.544),
    ("amber", 1.55),
    ("pet", 1.5750),
    ("diamond", 2.419),
];

/// An index by name, upper and lower case alike.
pub fn index(name: &str) -> Option<f32> {
    INDICES.iter().find(|i| i.0.eq_ignore_ascii_case(name.trim())).map(|i| i.1)
}

/// The names, for messages.
pub fn names() -> String {
    INDICES.iter().map(|i| i.0).collect::<Vec<_>>().join(", ")
}
