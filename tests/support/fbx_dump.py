"""Convert an element tree to text, so that two FBX files can be compared line by line."""

from __future__ import annotations

import hashlib

import numpy as np

from app.formats.fbx.encode import Element, Property

_LONGEST_ARRAY = 16
_LONGEST_ENDS = 4


def text(root: Element) -> str:
    """Deterministic text of a decoded file.

    Parameters
    ----------
    root : Element
        As `app.formats.fbx.decode.read_elements` gives it; nameless roots print their children only.

    Returns
    -------
    str
        One line per record, indented; of long arrays the type, length, ends and a digest of all values.
    """
    lines: list[str] = []
    if root.name:
        _add(root, 0, lines)
    else:
        lines.append("version " + " ".join(_property(value) for value in root.properties))
        for child in root.children or ():
            _add(child, 0, lines)
    return "\n".join(lines) + "\n"


def _add(element: Element, depth: int, lines: list[str]) -> None:
    parts = [element.name + ":", *(_property(value) for value in element.properties)]
    if element.children is not None and not element.children:
        parts.append("{}")
    lines.append("  " * depth + " ".join(parts))
    for child in element.children or ():
        _add(child, depth + 1, lines)


def _property(value: Property) -> str:
    if isinstance(value, np.ndarray):
        head = f"{value.dtype.name}[{len(value)}]"
        if len(value) <= _LONGEST_ARRAY:
            return f"{head}({' '.join(_number(v) for v in value.tolist())})"
        ends = " ".join(_number(v) for v in value[:_LONGEST_ENDS].tolist())
        last = _number(value[-1].item())
        return f"{head}({ends} .. {last}; {hashlib.blake2b(value.tobytes(), digest_size=8).hexdigest()})"
    if isinstance(value, bytes):
        return "bytes:" + value.hex()
    if isinstance(value, str):
        return repr(value)
    if isinstance(value, bool | np.bool_):
        return "true" if value else "false"
    if isinstance(value, float | np.floating):
        return _number(float(value))
    if isinstance(value, np.integer):
        return f"{int(value)}{'' if value.dtype.itemsize == 4 else {2: 'h', 8: 'l'}[value.dtype.itemsize]}"
    raise TypeError(f"no text for {type(value).__name__}; decode the file first")


def _number(value: float | int | bool) -> str:
    return repr(value + 0.0) if isinstance(value, float) else str(value)
