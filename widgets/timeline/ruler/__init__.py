"""The ruler, and the flags over it."""
