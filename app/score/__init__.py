"""Reading of music files as scores: notes, tempo map, metres, controller curves, marks and parts."""
