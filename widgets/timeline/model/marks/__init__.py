"""Marks of the composer on the timeline: where they lie, and the hand that moves them."""
