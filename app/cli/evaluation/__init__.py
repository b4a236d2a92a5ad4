"""``suisou evaluate``: an evaluation made, and its results."""
