"""Lane of the timeline with the user's additive animation curves."""
