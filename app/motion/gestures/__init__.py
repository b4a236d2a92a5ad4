"""Gestures as motion layers of the body."""
