"""Steps receive values of their declared types, which the type checker cannot verify through tables of names."""

from __future__ import annotations

import collections.abc
import inspect
from functools import partial
from types import NoneType, UnionType
from typing import Any, Self, Union, get_args, get_origin, get_type_hints

import pytest

from app.motion.faces import face_curves, gaze
from app.motion.fingering import fingers
from app.motion.gestures import layers
from app.performance import body_problems, ensemble_steps
from app.plan import generate, player
from app.steps import StepTable

TABLES = {
    "plan": player.PLAYER,
    "among others": player.AMONG_OTHERS,
    "line": generate.LINE,
    "shared line": generate.SHARED_LINE,
    "ensemble": generate.ENSEMBLE,
    "whole": ensemble_steps.WHOLE,
    "played": ensemble_steps.PLAYED,
    "line of a player": ensemble_steps.LINE,
    "held": ensemble_steps.HELD,
    "reach": body_problems.REACH,
    "face": face_curves.FACE,
    "layers": layers.LAYERS,
    "gaze": gaze.GAZE,
    "fingers": fingers.FINGERS,
}
ABSTRACT = (collections.abc.Sequence, collections.abc.Mapping, collections.abc.Collection, collections.abc.Iterable)


def hints(function: Any) -> dict[str, Any]:
    """Types of the parameters and of the result of a function or class."""
    if isinstance(function, partial):
        return hints(function.func)
    if inspect.isclass(function):
        return {**get_type_hints(function), "return": function}
    found = get_type_hints(function)
    return found | {"return": function.__self__} if found.get("return") is Self else found


def made_by(table: StepTable, name: str) -> Any:
    """Type of a step's result; None for an input."""
    if name in table.paths:
        base, *attributes = table.paths[name].split(".")
        found = made_by(table, base)
        for attribute in attributes:
            if found is None:
                return None
            holder = get_origin(found) or found
            declared = get_type_hints(holder).get(attribute)
            if declared is None:
                declared = hints(inspect.getattr_static(holder, attribute).func)["return"]
            found = declared[get_args(found)] if getattr(declared, "__parameters__", ()) else declared
        return found
    return hints(table.functions[name])["return"] if name in table.functions else None


def fits(made: Any, read: Any) -> bool:
    """Return whether a value of one type may be used as another."""
    if read is Any or read is object or made == read or isinstance(read, type(Any)) or "~" in str(read) + str(made):
        return True
    if get_origin(read) in (Union, UnionType):
        made_of = get_args(made) if get_origin(made) in (Union, UnionType) else (made,)
        return all(any(fits(one, other) for other in get_args(read)) for one in made_of)
    if get_origin(made) in (Union, UnionType):
        return all(fits(one, read) for one in get_args(made))
    whole, other = get_origin(made) or made, get_origin(read) or read
    if not (inspect.isclass(whole) and inspect.isclass(other) and issubclass(whole, other)):
        return False
    mine = [one for one in get_args(made) if one is not Ellipsis]
    theirs = [one for one in get_args(read) if one is not Ellipsis]
    return not theirs or not mine or all(fits(one, two) for one, two in zip(mine, theirs, strict=False))


@pytest.mark.parametrize("name", TABLES)
def test_steps_read_what_other_steps_make(name: str) -> None:
    table, checked = TABLES[name], 0
    for step, reads in table.reads.items():
        declared = hints(table.functions[step])
        for parameter, read in zip(table.parameters[step], reads, strict=True):
            for one in (read,) if isinstance(read, str) else read:
                made = made_by(table, one)
                wanted = declared[parameter] if isinstance(read, str) else get_args(declared[parameter])[0]
                if made is not None:
                    assert fits(made, wanted), (step, parameter, one, made, wanted)
                    checked += 1
    assert checked or not any(read in table.functions for reads in table.reads.values() for read in reads)


def test_a_wrong_type_is_found() -> None:
    def numbers(text: str) -> tuple[int, ...]:
        return tuple(map(ord, text))

    def joined(numbers: tuple[str, ...]) -> str:
        return "".join(numbers)

    assert not fits(hints(numbers)["return"], hints(joined)["numbers"])
    assert fits(tuple[int, ...], collections.abc.Sequence[int])
    assert not fits(NoneType, int)
