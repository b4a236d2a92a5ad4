"""Additive curves as displayed in the timeline."""
