"""Names of edits, as the undo list shows them."""

from __future__ import annotations

from typing import Final

TEMPLATES: Final[dict[str, str]] = {}
