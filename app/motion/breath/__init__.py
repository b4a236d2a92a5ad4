"""Breath in the trunk."""
