"""Entries, who gives them, and who answers with a nod."""
