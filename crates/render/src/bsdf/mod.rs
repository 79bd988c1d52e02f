//! Surface scattering: materials resolved at a point into a sum of lobes that can be evaluated and sampled.
//!
//! Directions are unit vectors in the point's local shading frame, both pointing away from the surface; `wo` is where
//! the path comes from, `wi` where it goes. Values include |cos theta_i|.
