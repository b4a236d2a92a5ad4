"""Lane of the timeline with the fingering of every note."""
