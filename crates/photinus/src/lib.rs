//! The facade: scene, names and settings in; image, profile and queries out.
