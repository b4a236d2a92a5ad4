"""Events as regions of a lane."""
