"""Dialogs of evaluations: what is made, and what viewers answered."""
