"""How a body holds an instrument."""
