"""Dancers and choreographies in the window."""
