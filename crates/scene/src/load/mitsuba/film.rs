//! `<film>` and `<rfilter>`.

use super::props::Props;
use super::tree::NodeId;
use super::{Importer, names};
use crate::load::LoadError;
use crate::load::defaults::DEFAULT_FILM;
use crate::{FilmSettings, Filter};

/// Most pixels along an edge, and in all.
const MAX_EDGE: i64 = 1 << 16;
const MAX_PIXELS: i64 = 1 << 28;

impl<'t> Importer<'t, '_, '_> {
    /// The picture that the element `id` describes.
    pub(super) fn film(&mut self, id: NodeId) -> Result<FilmSettings, LoadError> {
        let props = self.props(id)?;
        if !names::is_supported("film", props.kind()) {
            self.context.warn(&props.place(), format!("unknown film \"{}\": read as hdrfilm", props.kind()));
        }
        // How the file is stored and what is written into it is the command line's to say.
        props.ignore(&[
            "file_format",
            "pixel_format",
            "component_format",
            "banner",
            "attach_log",
            "sample_border",
            "compensate",
            "gamma",
            "exposure",
            "tonemap_method",
            "key",
            "burn",
            "label",
            "channel_names",
            "variable",
            "digits",
        ]);
        let size = |name: &str, default: u32| -> Result<i64, LoadError> {
            let v = props.integer(name)?.unwrap_or(i64::from(default));
            if (1..=MAX_EDGE).contains(&v) {
                return Ok(v);
            }
            let message = format!("the film's {name} is {v}, but has to be from 1 to {MAX_EDGE}");
            Err(LoadError::invalid(props.place_of(name), message))
        };
        let (width, height) = (size("width", DEFAULT_FILM.width)?, size("height", DEFAULT_FILM.height)?);
        if width * height > MAX_PIXELS {
            return Err(props.error(format!("a film of {width} x {height} pixels is beyond the limit of {MAX_PIXELS}")));
        }
        let crop = if ["crop_width", "crop_height", "crop_offset_x", "crop_offset_y"].iter().any(|n| props.has(n)) {
            let x = props.integer("crop_offset_x")?.unwrap_or(0);
            let y = props.integer("crop_offset_y")?.unwrap_or(0);
            let w = props.integer("crop_width")?.unwrap_or(width);
            let h = props.integer("crop_height")?.unwrap_or(height);
            let inside = |at: i64, len: i64, all: i64| at >= 0 && len >= 1 && at < all && len <= all - at;
            if !(inside(x, w, width) && inside(y, h, height)) {
                return Err(props.error("the crop window is not inside the film"));
            }
            Some([x as u32, y as u32, w as u32, h as u32])
        } else {
            None
        };
        let filter = match props.objects("rfilter").first() {
            Some(&(_, id)) => self.filter(id)?,
            None => DEFAULT_FILM.filter,
        };
        props.finish(self.context);
        Ok(FilmSettings { width: width as u32, height: height as u32, crop, filter })
    }

    fn filter(&mut self, id: NodeId) -> Result<Filter, LoadError> {
        let props = self.props(id)?;
        let positive = |props: &Props<'t>, name: &str, default: f32| -> Result<f32, LoadError> {
            match props.float(name)?.unwrap_or(default) {
                v if v > 0.0 && v <= 64.0 => Ok(v),
                v => Err(props.error(format!("the filter's {name} is {v}, but has to be above 0, at most 64"))),
            }
        };
        let filter = match props.kind() {
            "box" => {
                props.ignore(&["radius"]);
                Filter::Box
            }
            "tent" => Filter::Tent { radius: positive(&props, "radius", 1.0)? },
            "gaussian" => Filter::Gaussian { stddev: positive(&props, "stddev", 0.5)? },
            "mitchell" => Filter::Mitchell {
                b: props.float("b")?.unwrap_or(1.0 / 3.0),
                c: props.float("c")?.unwrap_or(1.0 / 3.0),
            },
            "catmullrom" => Filter::CatmullRom,
            "lanczos" => match props.integer("lobes")?.unwrap_or(3) {
                lobes @ 1..=16 => Filter::Lanczos { lobes: lobes as u32 },
                lobes => return Err(props.error(format!("a Lanczos filter of {lobes} lobes: use 1 to 16"))),
            },
            other => {
                self.context.warn(&props.place(), format!("unknown rfilter \"{other}\": the default is used"));
                props.ignore_all();
                DEFAULT_FILM.filter
            }
        };
        props.finish(self.context);
        Ok(filter)
    }
}
