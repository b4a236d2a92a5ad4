"""Dialogs of choreographies: their learned contents, and learning."""
