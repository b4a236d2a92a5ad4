"""An Unreal project to export into, and a short export."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from functools import cache
from pathlib import Path

import msgspec
import pytest

from app.choreography.model_file import write_model
from app.export.request import ExportRequest
from app.export.unreal.project import UnrealProject, find_project
from app.export.unreal.run import UnrealExport, export_into
from app.messages import text
from app.performance.ensemble import Performance
from app.performance.span import bars_span
from app.project.casting import StagePosition
from app.project.model import Project, map_choices, project_from_score
from app.project.performers import Dancer
from app.project.recording import AudioTrack
from app.score.read import read_midi
from instrument_maps.library import all_maps
from tests.support.dances import model
from tests.support.phrases import know_phrases

QUARTET = Path(__file__).parents[4] / "resources" / "examples" / "quartet.mid"


@pytest.fixture(autouse=True)
def _phrases_known(monkeypatch: pytest.MonkeyPatch) -> None:
    know_phrases(monkeypatch)


@cache
def quartet() -> Project:
    """The bundled quartet, read once; values never change."""
    maps = all_maps()
    return project_from_score(read_midi(QUARTET, maps=map_choices(maps.values())), maps)


@cache
def planned_quartet() -> Performance:
    performance = Performance(quartet())
    performance.prepare()
    return performance


def request_of(
    project: Project, players: tuple[str, ...] = ("Trumpet 1",), source: str = "quartet.mid", last_bar: int = 1
) -> ExportRequest:
    # Plans shared with the quartet are reused, as in an editor that played it before.
    performance = Performance(project, planned_quartet())
    chosen = tuple(player for player in project.players if player.name in players)
    dancers = tuple(dancer for dancer in project.dancers if dancer.name in players)
    assert len(chosen) + len(dancers) == len(players)
    return ExportRequest(
        performance=performance,
        players=chosen,
        folder=Path("nowhere"),
        formats=frozenset(),
        span=bars_span(performance, Fraction(12), (1, last_bar), 0.0),
        bars=(1, last_bar),
        source=source,
        creator="Suisou test",
        dancers=dancers,
    )


def with_dancers(project: Project, folder: Path, *names: str) -> Project:
    """Project with dancers of these names; their choreography is written into a folder."""
    path = folder / "steps.choreography"
    if not path.exists():
        write_model(path, model())
    dancers = tuple(
        Dancer(f"dancer:{number}", name, str(path), "woman_adult", StagePosition(number - 1.5, 2.0, 0.5), seed=number)
        for number, name in enumerate(names, 1)
    )
    return replace(project, dancers=dancers)


def renamed(project: Project, names: list[str]) -> Project:
    players = zip(project.players, names, strict=True)
    return replace(project, players=tuple(msgspec.structs.replace(player, name=name) for player, name in players))


def with_recording(project: Project, path: Path, offset_s: float) -> Project:
    return replace(project, audio=AudioTrack(str(path), offset_s))


def artists_project(folder: Path) -> UnrealProject:
    """Unreal project with an artist's file in every folder that an export writes to."""
    files = {
        "Game.uproject": json.dumps({"FileVersion": 3, "EngineAssociation": "5.6"}),
        "Content/Suisou/quartet/BP_Mine.uasset": "mine",
        "Plugins/Other/Other.uplugin": "{}",
        "SuisouSource/notes.txt": "mine",
        "SuisouSource/quartet/Audio/mine.wav": "mine",
    }
    for name, content in files.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(content)
    return find_project(folder)


@pytest.fixture
def unreal(tmp_path: Path) -> UnrealProject:
    """Unreal project with an artist's file in every folder that an export writes to."""
    return artists_project(tmp_path / "Game")


@pytest.fixture(scope="session")
def exported_files(tmp_path_factory: pytest.TempPathFactory) -> dict[str, bytes]:
    """All files of such a project after the first player was exported into it."""
    unreal = artists_project(tmp_path_factory.mktemp("exported_unreal") / "Game")
    export_into(request_of(quartet()), unreal, text)
    return tree_of(unreal.folder)


@pytest.fixture
def exported(unreal: UnrealProject, exported_files: dict[str, bytes]) -> UnrealProject:
    """Such a project after the first player was exported into it."""
    for name, data in exported_files.items():
        (unreal.folder / name).parent.mkdir(parents=True, exist_ok=True)
        (unreal.folder / name).write_bytes(data)
    return unreal


Export = Callable[[ExportRequest], UnrealExport]


@pytest.fixture
def export(unreal: UnrealProject) -> Export:
    return lambda request: export_into(request, unreal, text)


def tree_of(folder: Path) -> dict[str, bytes]:
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in folder.rglob("*") if path.is_file()}
