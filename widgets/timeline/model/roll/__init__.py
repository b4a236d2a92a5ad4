"""Notes and cues as displayed in the piano roll."""
