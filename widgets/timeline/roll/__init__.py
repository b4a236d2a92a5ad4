"""Piano roll: the lane of the timeline with the notes of all players."""
