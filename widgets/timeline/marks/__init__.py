"""Draws the composer's marks (dynamics, articulations, slurs) in the timeline."""
