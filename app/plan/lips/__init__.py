"""Lips and tongue."""
