"""Qt panels of the editor."""
