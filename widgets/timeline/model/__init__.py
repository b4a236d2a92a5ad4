"""Contents of the timeline and the meaning of gestures, as values and functions independent of Qt."""
