"""What an animator changes by hand: corrections, poses, additive curves."""
