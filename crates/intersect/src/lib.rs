//! Ray-triangle methods, one file each, over any scalar.
