"""Fingerings and mutes."""
