"""Contents of an instrument map: frozen records, one per table of the TOML file.

A map contains everything that the program uses about an instrument: *nodes* (the named moving parts of the model),
*controls* (parts that a player moves), *contacts* (parts of hands that touch nodes) and *fingerings* (controls for each
note). No other code depends on the identity of an instrument.

Frames
------
The root frame of a model has its origin in the centre of the mouthpiece's rim plane, +Z along the air
stream, +Y up as played and +X to the player's left; metres. The frame of a moving node is that of the
node at rest and moves with it: a point given in the frame of ``valve_1`` goes down with the valve.
At rest the frames of all nodes of a model differ from the root's by a translation only.
"""

from __future__ import annotations

from typing import Literal, NamedTuple, TypeAlias

from instrument_maps.hold import Contact, HandSeed, Hold, Proxy
from instrument_maps.map_table import MapTable, Vector
from instrument_maps.wind import Acoustics, Air, Embouchure, Mouthpiece, Stopped, Water

SCHEMA_VERSION = 1
"""Version of the schema; a file with another number is refused."""

ROOT = "root"
"""Name of the node for the instrument itself."""


FINGERS = ("thumb", "index", "middle", "ring", "little")
PLACES = ("pad", "side", "pad_middle", "side_middle", "pad_proximal", "side_proximal")
PARTS = frozenset(
    f"{hand}.{part}"
    for hand in ("left", "right")
    for part in (*(f"{finger}.{place}" for finger in FINGERS for place in PLACES), "palm", "thumb_web")
) - {f"{hand}.thumb.{place}_proximal" for hand in ("left", "right") for place in ("pad", "side")}
"""Body landmarks for contacts: ``right.index.pad`` (of the last phalanx), ``left.ring.pad_middle`` (of the one before
it), ``left.index.side_proximal`` (of the first; a thumb has only two outside the palm), ``left.palm``.
"""

MOVERS = frozenset(f"{hand}.{mover}" for hand in ("left", "right") for mover in (*FINGERS, "hand"))
"""Movers of a control: a finger, or a whole hand (a playing slide)."""


class InstrumentName(MapTable, frozen=True):
    """Name of the instrument by language (BCP 47 primary tags that the program supports)."""

    en: str
    ja: str


class Range(MapTable, frozen=True):
    """Range of the instrument as concert MIDI pitches, both ends inclusive.

    ``low``..``high`` is the range of the fingering table; in ``easy_low``..``easy_high`` the embouchure is neither
    completely relaxed nor tight. ``usual_low``..``usual_high`` is the range without pedal tones and altissimo, by which
    an instrument is chosen for a part; None for that of the table.
    """

    low: int
    high: int
    easy_low: int
    easy_high: int
    usual_low: int | None = None
    usual_high: int | None = None

    @property
    def usual(self) -> tuple[int, int]:
        """Lowest and highest pitch without pedal tones and altissimo."""
        low = self.low if self.usual_low is None else self.usual_low
        return low, self.high if self.usual_high is None else self.usual_high


class ControlMotion(MapTable, frozen=True):
    """Motion of a node while its control moves from 0 to 1, in the root frame.

    Either a translation (``axis`` and ``travel_m``) or a rotation about ``pivot_m`` (a point in the root
    frame; ``axis`` and ``angle_rad``, right-handed).
    """

    axis: Vector
    travel_m: float | None = None
    angle_rad: float | None = None
    pivot_m: Vector | None = None


ControlKind: TypeAlias = Literal["press", "lever", "slide", "key", "hole"]


class Control(MapTable, frozen=True):
    """A part moved by the player: a valve, a slide, a lever, a key; or a hole covered by a finger.

    Attributes
    ----------
    name : str
        Unique name; also that of the bone in an exported file.
    kind : str
        ``"press"`` goes down under a finger, ``"lever"`` turns under one, ``"slide"`` is pushed and pulled; ``"key"``
        is a woodwind's key, ``"hole"`` a hole that the finger itself closes (with or without a ring that goes down).
    role : str
        ``"pitch"``: part of fingerings. ``"intonation"``: corrects a note of sufficient length.
    finger : str
        Finger or hand that moves it, one of `MOVERS`.
    node : str or None
        Moved node of the model; None for a hole without a moving part.
    motion : ControlMotion or None
        Motion of the node; None exactly if ``node`` is None.
    label : str
        Sign in the label of a fingering (``"1"``, ``"T"``, ``"L1"``); empty for a slide, whose position is the label,
        or if there is none.
    half_value : float or None
        Value 0..1 of a half-closed hole. Its sign then has the suffix ``"h"``.
    hover_m : float
        Height of a waiting finger over its key or hole; 0 if it stays on it (a valve).
    rest_value : float
        Value at rest, 0..1.
    move_window_s : float
        Greatest time in seconds before the next onset at which it starts to move.
    move_note_share : float
        Greatest share of the sounding note before it for moving.
    max_speed_m_s : float or None
        Speed that limits a control with a long way (a slide): the window is then at least distance / speed.
    unhurried_speed_m_s : float or None
        Speed of such a control if the previous note leaves enough time: its move then takes distance / speed, with a
        maximum of 15/8 of that (`app.motion.curves.curve.minimum_jerk`).
    used_with : tuple of str
        Intonation only: labels of the fingerings that it corrects.
    held_min_s : float or None
        Intonation only: least duration of a corrected note in seconds.
    attack_s : float or None
        Time in seconds for which a fingering for attacks (tag ``attack``) uses it in longer notes; None for the whole
        note.
    """

    name: str
    kind: ControlKind
    role: Literal["pitch", "intonation"]
    finger: str
    node: str | None = None
    motion: ControlMotion | None = None
    label: str = ""
    half_value: float | None = None
    hover_m: float = 0.0
    rest_value: float = 0.0
    move_window_s: float = 0.06
    move_note_share: float = 0.4
    max_speed_m_s: float | None = None
    unhurried_speed_m_s: float | None = None
    used_with: tuple[str, ...] = ()
    held_min_s: float | None = None
    attack_s: float | None = None

    @property
    def travel_m(self) -> float:
        """Distance in metres over which the control's node moves from 0 to 1; 0 if it rotates or does not move."""
        return 0.0 if self.motion is None or self.motion.travel_m is None else self.motion.travel_m


class Link(MapTable, frozen=True):
    """A part moved by other controls: the pad closed by a key's rod far from the finger, the ring of a neighbouring
    hole.

    Attributes
    ----------
    node : str
        Moved node of the model; not the node of a control.
    motion : ControlMotion
        Motion of the node.
    controls : tuple of str
        Names of the controls that move it.
    when : str
        ``"any"``: by the greatest of their values. ``"all"``: by the least.
    """

    node: str
    motion: ControlMotion
    controls: tuple[str, ...]
    when: Literal["any", "all"] = "any"


class Endpin(MapTable, frozen=True):
    """The pin on which an instrument stands on the floor, with adjustable length.

    Attributes
    ----------
    node : str
        Sliding node of the model, pushed in at rest.
    axis : vector
        Direction in which the pin is drawn out, in the root frame.
    tip_m : vector
        Tip at rest in the root frame.
    most_m : float
        Greatest length in metres by which it can be drawn out.
    """

    node: str
    axis: Vector
    tip_m: Vector
    most_m: float


class MovingPart(NamedTuple):
    """A node of the instrument's model that moves, such as a key or slide.

    ``name`` is that of its bone in a file: the control's name, or the node's own for a link and an endpin, which moves
    by a value of its own name.
    """

    name: str
    node: str
    motion: ControlMotion
    controls: tuple[str, ...]
    when: Literal["any", "all"] = "any"


class ChartKey(MapTable, frozen=True):
    """A control's name for players, and its place in a fingering chart.

    Attributes
    ----------
    name : str
        Name of the control.
    en, ja : str
        English and Japanese name for players, unique among the instrument's controls.
    sign : str
        A few letters shown on its symbol.
    at : (float, float) or None
        Centre in units of holes from the left hand's first, to the right and down; None for the place of its finger.
    round : bool
        Drawn as a hole and not as a key.
    """

    name: str
    en: str
    ja: str
    sign: str = ""
    at: tuple[float, float] | None = None
    round: bool = False


class Fingering(MapTable, frozen=True):
    """One way to play one written note.

    Attributes
    ----------
    written_pitch : int
        Written MIDI pitch.
    rank : int
        1 = first choice; alternates count on without gaps.
    label : str
        Usual short form: ``"0"``, ``"13"``, ``"T12"``; for a slide ``"1"``..``"7"``, ``"T1"``; for keys and holes their
        sorted signs with spaces, ``"(open)"`` for none.
    controls : dict of str to float
        Value 0..1 of every pitch control that is not at rest. A file may omit it if the label determines it.
    fingers : dict of str to str
        Controls worked by another finger than usual, and that finger.
    cents : float
        Deviation of the note from equal temperament when blown normally, including the effect of ``controls``.
    correction : dict of str to float
        Values of the intonation controls for a held note.
    tags : tuple of str
        Reasons for using it: ``"trill"``, ``"fast"``, ``"raised"`` and so on; ``"obsolete"`` marks an alternate that
        earlier versions had by mistake, which is only used by old projects in which it was pinned.
    """

    written_pitch: int
    rank: int
    label: str
    controls: dict[str, float] = {}
    cents: float = 0.0
    correction: dict[str, float] = {}
    fingers: dict[str, str] = {}
    tags: tuple[str, ...] = ()

    @property
    def is_obsolete(self) -> bool:
        """True if the fingering exists only because corrections in old projects refer to it; never true for a first
        choice.
        """
        return self.rank > 1 and "obsolete" in self.tags


class InstrumentMap(MapTable, frozen=True):
    """One instrument as described in its file.

    Attributes
    ----------
    schema_version : int
        Version of the file format, `SCHEMA_VERSION`.
    id : str
        Id, equal to the file name without suffix.
    name : InstrumentName
        Name for users, in English and Japanese.
    short_name : str
        Short name for file names and narrow columns.
    plays : tuple of str
        Ids of the instrument vocabulary whose parts this instrument plays.
    substitutes_for : tuple of str
        Ids for which it is a substitute if they have no map of their own.
    transposition_semitones : int
        Written minus concert pitch.
    range : Range
        Range in concert pitches.
    model : str
        File name of the glTF binary.
    clef : str
        Clef of its parts.
    breaks : tuple of int
        Written pitches at which a new register begins; a line crosses the break between such a note and the one below.
    air : Air or None
        Duration of a breath on the instrument; None if the body alone determines it.
    water : Water or None
        Letting out of water; None if it is not visible.
    stopped : Stopped or None
        Notes with the hand in the bell; None if there are none.
    chart : tuple of ChartKey
        Names and places of the controls in the order of labels.
    fingerings : tuple of Fingering
        Fingerings sorted by written pitch and rank.
    size : float
        Size relative to its file and model (`instrument_maps.size.scaled`); never in a file.
    """

    schema_version: int
    id: str
    name: InstrumentName
    short_name: str
    plays: tuple[str, ...]
    transposition_semitones: int
    range: Range
    model: str
    embouchure: Embouchure
    mouthpiece: Mouthpiece
    controls: tuple[Control, ...]
    contacts: tuple[Contact, ...]
    hands: tuple[HandSeed, ...]
    proxy: tuple[Proxy, ...]
    hold: Hold
    fingerings: tuple[Fingering, ...]
    substitutes_for: tuple[str, ...] = ()
    clef: Literal["treble", "bass", "alto", "tenor"] = "treble"
    links: tuple[Link, ...] = ()
    endpin: Endpin | None = None
    breaks: tuple[int, ...] = ()
    air: Air | None = None
    water: Water | None = None
    stopped: Stopped | None = None
    acoustics: Acoustics | None = None
    sources: tuple[str, ...] = ()
    chart: tuple[ChartKey, ...] = ()
    size: float = 1.0

    def control(self, name: str) -> Control:
        """Return the control with a name. Raises KeyError if there is none."""
        for control in self.controls:
            if control.name == name:
                return control
        raise KeyError(name)

    @property
    def moving_parts(self) -> tuple[MovingPart, ...]:
        """Return the moving parts of the model: those of controls, those linked to controls, and the endpin."""
        own = [
            MovingPart(control.name, control.node, control.motion, (control.name,))
            for control in self.controls
            if control.node is not None and control.motion is not None
        ]
        along = [MovingPart(link.node, link.node, link.motion, link.controls, link.when) for link in self.links]
        pin = self.endpin
        if pin is None:
            return (*own, *along)
        return (*own, *along, MovingPart(pin.node, pin.node, ControlMotion(pin.axis, travel_m=pin.most_m), (pin.node,)))

    @property
    def nodes(self) -> tuple[str, ...]:
        """Names of the model's nodes that `moving_parts` move, in the same order."""
        return tuple(part.node for part in self.moving_parts)

    def in_range(self, concert_pitch: int) -> bool:
        """Return whether the table has fingerings for a concert pitch."""
        return self.range.low <= concert_pitch <= self.range.high

    def nearest_playable(self, concert_pitch: int) -> int:
        """Return the concert pitch if it is in the range, else the nearest end of the range."""
        return min(max(concert_pitch, self.range.low), self.range.high)

    def fingerings_for(self, concert_pitch: int) -> tuple[Fingering, ...]:
        """Return the fingerings of a concert pitch (MIDI number), the preferred one first.

        For a pitch out of range, those of `nearest_playable`. Never empty for a valid map.
        """
        written = self.nearest_playable(concert_pitch) + self.transposition_semitones
        return tuple(fingering for fingering in self.fingerings if fingering.written_pitch == written)

    def offered_for(self, concert_pitch: int, shown: str) -> tuple[Fingering, ...]:
        """Return the fingerings of a concert pitch that a user may choose, without obsolete ones except for the label
        ``shown``.
        """
        every = self.fingerings_for(concert_pitch)
        return tuple(item for item in every if not item.is_obsolete or item.label == shown)

    def values(self, fingering: Fingering, *, held: bool = False) -> dict[str, float]:
        """Return the value 0..1 of every control in a fingering; ``held`` adds the tuning corrections for a
        held note.
        """
        chosen = {**fingering.controls, **(fingering.correction if held else {})}
        return {control.name: chosen.get(control.name, control.rest_value) for control in self.controls}
