"""Changes of an animator by hand: corrections, poses, additive curves."""
