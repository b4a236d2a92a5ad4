"""The inspector: what is selected, what was made by hand, problems, history."""
