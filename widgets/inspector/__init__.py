"""The inspector: selection, manual changes, problems, history."""
