"""Values of parameters according to their declarations, so that new parameters are included in all tests
that use them.
"""

from __future__ import annotations

from typing import Any

from hypothesis import strategies as st

from app.plan.parameters import Parameter

CHOREOGRAPHIES = ("", "salsa", "/dances/tango.choreography")
NAMES = {
    "choreography": CHOREOGRAPHIES,
    "style": ("section_player", "reserved", "jazz"),
    "habits": ("", "swayer", "statue,tapper"),
    "layers_off": ("", "gaze", "breath_motion,sway"),
}
"""Example values of the parameters that are names."""


def values(parameter: Parameter) -> st.SearchStrategy[Any]:
    """Any valid value of a parameter."""
    if parameter.choices:
        return st.sampled_from([value for value, _ in parameter.choices])
    if parameter.bounds is None:
        return st.sampled_from(NAMES[parameter.name])
    return st.integers(*map(int, parameter.bounds)) if parameter.kind is int else st.floats(*parameter.bounds)


def others(parameter: Parameter, now: object) -> list[Any]:
    """Values far from the present one: other choices, or the ends of the usual range."""
    if parameter.choices:
        found = [value for value, _ in parameter.choices]
    elif parameter.bounds is None:
        found = list(NAMES[parameter.name] if parameter.name != "choreography" else CHOREOGRAPHIES[:2])
    else:
        low, high = parameter.bounds
        found = [parameter.kind(low), parameter.kind(min(high if parameter.usual is None else parameter.usual, 1000))]
    return [value for value in found if value != now]
