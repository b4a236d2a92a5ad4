"""Properties of the evaluation."""
