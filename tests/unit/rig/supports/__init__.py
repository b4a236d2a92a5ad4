"""Tests of straps and chairs."""
