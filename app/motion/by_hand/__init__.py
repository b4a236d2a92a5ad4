"""Motion added by an animator before contacts are solved."""
