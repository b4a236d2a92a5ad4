"""``suisou evaluate``: makes an evaluation, and tabulates its results."""
