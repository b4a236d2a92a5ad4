"""What a player sees in the notes: pieces and parts as arrays, rests, fermatas, dynamics, felt bars."""
