"""Facial expressions and glances."""
