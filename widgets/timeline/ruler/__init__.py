"""The ruler above the lanes, and the flags of markers above it."""
