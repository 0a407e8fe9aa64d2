//! Portable elementary functions, built from exact operations: the same bits on every CPU.
