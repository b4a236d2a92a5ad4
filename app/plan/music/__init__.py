"""The notes as a player sees them: pieces and parts as arrays, rests, fermatas, dynamics, felt bars."""
