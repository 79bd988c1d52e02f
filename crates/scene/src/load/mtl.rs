//! OBJ material libraries.
