"""Plan to sampled motion: controls, face, body layers, and contacts solved last."""
