"""Ranges of time: limits of typed positions and of scrolling, the whole piece, and the selection."""

from __future__ import annotations

from app.editor.session import Session

MARGIN_S = 2.0
ROOM_SHARE = 0.1
"""Free space after the last note, relative to the length of the piece, in which notes can be added."""
ROOM_S = 8.0
LEAST_S = 60.0
PREROLL_S = 4.0
"""Seconds before the first beat that are shown until plans determine this time."""
LEAST_BARS = 4
"""Least number of bars shown."""


def place_limits(session: Session) -> tuple[float, float]:
    """Return the first and last second at which something can be placed: from the beginning of the pre-roll to some
    time after the end.
    """
    start_s, end_s = _performance_s(session)
    return start_s, max(end_s + max(ROOM_S, ROOM_SHARE * end_s), LEAST_S)


def scroll_limits(session: Session) -> tuple[float, float]:
    """Return the range of seconds to which the timeline can scroll: the positions of `place_limits` and a margin before
    them.
    """
    start_s, end_s = place_limits(session)
    return start_s - MARGIN_S, end_s


def whole_piece(session: Session) -> tuple[float, float]:
    """Return the range of seconds that shows the whole piece and at least some bars; all that can be shown for an empty
    piece.
    """
    limits_s = scroll_limits(session)
    score = session.project.score
    if not score.sounding_end_tick:
        return limits_s
    least_tick = max(score.metre_map.tick_of_bar(LEAST_BARS + 1), score.sounding_end_tick)
    shown_end_s = max(_performance_s(session)[1] + MARGIN_S, score.tempo_map.seconds(float(least_tick)))
    return limits_s[0], min(shown_end_s, limits_s[1])


def _performance_s(session: Session) -> tuple[float, float]:
    """Return the first and last second of the performance; before planning, those of the notes with the usual
    pre-roll.
    """
    score = session.project.score
    end_s = score.tempo_map.seconds(float(score.end_tick))
    performance = session.performance
    if performance.planned and performance.plans:
        frame = performance.time_frame
        return min(frame.first_frame_s, 0.0), max(end_s, frame.end_s)
    return -PREROLL_S, end_s


def selected_span(session: Session) -> tuple[float, float] | None:
    """Return start and end in seconds of all that is selected (a time range, notes, events); None if nothing with a
    time is selected.
    """
    selection, project = session.selection, session.project
    tempo = project.score.tempo_map
    places: list[tuple[float, float]] = []
    if selection.span is not None:
        places.append((tempo.seconds(float(selection.span[0])), tempo.seconds(float(selection.span[1]))))
    if selection.notes:
        places.extend(
            (tempo.seconds(float(note.onset_tick)), tempo.seconds(float(note.end_tick)))
            for part in project.score.parts
            for note in part.notes
            if note.id in selection.notes
        )
    if selection.events:
        requested = {(key.player_id, key.event_id) for key in selection.events}
        for player_id, plan in session.plans.items():
            for events in (plan.fingerings, plan.breaths, plan.embouchures, plan.cues, plan.gestures, plan.expressions):
                places.extend((event.start_s, event.end_s) for event in events if (player_id, event.id) in requested)
    if not places:
        return None
    return min(start for start, _ in places), max(end for _, end in places)
