"""Faces and gaze as curves."""
