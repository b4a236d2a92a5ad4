"""Expressions and glances."""
