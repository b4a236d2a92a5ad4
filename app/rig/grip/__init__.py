"""Grips: how bodies hold instruments."""
