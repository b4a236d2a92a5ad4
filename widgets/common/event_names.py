"""Names of kinds of events and of expressions, in the user's language."""

from __future__ import annotations

from app.editor.translated import tr
from app.score.marks import MARK
from metadata.library import GESTURES, HABITS, STYLES
from widgets.common.instrument_name import language


def kind_name(kind: str) -> str:
    """Return the translated name of a kind of event (`app.plan.event_id.EventId`)."""
    return _named("event", kind)


def expression_name(name: str) -> str:
    """Return the translated name of a bundled expression; the user's own expressions keep their names."""
    return _named("expression_name", name)


def mark_name(kind: str) -> str:
    """Return the translated name of a kind of mark (`app.score.marks`)."""
    return _named(MARK, kind)


def pose_name(target: str) -> str:
    """Return the translated name of the part of body or instrument that a pose correction moves."""
    return _named("pose_name", target)


def gesture_name(name: str) -> str:
    """Return the title of a gesture from a table; the name itself if the gesture is missing."""
    gesture = GESTURES.now().items.get(name)
    return name if gesture is None else gesture.title.in_language(language())


def style_name(name: str) -> str:
    """Return a style's name in the user's language; the id if the style is missing."""
    style = STYLES.now().items.get(name)
    return name if style is None else style.title.in_language(language())


def habit_name(name: str) -> str:
    """Return a habit's name in the user's language; the id if the habit is missing."""
    habit = HABITS.now().items.get(name)
    return name if habit is None else habit.title.in_language(language())


def _named(room: str, name: str) -> str:
    """Return the translated text for a name in a group of texts; the name itself if there is no text."""
    text = tr(f"{room}.{name}")
    return name if text == f"{room}.{name}" else text
