"""Tables of a map about blowing the instrument: embouchure, mouthpiece, tube, water, bell and air.

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
        Distance between the lips where they close around the mouthpiece; 0 for a cup and an air jet.
    puff : float
        Filling of the cheeks on low and loud notes: 1 as for a brass player, 0 if cheeks stay flat.
    vibrato : float
        Usual amount of vibrato on held notes, 0..1.
    """

    kind: EmbouchureKind
    lips_apart_m: float = 0.0
    puff: float = 1.0
    vibrato: float = 0.5


class Mouthpiece(MapTable, frozen=True):
    """Position and orientation of the mouthpiece at the lips, in the model's root frame.

    ``position_m`` is the centre of the rim plane, ``air_axis`` the direction of the air stream, ``up_axis`` up during
    playing (unit vectors, orthogonal); ``rim_radius_m`` is the crest of the rim, where it presses on the lips,
    ``rim_outer_radius_m`` its outer edge.

    For a reed or beak the position is the middle of the section enclosed by the lips (the tip is behind it in the
    mouth); for an air jet it is the edge of the plate on which the lower lip rests. The radii are then half the width
    of mouthpiece, reed or plate at the lips.
    """

    position_m: Vector
    air_axis: Vector
    up_axis: Vector
    rim_radius_m: float
    rim_outer_radius_m: float


class Acoustics(MapTable, frozen=True):
    """Acoustics of the tube, by which tests check the fingering table.

    Attributes
    ----------
    fundamental_pitch : int
        Concert MIDI pitch of the first harmonic of the plain tube.
    tube_m : float
        Effective length of the plain tube.
    semitones : dict of str to int
        Semitones by which each pitch control alone lowers the tube (valves, a trigger).
    compensator : str or None
        Valve with which the others lengthen the tube in proportion, so that their sum with it is in tune: it sends the
        air through them once more, or to tubes of their own (the other side of a double horn).
    slide_control : str or None
        The playing slide, whose positions are ``tube_m x (2**(semitones/12) - 1) / 2`` from closed, multiplied by the
        relative length of the tube with the other controls.
    """

    fundamental_pitch: int
    tube_m: float
    semitones: dict[str, int]
    slide_control: str | None = None
    compensator: str | None = None


class Water(MapTable, frozen=True):
    """Letting out of water from the instrument in a long rest.

    Attributes
    ----------
    gesture : str
        Name of the gesture in `metadata.gestures`.
    position_m, normal : vector or None
        Place at which the forefinger presses the water key, and outward normal, in the root frame. None if there is no
        key.
    """

    gesture: str
    position_m: Vector | None = None
    normal: Vector | None = None


class Stopped(MapTable, frozen=True):
    """Notes played with the hand in the bell, which shortens the tube.

    Attributes
    ----------
    fingered_semitones : int
        Semitones by which such a note is fingered higher than it sounds; -1 for a semitone lower.
    hand : "left" or "right"
        The hand in the bell.
    without : tuple of str
        Pitch controls that stay at rest.
    turned_deg : vector
        Rotation vector in the root frame by which the palm turns about its knuckles to close the bell; the fingers stay
        in place.
    """

    fingered_semitones: int
    hand: Hand
    without: tuple[str, ...] = ()
    turned_deg: Vector = (0.0, 0.0, 0.0)


class Air(MapTable, frozen=True):
    """Duration of one full breath of an adult on the instrument, in seconds of playing, for each dynamic."""

    piano_s: float
    mezzoforte_s: float
    forte_s: float
