"""Suisou: from the notes of a wind ensemble to the performance of its players."""
