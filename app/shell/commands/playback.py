"""Commands for playback: playing, looping, stepping, choosing what is heard, and the piece's recording."""

from __future__ import annotations

from functools import partial
from math import ceil, floor
from typing import TYPE_CHECKING

from app.editor.session import Session
from app.errors import Message
from app.project.edit.piece import set_audio
from app.shell.action import Action
from app.shell.commands.command_targets import selected_ticks
from app.shell.editor import Editor, EditorAction

if TYPE_CHECKING:
    from app.editor.listening import Source

_NEAR_S = 1e-4
"""Two moments closer than this number of seconds count as equal."""


def toggle(session: Session) -> None:
    """Start playing at the playhead, or stop."""
    if session.playback is None:
        return
    if session.playback.is_playing:
        session.playback.stop()
    else:
        session.playback.play(session.playhead_s)


def play_bar(session: Session) -> None:
    """Start playing at the beginning of the bar."""
    if session.playback is not None:
        start_s = _bar_s(session, _bar(session))
        session.set_playhead(start_s)
        session.playback.play(start_s)


def stop(session: Session) -> None:
    """Stop playing, and return to the start of the loop if there is one."""
    if session.playback is None:
        return
    if session.playback.is_playing:
        session.playback.stop()
    elif session.loop_s is not None and session.playhead_s != session.loop_s[0]:
        _go(session, session.loop_s[0])
    else:
        to_start(session)


def to_start(session: Session) -> None:
    """Move the playhead to the beginning of the performance."""
    _go(session, session.performance.time_frame.first_frame_s)


def to_end(session: Session) -> None:
    """Move the playhead to the end of the last note."""
    score = session.project.score
    _go(session, score.tempo_map.seconds(float(score.end_tick)))


def toggle_loop(session: Session, on: bool = True) -> None:
    """Loop the selected range, the selected notes or else the current bar; end the loop if that range is looped
    already.
    """
    span = _selected_s(session)
    if session.loop_s is not None and (span is None or span == session.loop_s):
        session.set_loop(None)
        return
    if span is None:
        bar = _bar(session)
        span = (_bar_s(session, bar), _bar_s(session, bar + 1))
    session.set_loop(span)


def step_frames(session: Session, count: int) -> None:
    """Move the playhead by whole frames; from between two frames, first to the nearest frame in that direction."""
    fps = float(session.project.fps)
    frame = session.playhead_s * fps
    near = round(frame)
    if abs(frame - near) < _NEAR_S * fps:
        frame = near
    target = floor(frame) + count if count > 0 else ceil(frame) + count
    _go(session, target / fps)


def step_notes(session: Session, by: int) -> None:
    """Move the playhead to the next note (1) or the previous note (-1) of the active player."""
    beyond = [by * at_s for at_s in _onsets_s(session) if by * (at_s - session.playhead_s) > _NEAR_S]
    if beyond:
        _go(session, by * min(beyond))


def bar_back(session: Session) -> None:
    """Move the playhead to the beginning of the bar, or from there to the previous bar."""
    bar = _bar(session)
    start_s = _bar_s(session, bar)
    _go(session, start_s if session.playhead_s > start_s + _NEAR_S else _bar_s(session, bar - 1))


def bar_on(session: Session) -> None:
    """Move the playhead to the next bar."""
    _go(session, _bar_s(session, _bar(session) + 1))


def remove_recording(session: Session) -> None:
    """Remove the recording, so that the synthesiser plays."""
    session.attempt(Message("edit.remove_audio"), lambda project: set_audio(project, None))


def follow_recording(editor: Editor) -> None:
    """Ask for the properties to take from the recording (such as tempo), and apply them."""
    from widgets.dialogs.follow_recording import FollowRecordingDialog

    dialog = FollowRecordingDialog(editor.session, editor.window)
    dialog.requested.connect(editor.sound.follow)
    dialog.open()


def _speed(percent: int) -> Action:
    return Action(
        f"play.speed_{percent}",
        lambda session, on: session.listening.set(speed=percent / 100),
        "play/speed",
        checked=lambda session: round(100 * session.listening.speed) == percent,
    )


def _source(source: Source) -> Action:
    return Action(
        f"play.source_{source}",
        lambda session, on: session.listening.set(source=source),
        "play/sound",
        enabled=_has_recording,
        checked=lambda session: _has_recording(session) and session.listening.source == source,
    )


def _can_play(session: Session) -> bool:
    return session.playback is not None


def _has_recording(session: Session) -> bool:
    return session.project.audio is not None


def _has_notes(session: Session) -> bool:
    player = session.player
    return player is not None and bool(session.project.part(player).notes)


def _recording_ready(editor: Editor) -> bool:
    session = editor.session
    return session.listening.waveform is not None and session.project.score.end_tick > 0


def _go(session: Session, time_s: float) -> None:
    session.set_playhead(time_s)
    session.reveal(time_s)


def _bar(session: Session) -> int:
    score = session.project.score
    # A playhead moved to a bar line is in that bar, regardless of rounding.
    return score.metre_map.bar_of_tick(floor(score.tempo_map.ticks(session.playhead_s + _NEAR_S)))


def _bar_s(session: Session, bar: int) -> float:
    score = session.project.score
    return score.tempo_map.seconds(float(score.metre_map.tick_of_bar(bar)))


def _onsets_s(session: Session) -> set[float]:
    player, tempo_map = session.player, session.project.score.tempo_map
    if player is None:
        return set()
    return {tempo_map.seconds(float(note.onset_tick)) for note in session.project.part(player).notes}


def _selected_s(session: Session) -> tuple[float, float] | None:
    """Return start and end of the selection in seconds; None if nothing is selected."""
    ticks, tempo_map = selected_ticks(session), session.project.score.tempo_map
    return (tempo_map.seconds(float(ticks[0])), tempo_map.seconds(float(ticks[1]))) if ticks is not None else None


ACTIONS: tuple[Action | EditorAction, ...] = (
    Action("play.toggle", toggle, "play", "Space", enabled=_can_play, icon="play"),
    Action("play.bar", play_bar, "play", "Return;Enter", enabled=_can_play, icon="play"),
    Action("play.stop", stop, "play", enabled=_can_play, icon="stop"),
    Action("play.loop", toggle_loop, "play", "L", checked=lambda session: session.loop_s is not None, icon="loop"),
    Action("play.to_start", to_start, "play/go", "Home", icon="to_start"),
    Action("play.to_end", to_end, "play/go", "End", icon="to_end"),
    Action("play.frame_back", partial(step_frames, count=-1), "play/go", ",", icon="previous_frame"),
    Action("play.frame_on", partial(step_frames, count=1), "play/go", ".", icon="next_frame"),
    Action("play.note_back", partial(step_notes, by=-1), "play/go", "Alt+,", enabled=_has_notes, icon="previous_note"),
    Action("play.note_on", partial(step_notes, by=1), "play/go", "Alt+.", enabled=_has_notes, icon="next_note"),
    Action("play.bar_back", bar_back, "play/go", "PgUp"),
    Action("play.bar_on", bar_on, "play/go", "PgDown"),
    *(_speed(percent) for percent in (25, 50, 75, 100, 150, 200)),
    _source("recording"),
    _source("synthesiser"),
    _source("both"),
    Action(
        "play.click",
        lambda session, on: session.listening.set(click=on),
        "play",
        "Shift+C",
        checked=lambda session: session.listening.click,
        icon="metronome",
    ),
    Action(
        "play.percussion",
        lambda session, on: session.listening.set(percussion=on),
        "play",
        checked=lambda session: session.listening.percussion,
        enabled=lambda session: bool(session.project.score.percussion),
    ),
    Action(
        "play.scrub",
        lambda session, on: session.listening.set(scrub_sound=on),
        "play",
        checked=lambda session: session.listening.scrub_sound,
        icon="sound",
    ),
    Action(
        "play.follow",
        lambda session, on: session.set_follow(on),
        "play",
        checked=lambda session: session.follow,
        icon="follow",
    ),
    EditorAction(
        "play.estimate_offset",
        lambda editor: editor.sound.estimate(),
        "play/recording",
        enabled=_recording_ready,
        icon="offset",
    ),
    EditorAction(
        "play.fit_tempo",
        lambda editor: editor.sound.estimate(with_tempo=True),
        "play/recording",
        enabled=_recording_ready,
        icon="tempo",
    ),
    EditorAction(
        "play.follow_recording",
        follow_recording,
        "play/recording",
        enabled=_recording_ready,
        icon="tempo",
    ),
    Action("play.remove_recording", remove_recording, "play/recording", enabled=_has_recording, icon="remove"),
)
