"""The skeleton that files are written on."""

from __future__ import annotations

from typing import Final

TEMPLATES: Final[dict[str, str]] = {
    "skeleton.root_added": "{file} has several root bones ({bones}); Unreal takes only one, so the bone {root} was put "
    "above them",
}
"""Message id -> English template."""
