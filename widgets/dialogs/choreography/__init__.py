"""Dialogs of choreographies: what one has learned, and how one is learned."""
