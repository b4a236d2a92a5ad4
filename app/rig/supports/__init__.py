"""Straps that carry instruments, and the chair of a seated player: their shapes, their motion, and their fitting."""
