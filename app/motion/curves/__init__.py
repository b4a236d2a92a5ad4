"""Curves of time that all layers are made of."""
