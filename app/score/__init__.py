"""MIDI file to score: notes, tempo map, metres, controller curves, parts."""
