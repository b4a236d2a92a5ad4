"""Curves of controls and fingers."""
