"""Controls and fingers as curves."""
