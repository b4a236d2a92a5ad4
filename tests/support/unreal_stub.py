"""The part of ``unreal-stub`` (PyPI), written from Unreal Engine 5.6's own reflection, that the plug-in uses.

The whole is 26 MB, and one of its lines is no Python. Classes are cut out as text: those asked for and their bases.
"""

from __future__ import annotations

import os
import re
from functools import cache
from pathlib import Path

FOLDER = os.environ.get("SUISOU_FOREIGN_PACKAGES", "")
FILE = Path(FOLDER) / "unreal" / "unreal.py"
_CLASS = re.compile(r"^class (\w+)\((.*?)\):", re.MULTILINE)
_ANY = re.compile(r"(def get_editor_property\(.*?\)) -> object:")
_PROPERTY = re.compile(r"^    - ``(\w+)`` \((.*?)\): +\[(Read-Only|Read-Write)\]", re.MULTILINE)


@cache
def _blocks() -> dict[str, tuple[str, str]]:
    """Text and name of the base of every class."""
    text = FILE.read_text(encoding="utf-8-sig")
    found = list(_CLASS.finditer(text))
    ends = [match.start() for match in found[1:]] + [text.index("\ndef log(")]
    return {match[1]: (text[match.start() : end], match[2]) for match, end in zip(found, ends, strict=True)}


@cache
def _head_and_functions() -> tuple[str, str]:
    text = FILE.read_text(encoding="utf-8-sig")
    return text[: text.index("class ")], text[text.index("\ndef log(") :]


def excerpt(names: set[str]) -> str:
    """Source of some classes, their bases, and all functions of the module."""
    blocks, chosen = _blocks(), set[str]()
    for name in names:
        while name in blocks and name not in chosen:
            chosen.add(name)
            name = blocks[name][1]
    head, functions = _head_and_functions()
    classes = "".join(text for name, (text, _) in blocks.items() if name in chosen)
    classes = _ANY.sub(r"\1 -> Any:", classes)
    # The engine accepts Python's strings for both types, and a property has the type given in its documentation.
    return "\n".join([head, "Name = Text = str", classes, functions])


def documented_properties(name: str) -> dict[str, str]:
    """Type of every writable editor property of a class according to its documentation."""
    text, _ = _blocks()[name]
    return {prop: kind for prop, kind, access in _PROPERTY.findall(text) if access == "Read-Write"}
