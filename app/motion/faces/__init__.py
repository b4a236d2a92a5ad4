"""Curves of faces and gaze."""
