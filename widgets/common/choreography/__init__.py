"""Dances as they are drawn in several panels."""
