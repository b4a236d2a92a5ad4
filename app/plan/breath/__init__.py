"""Breaths: their places and depths, and the air supply."""
