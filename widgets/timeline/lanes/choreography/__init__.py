"""Lane of the timeline with the steps of each dancer's dance."""
