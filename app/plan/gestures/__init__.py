"""Plans the gestures of body, feet and instrument."""
