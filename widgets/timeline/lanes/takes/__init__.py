"""Lane of the timeline with a player's recorded takes."""
