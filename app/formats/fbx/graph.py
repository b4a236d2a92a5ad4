"""Objects and connections of a decoded FBX file, with checked access."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeVar

import numpy as np
import numpy.typing as npt

from app.arrays import AnyFloatArray, FloatArray, IntArray
from app.errors import FileError
from app.formats.fbx.encode import Element, Property

T = TypeVar("T")


@dataclass(frozen=True)
class FbxObject:
    """An object of an FBX file: kind, name and record."""

    id: int
    kind: str
    name: str
    sub_class: str
    element: Element


class ObjectGraph:
    """Objects of an FBX file by id, and their connections."""

    def __init__(self, root: Element, file: str) -> None:
        self.file = file
        self.objects: dict[int, FbxObject] = {}
        self.children: dict[int, list[tuple[int, str]]] = {}
        self.parents: dict[int, list[tuple[int, str]]] = {}
        for element in self.section(root, "Objects").children or ():
            number, name, sub_class = (*element.properties, None, None, None)[:3]
            if not isinstance(number, np.int64) or not isinstance(name, str) or not isinstance(sub_class, str):
                raise FileError("fbx.missing", file=file, what=f"id or name of a {element.name}")
            key = int(number)
            self.objects[key] = FbxObject(key, element.name, name.split("\0")[0], sub_class, element)
        for element in self.section(root, "Connections").children or ():
            _, child, parent, target = (*element.properties, None, None, None, None)[:4]
            if not isinstance(child, np.int64) or not isinstance(parent, np.int64):
                raise FileError("fbx.missing", file=file, what="end of a connection")
            to_property = target if isinstance(target, str) else ""
            self.children.setdefault(int(parent), []).append((int(child), to_property))
            self.parents.setdefault(int(child), []).append((int(parent), to_property))

    def section(self, root: Element, name: str) -> Element:
        """Return the child record with a name. Raises FileError if it is missing."""
        found = root.child(name)
        if found is None:
            raise FileError("fbx.missing", file=self.file, what=name)
        return found

    def of_kind(self, kind: str, sub_class: str) -> list[FbxObject]:
        """Return the objects of a kind and class, in file order."""
        return [o for o in self.objects.values() if o.kind == kind and o.sub_class == sub_class]

    def below(self, parent: FbxObject, kind: str, sub_class: str | None = None) -> list[FbxObject]:
        """Return the objects of a kind that are connected to ``parent``, in file order."""
        linked = (self.objects.get(child) for child, _ in self.children.get(parent.id, ()))
        return [o for o in linked if o is not None and o.kind == kind and sub_class in (None, o.sub_class)]

    def _array(self, element: Element, name: str, kind: str) -> npt.NDArray[np.generic]:
        child = element.child(name)
        values = child.properties[0] if child is not None and child.properties else None
        if not isinstance(values, np.ndarray) or values.dtype.kind != kind:
            raise FileError("fbx.missing", file=self.file, what=f"{name} of a {element.name}")
        return values

    def floats(self, element: Element, name: str, width: int) -> FloatArray:
        """Return the float array ``name`` below an FBX record as rows (N, width); read-only."""
        return self.stored(element, name, width).astype(np.float64, copy=False)

    def stored(self, element: Element, name: str, width: int) -> AnyFloatArray:
        """Return the numbers ``name`` below an FBX record as rows (N, width), in the precision of the file. Raises
        FileError for incomplete rows."""
        values: AnyFloatArray = self._array(element, name, "f")  # type: ignore[assignment]
        if len(values) % width or not np.isfinite(values).all():
            raise FileError("fbx.contradiction", file=self.file, detail=f"{name} is not made of finite {width}s")
        return values.reshape(-1, width)

    def integers(self, element: Element, name: str) -> IntArray:
        """Return the integer array ``name`` below an FBX record, shape (N,); read-only."""
        return self._array(element, name, "i").astype(np.int64, copy=False)

    def matrix(self, element: Element, name: str) -> FloatArray:
        """Return the sixteen numbers ``name`` below an FBX record as a matrix (4, 4) for column vectors. Raises
        FileError for another count."""
        values = self.floats(element, name, 16)
        if len(values) != 1:
            raise FileError("fbx.contradiction", file=self.file, detail=f"{name} is not a matrix")
        return values.reshape(4, 4).T

    def only(self, element: Element, kind: type[T]) -> T:
        """Return the only property of a record. Raises FileError if it is missing or of another type."""
        if len(element.properties) != 1 or not isinstance(element.properties[0], kind):
            raise FileError("fbx.missing", file=self.file, what=f"value of {element.name}")
        return element.properties[0]


def properties_of(element: Element) -> dict[str, tuple[Property, ...]]:
    """Return the values of an FBX record's "Properties70" block, by the name of the property."""
    block = element.child("Properties70")
    rows = [row.properties for row in (block.children or () if block is not None else ())]
    return {row[0]: row[4:] for row in rows if len(row) >= 4 and isinstance(row[0], str)}


def numbers(values: tuple[Property, ...]) -> list[float]:
    """Return the numbers among the values of a property."""
    return [float(value) for value in values if isinstance(value, float | np.integer | np.floating)]
