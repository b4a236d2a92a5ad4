"""Contents of the ruler (tempo, metres, markers) and the beats pinned to the recording."""
