"""What an instrument map says: frozen records, one per table of the TOML file.

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

from typing import Literal, NamedTuple, TypeAlias, TypeVar

import msgspec

SCHEMA_VERSION = 1
"""The schema these records describe; a file that says another number is refused."""

ROOT = "root"
"""Name of the node that stands for the instrument itself."""

Vector: TypeAlias = tuple[float, float, float]
Hand: TypeAlias = Literal["left", "right"]
Posture: TypeAlias = Literal["standing", "seated"]
_Kind = TypeVar("_Kind")

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
"""What may move a control: a finger, or a whole hand (a playing slide)."""


class _Table(msgspec.Struct, frozen=True, forbid_unknown_fields=True, omit_defaults=True):
    """A table of the file: immutable, and a key it does not know is an error."""


class InstrumentName(_Table, frozen=True):
    """Name of the instrument by language (BCP 47 primary tags that the program supports)."""

    en: str
    ja: str


class Range(_Table, frozen=True):
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


EmbouchureKind: TypeAlias = Literal["cup", "single_reed", "double_reed", "air_jet", "fipple"]


class Embouchure(_Table, frozen=True):
    """How the lips meet the instrument.

    Attributes
    ----------
    kind : str
        ``"cup"``: both lips inside a cup mouthpiece. ``"single_reed"``: upper teeth on the mouthpiece, lower lip over
        the lower teeth under the reed. ``"double_reed"``: both lips drawn over the teeth around the reed.
        ``"air_jet"``: the plate under the lower lip, a small opening between the lips blows across the hole.
        ``"fipple"``: a beak between relaxed lips.
    lips_apart_m : float
        Height of what lies between the lips where they close around it; 0 for a cup and an air jet.
    puff : float
        How far low and loud notes fill the cheeks: 1 as a brass player's may, 0 where cheeks stay flat.
    vibrato : float
        How much vibrato held notes usually have, 0..1.
    """

    kind: EmbouchureKind
    lips_apart_m: float = 0.0
    puff: float = 1.0
    vibrato: float = 0.5


class Mouthpiece(_Table, frozen=True):
    """The frame the lips are put to, in the model's root frame.

    ``position_m`` is the centre of the rim plane, ``air_axis`` the direction of the air stream,
    ``up_axis`` up as played (unit vectors, orthogonal); ``rim_radius_m`` is the crest of the rim, where
    it presses on the lips, ``rim_outer_radius_m`` its outer edge.

    Of a reed or a beak the position is the middle of what the lips close around, there where they close (the tip lies
    behind it, in the mouth); of an air jet it is the edge of the plate where the lower lip rests. The radii are then
    half the width of mouthpiece, reed or plate that the lips meet.
    """

    position_m: Vector
    air_axis: Vector
    up_axis: Vector
    rim_radius_m: float
    rim_outer_radius_m: float


class ControlMotion(_Table, frozen=True):
    """Motion of a node while its control goes from 0 to 1, in the root frame.

    Either a translation (``axis`` and ``travel_m``) or a rotation about ``pivot_m`` (a point in the root
    frame; ``axis`` and ``angle_rad``, right-handed).
    """

    axis: Vector
    travel_m: float | None = None
    angle_rad: float | None = None
    pivot_m: Vector | None = None


ControlKind: TypeAlias = Literal["press", "lever", "slide", "key", "hole"]


class Control(_Table, frozen=True):
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
    used_with: tuple[str, ...] = ()
    held_min_s: float | None = None
    attack_s: float | None = None

    @property
    def travel_m(self) -> float:
        """How far its node is pushed or pulled; 0 for what turns and for what does not move."""
        return 0.0 if self.motion is None or self.motion.travel_m is None else self.motion.travel_m


class Link(_Table, frozen=True):
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


class Endpin(_Table, frozen=True):
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


class Contact(_Table, frozen=True):
    """A part of a hand that touches the instrument.

    Attributes
    ----------
    part : str
        One of `PARTS`.
    node : str
        The node that is touched (`ROOT` or the node of a control): position and normal are in its frame.
    position_m, normal : vector
        A point of the surface and the unit normal that points out of it, towards the skin.
    control : str or None
        The control this touch works, if any. A finger may work several, each with a touch of its own; the first in
        the file is where it is at home. Thumb and little fingers go from one to the other.
    together : tuple of str
        Other controls that the same finger works at the same time in this place (a thumb on hole and register key).
    when : str
        ``"always"``; ``"pressed"``: only while the control is away from rest; ``"released"``: only at rest.
    grip : str
        ``"firm"``: the touch that carries or works the instrument, exact. ``"resting"``: the part lies
        against the surface where the hand allows it (judged as the hand's grip, not as a touch). ``"guide"``, never in
        a file: about here lies a part that cannot bend, and no one judges it (a mitten's finger).
    """

    part: str
    node: str
    position_m: Vector
    normal: Vector
    control: str | None = None
    together: tuple[str, ...] = ()
    when: Literal["always", "pressed", "released"] = "always"
    grip: Literal["firm", "resting", "guide"] = "firm"


class HandSeed(_Table, frozen=True):
    """Where a solver starts a hand from: a plausible pose of a medium hand, not a contact.

    ``palm_position_m`` is the middle of the palm's skin, ``palm_normal`` points out of the palm,
    ``finger_direction`` from the wrist to the knuckles; in the frame of ``node``. ``curl`` is the bend of the
    fingers without a contact: 0 straight, 1 a fist; in the order index, middle, ring, little.
    ``elbow_off_ribs_deg`` is the swing of the elbow to the outside; None as the body's posture has it.
    """

    hand: Hand
    node: str
    palm_position_m: Vector
    palm_normal: Vector
    finger_direction: Vector
    curl: tuple[float, float, float, float] = (0.35, 0.4, 0.45, 0.45)
    elbow_off_ribs_deg: float | None = None


class Capsule(_Table, frozen=True, tag="capsule", tag_field="shape"):
    """A tube or bar: all points within ``radius_m`` of the segment ``a_m``..``b_m``."""

    node: str
    a_m: Vector
    b_m: Vector
    radius_m: float


class Cylinder(_Table, frozen=True, tag="cylinder", tag_field="shape"):
    """A flat-ended round body between ``a_m`` and ``b_m``."""

    node: str
    a_m: Vector
    b_m: Vector
    radius_m: float


class Cone(_Table, frozen=True, tag="cone", tag_field="shape"):
    """A flat-ended round body whose radius goes from ``radius_a_m`` to ``radius_b_m``."""

    node: str
    a_m: Vector
    b_m: Vector
    radius_a_m: float
    radius_b_m: float


class Ring(_Table, frozen=True, tag="ring", tag_field="shape"):
    """A torus about ``axis``: ``radius_m`` to the middle of its tube, which is ``tube_radius_m`` thick."""

    node: str
    centre_m: Vector
    axis: Vector
    radius_m: float
    tube_radius_m: float


class Box(_Table, frozen=True, tag="box", tag_field="shape"):
    """A box with half sizes ``half_m`` along the unit vectors ``x_axis``, ``y_axis`` and their cross product."""

    node: str
    centre_m: Vector
    half_m: Vector
    x_axis: Vector
    y_axis: Vector


Proxy: TypeAlias = Capsule | Cylinder | Cone | Ring | Box
"""A closed body that stands for a part of the model when a hand is checked against it."""


class Carriage(_Table, frozen=True):
    """How the instrument is carried while playing, as (lowest, usual, highest) angles in degrees.

    From the horizontal, straight ahead of the player: ``pitch_down_deg`` bell below the mouthpiece,
    ``yaw_left_deg`` bell to the player's left, ``roll_left_deg`` the instrument's up leaning to the left.
    Applied in the order yaw, pitch, roll.

    How the player turns to it, in degrees: ``head_left_deg`` the head to the left of the trunk, ``head_lean_left_deg``
    its ear towards the left shoulder, ``trunk_left_deg`` the shoulders to the left of the feet.
    """

    pitch_down_deg: Vector
    yaw_left_deg: Vector
    roll_left_deg: Vector
    head_left_deg: float = 0.0
    head_lean_left_deg: float = 0.0
    trunk_left_deg: float = 0.0


class LoweredPlace(_Table, frozen=True):
    """Place of the instrument in a long rest.

    ``offset_m`` is the mouthpiece's place relative to where it is while playing, in the player's frame
    (left, up, ahead); the angles are as in `Carriage`.
    """

    offset_m: Vector
    pitch_down_deg: float
    yaw_left_deg: float
    roll_left_deg: float


class Hold(_Table, frozen=True):
    """How a trained player carries the instrument.

    ``support_hand`` bears its weight. ``standing`` and ``seated`` are for playing; the two ``lowered``
    tables are for long rests. An instrument that is only played seated has no tables for standing, and the other way
    round.

    ``free_hand``: which hand can leave the instrument while it is lowered, and comes past it to the music; None: the
    one that does not bear its weight.

    ``size_range``: a player with small hands or short arms gets it smaller, one with large hands larger, but never
    beyond these multiples of the model's size.
    """

    support_hand: Hand
    standing: Carriage | None = None
    seated: Carriage | None = None
    lowered_standing: LoweredPlace | None = None
    lowered_seated: LoweredPlace | None = None
    size_range: tuple[float, float] = (0.5, 1.25)
    free_hand: Literal["left", "right", "none"] | None = None

    @property
    def leaving_hand(self) -> Hand | None:
        """The hand that can leave the lowered instrument: what else holds it bears it meanwhile. None: neither."""
        if self.free_hand is None:
            return "left" if self.support_hand == "right" else "right"
        return None if self.free_hand == "none" else self.free_hand

    @property
    def postures(self) -> tuple[Posture, ...]:
        """In what the instrument is played, the usual one first."""
        both: tuple[tuple[Posture, Carriage | None], ...] = (("standing", self.standing), ("seated", self.seated))
        return tuple(posture for posture, carriage in both if carriage is not None)

    def possible(self, posture: Posture) -> Posture:
        """The posture itself, or the only one the instrument is played in."""
        return posture if posture in self.postures else self.postures[0]

    def carriage(self, posture: Posture) -> Carriage:
        """Return how it is carried, in the only posture it is played in where the requested one is not possible."""
        return self._either(posture, self.standing, self.seated)

    def lowered(self, posture: Posture) -> LoweredPlace:
        """Return where it is in a long rest; likewise."""
        return self._either(posture, self.lowered_standing, self.lowered_seated)

    @staticmethod
    def _either(posture: Posture, standing: _Kind | None, seated: _Kind | None) -> _Kind:
        requested, other = (seated, standing) if posture == "seated" else (standing, seated)
        found = other if requested is None else requested
        if found is None:
            raise ValueError("a map without any posture")
        return found


class Acoustics(_Table, frozen=True):
    """The tube behind the table of fingerings: lets a test, or a reader, check it.

    Attributes
    ----------
    fundamental_pitch : int
        Concert MIDI pitch of the first harmonic of the plain tube.
    tube_m : float
        Effective length of the plain tube.
    semitones : dict of str to int
        What each pitch control lowers the tube by when it is alone (valves, a trigger).
    compensator : str or None
        The valve with which the others lengthen the tube in proportion, so that their sum with it is in tune: it sends
        the air through them once more, or to tubes of their own (the other side of a double horn).
    slide_control : str or None
        The playing slide, whose places are ``tube_m x (2**(semitones/12) - 1) / 2`` from closed, times the
        length of the tube with the other controls.
    """

    fundamental_pitch: int
    tube_m: float
    semitones: dict[str, int]
    slide_control: str | None = None
    compensator: str | None = None


class Fingering(_Table, frozen=True):
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


class Water(_Table, frozen=True):
    """How water is let out of the instrument in a long rest.

    Attributes
    ----------
    gesture : str
        Its name in `metadata.gestures`.
    position_m, normal : vector or None
        Of the water key: where the forefinger presses it, and the way out of it; in the root frame. None where there is
        none to press.
    """

    gesture: str
    position_m: Vector | None = None
    normal: Vector | None = None


class Stopped(_Table, frozen=True):
    """How notes are played with the bell closed by the hand, which makes the tube shorter.

    Attributes
    ----------
    fingered_semitones : int
        How much higher than it sounds a note is fingered; -1: a semitone lower.
    hand : "left" or "right"
        The hand in the bell.
    without : tuple of str
        Controls of pitch that are at rest meanwhile.
    turned_deg : vector
        Rotation vector, in the root frame, by which the palm turns about its knuckles to close the bell; the fingers
        stay where they lie.
    """

    fingered_semitones: int
    hand: Hand
    without: tuple[str, ...] = ()
    turned_deg: Vector = (0.0, 0.0, 0.0)


class Air(_Table, frozen=True):
    """How long one full breath of an adult lasts on the instrument, seconds of playing by dynamic."""

    piano_s: float
    mezzoforte_s: float
    forte_s: float


class InstrumentMap(_Table, frozen=True):
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
    size: float = 1.0

    def control(self, name: str) -> Control:
        """Return the control of this name; `KeyError` if there is none."""
        for control in self.controls:
            if control.name == name:
                return control
        raise KeyError(name)

    @property
    def moving_parts(self) -> tuple[MovingPart, ...]:
        """What moves in the model: the parts of the controls, then the linked ones, then the endpin."""
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
        """Those of a concert pitch that a user may choose: obsolete ones only where one has the label ``shown``."""
        every = self.fingerings_for(concert_pitch)
        return tuple(item for item in every if not item.is_obsolete or item.label == shown)

    def values(self, fingering: Fingering, *, held: bool = False) -> dict[str, float]:
        """Return the value of every control under a fingering; ``held`` adds the intonation controls."""
        chosen = {**fingering.controls, **(fingering.correction if held else {})}
        return {control.name: chosen.get(control.name, control.rest_value) for control in self.controls}
