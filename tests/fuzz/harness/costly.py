"""Small files with a high cost by kind of reader: the worst of each known cause."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from typing import Final

from tests.fuzz.harness.costly_files import COSTLY_FILES
from tests.fuzz.harness.costly_media import COSTLY_MEDIA
from tests.fuzz.harness.costly_midi import COSTLY, STUCK
from tests.fuzz.harness.costly_motion import COSTLY_MOTION
from tests.fuzz.harness.costly_projects import COSTLY_DANCES, COSTLY_METADATA, COSTLY_PROJECTS
from tests.fuzz.harness.own_files import COSTLY_OWN
from tests.fuzz.harness.scores import COSTLY_SCORES

Make = Callable[[int], bytes]
"""Function from a size in bytes to a file of about this size."""


def _named(ways: Mapping[str, tuple[Make, ...]]) -> dict[str, dict[str, Make]]:
    return {kind: {make.__name__: make for make in makes} for kind, makes in ways.items()}


ALL_COSTLY: Final[Mapping[str, Mapping[str, Make]]] = {
    "midi": COSTLY,
    "inspected": {**COSTLY, **STUCK},
    "performed": COSTLY_PROJECTS,
    "danced": COSTLY_DANCES,
    "piece_metadata": COSTLY_METADATA,
    "notation": {make.__name__: make for make in COSTLY_SCORES},
    **_named(COSTLY_FILES),
    **_named(COSTLY_MEDIA),
    **_named(COSTLY_MOTION),
    **_named(COSTLY_OWN),
}
"""Functions that make costly files, by kind of file (`tests.fuzz.harness.readers.KINDS`) and by cause of the cost."""


def costly(kind: str, size: int = 10_000) -> dict[str, Callable[[], bytes]]:
    """Files of a kind by the cause of their cost."""
    return {name: partial(make, size) for name, make in ALL_COSTLY[kind].items()}
