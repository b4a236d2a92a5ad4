"""The drawing area shared by ruler, roll and lanes: time axis, drawing, mouse."""
