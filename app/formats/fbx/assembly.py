"""Objects of an FBX file with ids and connections, before encoding."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Final

import numpy as np

from app.formats.fbx.encode import Element, Property
from app.formats.scene import Material
from app.formats.texture_files import TextureFiles
from app.formats.textures import Texture, TextureUse

_FIRST_ID: Final = 1_000_000


@dataclass
class Assembly:
    """The objects and connections of an FBX file while it is built."""

    files: TextureFiles
    objects: list[Element] = field(default_factory=list)
    connections: list[Element] = field(default_factory=list)
    materials: dict[Material, int] = field(default_factory=dict)
    textures: dict[TextureUse, int] = field(default_factory=dict)
    videos: dict[Texture, int] = field(default_factory=dict)
    last_id: int = _FIRST_ID

    def new_id(self) -> int:
        """Return a new, unused object id."""
        self.last_id += 1
        return self.last_id

    def add(self, kind: str, name: str, class_name: str, sub_class: str, children: tuple[Element, ...]) -> int:
        """Add an FBX object with a name, its two class names and child records; return its new id."""
        new = self.new_id()
        self.objects.append(Element(kind, (np.int64(new), f"{name}\0\x01{class_name}", sub_class), children))
        return new

    def connect(self, child: int, parent: int, to_property: str | None = None) -> None:
        """Connect an object to another object, or to one of its properties."""
        ends: tuple[Property, ...] = (np.int64(child), np.int64(parent))
        if to_property is None:
            self.connections.append(Element("C", ("OO", *ends)))
        else:
            self.connections.append(Element("C", ("OP", *ends, to_property)))
