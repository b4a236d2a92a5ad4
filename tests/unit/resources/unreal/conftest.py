"""The plug-in in a fake Unreal editor with an open project."""

from __future__ import annotations

import importlib
import shutil
import sys
from collections.abc import Callable, Iterator
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest

from app.export.request import ExportRequest
from app.export.unreal.project import UnrealProject, find_project
from app.export.unreal.run import export_into
from app.messages import text
from app.performance.ensemble import Performance
from app.performance.span import bars_span
from app.project.model import Project
from tests.support.fake_unreal import Studio, fake_unreal
from tests.support.phrases import know_phrases
from tests.unit.export.unreal.conftest import planned_quartet, quartet

PYTHON = Path(__file__).parents[4] / "resources" / "unreal" / "Suisou" / "Content" / "Python"


class Editor:
    """A fake editor with an open project; menu items are chosen by their text."""

    def __init__(self, folder: Path, language: str = "en") -> None:
        self.folder = folder
        self.unreal = fake_unreal(folder, language)
        self.studio: Studio = self.unreal.studio
        self.start()

    def start(self) -> None:
        """Start the editor, which runs its startup script."""
        for name in [name for name in sys.modules if name.split(".")[0] in ("suisou_import", "init_unreal")]:
            del sys.modules[name]
        sys.modules["unreal"] = self.unreal
        importlib.import_module("init_unreal")

    def choose(self, label: str) -> str:
        """Choose an item of the menu and return the last dialog."""
        shown = len(self.studio.dialogs)
        exec(self.studio.commands[label], {})
        assert len(self.studio.dialogs) > shown, "nothing was said"
        assert not self.studio.errors, self.studio.errors
        return self.studio.dialogs[-1]

    def import_performance(self) -> str:
        return self.choose("Import Performance")

    def update_performance(self) -> str:
        return self.choose("Update Performance")

    def pieces(self) -> set[str]:
        """Folders of the imported pieces, without the shared folder of textures."""
        return {path.split("/")[3] for path in self.studio.assets} - {"Textures"}

    def sequence(self, piece: str = "quartet") -> Any:
        return self.studio.assets[f"/Game/Suisou/{piece}/LS_{piece}"]


@pytest.fixture(autouse=True)
def _phrases_known(monkeypatch: pytest.MonkeyPatch) -> None:
    know_phrases(monkeypatch)


@pytest.fixture
def plugin(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Put the plug-in's folder on the path, and remove it and its modules afterwards."""
    monkeypatch.syspath_prepend(str(PYTHON))
    monkeypatch.setattr(sys, "dont_write_bytecode", True)
    yield
    for name in [name for name in sys.modules if name.split(".")[0] in ("suisou_import", "init_unreal", "unreal")]:
        del sys.modules[name]


def exported(
    folder: Path,
    project: Project,
    players: tuple[str, ...] = ("Trumpet 1", "Trombone 1"),
    last_bar: int = 1,
    fps: Fraction = Fraction(12),
    source: str = "quartet.mid",
    **options: Any,
) -> UnrealProject:
    """Export into a new Unreal project in a folder; ``options`` are additional options of the request."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "Game.uproject").write_text('{"FileVersion": 3, "EngineAssociation": "5.6"}')
    unreal = find_project(folder)
    performance = Performance(project, planned_quartet())
    request = ExportRequest(
        performance=performance,
        players=tuple(player for player in project.players if player.name in players),
        folder=folder,
        formats=frozenset(),
        span=bars_span(performance, fps, (1, last_bar), 0.0),
        bars=(1, last_bar),
        source=source,
        creator="Suisou test",
        dancers=tuple(dancer for dancer in project.dancers if dancer.name in players),
        **options,
    )
    export_into(request, unreal, text)
    return unreal


@pytest.fixture(scope="session")
def quartet_folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Project with all four players of the example, two bars."""
    folder = tmp_path_factory.mktemp("exported") / "Game"
    exported(folder, quartet(), ("Trumpet 1", "Trumpet 2", "Trombone 1", "Trombone 2"), last_bar=2)
    return folder


Open = Callable[[], Editor]


@pytest.fixture
def editor(plugin: None, quartet_folder: Path, tmp_path: Path) -> Editor:
    """Editor with the quartet exported into its project."""
    shutil.copytree(quartet_folder, tmp_path / "Game")
    return Editor(tmp_path / "Game")
