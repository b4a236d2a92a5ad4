"""The editor's stream, received by an independent receiver over real UDP."""

from __future__ import annotations

import os
import socket
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QLabel, QLineEdit, QPushButton
from pytestqt.qtbot import QtBot

from app.editor.settings import Settings
from app.editor.streaming import StreamTarget
from app.errors import Message
from app.performance.bodies import character_of
from app.performance.play_along import PlayAlong
from app.rig.characters.character_library import character_named
from app.score.take import ControllerMapping
from app.shell.app import Program
from app.stream.sender import Sender
from tests.gui.shell.conftest import Start, trigger
from tests.support.bad_players import with_instrument
from tests.support.osc import Frame, Receiver
from tests.support.performed import performance_curves
from tests.support.windows import child
from tests.unit.export.unreal.conftest import with_dancers
from widgets.common.actions import actions
from widgets.dialogs.stream import StreamDialog
from widgets.players.player_list import PlayerList

pytestmark = pytest.mark.moved

ARM = "RightLowerArm"
PORT = 21000 + 10 * int(os.environ.get("PYTEST_XDIST_WORKER", "gw0").removeprefix("gw"))
"""First of ten ports that neither other test workers nor the system use."""


def ready(program: Program, qtbot: QtBot) -> None:
    player = program.session.project.players[0].id
    qtbot.waitUntil(lambda: program.generator.live.pose(player, program.session.playhead_s) is not None)


def stream_to(program: Program, port: int) -> None:
    program.session.streaming.set(port=port)
    trigger(program, "stream.toggle")


def received(receiver: Receiver, qtbot: QtBot, count: int = 1) -> list[Frame]:
    before = len(receiver.frames)
    qtbot.waitUntil(lambda: len(receiver.frames) >= before + count)
    return receiver.frames


def test_nothing_is_sent_until_it_is_asked_for_and_no_more_afterwards(program: Program, qtbot: QtBot) -> None:
    ready(program, qtbot)
    with Receiver() as receiver:
        program.session.streaming.set(port=receiver.port)
        program.session.set_playhead(2.0)
        qtbot.wait(300)
        assert not receiver.packets
        trigger(program, "stream.toggle")
        received(receiver, qtbot, 3)
        assert actions(program.session)["stream.toggle"].isChecked()
        trigger(program, "stream.toggle")
        qtbot.wait(50)
        count = len(receiver.packets)
        program.session.set_playhead(3.0)
        qtbot.wait(400)
        assert len(receiver.packets) == count
        assert program.session.streaming.state == "off"


def test_it_follows_the_playhead_and_rests_slowly(program: Program, qtbot: QtBot) -> None:
    ready(program, qtbot)
    with Receiver() as receiver:
        stream_to(program, receiver.port)
        first = received(receiver, qtbot)[-1]
        # Somewhere the trumpet is played, not rested.
        note = program.session.project.part(program.session.project.players[0]).notes[2]
        time_s = program.session.project.score.tempo_map.seconds(note.onset_tick) + 0.05
        program.session.set_playhead(time_s)
        player = program.session.project.players[0].id
        qtbot.waitUntil(lambda: program.generator.live.pose(player, time_s) is not None)
        qtbot.waitUntil(lambda: receiver.frames[-1].bones[ARM] != first.bones[ARM])
        pose = program.generator.live.pose(player, time_s)
        assert pose is not None
        qtbot.wait(1200)
        joint = character_of(program.session.project.players[0]).skeleton.index("rightLowerArm")
        expected = np.asarray(pose.rotations[joint], float) * (1, -1, -1, 1)
        np.testing.assert_allclose(receiver.frames[-1].bones[ARM][3:], expected, atol=2e-6)
        # At rest: alive, but seldom.
        frames = received(receiver, qtbot, 5)[-5:]
        assert frames[-1].at_s - frames[0].at_s > 4 / 8.0


def test_while_it_plays_every_frame_is_another_and_no_more_than_the_rate(program: Program, qtbot: QtBot) -> None:
    ready(program, qtbot)
    sound = program.editor.sound
    program.session.playback = sound.playback
    with Receiver() as receiver:
        program.session.streaming.set(rate_hz=30)
        stream_to(program, receiver.port)
        first = len(received(receiver, qtbot))
        program.session.playback.play(1.0)
        qtbot.waitUntil(lambda: len({frame.bones[ARM] for frame in receiver.frames[first:]}) > 40)
        frames = receiver.frames[first:]
        program.session.playback.stop()
    assert (len(frames) - 1) / (frames[-1].time_s - frames[0].time_s) < 30.5


def test_who_is_played_from_a_controller_is_sent_as_they_play(program: Program, qtbot: QtBot) -> None:
    ready(program, qtbot)
    session = program.session
    player = session.project.players[0]
    with Receiver() as receiver:
        stream_to(program, receiver.port)
        rested = received(receiver, qtbot)[-1]
        live = PlayAlong(performance_curves(session.performance, player))
        session.live_players.begin(live)
        session.live_players.receive(player.id, time.perf_counter(), "b0027f", ControllerMapping())
        low = session.performance.instrument(player).range.low
        session.live_players.receive(player.id, time.perf_counter(), f"90{low + 8:02x}64", ControllerMapping())

        def moved() -> list[Frame]:
            return [frame for frame in receiver.frames if frame.face != rested.face and frame.bones != rested.bones]

        qtbot.waitUntil(lambda: len(moved()) > 5)
        session.live_players.end(player.id)


def test_who_is_in_front_is_sent_or_everyone(program: Program, qtbot: QtBot) -> None:
    ready(program, qtbot)
    session = program.session
    ids = [player.id for player in session.project.players]
    qtbot.waitUntil(lambda: all(program.generator.live.pose(id, 0.0) is not None for id in ids))
    with Receiver(PORT) as first, Receiver(PORT + 1) as second:
        session.streaming.set(everyone=True)
        stream_to(program, PORT)
        qtbot.waitUntil(lambda: bool(first.frames) and bool(second.frames))
        assert first.frames[-1].root != second.frames[-1].root
        session.streaming.set(everyone=False)
        qtbot.waitUntil(lambda: first.frames[-1].root[:3] == (0.0, 0.0, 0.0))
        qtbot.wait(100)
        count = len(second.packets)
        session.set_players((ids[2],))
        assert [line.player_id for line in session.streaming.lines] == [ids[2]]
        qtbot.waitUntil(lambda: [*first.frames[-1].trackers] == [session.project.players[2].instrument_id])
        assert first.frames[-1].root[:3] == (0.0, 0.0, 0.0)
        assert len(second.packets) == count


def test_a_dancer_is_sent_on_the_port_after_the_players(program: Program, qtbot: QtBot, tmp_path: Path) -> None:
    session = program.session
    session.apply(Message("edit.add_dancer"), with_dancers(session.project, tmp_path, "Ana"))
    dancer = session.project.dancers[0]
    time_s = 9.0
    session.set_playhead(time_s)
    qtbot.waitUntil(lambda: program.generator.live.pose(dancer.id, time_s) is not None)
    with Receiver(PORT + 4) as receiver:
        session.streaming.set(everyone=True)
        stream_to(program, PORT)
        assert session.streaming.lines[-1] == StreamTarget(dancer.id, PORT + 4)
        received(receiver, qtbot, 2)
        chip = child(program.window.status, QPushButton, "stream_state")
        assert f"Ana: {PORT + 4}" in chip.toolTip()
        pose = program.generator.live.pose(dancer.id, time_s)
        assert pose is not None
        joint = character_named(dancer.character_id).skeleton.index("rightLowerArm")
        expected = np.asarray(pose.rotations[joint], float) * (1, -1, -1, 1)
        np.testing.assert_allclose(receiver.frames[-1].bones[ARM][3:], expected, atol=2e-6)
        assert receiver.frames[-1].trackers == {}
        assert receiver.frames[-1].root[:3] == pytest.approx((-dancer.stage.x_m, 0.0, dancer.stage.z_m))
        before = receiver.frames[-1].bones
        session.set_playhead(time_s + 0.7)
        qtbot.waitUntil(lambda: receiver.frames[-1].bones != before)
        dialog = StreamDialog(session)
        assert dialog._list.topLevelItem(4).text(0) == "Ana"


def test_where_no_one_plays_the_selected_dancer_is_sent(program: Program, qtbot: QtBot, tmp_path: Path) -> None:
    session = program.session
    alone = replace(with_dancers(session.project, tmp_path, "Ana", "Bo"), players=(), corrections={}, takes={})
    session.apply(Message("edit.add_dancer"), alone)
    ids = [dancer.id for dancer in alone.dancers]
    with Receiver() as receiver:
        stream_to(program, receiver.port)
        assert [line.player_id for line in session.streaming.lines] == ids[-1:]
        session.set_dancer(ids[0])
        assert [line.player_id for line in session.streaming.lines] == ids[:1]
        assert received(receiver, qtbot)[-1].root[:3] == (0.0, 0.0, 0.0)


def test_no_one_there_is_said_and_hurts_no_one(program: Program, qtbot: QtBot) -> None:
    ready(program, qtbot)
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    stream_to(program, port)
    chip = child(program.window.status, QPushButton, "stream_state")
    qtbot.waitUntil(lambda: program.session.streaming.state == "no_receiver")
    assert "no receiver" in chip.text()
    assert program.session.streaming.trouble is None
    with Receiver(port) as receiver:
        received(receiver, qtbot, 2)
        qtbot.waitUntil(lambda: program.session.streaming.state == "sending")
        assert f"127.0.0.1:{port}" in chip.text()


def test_what_is_in_the_way_is_said_once_and_tried_again(
    program: Program, qtbot: QtBot, monkeypatch: pytest.MonkeyPatch
) -> None:
    ready(program, qtbot)
    reported = list[str]()
    program.session.noticed.connect(lambda message, severity: reported.append(message.id))
    monkeypatch.setattr("app.editor.streamer.RETRY_S", 0.1)
    program.session.streaming.set(host="unknown host.invalid")
    trigger(program, "stream.toggle")
    assert program.session.streaming.state == "failed"
    assert reported == ["stream.host_unknown"]
    send = Sender.send

    def unreachable(sender: Sender, datagrams: object) -> None:
        raise sender._not_sent(OSError(101, "unreachable"))

    with Receiver() as receiver:
        monkeypatch.setattr(Sender, "send", unreachable)
        program.session.streaming.set(host="127.0.0.1", port=receiver.port)
        qtbot.waitUntil(lambda: len(reported) > 1)
        qtbot.wait(500)
        assert reported == ["stream.host_unknown", "stream.not_sent"]
        assert program.session.streaming.state == "failed"
        monkeypatch.setattr(Sender, "send", send)
        received(receiver, qtbot)
        qtbot.waitUntil(lambda: program.session.streaming.state == "sending")
        assert program.session.streaming.trouble is None


def test_the_dialog_by_mouse_and_keys(program: Program, qtbot: QtBot) -> None:
    ready(program, qtbot)
    trigger(program, "stream.settings")
    dialog = child(program.window, StreamDialog)
    qtbot.waitUntil(dialog.isActiveWindow)
    host = child(dialog, QLineEdit, "stream_host")
    warning, reported = dialog.findChild(QLabel, "stream_warning"), dialog.findChild(QLabel, "stream_status")
    toggle, here = dialog.findChild(QPushButton, "stream_toggle"), dialog.findChild(QPushButton, "stream_here")
    assert reported is not None
    assert toggle is not None
    assert here is not None
    assert warning.isHidden()
    host.setFocus()
    host.selectAll()
    QTest.keyClicks(host, "192.168.0.20")
    assert program.session.streaming.host == "127.0.0.1", "not while it is being typed"
    QTest.keyClick(host, Qt.Key.Key_Tab)
    assert program.session.streaming.host == "192.168.0.20"
    assert not warning.isHidden()
    QTest.mouseClick(here, Qt.MouseButton.LeftButton)
    assert host.text() == "127.0.0.1"
    assert warning.isHidden()
    with Receiver() as receiver:
        program.session.streaming.set(port=receiver.port)
        QTest.mouseClick(toggle, Qt.MouseButton.LeftButton)
        received(receiver, qtbot, 2)
        qtbot.waitUntil(lambda: "frames per second" in reported.text())
        QTest.mouseClick(toggle, Qt.MouseButton.LeftButton)
        assert reported.text() == "Not streaming."
    dialog.close()


def test_many_computers_are_sent_to_only_after_a_confirmation(
    start: Start, program: Program, qtbot: QtBot, settings: Settings
) -> None:
    ready(program, qtbot)
    streaming = program.session.streaming
    trigger(program, "stream.settings")
    dialog = child(program.window, StreamDialog)
    reported, anyway = dialog.findChild(QLabel, "stream_status"), dialog.findChild(QPushButton, "stream_anyway")
    assert reported is not None
    assert anyway.isHidden()
    with Receiver(host="0.0.0.0") as receiver:
        streaming.set(host="127.255.255.255", port=receiver.port)
        trigger(program, "stream.toggle")
        assert streaming.state == "failed"
        assert "every computer on the network" in reported.text()
        assert not anyway.isHidden()
        qtbot.wait(300)
        assert not receiver.packets
        QTest.mouseClick(anyway, Qt.MouseButton.LeftButton)
        received(receiver, qtbot, 2)
        assert anyway.isHidden()
        # For this address and this session only.
        streaming.set(host="127.0.0.1")
        streaming.set(host="239.1.2.3")
        assert streaming.state == "failed"
        assert not anyway.isHidden()
        streaming.set(on=False)
    dialog.close()
    settings.stream_host = "127.255.255.255"
    again = start().session.streaming
    again.set(on=True)
    assert again.state == "failed"


def test_where_to_is_remembered_but_not_that_it_was_on(start: Start, settings: Settings, qtbot: QtBot) -> None:
    first = start()
    first.session.streaming.set(host="studio-pc", port=40001, everyone=True, faces="vrm", rate_hz=30)
    first.session.streaming.set(port=39539)
    second = start().session.streaming
    assert (second.host, second.port, second.everyone) == ("studio-pc", 39539, True)
    assert (second.faces, second.rate_hz, second.on, second.state) == ("vrm", 30, False, "off")
    settings.stream_faces = "nonsense"
    assert start().session.streaming.faces == "arkit"


def test_a_fault_of_sending_is_reported_and_the_stream_is_off(
    program: Program, qtbot: QtBot, monkeypatch: pytest.MonkeyPatch
) -> None:
    ready(program, qtbot)

    def fail(*_: object) -> list[bytes]:
        raise ValueError("a bug")

    with Receiver() as receiver, qtbot.captureExceptions() as caught:
        stream_to(program, receiver.port)
        received(receiver, qtbot)
        monkeypatch.setattr("app.stream.vmc.Sent.datagrams", fail)
        program.session.set_playhead(2.0)
        qtbot.waitUntil(lambda: program.session.streaming.state == "off")
        assert [str(fault) for _, fault, _ in caught] == ["a bug"]
        assert not actions(program.session)["stream.toggle"].isChecked()
        # Asked again, it sends again.
        monkeypatch.undo()
        trigger(program, "stream.toggle")
        received(receiver, qtbot)


def test_who_cannot_be_seen_is_named_and_everyone_else_is_sent(program: Program, qtbot: QtBot) -> None:
    ready(program, qtbot)
    session, live = program.session, program.generator.live
    session.attempt(Message("edit.set_tempo"), lambda project: with_instrument(project, 0, "ophicleide"))
    session.streaming.set(everyone=True)
    first_id = session.project.players[0].id
    # The display is unchanged until the instrument is found to be missing; a missing pose causes no report.
    qtbot.waitUntil(lambda: live.error(first_id) is not None and live.pose(first_id, session.playhead_s) is None)
    with Receiver(PORT) as first, Receiver(PORT + 1) as second:
        stream_to(program, PORT)
        received(second, qtbot)
        assert not first.frames
        dialog = StreamDialog(session)
        named = [dialog._list.topLevelItem(row).text(0) for row in range(4)]
        assert "not sent" in named[0]
        assert "instrument 'ophicleide' of Trumpet 1 is not installed" in named[0]
        assert named[1] == session.project.players[1].name
    players = child(program.window, PlayerList)
    assert ["is not installed" in row.unseen for row in players.rows.rows] == [True, False, False, False]
