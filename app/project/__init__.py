"""Project: the immutable value that holds a piece, its players and every correction."""
