//! Image files in and out, colour and image metrics.
