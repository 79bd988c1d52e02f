//! `<integrator>`: what a file says of light transport.

use super::Importer;
use super::tree::NodeId;
use crate::load::LoadError;
use crate::{IntegratorHint, IntegratorKind};

/// Integrators that wrap another and decide nothing themselves.
const WRAPPERS: &[&str] = &["moment", "aov", "stokes", "adaptive", "irrcache", "multichannel", "field"];
/// Integrators that follow light everywhere.
const FULL: &[&str] = &[
    "path",
    "volpath",
    "volpathmis",
    "volpath_simple",
    "ptracer",
    "bdpt",
    "mlt",
    "pssmlt",
    "erpt",
    "photonmapper",
    "ppm",
    "sppm",
    "vpl",
    "prb",
    "prb_basic",
    "prb_projective",
    "prbvolpath",
    "prb_reparam",
];
/// Integrators of emission and one bounce.
const DIRECT: &[&str] = &["direct", "direct_projective", "emission", "direct_reparam", "emission_reparam"];
/// Parameters that every integrator may have and none of which says how long paths are.
const HINTS: &[&str] = &[
    "timeout",
    "block_size",
    "samples_per_pass",
    "rr_depth",
    "strict_normals",
    "shading_samples",
    "emitter_samples",
    "bsdf_samples",
    "luminaire_samples",
    "aovs",
    "use_spectral_mis",
    "lightimage",
    "sample_direct",
    "bidirectional",
    "max_error",
    "p_value",
    "global_photons",
    "caustic_photons",
    "volume_photons",
    "global_lookup_radius",
    "caustic_lookup_radius",
    "lookup_size",
    "granularity",
    "gather_locally",
    "direct_samples",
    "glossy_samples",
    "photon_count",
    "initial_radius",
    "alpha",
    "max_passes",
    "auto_cancel_gathering",
    "resolution",
    "quality",
    "gradients",
    "clamp_neighbor",
    "clamp_screen",
    "overture",
    "quality_adjustment",
    "indirect_only",
    "debug",
    "clamping",
    "shadow_map_resolution",
    "direct_lights",
    "mutations",
];

impl Importer<'_, '_, '_> {
    /// The hint of the element `id`, of the innermost one where they are nested; none where there is none inside.
    pub(super) fn integrator(&mut self, id: NodeId) -> Result<Option<IntegratorHint>, LoadError> {
        let props = self.props(id)?;
        let kind = props.kind().to_ascii_lowercase();
        props.ignore(HINTS);
        self.enter(id)?;
        let nested = props.objects("integrator");
        let mut hint = match nested.first() {
            Some(&(_, inner)) => self.integrator(inner)?,
            None => None,
        };
        self.leave();
        let hide_emitters = props.boolean("hide_emitters")?.unwrap_or(false);
        if nested.is_empty() {
            let kind = match kind.as_str() {
                k if DIRECT.contains(&k) => IntegratorKind::Direct,
                k if FULL.contains(&k) => IntegratorKind::Full,
                k if WRAPPERS.contains(&k) => IntegratorKind::Unspecified,
                k => {
                    let message = format!("the integrator \"{k}\" is not rendered as such: read as \"path\"");
                    self.context.warn(&props.place(), message);
                    props.ignore_all();
                    IntegratorKind::Full
                }
            };
            let max_depth = match props.integer("max_depth")? {
                None | Some(-1) => None,
                Some(depth) => match u32::try_from(depth) {
                    Ok(depth) => Some(depth),
                    Err(_) => return Err(props.error("max_depth has to be -1 (no limit) or 0 and more")),
                },
            };
            // Emission and one bounce are two vertices, whatever else is said.
            let max_depth = if kind == IntegratorKind::Direct { Some(2) } else { max_depth };
            hint = Some(IntegratorHint { kind, max_depth, hide_emitters });
        } else if let Some(inner) = &mut hint {
            props.ignore(&["max_depth"]);
            inner.hide_emitters |= hide_emitters;
        }
        props.finish(self.context);
        Ok(hint)
    }
}
