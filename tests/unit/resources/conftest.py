"""Imports modules of the scripts that build characters, by the bare names that the scripts use."""

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
