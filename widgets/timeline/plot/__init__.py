"""The drawing area that ruler, roll and lanes share: time axis, drawing, mouse."""
