"""Mapping from the morphs of a figure's file to the 52 ARKit shapes used by the program.

Names come from tables in ``metadata/faces``. The table that produces most shapes is used, and others fill its gaps.
Shapes in no table are reported as missing.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Final
from weakref import WeakKeyDictionary

from app.errors import FileError
from app.rig.figure import Figure
from metadata.known_names import FaceNames, morph_key
from metadata.load import load_face_names
from metadata.model import ARKIT_MORPHS

SHAPES: Final = frozenset(ARKIT_MORPHS)
LEAST_ALIKE: Final = 2
"""Least number of known names with the same prefix and suffix for these to be removed."""
SHORTEST_AFFIXED: Final = 4
"""Names shorter than this number of characters must match exactly."""


@dataclass(frozen=True)
class FaceMapping:
    """Mapping from a figure's own morphs to ARKit shapes.

    Attributes
    ----------
    profile : str
        Id of the table that produces most shapes; empty if none produces any.
    morphs : mapping of str to mapping of str to float
        Weights of the figure's morphs by ARKit shape.
    missing : tuple of str
        Shapes that the face lacks.
    """

    profile: str
    morphs: Mapping[str, Mapping[str, float]]
    missing: tuple[str, ...]


def map_morphs(figure: Figure, requested: Mapping[str, Mapping[str, float]] | None = None) -> FaceMapping:
    """Return the morphs that produce the ARKit shapes of a figure's face.

    Parameters
    ----------
    requested : mapping of str to mapping of str to float
        The user's corrections: weights of morphs by shape; empty if the face lacks the shape.

    Raises
    ------
    FileError
        A correction refers to an unknown shape or morph.
    """
    found = _found(figure)
    order = sorted(found, key=lambda name: (-len(found[name]), name))
    morphs: dict[str, Mapping[str, float]] = {}
    for name in order:
        for shape, weights in found[name].items():
            morphs.setdefault(shape, weights)
    for shape, own in (requested or {}).items():
        _check(figure, shape, own)
        morphs.pop(shape, None)
        if own:
            morphs[shape] = dict(own)
    return FaceMapping(
        profile=order[0] if order and found[order[0]] else "",
        morphs={shape: morphs[shape] for shape in ARKIT_MORPHS if shape in morphs},
        missing=tuple(shape for shape in ARKIT_MORPHS if shape not in morphs),
    )


_kept: WeakKeyDictionary[Figure, dict[str, dict[str, dict[str, float]]]] = WeakKeyDictionary()


def _found(figure: Figure) -> dict[str, dict[str, dict[str, float]]]:
    """Return the mapping of a figure's morphs by each table of face names, cached, since every correction needs it."""
    known = _kept.get(figure)
    if known is None:
        known = _kept[figure] = {name: _shapes(figure, table) for name, table in load_face_names().items()}
    return known


def _check(figure: Figure, shape: str, own: Mapping[str, float]) -> None:
    if shape not in SHAPES:
        raise FileError("figure.no_shape", file=figure.file, shape=shape)
    for morph in own:
        if morph not in figure.morph_names:
            raise FileError("figure.no_morph", file=figure.file, shape=shape, morph=morph)


def _shapes(figure: Figure, table: FaceNames) -> dict[str, dict[str, float]]:
    """Return the figure's morphs for each ARKit shape, with weights, by one table of morph names."""
    ways = {shape: table.ways(shape) for shape in table.morphs}
    known = {name for own in ways.values() for way in own for name in way}
    if table.of == "expressions":
        holders = {morph_key(name): dict(weights) for name, weights in figure.expressions.items() if weights}
    else:
        # Several morphs may form one expression: those of eyes and lashes contain the name of their mesh.
        holders = {
            name: dict.fromkeys(morphs, 1.0) for name, morphs in _named(figure.morph_names, known).items() if morphs
        }
    eyes = [name for name in holders if table.of == "expressions" and name.startswith(("blink", "look"))]
    of_eyes = {morph for name in eyes for morph in holders[name]}
    made = {}
    for shape, own in ways.items():
        way = next((way for way in own if all(name in holders for name in way)), None)
        if way is not None:
            weights: dict[str, float] = defaultdict(float)
            for name, weight in way.items():
                for morph, share in holders[name].items():
                    # A smile of the whole face moves lids and gaze too, which have shapes of their own.
                    if not (shape.startswith("mouth") and morph in of_eyes):
                        weights[morph] += weight * share
            made[shape] = dict(weights)
    return made


def _named(morphs: Iterable[str], known: set[str]) -> dict[str, list[str]]:
    """Return the figure's morphs for each known name (such as those of ARKit), regardless of a prefix or suffix that
    all morphs share."""
    keys = {morph: morph_key(morph) for morph in morphs}
    affixes: dict[tuple[str, str], set[str]] = defaultdict(set)
    for key in keys.values():
        for name in known:
            at = key.rfind(name) if len(name) >= SHORTEST_AFFIXED or name == key else -1
            if at >= 0:
                affixes[key[:at], key[at + len(name) :]].add(name)
    if not affixes:
        return {}
    # The prefix may differ between meshes; the suffix is chosen by the exporter, and the remaining morphs are
    # correctives.
    _, after = min(affixes, key=lambda affix: (-len(affixes[affix]), len(affix[0] + affix[1]), affix))
    before = {start for start, end in affixes if end == after and len(affixes[start, end]) >= LEAST_ALIKE}
    found: dict[str, list[str]] = defaultdict(list)
    for morph, key in keys.items():
        inner = [key[len(start) : len(key) - len(after)] for start in before if key.startswith(start)]
        named = [name for name in inner if name in known] if key.endswith(after) else []
        # The longest name that fits is meant: "eye blink" rather than "blink".
        name = key if key in known else max(named, key=lambda name: (len(name), name), default="")
        if name:
            found[name].append(morph)
    return found
