//! Numbers, lists and colours as Mitsuba writes them.

/// A finite number.
pub fn parse_f64(text: &str) -> Option<f64> {
    text.trim().parse::<f64>().ok().filter(|v| v.is_finite())
}

/// A finite number in single precision, rounded once.
pub fn parse_f32(text: &str) -> Option<f32> {
    text.trim().parse::<f32>().ok().filter(|v| v.is_finite())
}

/// Numbers between blanks or commas.
pub fn parse_list(text: &str) -> Option<Vec<f64>> {
    tokens(text).map(parse_f64).collect()
}

/// As [`parse_list`], in single precision.
pub fn parse_list_f32(text: &str) -> Option<Vec<f32>> {
    tokens(text).map(parse_f32).collect()
}

/// Words between blanks or commas.
pub fn tokens(text: &str) -> impl Iterator<Item = &str> {
    text.split([' ', ',', '\t', '\n', '\r']).filter(|t| !t.is_empty())
}

/// "maxDepth" and "intIOR" as "max_depth" and "int_ior": the names of Mitsuba 0.x in today's spelling.
pub fn snake_case(name: &str) -> String {
    let mut out = String::with_capacity(name.len() + 4);
    let mut lower_before = false;
    for c in name.chars() {
        if c.is_ascii_uppercase() {
            if lower_before {
                out.push('_');
            }
            out.push(c.to_ascii_lowercase());
        } else {
            out.push(c);
        }
        lower_before = c.is_ascii_lowercase();
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_old_versions_become_todays() {
        for (old, new) in [
            ("maxDepth", "max_depth"),
            ("intIOR", "int_ior"),
            ("toWorld", "to_world"),
            ("to_world", "to_world"),
            ("fovAxis", "fov_axis"),
            ("B", "b"),
            ("diffuseReflectance", "diffuse_reflectance"),
            ("color0", "color0"),
            ("flipTexCoords", "flip_tex_coords"),
            ("alphaU", "alpha_u"),
        ] {
            assert_eq!(snake_case(old), new);
        }
    }

    #[test]
    fn numbers_are_finite_and_lists_take_blanks_and_commas() {
        assert_eq!(parse_list(" 1, 2\t-3e2 ,+4 .5"), Some(vec![1.0, 2.0, -300.0, 4.0, 0.5]));
        assert_eq!(parse_list("1, two"), None);
        for bad in ["", "nan", "inf", "1e999", "1.0f", "0x10", "--1", "1 2"] {
            assert_eq!(parse_f64(bad), None, "{bad}");
        }
        assert_eq!(parse_f32("1e39"), None);
    }
}
