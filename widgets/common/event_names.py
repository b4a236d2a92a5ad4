"""Names of kinds of events and of expressions, in the user's language."""

from __future__ import annotations

from app.editor.translated import tr
from app.score.marks import MARK
from metadata.library import GESTURES, HABITS, STYLES
from widgets.common.instrument_name import language


def kind_name(kind: str) -> str:
    """The name of a kind of event (`app.plan.event_id.EventId`)."""
    return _named("event", kind)


def expression_name(name: str) -> str:
    """The translated name of a bundled expression; a user's own keeps its name."""
    return _named("expression_name", name)


def mark_name(kind: str) -> str:
    """The name of a kind of mark (`app.score.marks`)."""
    return _named(MARK, kind)


def pose_name(target: str) -> str:
    """The name of what is held differently."""
    return _named("pose_name", target)


def gesture_name(name: str) -> str:
    """The name of a gesture that is written in a table; one that is not there, by its own name."""
    gesture = GESTURES.now().items.get(name)
    return name if gesture is None else gesture.title.in_language(language())


def style_name(name: str) -> str:
    """A style's name in the user's language; a missing style goes by its id."""
    style = STYLES.now().items.get(name)
    return name if style is None else style.title.in_language(language())


def habit_name(name: str) -> str:
    """A habit's name in the user's language; a missing habit goes by its id."""
    habit = HABITS.now().items.get(name)
    return name if habit is None else habit.title.in_language(language())


def _named(room: str, name: str) -> str:
    """The text of a name; the name itself where there is none."""
    text = tr(f"{room}.{name}")
    return name if text == f"{room}.{name}" else text
