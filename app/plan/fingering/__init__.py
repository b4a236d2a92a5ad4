"""Plans the fingering of every note, and the use of mutes."""
