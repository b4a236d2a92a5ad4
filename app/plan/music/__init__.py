"""Music as input of the planning: pieces and parts as arrays, rests, fermatas, dynamics, felt bars."""
