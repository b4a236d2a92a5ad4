"""Pictures of the players: why there is none."""

from __future__ import annotations

from typing import Final

TEMPLATES: Final[dict[str, str]] = {
    "picture.no_gl": "the players cannot be drawn here, because there is no usable OpenGL 2 ({reason})",
    "picture.loading": "the players are still being loaded; try again in a moment",
}
