"""The section of the dancers in the panel of the players."""
