"""Project: an immutable value with a piece, its players and all corrections."""
