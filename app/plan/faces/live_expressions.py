"""Expressions from rules for live playing: by pitch, loudness and effort of the current note alone, since its length
and what follows are unknown.
"""

from __future__ import annotations

from collections.abc import Collection

import numpy as np

from app.arrays import FloatArray
from app.plan.rule_conditions import Facts, growth_of, matches
from instrument_maps.model import InstrumentMap
from metadata.rules import Rule, When

_KNOWN = frozenset({"loudness_above", "loudness_below", "semitones_above_easy", "semitones_below_easy", "effort_above"})
_GROWN = frozenset({"loudness", "height", "depth", "effort"})


def live_rules(rules: tuple[Rule, ...], expressions: Collection[str]) -> tuple[Rule, ...]:
    """Select the rules that can be applied in live playing and whose expression exists."""
    never = When()

    def follows(rule: Rule) -> bool:
        asked = {name for name in When.__struct_fields__ if getattr(rule.when, name) != getattr(never, name)}
        known = rule.do.expression in expressions and asked <= _KNOWN
        return rule.enabled and known and _GROWN.issuperset(rule.do.growth)

    return tuple(rule for rule in rules if follows(rule))


def faces_now(
    rules: tuple[Rule, ...], pitch: FloatArray, loudness: FloatArray, effort: FloatArray, instrument: InstrumentMap
) -> dict[str, float]:
    """Return the strength of each expression for the note played live at present; arrays have shape (1,)."""
    nothing = np.zeros(1)
    facts = Facts(
        loudness=loudness,
        pitch=pitch,
        lasts_s=nothing,
        rest_s=nothing,
        rest_after_s=nothing,
        above_easy=pitch - instrument.range.easy_high,
        below_easy=instrument.range.easy_low - pitch,
        accents=nothing,
        leap=nothing,
        played_s=nothing,
        effort=effort,
        places={},
    )
    shown: dict[str, float] = {}
    for rule in rules:
        puff = instrument.embouchure.puff if rule.do.scaled_by == "puff" else 1.0
        size = float(rule.do.strength * puff * growth_of(rule, facts)[0]) if matches(rule.when, facts)[0] else 0.0
        shown[rule.do.expression] = max(shown.get(rule.do.expression, 0.0), size)
    return shown
