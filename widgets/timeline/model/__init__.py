"""Contents of the timeline and the meaning of gestures on it, as values and functions: nothing here knows Qt."""
