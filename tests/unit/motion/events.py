"""Plan events for tests of motion, written independently of the planning code."""

from __future__ import annotations

from app.errors import Message
from app.plan.model import (
    BreathEvent,
    CueEvent,
    EmbouchureEvent,
    FingeringEvent,
    GestureEvent,
    PlayerPlan,
    TimeFrame,
    TongueEvent,
)
from instrument_maps.model import Control, ControlMotion

TICKS = 480
REASON = Message("test.reason")


def press(name: str = "valve_1", **changes: object) -> Control:
    """Valve pressed by a finger."""
    settings: dict[str, object] = {
        "kind": "press",
        "role": "pitch",
        "node": name,
        "motion": ControlMotion(axis=(0.0, -1.0, 0.0), travel_m=0.016),
        "finger": "right.index",
    }
    return Control(name=name, **(settings | changes))


def slide(name: str = "slide", **changes: object) -> Control:
    """Playing slide moved by a hand."""
    settings: dict[str, object] = {
        "kind": "slide",
        "role": "pitch",
        "node": name,
        "motion": ControlMotion(axis=(0.0, 0.0, 1.0), travel_m=0.6),
        "finger": "right.hand",
        "move_note_share": 0.5,
        "max_speed_m_s": 2.5,
    }
    return Control(name=name, **(settings | changes))


def fingerings(rows: list[tuple[float, float, dict[str, float]]], quarter_s: float = 0.5) -> tuple[FingeringEvent, ...]:
    """Events from (onset_s, end_s, controls) at a steady tempo."""
    return tuple(
        FingeringEvent(
            id=f"f{index}",
            note_id=f"n{index}",
            start_tick=round(start_s / quarter_s * TICKS),
            end_tick=round(end_s / quarter_s * TICKS),
            start_s=start_s,
            end_s=end_s,
            label="",
            rank=1,
            controls=controls,
            cents=0.0,
            reason=REASON,
        )
        for index, (start_s, end_s, controls) in enumerate(rows)
    )


def plan_of(
    events: tuple[FingeringEvent, ...],
    *,
    player_id: str = "player",
    first_frame_s: float = -2.0,
    breaths: tuple[BreathEvent, ...] = (),
    cues: tuple[CueEvent, ...] = (),
    gestures: tuple[GestureEvent, ...] = (),
) -> PlayerPlan:
    """Plan that plays these notes, with tongue and embouchure for each."""
    return PlayerPlan(
        player_id=player_id,
        time_frame=TimeFrame(first_frame_s, events[-1].end_s + 2.0),
        fingerings=events,
        breaths=breaths,
        tongues=tuple(TongueEvent(e.note_id, e.start_s - 0.035, e.start_s) for e in events),
        embouchures=tuple(
            EmbouchureEvent(e.note_id, e.start_s, e.end_s, 0.2 + 0.1 * (i % 7), 0.3, 0.6, REASON)
            for i, e in enumerate(events)
        ),
        cues=cues,
        gestures=gestures,
        expressions=(),
        problems=(),
    )


def breath(start_s: float, end_s: float, depth: float = 0.8, kind: str = "breath") -> BreathEvent:
    """A breath at these times."""
    ticks = (round(start_s * 2 * TICKS), round(end_s * 2 * TICKS))
    return BreathEvent(f"b{start_s}", kind, *ticks, start_s, end_s, depth, REASON)


def cue(entry_s: float, beat_s: float = 0.5) -> CueEvent:
    """A cue whose preparatory beat is one beat before the entry."""
    start_s, peak_s = entry_s - 2 * beat_s, entry_s - beat_s
    return CueEvent(f"c{entry_s}", "player", 0, 0, start_s, peak_s, entry_s, beat_s, REASON)
