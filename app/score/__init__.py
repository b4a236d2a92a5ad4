"""Files of music to score: notes, tempo map, metres, controller curves, marks, parts."""
