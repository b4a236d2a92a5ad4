"""Instrument maps: one TOML table per instrument, with loader and validator."""
