"""Parameters of a performer: each is declared once, where it is a field.

Its type, name and default are the field's; all else is said by the `Parameter` in its annotation. Sliders and lists of
choices, ``--set``, checks, presets, randomising, the history, older files and what is made again after a change follow
from that. Its texts are ids of `app.messages.parameters`.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import KW_ONLY, dataclass, replace
from typing import Annotated, Any, Final, Literal, TypeAlias, get_args, get_origin, get_type_hints

import msgspec

from metadata.acting import AMOUNTS, SECTION_PLAYER, as_text, names_in

Bounds: TypeAlias = tuple[float, float]
"""Lowest and highest, both allowed."""
Value: TypeAlias = str | int | float | bool | None
Decided: TypeAlias = Literal["breaths", "cues", "lips", "poses", "gestures", "rules", "motion"]
"""Step of the plan that a parameter decides, or the look of a plan."""

SEED: Final = (0, 2**63 - 1)
AUTOMATIC: Final = "auto"
"""None as a text."""
NONE: Final = "none"
"""No names, as a text."""


@dataclass(frozen=True)
class Parameter:
    """Declaration of a parameter.

    Attributes
    ----------
    label, tip, unit : str
        Ids of texts; empty: none.
    bounds : (low, high) or None
        None: its type alone bounds it.
    usual : float or None
        The control fills up to here, more can be typed; None: up to the highest value.
    step : float
        Of the control.
    choices : tuple of (value, word)
        A list instead of a slider; the words are ids of texts.
    names : tuple of str
        A text may hold any of these, with commas between them.
    section : str
        Which part of the panel shows it; empty: something else than a slider or a plain list does.
    row : int
        Rows of higher numbers stand lower in the section; those of the same follow the fields.
    decides : frozenset of Decided
        What has to be made again after a change.
    spread : float
        How far from the ensemble's middle the players differ when they are randomised with a spread of 1; 0: they are
        not.
    is_own : bool
        It makes one player differ from the others, and is in no preset.
    since : int
        The first version of project files that has it.
    before : Value or UNSET
        What files of earlier versions mean; by default its default.
    name, kind, default
        Of the field.
    """

    label: str
    tip: str = ""
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
    before: Value | msgspec.UnsetType = msgspec.UNSET
    name: str = ""
    kind: Any = None
    default: Any = None

    @property
    def words(self) -> tuple[str, ...]:
        """Every text that the user may see."""
        return tuple(filter(None, (self.label, self.tip, self.unit, *(word for _, word in self.choices))))

    @property
    def in_older_files(self) -> Value:
        """Value for files without it."""
        value: Value = self.default if self.before is msgspec.UNSET else self.before
        return value

    @property
    def possible(self) -> str:
        """Possible values as a text for a message: numbers and words only."""
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
        """Return whether it may have this value."""
        try:
            msgspec.convert(value, self.kind)
        except msgspec.ValidationError:
            return False
        if self.names and not set(names_in(str(value))) <= set(self.names):
            return False
        return not _is_number(value) or self.held(value) == value

    def held(self, value: Any) -> Any:
        """A number within the bounds and of the right type; another value as it is."""
        if self.bounds is None or not _is_number(value):
            return value
        low, high = self.bounds
        return self.kind(min(max(value, low), high))

    def read(self, text: str) -> Value:
        """The value that a text means. Raises ValueError where it is not possible."""
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


def declared(struct: type[msgspec.Struct]) -> dict[str, Parameter]:
    """The parameters of a struct by name, in the order of its fields."""
    found = {}
    hints = get_type_hints(struct, include_extras=True)
    for field in msgspec.structs.fields(struct):
        hint = hints[field.name]
        kind, *said = get_args(hint) if get_origin(hint) is Annotated else (hint,)
        for parameter in said:
            if isinstance(parameter, Parameter):
                found[field.name] = replace(parameter, name=field.name, kind=kind, default=field.default)
    return found


_SHARE: Final = (0.0, 1.0)
_NATURAL: Final = (0.0, 2.0)
"""Limits of multiples of the natural amount."""
_BEATS: Final = (0.0, 64.0)
_BREATHS: Final[frozenset[Decided]] = frozenset({"breaths"})


class PlayerParameters(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Parameters of one player; every field is a `--set` parameter by its name."""

    # fmt: off
    amplitude: Annotated[float, Parameter(
        "parameter.amplitude", "parameter.amplitude_tip",
        bounds=_SHARE, section="motion", spread=0.5,
    )] = 0.5
    breath_min_beats: Annotated[float, Parameter(
        "parameter.breath_min_beats", "parameter.breath_min_beats_tip", "unit.beats",
        bounds=_BEATS, usual=4.0, step=0.25, section="breath", decides=_BREATHS,
    )] = 0.5
    breath_last_beat_beats: Annotated[float, Parameter(
        "parameter.breath_last_beat_beats",
        "parameter.breath_last_beat_beats_tip", "unit.beats",
        bounds=_BEATS, usual=8.0, step=0.25, section="breath", decides=_BREATHS,
    )] = 1.0
    breath_prepare_beats: Annotated[float, Parameter(
        "parameter.breath_prepare_beats",
        "parameter.breath_prepare_beats_tip", "unit.beats",
        bounds=_BEATS, usual=8.0, step=0.25, section="breath", decides=_BREATHS,
    )] = 2.0
    lung_s: Annotated[float, Parameter(
        "parameter.lung_s",
        "parameter.lung_s_tip", "unit.seconds",
        bounds=(1.0, 60.0), usual=20.0, step=0.5, decimals=1,
        section="breath", row=1, decides=_BREATHS, spread=4.0,
    )] = 9.0
    embouchure_tension: Annotated[float, Parameter(
        "parameter.embouchure_tension", "parameter.embouchure_tension_tip", "unit.times",
        bounds=_NATURAL, section="face", decides=frozenset({"lips", "motion"}), spread=0.5,
    )] = 1.0
    sway: Annotated[float, Parameter(
        "parameter.sway", "parameter.sway_tip", "unit.times",
        bounds=_NATURAL, section="motion", spread=1.0,
    )] = 1.0
    weight_shift: Annotated[float, Parameter(
        "parameter.weight_shift", "parameter.weight_shift_tip", "unit.times",
        bounds=_NATURAL, section="motion", spread=1.0,
    )] = 1.0
    bell_height: Annotated[float, Parameter(
        "parameter.bell_height", "parameter.bell_height_tip", "unit.times",
        bounds=_NATURAL, section="motion", spread=1.0,
    )] = 1.0
    posture: Annotated[Literal["standing", "seated"], Parameter(
        "parameter.posture", choices=(("standing", "choice.standing"), ("seated", "choice.seated")),
        section="player", decides=frozenset({"poses", "motion"}),
    )] = "standing"
    cue_leader: Annotated[bool | None, Parameter(
        "parameter.cue_leader", choices=((None, "choice.automatic"), (True, "choice.yes"), (False, "choice.never")),
        section="player", decides=frozenset({"cues"}), is_own=True,
    )] = None
    """None: the piece decides (the highest part that plays first leads)."""
    seed: Annotated[int, Parameter(
        "parameter.seed", "parameter.seed_tip",
        bounds=SEED, section="motion", row=2, decides=frozenset({"breaths", "motion"}), is_own=True,
    )] = 0
    breath_need: Annotated[float, Parameter(
        "parameter.breath_need",
        "parameter.breath_need_tip",
        bounds=_SHARE, section="breath", decides=_BREATHS, since=6, before=0.0,
    )] = 0.35
    """Scale of the playing and the air that a rest needs to be breathed in (`app.plan.breath.rests_for_breath`); 0:
    every rest is breathed in (T6), 1: only when out of air."""
    circular_breathing: Annotated[bool, Parameter(
        "parameter.circular_breathing",
        "parameter.circular_breathing_tip",
        choices=((False, "choice.no"), (True, "choice.yes")), section="breath", row=2, decides=_BREATHS,
    )] = False
    choreography: Annotated[str, Parameter(
        "parameter.choreography", "parameter.choreography_tip",
        section="motion", row=1, since=8,
    )] = ""
    """Dance of hips, trunk and head while playing: the name of a bundled choreography or the absolute path of a
    ``.choreography`` file; empty: they move as is generated."""
    dance_amount: Annotated[float, Parameter(
        "parameter.dance_amount",
        "parameter.dance_amount_tip",
        bounds=_SHARE, section="dance", since=8,
    )] = 0.5
    dance_variation: Annotated[int, Parameter(
        "parameter.dance_variation",
        "parameter.dance_variation_tip",
        bounds=SEED, section="dance", is_own=True, since=8,
    )] = 0
    """Another one is another dance to the same music, the same for everyone who has it; 0: a dance of the player's own,
    by ``seed``."""
    style: Annotated[str, Parameter(
        "parameter.style", "parameter.style_tip",
        section="acting", row=-1, decides=frozenset({"rules", "motion"}), since=10,
    )] = SECTION_PLAYER
    """Name of a table of ``metadata/styles`` or of the user's own."""
    habits: Annotated[str, Parameter(
        "parameter.habits", "parameter.habits_tip",
        section="acting", row=-1, decides=frozenset({"rules", "motion"}), since=10,
    )] = ""
    """Names of tables of ``metadata/habits`` or of the user's own, with commas between them."""
    phrase_motion: Annotated[float, Parameter(
        "parameter.phrase_motion", "parameter.phrase_motion_tip", "unit.times",
        bounds=_NATURAL, section="acting", spread=0.5, since=10,
    )] = 1.0
    stillness: Annotated[float, Parameter(
        "parameter.stillness", "parameter.stillness_tip", "unit.times",
        bounds=_NATURAL, section="acting", spread=0.5, decides=frozenset({"gestures", "motion"}), since=10,
    )] = 1.0
    footwork: Annotated[float, Parameter(
        "parameter.footwork", "parameter.footwork_tip", "unit.times",
        bounds=_NATURAL, section="acting", spread=0.5, since=10,
    )] = 1.0
    toe_taps: Annotated[float, Parameter(
        "parameter.toe_taps", "parameter.toe_taps_tip", "unit.times",
        bounds=_NATURAL, section="acting", spread=0.5, decides=frozenset({"gestures", "motion"}), since=10,
    )] = 1.0
    breath_motion: Annotated[float, Parameter(
        "parameter.breath_motion", "parameter.breath_motion_tip", "unit.times",
        bounds=_NATURAL, section="acting", spread=0.3, since=10,
    )] = 1.0
    cue_size: Annotated[float, Parameter(
        "parameter.cue_size", "parameter.cue_size_tip", "unit.times",
        bounds=_NATURAL, section="acting", spread=0.3, since=10,
    )] = 1.0
    face_intensity: Annotated[float, Parameter(
        "parameter.face_intensity", "parameter.face_intensity_tip", "unit.times",
        bounds=_NATURAL, section="acting", spread=0.5, since=10,
    )] = 1.0
    lip_motion: Annotated[float, Parameter(
        "parameter.lip_motion", "parameter.lip_motion_tip", "unit.times",
        bounds=_NATURAL, section="acting", spread=0.3, since=10,
    )] = 1.0
    gaze: Annotated[float, Parameter(
        "parameter.gaze", "parameter.gaze_tip", "unit.times",
        bounds=_NATURAL, section="acting", spread=0.5, since=10,
    )] = 1.0
    blinks: Annotated[float, Parameter(
        "parameter.blinks", "parameter.blinks_tip", "unit.times",
        bounds=_NATURAL, section="acting", spread=0.3, since=10,
    )] = 1.0
    gestures: Annotated[float, Parameter(
        "parameter.gestures", "parameter.gestures_tip", "unit.times",
        bounds=_NATURAL, section="acting", spread=0.5, since=10,
    )] = 1.0
    layers_off: Annotated[str, Parameter(
        "parameter.layers_off", "parameter.layers_off_tip",
        names=AMOUNTS, decides=frozenset({"gestures", "motion"}), since=13,
    )] = ""
    """Amounts whose layers are not shown, whatever they are, with commas between them."""
    # fmt: on


PARAMETERS: Final[Mapping[str, Parameter]] = declared(PlayerParameters)
"""Every parameter of a player by name."""
_DECIDING: Final = {
    kind: tuple(name for name, parameter in PARAMETERS.items() if kind in parameter.decides)
    for kind in get_args(Decided)
}


def parameters_deciding(parameters: PlayerParameters, kind: Decided) -> PlayerParameters:
    """Return those parameters that decide this; the others have their defaults."""
    return PlayerParameters(**{name: getattr(parameters, name) for name in _DECIDING[kind]})


def deciding_values(parameters: PlayerParameters, *kinds: Decided) -> tuple[Value, ...]:
    """The values of those parameters that decide any of this: equal ones give the same."""
    return tuple(getattr(parameters, name) for kind in kinds for name in _DECIDING[kind])
