"""The pipeline from a project to plans and motion, by player and time span."""
