"""Positions and drags of the composer's marks in the timeline."""
