"""Grips of a body on an instrument."""
