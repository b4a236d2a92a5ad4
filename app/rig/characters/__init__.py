"""Characters: their files read, their bones and faces known."""
