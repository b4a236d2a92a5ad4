"""Additive curves as the timeline shows them."""
