"""The ruler, and beats pinned to the recording."""
