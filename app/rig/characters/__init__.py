"""Characters: reading of their files, and identification of bones and faces."""
