"""The list of players and their parameters."""
