//! The command `photinus`.
fn main() {}
