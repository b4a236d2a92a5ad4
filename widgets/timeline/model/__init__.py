"""What the timeline shows and what gestures on it mean, as values and functions: nothing here knows Qt."""
