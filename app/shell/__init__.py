"""The editor: composition of the panels in a window, and nothing else."""
