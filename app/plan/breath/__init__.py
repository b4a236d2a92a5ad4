"""Breaths: where they are taken, how deep, and how far the air reaches."""
