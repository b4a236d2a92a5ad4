"""Evaluations in the window."""
