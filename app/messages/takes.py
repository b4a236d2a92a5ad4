"""Refusals of what is done with takes."""

from __future__ import annotations

from typing import Final

TEMPLATES: Final[dict[str, str]] = {
    "take.none": "There is no take {take} any more.",
    "take.too_many": "A project has room for {most} takes: delete some first.",
    "take.not_free": "{part} has notes already, so the tempo cannot follow one take. Quantise the take instead.",
    "take.too_few_notes": "The take has {count} {count:note|notes}; beats can be found from {least} on.",
    "take.no_beats": "No beat can be heard in this take.",
}
