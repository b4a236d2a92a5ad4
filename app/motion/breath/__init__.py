"""Breathing motion of the trunk."""
