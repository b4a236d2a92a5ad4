"""Motion that an animator adds by hand, before any contact is solved."""
