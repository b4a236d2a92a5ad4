"""Takes of the active player as the takes lane displays them."""
