"""Contents of an instrument map: frozen records, one per table of the TOML file.

A map is everything the program knows about an instrument. It speaks of *nodes* (the named moving parts of
the model), *controls* (what a player moves), *contacts* (which part of which hand touches what) and
*fingerings* (which controls give which note). Code below and above asks the map and never asks which
instrument it is.

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
"""The schema these records describe; a file that says another number is refused."""

ROOT = "root"
"""Name of the node that stands for the instrument itself."""


FINGERS = ("thumb", "index", "middle", "ring", "little")
PLACES = ("pad", "side", "pad_middle", "side_middle", "pad_proximal", "side_proximal")
PARTS = frozenset(
    f"{hand}.{part}"
    for hand in ("left", "right")
    for part in (*(f"{finger}.{place}" for finger in FINGERS for place in PLACES), "palm", "thumb_web")
) - {f"{hand}.thumb.{place}_proximal" for hand in ("left", "right") for place in ("pad", "side")}
"""Body landmarks a contact may name: ``right.index.pad`` (of the last phalanx), ``left.ring.pad_middle`` (of the
one before it), ``left.index.side_proximal`` (of the first; a thumb has but two outside the palm), ``left.palm``."""

MOVERS = frozenset(f"{hand}.{mover}" for hand in ("left", "right") for mover in (*FINGERS, "hand"))
"""Movers of a control: a finger, or a whole hand (a playing slide)."""


class InstrumentName(MapTable, frozen=True):
    """Name of the instrument by language (BCP 47 primary tags that the program supports)."""

    en: str
    ja: str


class Range(MapTable, frozen=True):
    """Concert MIDI pitches, both ends inclusive.

    ``low``..``high`` is what the table of fingerings covers; ``easy_low``..``easy_high`` is where the
    embouchure is neither relaxed to its limit nor drawn tight. ``usual_low``..``usual_high`` is the range without
    pedal tones and altissimo, by which an instrument is chosen for a part; None: as far as the table goes.
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
    """Motion of a node while its control goes from 0 to 1, in the root frame.

    Either a translation (``axis`` and ``travel_m``) or a rotation about ``pivot_m`` (a point in the root
    frame; ``axis`` and ``angle_rad``, right-handed).
    """

    axis: Vector
    travel_m: float | None = None
    angle_rad: float | None = None
    pivot_m: Vector | None = None


ControlKind: TypeAlias = Literal["press", "lever", "slide", "key", "hole"]


class Control(MapTable, frozen=True):
    """Something the player moves: a valve, a slide, a lever, a key; or a hole a finger covers.

    Attributes
    ----------
    name : str
        Unique; also the bone's name in an exported file.
    kind : str
        ``"press"`` goes down under a finger, ``"lever"`` turns under one, ``"slide"`` is pushed and pulled; ``"key"``
        is a woodwind's key, ``"hole"`` a hole that the finger itself closes (with or without a ring that goes down).
    role : str
        ``"pitch"``: named by the fingerings. ``"intonation"``: corrects a note that is held long enough.
    finger : str
        What moves it, one of `MOVERS`.
    node : str or None
        The model's node it moves; None for a hole without a moving part.
    motion : ControlMotion or None
        How; None exactly where ``node`` is.
    label : str
        Its sign in the short form of a fingering (``"1"``, ``"T"``, ``"L1"``); empty where the place itself is the
        label (a slide) or where it has none.
    half_value : float or None
        A hole that may be half closed: its value then, 0..1. The label is then the hole's with ``"h"`` after it.
    hover_m : float
        How high over its key or hole a finger that plays nothing waits; 0 where it stays on it (a valve).
    rest_value : float
        Where it is when nothing is played, 0..1.
    move_window_s : float
        It leaves its place at most this long before the next onset ...
    move_note_share : float
        ... and at most this part of the sounding note before it.
    max_speed_m_s : float or None
        Where the distance decides (a slide): the window is then at least distance / speed.
    unhurried_speed_m_s : float or None
        Of such a control where the note before leaves it the time: its move then takes distance / speed, and its
        fastest moment is 15/8 of that (`app.motion.curves.curve.minimum_jerk`).
    used_with : tuple of str
        Intonation only: labels of the fingerings it corrects.
    held_min_s : float or None
        Intonation only: notes shorter than this are not corrected.
    attack_s : float or None
        How long a fingering for attacks (tag ``attack``) holds it, of longer notes; None: as long as the note.
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
        """Distance that its node is pushed or pulled; 0 if it turns or does not move."""
        return 0.0 if self.motion is None or self.motion.travel_m is None else self.motion.travel_m


class Link(MapTable, frozen=True):
    """A part that other controls move: the pad a key's rod closes far from the finger, the ring of a neighbouring hole.

    Attributes
    ----------
    node : str
        The model's node that moves along; not the node of a control.
    motion : ControlMotion
        How.
    controls : tuple of str
        Names of the controls that move it.
    when : str
        ``"any"``: it goes as far as the furthest of them. ``"all"``: as far as the least of them.
    """

    node: str
    motion: ControlMotion
    controls: tuple[str, ...]
    when: Literal["any", "all"] = "any"


class Endpin(MapTable, frozen=True):
    """The pin an instrument stands on the floor with, as long as its player needs it.

    Attributes
    ----------
    node : str
        The model's node that slides, pushed in at rest.
    axis : vector
        The way out, in the root frame.
    tip_m : vector
        Its tip at rest, in the root frame.
    most_m : float
        How far it can be drawn out.
    """

    node: str
    axis: Vector
    tip_m: Vector
    most_m: float


class MovingPart(NamedTuple):
    """A node of the model that moves, whatever moves it.

    ``name`` is its bone's in a file: the control's that moves it, or the node's own for a link and an endpin, which
    moves by a value of its own name.
    """

    name: str
    node: str
    motion: ControlMotion
    controls: tuple[str, ...]
    when: Literal["any", "all"] = "any"


class ChartKey(MapTable, frozen=True):
    """A control as players know it: its name, and its place in a drawn fingering.

    Attributes
    ----------
    name : str
        The control's.
    en, ja : str
        What it is called; no other control of the instrument is called so.
    sign : str
        A few letters that fit on its picture.
    at : (float, float) or None
        Its middle, counted in holes from the left hand's first, to the right and down; None: beside its finger's place.
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
        MIDI pitch as the player reads it.
    rank : int
        1 = first choice; alternates count on without gaps.
    label : str
        The usual short form: ``"0"``, ``"13"``, ``"T12"``; of a slide ``"1"``..``"7"``, ``"T1"``; of keys and holes
        their labels, sorted, one space between, ``"(open)"`` for none.
    controls : dict of str to float
        Value 0..1 of every pitch control away from its rest. A file may leave it out where the label says it.
    fingers : dict of str to str
        Controls that another finger than usual works here, and which.
    cents : float
        How far the note is from equal temperament when it is simply blown, after what ``controls`` does.
    correction : dict of str to float
        Values of the intonation controls for a note that is held.
    tags : tuple of str
        Why one would take it: ``"trill"``, ``"fast"``, ``"raised"`` ...; ``"obsolete"`` marks an alternate that earlier
        versions had by mistake: old projects keep it where it was set by hand, nothing else takes it.
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
        """True if it is kept only for corrections of old projects; a first choice never is."""
        return self.rank > 1 and "obsolete" in self.tags


class InstrumentMap(MapTable, frozen=True):
    """One instrument, as its file says it.

    Attributes
    ----------
    schema_version : int
        `SCHEMA_VERSION`.
    id : str
        The file's stem.
    name : InstrumentName
        For people.
    short_name : str
        For a file name or a narrow column.
    plays : tuple of str
        Ids of the instrument vocabulary whose parts this instrument plays.
    substitutes_for : tuple of str
        Ids it may stand in for where they have no map of their own.
    transposition_semitones : int
        Written minus concert pitch.
    range : Range
        Concert pitches.
    model : str
        File name of the glTF binary.
    clef : str
        The clef its parts are written in.
    breaks : tuple of int
        Written pitches at which a new register begins; a line crosses the break between such a note and the one below.
    air : Air or None
        None: as the body's lungs say, whatever the instrument.
    water : Water or None
        None: it is let out where no one sees it.
    stopped : Stopped or None
        None: no hand closes its bell.
    chart : tuple of ChartKey
        Names and places of the controls, in the order in which a fingering is said.
    fingerings : tuple of Fingering
        Sorted by written pitch and rank.
    size : float
        How large it is, as a multiple of its file and model (`instrument_maps.size.scaled`); never in a file.
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
        """Return the control of this name; `KeyError` if there is none."""
        for control in self.controls:
            if control.name == name:
                return control
        raise KeyError(name)

    @property
    def moving_parts(self) -> tuple[MovingPart, ...]:
        """Moving parts of the model: those of the controls, then the linked ones, then the endpin."""
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
        """The nodes of `moving_parts`."""
        return tuple(part.node for part in self.moving_parts)

    def in_range(self, concert_pitch: int) -> bool:
        """Return whether the table has fingerings for this concert pitch."""
        return self.range.low <= concert_pitch <= self.range.high

    def nearest_playable(self, concert_pitch: int) -> int:
        """Return the concert pitch itself, or the end of the range that is nearest to it."""
        return min(max(concert_pitch, self.range.low), self.range.high)

    def fingerings_for(self, concert_pitch: int) -> tuple[Fingering, ...]:
        """Return the fingerings of a concert pitch, first choice first.

        For a pitch out of range: those of `nearest_playable`. Never empty for a valid map.
        """
        written = self.nearest_playable(concert_pitch) + self.transposition_semitones
        return tuple(fingering for fingering in self.fingerings if fingering.written_pitch == written)

    def offered_for(self, concert_pitch: int, shown: str) -> tuple[Fingering, ...]:
        """Fingerings of a concert pitch that a user may choose; obsolete ones are left out unless one has the label
        ``shown``."""
        every = self.fingerings_for(concert_pitch)
        return tuple(item for item in every if not item.is_obsolete or item.label == shown)

    def values(self, fingering: Fingering, *, held: bool = False) -> dict[str, float]:
        """Return the value of every control under a fingering; ``held`` adds the intonation controls."""
        chosen = {**fingering.controls, **(fingering.correction if held else {})}
        return {control.name: chosen.get(control.name, control.rest_value) for control in self.controls}
