"""Transport bar: playing, position, tempo, snapping."""
