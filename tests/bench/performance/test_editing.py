"""Waiting times in editing: plans after an edit, the pose at the playhead, memory. Printed, never asserted."""

from __future__ import annotations

import time
from dataclasses import replace

import msgspec
import pytest

from app.performance.ensemble import Performance
from app.performance.excerpt import PerformanceExcerpt
from app.performance.live import LiveMotion
from app.plan.by_hand.corrections import (
    AddExpression,
    Correction,
    PinFingering,
    PoseCorrection,
    SetBreath,
    SetCue,
    SetEmbouchure,
)
from app.project.edit.corrections import with_corrections
from app.project.edit.piece import new_piece
from app.project.model import Project
from app.rig.characters.character_library import bundled_characters
from app.rig.characters.load_character import load_character
from tests.bench.performance.large import calibration_s, large_project, reported


@pytest.fixture(scope="module")
def planned() -> tuple[Performance, float]:
    project = large_project()
    unit_s = calibration_s()
    performance = Performance(project)
    start_s = time.perf_counter()
    performance.prepare()
    reported("plans of 50 players and 100,000 notes, fresh", time.perf_counter() - start_s, unit_s)
    return performance, unit_s


@pytest.mark.bench
def test_who_is_in_front_of_an_opened_piece_moves_first_and_everyone_before_all_is_planned() -> None:
    project = large_project()
    front, ids = project.players[0].id, [player.id for player in project.players]
    unit_s, live = calibration_s(), LiveMotion(Performance(new_piece()))
    live.request(0.0, player_ids=(front,))
    performance, start_s = Performance(project), time.perf_counter()

    def planned(player_ids: tuple[str, ...]) -> None:
        if front not in player_ids:
            return
        reported("the front player of an opened piece is planned", time.perf_counter() - start_s, unit_s)
        live.show_first(performance, player_ids)
        live.work()
        assert live.pose(front, 0.0) is not None
        reported("it moves", time.perf_counter() - start_s, unit_s)
        excerpt = PerformanceExcerpt(performance, 0.0)
        excerpt.prepare()
        reported("everyone is planned around the playhead", time.perf_counter() - start_s, unit_s)
        live.show_excerpt(performance, excerpt)
        while not live.is_moving:
            live.work()
        assert all(live.pose(player_id, 0.0) is not None for player_id in ids)
        reported("everyone moves there", time.perf_counter() - start_s, unit_s)

    performance.prepare(first=lambda: (front,), planned=planned)
    reported("everyone is planned", time.perf_counter() - start_s, unit_s)
    live.show(performance)
    made = live.made
    while not live.is_seen:
        live.work()
    reported("everyone moves as planned", time.perf_counter() - start_s, unit_s)
    print(f"; of {2 * len(ids)} motions at the playhead {live.made - made} were made again", end="")


def corrections(performance: Performance) -> dict[str, Correction]:
    player = performance.project.players[3]
    note = performance.project.part(player).notes[1000]
    label = performance.plan(player).fingerings[1001].label
    return {
        "a fingering": PinFingering(note.id, label),
        "an embouchure": SetEmbouchure(note.id, tension=0.9),
        "an expression": AddExpression("x", "strained", note.onset_tick, note.onset_tick + 960),
        "a pose": PoseCorrection("x", "bell", note.onset_tick, note.onset_tick + 1920, up_deg=10.0),
        "a breath": SetBreath(note.id, -240),
        "a cue": SetCue(note.id),
    }


def note_moved(project: Project) -> Project:
    part = project.part(project.players[3])
    note = part.notes[1000]
    notes = tuple(msgspec.structs.replace(n, pitch=n.pitch + 1) if n is note else n for n in part.notes)
    parts = tuple(
        msgspec.structs.replace(other, notes=notes) if other is part else other for other in project.score.parts
    )
    return replace(project, score=msgspec.structs.replace(project.score, parts=parts))


@pytest.mark.bench
def test_plans_and_picture_after_one_edit(planned: tuple[Performance, float]) -> None:
    performance, unit_s = planned
    player = performance.project.players[3]
    at_s = performance.plan(player).fingerings[1000].start_s + 0.1
    edits = {
        name: with_corrections(performance.project, player.id, [item])
        for name, item in corrections(performance).items()
    }
    edits["a note's pitch"] = note_moved(performance.project)
    for name, project in edits.items():
        live = LiveMotion(performance)
        live.request(at_s, 4.0, (player.id,))
        for _ in range(3):
            live.work()
        start_s = time.perf_counter()
        after = Performance(project, performance)
        after.prepare()
        plans_s = time.perf_counter() - start_s
        live.show(after)
        live.request(at_s, 4.0, (player.id,))
        live.work()
        picture_s = time.perf_counter() - start_s
        reported(f"{name}: new plans", plans_s, unit_s)
        reported(f"{name}: the picture is right again", picture_s, unit_s)


@pytest.mark.bench
def test_a_pose_at_once_and_from_what_is_made(planned: tuple[Performance, float]) -> None:
    performance, unit_s = planned
    players = performance.project.players
    live = LiveMotion(performance)
    times_s: list[float] = []
    for player in players:
        live.pose_now(player.id, 10.0)
    for number in range(100):
        start_s = time.perf_counter()
        live.pose_now(players[number % 50].id, 3.0 * number)
        times_s.append(time.perf_counter() - start_s)
    reported("a pose made at once, of a part of 2,000 notes (median)", sorted(times_s)[50], unit_s)
    live.request(60.0, 1.0)
    for _ in range(120):
        live.work()
    start_s = time.perf_counter()
    for step in range(10):
        for player in players:
            live.pose(player.id, 60.0 + 0.0123 * step)
    reported("poses of 50 players from what is made", (time.perf_counter() - start_s) / 10.0, unit_s)


@pytest.mark.bench
def test_memory_and_time_of_ten_minutes() -> None:
    unit_s = calibration_s()
    project = large_project(4, 1500)
    performance = Performance(project)
    performance.prepare()
    frame = performance.time_frame
    live = LiveMotion(performance, 1 << 40)
    start_s, chunks = time.perf_counter(), 0
    while live.work():
        chunks += 1
    spent_s = time.perf_counter() - start_s
    minutes = (frame.end_s - frame.first_frame_s) / 60.0
    print(f"\nmotion of 4 players: {live.bytes / 2**20 * 10.0 / minutes:.0f} MB in ten minutes", end="")
    reported("motion of 4 players for ten minutes, made behind", spent_s * 10.0 / minutes, unit_s)
    reported("one chunk of one player", spent_s / chunks, unit_s)
    bounded = LiveMotion(performance, 32 * 2**20)
    while bounded.work():
        pass
    print(f"\nbounded to 32 MB: {bounded.bytes / 2**20:.1f} MB", end="")


@pytest.mark.bench
def test_characters_are_loaded() -> None:
    unit_s = calibration_s()
    for name, path in bundled_characters().items():
        start_s = time.perf_counter()
        load_character(path)
        reported(f"character {name}", time.perf_counter() - start_s, unit_s)
