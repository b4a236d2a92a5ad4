"""Parameters of a performer, each declared once as a field.

Type, name and default are the field's; everything else is in the `Parameter` of its annotation. Sliders, choice lists,
``--set``, checks, presets, randomising, the history, migration and partial recomputation are derived from that. Texts
are ids of `app.messages.parameters`.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import KW_ONLY, dataclass, replace
from typing import Annotated, Any, Final, Literal, TypeAlias, get_args, get_origin, get_type_hints

import msgspec

from metadata.acting import AMOUNTS, SECTION_PLAYER, as_text, names_in

Bounds: TypeAlias = tuple[float, float]
"""Lowest and highest value, both allowed."""
Value: TypeAlias = str | int | float | bool | None
Decided: TypeAlias = Literal["breaths", "cues", "lips", "poses", "gestures", "rules", "motion"]
"""Step of the plan that a parameter influences, or the appearance of a plan."""

SEED: Final = (0, 2**63 - 1)
AUTOMATIC: Final = "auto"
"""Text of a value that is chosen automatically."""
NONE: Final = "none"
"""Text of an empty list of names."""


@dataclass(frozen=True)
class Parameter:
    """Declaration of a parameter.

    Attributes
    ----------
    unit : str
        Text id of the unit; empty: none.
    bounds : (low, high) or None
        Lowest and highest value; None: limited only by its type.
    usual : float or None
        Upper end of the slider, beyond which values can be typed; None: the highest value.
    step : float
        Step of the slider or number field.
    choices : tuple of (value, word)
        A list instead of a slider; the words are ids of texts.
    names : tuple of str
        Allowed words of a text that is a comma-separated list.
    section : str
        Section of the panel; empty: shown by a special control instead of a slider or list.
    row : int
        Row within the section; higher numbers are lower, equal ones keep the order of the fields.
    decides : frozenset of Decided
        Results that must be recomputed after a change.
    spread : float
        Deviation of players from the ensemble's mean when they are randomised with a spread of 1; 0: not randomised.
    is_own : bool
        Whether it distinguishes one player from the others, and so is not in presets.
    since : int
        First version of project files that has it.
    in_older_files : Value
        Value for files without it; by default its default.
    has_tip : bool
        Whether it has an explaining text.
    texts : str
        First part of its text ids.
    name, kind, default
        Name, type and default value of the field that declares the parameter.
    """

    unit: str = ""
    _: KW_ONLY
    bounds: Bounds | None = None
    usual: float | None = None
    step: float = 0.05
    decimals: int = 2
    choices: tuple[tuple[Value, str], ...] = ()
    names: tuple[str, ...] = ()
    section: str = ""
    row: int = 0
    decides: frozenset[Decided] = frozenset({"motion"})
    spread: float = 0.0
    is_own: bool = False
    since: int = 1
    in_older_files: Any = msgspec.UNSET
    has_tip: bool = True
    texts: str = ""
    name: str = ""
    kind: Any = None
    default: Any = None

    @property
    def label(self) -> str:
        """Text id of the parameter's name."""
        return f"{self.texts}.{self.name}"

    @property
    def tip(self) -> str:
        """Text id of the parameter's explanation; empty if there is none."""
        return f"{self.label}_tip" if self.has_tip else ""

    @property
    def words(self) -> tuple[str, ...]:
        """Ids of all texts about the parameter that the user may see: label, tip, unit and choices."""
        return tuple(filter(None, (self.label, self.tip, self.unit, *(word for _, word in self.choices))))

    @property
    def possible(self) -> str:
        """Possible values of the parameter as text for an error message: numbers and words."""
        if self.bounds is not None:
            return f"{self.bounds[0]} ... {self.bounds[1]}"
        options = [NONE, *self.names] if self.names else []
        for kind in get_args(self.kind) or (self.kind,):
            if isinstance(kind, str):
                options.append(kind)
            elif kind is bool:
                options += ["true", "false"]
            elif kind is type(None):
                options.append(AUTOMATIC)
        return ", ".join(options)

    def allows(self, value: object) -> bool:
        """Return whether a value has the type of the parameter and is within its bounds."""
        try:
            msgspec.convert(value, self.kind)
        except msgspec.ValidationError:
            return False
        if self.names and not set(names_in(str(value))) <= set(self.names):
            return False
        return not _is_number(value) or self.held(value) == value

    def held(self, value: Any) -> Any:
        """Clip a value to the parameter's bounds; values of another type are returned unchanged."""
        if self.bounds is None or not _is_number(value):
            return value
        low, high = self.bounds
        return self.kind(min(max(value, low), high))

    def read(self, text: str) -> Value:
        """Parse a value of the parameter. Raises ValueError if the text is invalid."""
        if self.names:
            text = "" if text.casefold() in (AUTOMATIC, NONE) else as_text(names_in(text))
        try:
            value: Value = msgspec.convert(
                None if text.casefold() in (AUTOMATIC, NONE, "null") else text, self.kind, strict=False
            )
        except msgspec.ValidationError as error:
            raise ValueError(text) from error
        if not self.allows(value):
            raise ValueError(text)
        return value


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def declared(struct: type[msgspec.Struct], texts: str) -> dict[str, Parameter]:
    """Collect the parameters declared in the fields of a struct, by name in the order of the fields; ``texts`` as in
    `Parameter`.
    """
    found = {}
    hints = get_type_hints(struct, include_extras=True)
    for field in msgspec.structs.fields(struct):
        hint = hints[field.name]
        kind, *said = get_args(hint) if get_origin(hint) is Annotated else (hint,)
        for parameter in said:
            if isinstance(parameter, Parameter):
                found[field.name] = replace(
                    parameter,
                    texts=texts,
                    name=field.name,
                    kind=kind,
                    default=field.default,
                    in_older_files=field.default
                    if parameter.in_older_files is msgspec.UNSET
                    else parameter.in_older_files,
                )
    return found


_SHARE: Final = (0.0, 1.0)
_NATURAL: Final = (0.0, 2.0)
"""Limits of multiples of the natural amount."""
_BREATHS: Final[frozenset[Decided]] = frozenset({"breaths"})
_RULES: Final[frozenset[Decided]] = frozenset({"rules", "motion"})


def _times(section: str, spread: float, *also: Decided, since: int = 10) -> Parameter:
    """Declare a parameter that is a factor of a natural amount of motion; changes affect the motion and the results in
    ``also``.
    """
    decides = frozenset[Decided]({"motion", *also})
    return Parameter("unit.times", bounds=_NATURAL, section=section, spread=spread, decides=decides, since=since)


def _beats(usual: float) -> Parameter:
    """Declare a parameter that is a number of beats and affects breaths; ``usual`` is the upper end of its slider."""
    return Parameter("unit.beats", bounds=(0.0, 64.0), usual=usual, step=0.25, section="breath", decides=_BREATHS)


class PlayerParameters(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Parameters of one player; every field is a `--set` parameter by its name."""

    # fmt: off
    amplitude: Annotated[float, Parameter(bounds=_SHARE, section="motion", spread=0.5)] = 0.5
    breath_min_beats: Annotated[float, _beats(usual=4.0)] = 0.5
    breath_last_beat_beats: Annotated[float, _beats(usual=8.0)] = 1.0
    breath_prepare_beats: Annotated[float, _beats(usual=8.0)] = 2.0
    lung_s: Annotated[float, Parameter(
        "unit.seconds", bounds=(1.0, 60.0), usual=20.0, step=0.5, decimals=1,
        section="breath", row=1, decides=_BREATHS, spread=4.0,
    )] = 9.0
    embouchure_tension: Annotated[float, _times("face", 0.5, "lips", since=1)] = 1.0
    sway: Annotated[float, _times("motion", 1.0, since=1)] = 1.0
    weight_shift: Annotated[float, _times("motion", 1.0, since=1)] = 1.0
    bell_height: Annotated[float, _times("motion", 1.0, since=1)] = 1.0
    posture: Annotated[Literal["standing", "seated"], Parameter(
        choices=(("standing", "choice.standing"), ("seated", "choice.seated")), has_tip=False,
        section="player", decides=frozenset({"poses", "motion"}),
    )] = "standing"
    cue_leader: Annotated[bool | None, Parameter(
        choices=((None, "choice.automatic"), (True, "choice.yes"), (False, "choice.never")), has_tip=False,
        section="player", decides=frozenset({"cues"}), is_own=True,
    )] = None
    """Id of the player who gives cues; None for the highest part that plays first."""
    seed: Annotated[int, Parameter(
        bounds=SEED, section="motion", row=2, decides=frozenset({"breaths", "motion"}), is_own=True,
    )] = 0
    breath_need: Annotated[float, Parameter(
        bounds=_SHARE, section="breath", decides=_BREATHS, since=6, in_older_files=0.0,
    )] = 0.35
    """Factor of the playing and the air after which a player breathes in a rest (`app.plan.breath.rests_for_breath`);
    0: in every rest (T6), 1: only without air.
    """
    circular_breathing: Annotated[bool, Parameter(
        choices=((False, "choice.no"), (True, "choice.yes")), section="breath", row=2, decides=_BREATHS,
    )] = False
    choreography: Annotated[str, Parameter(section="motion", row=1, since=8)] = ""
    """Dance of hips, trunk and head while playing: name of a bundled choreography or absolute path of a
    ``.choreography`` file; empty for generated motion.
    """
    dance_amount: Annotated[float, Parameter(bounds=_SHARE, section="dance", since=8)] = 0.5
    dance_variation: Annotated[int, Parameter(bounds=SEED, section="dance", is_own=True, since=8)] = 0
    """Number of the dance, equal for all players with the same one; 0 for an individual dance by ``seed``."""
    style: Annotated[str, Parameter(section="acting", row=-1, decides=_RULES, since=10)] = SECTION_PLAYER
    """Name of a table of ``metadata/styles`` or of the user's styles."""
    habits: Annotated[str, Parameter(section="acting", row=-1, decides=_RULES, since=10)] = ""
    """Names of tables of ``metadata/habits`` or of the user's habits, separated by commas."""
    phrase_motion: Annotated[float, _times("acting", 0.5)] = 1.0
    stillness: Annotated[float, _times("acting", 0.5, "gestures")] = 1.0
    footwork: Annotated[float, _times("acting", 0.5)] = 1.0
    toe_taps: Annotated[float, _times("acting", 0.5, "gestures")] = 1.0
    breath_motion: Annotated[float, _times("acting", 0.3)] = 1.0
    cue_size: Annotated[float, _times("acting", 0.3)] = 1.0
    face_intensity: Annotated[float, _times("acting", 0.5)] = 1.0
    lip_motion: Annotated[float, _times("acting", 0.3)] = 1.0
    gaze: Annotated[float, _times("acting", 0.5)] = 1.0
    blinks: Annotated[float, _times("acting", 0.3)] = 1.0
    gestures: Annotated[float, _times("acting", 0.5)] = 1.0
    layers_off: Annotated[str, Parameter(names=AMOUNTS, decides=frozenset({"gestures", "motion"}), since=13)] = ""
    """Names of amounts whose layers are disabled regardless of their values, separated by commas."""
    # fmt: on


PARAMETERS: Final[Mapping[str, Parameter]] = declared(PlayerParameters, "parameter")
"""All parameters of a player by name."""
_DECIDING: Final = {
    kind: tuple(name for name, parameter in PARAMETERS.items() if kind in parameter.decides)
    for kind in get_args(Decided)
}


def parameters_deciding(parameters: PlayerParameters, kind: Decided) -> PlayerParameters:
    """Return a copy of the parameters in which those that do not affect the given kind of result have their
    defaults.
    """
    return PlayerParameters(**{name: getattr(parameters, name) for name in _DECIDING[kind]})


def deciding_values(parameters: PlayerParameters, *kinds: Decided) -> tuple[Value, ...]:
    """Return the values of those parameters that affect the given kinds of results; equal values give equal results."""
    return tuple(getattr(parameters, name) for kind in kinds for name in _DECIDING[kind])
