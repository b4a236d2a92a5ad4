"""Records of a map that say how the instrument is blown: embouchure, mouthpiece, tube, water, bell and air.

Frames are those of `instrument_maps.model`.
"""

from __future__ import annotations

from typing import Literal, TypeAlias

from instrument_maps.map_table import Hand, MapTable, Vector

EmbouchureKind: TypeAlias = Literal["cup", "single_reed", "double_reed", "air_jet", "fipple"]


class Embouchure(MapTable, frozen=True):
    """Contact of the lips with the instrument.

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


class Mouthpiece(MapTable, frozen=True):
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


class Acoustics(MapTable, frozen=True):
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


class Water(MapTable, frozen=True):
    """Way in which water is let out of the instrument in a long rest.

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


class Stopped(MapTable, frozen=True):
    """Notes played with the bell closed by the hand, which makes the tube shorter.

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


class Air(MapTable, frozen=True):
    """Length of one full breath of an adult on the instrument, seconds of playing by dynamic."""

    piano_s: float
    mezzoforte_s: float
    forte_s: float
