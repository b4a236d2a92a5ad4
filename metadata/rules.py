"""Rules as written by an animator: in a musical situation, a player shows an expression or makes a gesture."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Annotated, Final, Literal, NamedTuple, TypeAlias

import msgspec

from metadata.model import Fraction01, NotNegative, Positive
from metadata.tables import Title, check_name, decoded, invalid

Offset: TypeAlias = Annotated[float, msgspec.Meta(ge=-60.0, le=60.0)]
Place: TypeAlias = Literal["first", "after_rest", "climax", "phrase_end", "before_rest", "last"]
Growth: TypeAlias = Literal["loudness", "height", "depth", "length", "accent", "effort"]
Moment: TypeAlias = Literal["gives_entry", "takes_entry", "ending"]
Anchor: TypeAlias = Literal["onset", "end"]

MOST_RULES = 200


class When(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Conditions on a note, all of which must hold; an absent one is not checked.

    Attributes
    ----------
    loudness_above, loudness_below : float
        Least and greatest loudness, 0..1; mezzoforte is 0.63.
    semitones_above_easy, semitones_below_easy : float
        Least distance in semitones above or below the instrument's easy range.
    longer_s, shorter_s : float
        Least and greatest duration of the note in seconds.
    rest_longer_s, rest_after_longer_s : float
        Least silence in seconds before the note, and after it.
    played_longer_s : float
        Least time in seconds that the player has played so far, including this note.
    accent : float
        Least excess of the loudness over that of surrounding notes, 0..1.
    leap_up, leap_down : float
        Least interval in semitones up or down from the note before.
    place : tuple of str
        Position, any of these: ``"first"`` or ``"last"`` of the part, ``"after_rest"``, ``"climax"`` (highest and
        loudest of its phrase), ``"phrase_end"``, ``"before_rest"`` (the same, with more to come).
    styles, habits : tuple of str
        Styles or habits, one of which the player has.
    not_styles : tuple of str
        Styles that the player must not have.
    chance : float
        Probability, 0..1, that the rule applies where all conditions hold.
    effort_above : float
        Least difficulty of the note, 0..1, by height, loudness and length.
    moment : str or None
        A moment instead of a note: ``"gives_entry"``, a cue given by the player; ``"takes_entry"``, the breath before
        an entry cued by others, after a rest; ``"ending"``, from the lowering of the instrument after a bright ending.
        The other conditions apply to the note that begins there.
    """

    loudness_above: Fraction01 | None = None
    loudness_below: Fraction01 | None = None
    semitones_above_easy: float | None = None
    semitones_below_easy: float | None = None
    longer_s: NotNegative | None = None
    shorter_s: NotNegative | None = None
    rest_longer_s: NotNegative | None = None
    rest_after_longer_s: NotNegative | None = None
    played_longer_s: NotNegative | None = None
    accent: Fraction01 | None = None
    leap_up: NotNegative | None = None
    leap_down: NotNegative | None = None
    place: tuple[Place, ...] = ()
    styles: tuple[str, ...] = ()
    not_styles: tuple[str, ...] = ()
    habits: tuple[str, ...] = ()
    chance: Fraction01 = 1.0
    effort_above: Fraction01 | None = None
    moment: Moment | None = None


class Do(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Effect of a rule.

    Attributes
    ----------
    expression, gesture : str
        Name of an expression or of a gesture.
    strength : float
        Strength of the expression, or size of the gesture.
    grows_with : str, tuple of str or None
        Quantity with which the strength grows to its maximum; several are combined by their geometric mean.
    grows_from : float
        Share of the strength at the limit of the condition.
    scaled_by : str or None
        ``"puff"``: multiplied by the amount of air that the instrument lets into the cheeks.
    start, end : str
        Onset or end of the note, from which the offsets count.
    start_s, end_s : float
        Offsets in seconds. A gesture without an end has its own duration.
    spread_s : float
        Greatest random delay in seconds of a gesture by player, place and seed, so that players are not simultaneous.
    fade_in_s, fade_out_s : float or None
        Fades of an expression; None for its own.
    stays_s : float
        Additional duration in seconds of an expression, limited by the rule's next one.
    """

    expression: str = ""
    gesture: str = ""
    strength: Fraction01 = 1.0
    grows_with: Growth | tuple[Growth, ...] | None = None
    grows_from: Fraction01 = 0.2
    scaled_by: Literal["puff"] | None = None
    start: Anchor = "onset"
    start_s: Offset = 0.0
    end: Anchor = "end"
    end_s: Offset | None = None
    spread_s: NotNegative = 0.0
    fade_in_s: Positive | None = None
    fade_out_s: Positive | None = None
    stays_s: NotNegative = 0.0

    @property
    def growth(self) -> tuple[Growth, ...]:
        """All quantities of the music with which the strength grows; empty if the strength is constant."""
        if self.grows_with is None:
            return ()
        return (self.grows_with,) if isinstance(self.grows_with, str) else self.grows_with


class Rule(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A rule of acting: conditions (`When`) and an effect (`Do`).

    Attributes
    ----------
    apart_s : float
        Least time in seconds between two effects; expressions closer than this are joined.
    title : Title
        Title in lists; by default its name.
    enabled : bool
        Whether it has an effect.
    events : str
        Name of its events in the corrections of a piece; empty for ``rule:`` and its name. An event with another name
        stays beside manual events.
    """

    name: str
    when: When
    do: Do
    apart_s: NotNegative = 0.35
    title: Title = Title("")
    enabled: bool = True
    events: str = ""

    @property
    def prefix(self) -> str:
        """Second part of the ids of the rule's events, after the kind of event."""
        return self.events or f"rule:{self.name}"


class RuleSet(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """All rules in one file."""

    name: str
    description: str
    rules: tuple[Rule, ...]


def read_rules(path: Path) -> RuleSet:
    """Read and check a file of rules. Raises FileError, MapError."""
    found = decoded(path, RuleSet)
    check_name(path, found.name)
    if len(found.rules) > MOST_RULES:
        raise invalid(path, "rules", f"at most {MOST_RULES}")
    seen: set[str] = set()
    for index, rule in enumerate(found.rules):
        place = f"rules[{index}]"
        if rule.name in seen:
            raise invalid(path, f"{place}.name", f"{rule.name!r} appears twice")
        seen.add(rule.name)
        for fault in rule_faults(rule):
            raise invalid(path, f"{place}.{fault.key}", fault.detail)
    return found


class RuleFault(NamedTuple):
    """A fault in a rule: the wrong key, the kind of fault, the requirement, and the growth that it concerns."""

    key: str
    code: str
    detail: str
    growth: str = ""


def rule_faults(rule: Rule) -> Iterator[RuleFault]:
    """Yield every error in a rule with the key that it concerns."""
    if not rule.name.isidentifier():
        yield RuleFault("name", "name", f"{rule.name!r} must be letters, digits and underscores")
    if rule.events and not rule.events.isidentifier():
        yield RuleFault("events", "name", f"{rule.events!r} must be letters, digits and underscores")
    if bool(rule.do.expression) == bool(rule.do.gesture):
        yield RuleFault("do", "do", "must have an expression or a gesture, and not both")
    if rule.do.gesture and (rule.do.fade_in_s or rule.do.fade_out_s):
        yield RuleFault("do.fade_in_s", "fades", "a gesture has its fades in its keys")
    if rule.do.gesture and rule.do.stays_s:
        yield RuleFault("do.stays_s", "stays", "a gesture ends when it is done")
    if rule.do.gesture and rule.when.moment is not None:
        yield RuleFault("when.moment", "moment", "is for expressions; say of a gesture where the note is")
    if rule.when.moment is not None and rule.do.growth:
        yield RuleFault("do.grows_with", "growth_at_moment", "has nothing to grow with at a moment")
    for grows in rule.do.growth:
        needed = GROWS_FROM.get(grows)
        if needed is not None and getattr(rule.when, needed) is None:
            yield RuleFault("do.grows_with", "growth", f"{grows!r} needs when.{needed}", grows)
    if rule.when == When():
        yield RuleFault("when", "when", "must say when")


GROWS_FROM: Final[Mapping[Growth, str]] = {
    "loudness": "loudness_above",
    "height": "semitones_above_easy",
    "depth": "semitones_below_easy",
    "length": "longer_s",
    "effort": "effort_above",
}
"""Condition from which a strength grows, by the quantity that it grows with."""


# Created while the import lock is held, as in `metadata.load`.
msgspec.json.Decoder(RuleSet)
