"""The lane of the recording."""
