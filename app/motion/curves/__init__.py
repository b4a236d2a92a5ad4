"""Curves of time from which all layers are made."""
