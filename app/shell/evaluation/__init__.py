"""What the window does with evaluations."""
