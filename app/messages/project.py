"""Projects: files, recovery, re-import."""

from __future__ import annotations

from typing import Final

TEMPLATES: Final[dict[str, str]] = {}
