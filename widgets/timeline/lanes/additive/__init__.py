"""The lane of additive curves."""
