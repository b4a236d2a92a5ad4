"""The pipeline: Project snapshot to plan to motion, by player and time span."""
