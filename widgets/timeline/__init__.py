"""The timeline: ruler, piano roll and lanes over one time axis."""
