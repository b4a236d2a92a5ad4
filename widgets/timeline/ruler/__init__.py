"""The ruler, and the flags above it."""
