"""Entries, the players who cue them, and the nods in answer."""
