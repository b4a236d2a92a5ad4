"""Gestures as layers of the body."""
