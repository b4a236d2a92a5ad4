"""Dialogs of evaluations: making one, and its results."""
