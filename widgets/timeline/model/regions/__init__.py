"""Events of players as regions (spans with fades) that a lane displays and drags."""
