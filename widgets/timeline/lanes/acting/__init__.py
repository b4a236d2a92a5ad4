"""Lane of the timeline with cues, facial expressions, poses and gestures."""
