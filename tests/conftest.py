"""What holds for every test."""

from __future__ import annotations

from hypothesis import settings

# Machines are noisy: how long an example took says nothing. Speed is measured in tests/bench, as ratios.
settings.register_profile("suisou", deadline=None)
settings.load_profile("suisou")
