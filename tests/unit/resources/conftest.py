"""Modules of the scripts that build characters, imported by their bare names as in the Python that runs them."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from importlib import import_module
from pathlib import Path
from types import ModuleType

import pytest

BUILD = Path(__file__).parents[3] / "resources" / "build"


@pytest.fixture(scope="module")
def build_module() -> Iterator[Callable[[str], ModuleType]]:
    """Import one of the modules, such as `character_skin`."""
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(str(BUILD))
        yield import_module
