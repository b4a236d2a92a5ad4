"""The editor: composition of the panels in a window, and nothing else."""

from app.shell import plain_import as plain_import
