"""An outfit for tests, made from the clothes of a bundled body."""

from __future__ import annotations

import json
import struct
from collections.abc import Collection, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

from app.rig.characters.character_library import bundled_characters
from app.rig.people import wardrobe as module
from app.rig.people.wardrobe import wardrobe

GARMENTS = ("shirt", "trousers", "shoes")
TITLE = {"en": "Test suit", "ja": "試験服"}


def write_outfit(
    path: Path, id: str = "test_suit", body: str = "man_adult", meshes: Collection[str] = GARMENTS, **facts: Any
) -> None:
    """Write the clothes of a bundled body as an outfit with the main colour for the shirt and the second colour for the
    trousers.
    """
    data = bundled_characters()[body].read_bytes()
    (length,) = struct.unpack_from("<I", data, 12)
    document, binary = json.loads(data[20 : 20 + length]), data[20 + length :]
    for node in document["nodes"]:
        if "mesh" in node and document["meshes"][node["mesh"]]["name"] not in meshes:
            del node["mesh"]
    told = {
        "id": id,
        "title": TITLE,
        "body": body,
        "parts": {name: name for name in meshes},
        "hides": list(meshes),
        "tints": {"shirt": "main", "trousers": "second"},
        **facts,
    }
    document["scenes"][0]["extras"] = {"suisou": {"outfit": told}}
    used = {document["meshes"][node["mesh"]]["name"] for node in document["nodes"] if "mesh" in node}
    for material in document["materials"] if used != {*GARMENTS} else ():
        # A file has the materials of its own garments alone.
        material["name"] = material["name"] if material["name"] in used else f"{material['name']}_unused"
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    size = 12 + 8 + len(text) + len(binary)
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(struct.pack("<4sIIII", b"glTF", 2, size, len(text), 0x4E4F534A) + text + binary)


@contextmanager
def wardrobe_in(folder: Path) -> Iterator[None]:
    """Use the wardrobe in a folder instead of the bundled one."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(module, "_folder", lambda: folder)
        wardrobe.cache_clear()
        try:
            yield
        finally:
            patch.undo()
            wardrobe.cache_clear()
