"""Body motion learned from motion capture and its music: a hidden Markov model of basic motions (Kameda et al.)."""
