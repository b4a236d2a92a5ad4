"""``suisou stream``: a piece in real time, sent to a listening program."""

from __future__ import annotations

import re
import statistics
from dataclasses import replace
from fractions import Fraction
from importlib.resources import as_file, files
from pathlib import Path

import msgspec
import numpy as np
import pytest

from app.choreography.performed.dancers import dancing_of
from app.cli import main
from app.cli.status import BAD_INPUT, BAD_USE, DONE, PARTIAL
from app.performance.ensemble import Performance
from app.performance.span import whole_span
from app.project.storage import save
from app.rig.characters.character_library import character_named
from tests.support.osc import Receiver
from tests.unit.export.unreal.conftest import quartet as bundled_quartet
from tests.unit.export.unreal.conftest import with_dancers


@pytest.fixture
def quartet() -> Path:
    """The bundled example."""
    with as_file(files("resources") / "examples" / "quartet.mid") as path:
        return path


def length_s(quartet: Path, capsys: pytest.CaptureFixture[str]) -> float:
    """End of the piece in seconds as printed by the program."""
    assert main(["stream", str(quartet), "--player", "Trombone 1", "--from", "9999"]) == BAD_USE
    (end,) = re.findall(r"lasts from -?[0-9.]+ to ([0-9.]+) s$", capsys.readouterr().err)
    return float(end)


def test_the_end_of_the_piece_is_sent_in_time(quartet: Path, capsys: pytest.CaptureFixture[str]) -> None:
    end_s = length_s(quartet, capsys)
    with Receiver() as receiver:
        asked = ["--player", "Trombone 1", "--fps", "50", "--port", str(receiver.port), "--from", str(end_s - 1.0)]
        assert main(["stream", str(quartet), *asked, "--faces", "vrm"]) == DONE
        frames = receiver.frames
    assert f"Trombone 1: 127.0.0.1:{receiver.port}" in capsys.readouterr().out
    # A busy machine leaves many out, and sends some late; no frame is early, and most keep their distance.
    assert 5 < len(frames) <= 50
    assert frames[-1].time_s - frames[0].time_s == pytest.approx(0.98, abs=0.25)
    late_s = [frame.at_s - frame.time_s for frame in frames]
    assert max(late_s) - statistics.median(late_s) < 0.5
    assert statistics.median(late_s) - min(late_s) < 0.1
    assert all("A" in frame.face and frame.applied for frame in frames)
    assert frames[0].root[:3] == (0.0, 0.0, 0.0)
    heads = {frame.bones["Head"] for frame in frames}
    assert len(heads) > 5, "it moves"


def test_everyone_has_a_port_and_a_place(quartet: Path, capsys: pytest.CaptureFixture[str]) -> None:
    end_s = length_s(quartet, capsys)
    with Receiver(39801) as first, Receiver(39804) as last:
        assert main(["stream", str(quartet), "--port", "39801", "--from", str(end_s - 0.2), "--fps", "30"]) == DONE
        places = {receiver.frames[0].root[:3] for receiver in (first, last)}
    assert len(places) == 2
    assert {place[1] for place in places} == {0.0}


def test_dancers_of_a_project_have_the_ports_after_the_players(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """The first of two dancers cannot dance but keeps the port."""
    project = with_dancers(bundled_quartet(), tmp_path, "Removed", "Ana")
    gone = msgspec.structs.replace(project.dancers[0], choreography=str(tmp_path / "gone.choreography"))
    ana = project.dancers[1]
    save(replace(project, dancers=(gone, ana)), tmp_path / "danced.suisou")
    performance = Performance(project)
    span = whole_span(performance.time_frame, Fraction(30))
    motion = dancing_of(performance, ana).motion(span.fps, 0, span.count)
    joint = character_named(ana.character_id).skeleton.index("leftUpperLeg")
    danced = motion.rotations[:, joint] * (1, -1, -1, 1)
    moving = np.flatnonzero(np.abs(np.diff(danced, axis=0)).max(axis=1) > 1e-3)
    last_s = span.first_frame_s + float(moving[-1] / span.fps)
    asked = ["stream", str(tmp_path / "danced.suisou"), "--from", str(last_s - 0.5), "--fps", "30"]
    with Receiver(39811) as first, Receiver(39812) as second:
        assert main([*asked, "--port", "39811", "--player", "Removed", "--player", "Ana"]) == PARTIAL
        assert not first.packets
        sent = second.frames
    reported = capsys.readouterr()
    assert "Ana: 127.0.0.1:39812" in reported.out
    assert "gone.choreography" in reported.err
    places = {round(float(value), 4) for value in (-ana.stage.x_m, 0.0, ana.stage.z_m)}
    for frame in sent:
        assert frame.trackers == {}
        assert {round(value, 4) for value in frame.root[:3]} == places
        away = np.abs(danced - np.array(frame.bones["LeftUpperLeg"][3:])).max(axis=1)
        assert away.min() < 1e-5, "a frame of the dance"
    assert len({frame.bones["LeftUpperLeg"] for frame in sent}) > 3


def test_what_makes_no_sense_is_said(quartet: Path, capsys: pytest.CaptureFixture[str]) -> None:
    one = ["stream", str(quartet), "--player", "Trombone 1"]
    assert main([*one, "--port", "80"]) == BAD_USE
    assert "--port: '80' is not a port from 1024 to 65535" in capsys.readouterr().err
    assert main([*one, "--host", " "]) == BAD_USE
    assert "--host" in capsys.readouterr().err
    assert main(["stream", str(quartet), "--port", "65534"]) == BAD_INPUT
    assert "65537" in capsys.readouterr().err
    assert main([*one, "--host", "unknown host"]) == BAD_INPUT
    assert "unknown host" in capsys.readouterr().err


@pytest.mark.parametrize("host", ["239.1.2.3", "127.255.255.255", "255.255.255.255"])
def test_many_computers_are_sent_to_only_where_that_is_asked_for(
    quartet: Path, capsys: pytest.CaptureFixture[str], host: str
) -> None:
    assert main(["stream", str(quartet), "--player", "Trombone 1", "--host", host]) == BAD_USE
    reported = capsys.readouterr().err
    assert host in reported
    assert "--broadcast" in reported


def test_a_broadcast_that_is_asked_for_is_sent(quartet: Path, capsys: pytest.CaptureFixture[str]) -> None:
    end_s = length_s(quartet, capsys)
    with Receiver(host="0.0.0.0") as receiver:
        asked = ["--player", "Trombone 1", "--port", str(receiver.port), "--from", str(end_s - 0.3)]
        assert main(["stream", str(quartet), *asked, "--host", "127.255.255.255", "--broadcast"]) == DONE
        assert receiver.frames
