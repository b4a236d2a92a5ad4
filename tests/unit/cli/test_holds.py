"""Fitting of grips, which may take minutes: it shows its progress, and Ctrl-C ends it."""

from __future__ import annotations

import io
import json
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import mido
import msgspec
import pytest

from app.cli import main
from app.cli.progress import find_holds
from app.cli.status import STOPPED
from app.identity_cache import IdentityCache
from app.performance import bodies, ensemble
from app.performance.body_problems import body_problems
from app.plan.parameters import PlayerParameters
from app.project.casting import StagePosition
from app.project.performers import Player
from app.rig.characters.character_library import character_named
from app.rig.grip.fitting.grip_files import hold_for
from app.rig.grip.grip_pose import GripPose
from app.rig.instrument import load_instrument
from app.steps import StepRuns
from instrument_maps.library import model_path
from instrument_maps.load import bundled_maps
from instrument_maps.model import InstrumentMap
from metadata.load import load_body
from tests.gui.conftest import quartet_project
from tests.support.bodies import playing
from tests.unit.cli.test_main import QUARTET


class Terminal(io.StringIO):
    """A terminal that records its output."""

    def isatty(self) -> bool:
        return True


TROMBONE = "trombone_tenor_F_attachment"


@pytest.mark.parametrize(
    ("command", "first"),
    [
        pytest.param(["export", str(QUARTET), "--to", "out", "--player", "Trombone 2"], TROMBONE, id="export"),
        pytest.param(["stream", str(QUARTET), "--player", "Trombone 2"], TROMBONE, id="stream"),
        # Reach is judged for all players.
        pytest.param(["inspect", str(QUARTET)], "trumpet_Bb", id="inspect"),
    ],
)
def test_the_search_shows_progress_and_ends_at_ctrl_c(
    command: list[str], first: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    searched: list[str] = []

    def stopped(character: Any, model: Any, instrument: Any, body: Any, reported: Callable[[float], None]) -> None:
        searched.append(instrument.id)
        reported(0.5)
        raise KeyboardInterrupt

    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(bodies, "hold_for", stopped)
    monkeypatch.setattr(bodies, "_HOLDS", IdentityCache(8))
    monkeypatch.setattr(ensemble, "is_held", lambda player, instrument: False)
    terminal = Terminal()
    monkeypatch.setattr(sys, "stderr", terminal)
    assert main(command) == STOPPED
    # For one player, no hold of another is searched for.
    assert searched == [first]
    assert "0 %  how the instruments are held" in terminal.getvalue()
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("stream", [io.StringIO(), Terminal()], ids=["file", "terminal"])
def test_without_a_terminal_a_line_names_each_grip_that_is_computed_and_none_that_is_stored(
    stream: io.StringIO, monkeypatch: pytest.MonkeyPatch
) -> None:
    stored: set[str] = {"Trumpet 2"}
    lines_before: dict[str, str] = {}

    def held(player: Player, instrument: InstrumentMap, progress: Callable[[float], None]) -> None:
        if player.name not in stored:
            for share in (0.0, 0.3, 0.6):
                progress(share)
        lines_before[player.name] = stream.getvalue()

    performance = ensemble.Performance(quartet_project())
    monkeypatch.setattr(ensemble, "is_held", lambda player, instrument: player.name == "Trombone 2")
    monkeypatch.setattr(ensemble, "hold_now", held)
    monkeypatch.setattr(sys, "stderr", stream)
    find_holds(performance, performance.project.players)
    assert [*lines_before] == ["Trumpet 1", "Trumpet 2", "Trombone 1"]
    if stream.isatty():
        assert "\n" not in stream.getvalue()
        return
    lines = stream.getvalue().splitlines()
    assert [(line.split(" (")[0].rpartition("how ")[2], line.partition("; ")[0][-6:]) for line in lines] == [
        ("Trumpet 1", "1 of 3"),
        ("Trombone 1", "3 of 3"),
    ]
    assert lines_before["Trumpet 1"].count("\n") == 1, "said while it is being computed"


def off_by_20_mm(character: Any, model: Any, instrument: Any, body: Any, progress: Any) -> GripPose:
    """Stored grip of the instrument whose first mandatory touch is off by 20 mm."""
    ours = bundled_maps()[instrument.id]
    hold = hold_for(character_named("man_adult"), load_instrument(model_path(ours), ours), ours, load_body())
    hand = hold.hands[0]
    firm = next(number for number, one in enumerate(hand.contacts) if one.firm)
    touches = tuple(
        replace(one, distance_m=0.02) if number == firm else one for number, one in enumerate(hand.contacts)
    )
    return replace(hold, hands=(replace(hand, contacts=touches), *hold.hands[1:]))


@pytest.fixture
def _missing(monkeypatch: pytest.MonkeyPatch) -> None:
    """Make all grips unknown, and each fitted one miss a touch."""
    monkeypatch.setattr(bodies, "hold_for", off_by_20_mm)
    monkeypatch.setattr(bodies, "_HOLDS", IdentityCache(8))
    monkeypatch.setattr(bodies, "_HELD", set())


@pytest.mark.usefixtures("_missing")
def test_what_the_hold_of_a_users_own_character_misses_is_reported(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Every command that writes no files reports it, fitting the grip first."""
    track = mido.MidiTrack([mido.MetaMessage("track_name", name="x")])
    track += [mido.Message("note_on", note=64, velocity=80), mido.Message("note_off", note=64, time=240)]
    path = tmp_path / "x.mid"
    mido.MidiFile(tracks=[track]).save(path)
    settings = ["--assign", "x=trumpet_Bb", "--set", "x.character=child", "--preroll", "1"]
    with playing():
        assert main(["inspect", str(path), "--json", "--fps", "12", *settings]) == 0
        inspected = json.loads(capsys.readouterr().out)["warnings"]
        assert main(["stream", str(path), "--fps", "10", "--from", "0.1", *settings]) == 0
        streamed = capsys.readouterr().err
    (line,) = [line for line in inspected if "not reach this instrument" in line]
    assert "misses by 20.0 mm" in line
    assert line in streamed


@pytest.mark.usefixtures("_missing")
def test_what_our_own_body_misses_on_a_users_own_instrument_is_reported() -> None:
    ours = bundled_maps()["trumpet_Bb"]
    own = msgspec.structs.replace(ours)
    player = Player("p", "P", "1", own.id, "man_adult", PlayerParameters(), StagePosition(0.0, 0.0, 0.0))

    def lacking(instrument: InstrumentMap) -> list[str]:
        bodies.hold_now(player, instrument)
        found = body_problems(player, instrument, (), waiting=False, runs=StepRuns())
        return [message.id for message in found.lacking]

    assert lacking(own) == ["character.touches_missed"]
    # Holds of ours on ours are known to meet all.
    assert lacking(ours) == []
