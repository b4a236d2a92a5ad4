"""Gestures of body, feet and instrument."""
