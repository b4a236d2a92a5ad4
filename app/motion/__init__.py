"""Turns plans into sampled motion: controls, face, body layers, and finally contacts."""
