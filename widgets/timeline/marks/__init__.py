"""Marks of the composer on the timeline, drawn."""
