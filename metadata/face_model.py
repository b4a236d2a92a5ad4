"""Playing faces as data: embouchures, and the motion of brows, lids, cheeks and nostrils."""

from __future__ import annotations

from typing import Literal, TypeAlias

import msgspec

from metadata.units import AmplitudeScale, Fraction01, NotNegative, Positive, Weights


class EmbouchureWeights(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """ARKit weights of one kind of embouchure (the map's ``embouchure.kind``).

    The face while playing is ``relaxed * (1 - tension) + tight * tension + air * air + soft * (1 - air) + effort *
    effort``; on top of it the jaw opens as far as lips need that close around something, or leave an opening
    (`app.motion.faces.morph_weights`). The tables from ``onset`` on are what the lips do within a note.

    Attributes
    ----------
    relaxed, tight : dict of str to float
        Low notes, fully relaxed, and high notes, drawn tight.
    air, effort : dict of str to float
        Full air and full effort.
    tongue_stroke, tongue_back : dict of str to float
        A plain stroke of the tongue's tip before an attack, and one of its back in double and triple tonguing (shown at
        half its size there).
    push : dict of str to float
        A marcato attack, pushed by the breath.
    inhale : dict of str to float
        The mouth in a full breath.
    opening_m : float
        Height of the opening between the lips beside what lies between them; 0: the lips stay as the weights have them.
    soft : dict of str to float
        The softest playing: a smaller, firmer opening.
    onset : dict of str to float
        Firmer just before an attack, and settled soon after it.
    corners, chin : dict of str to float
        How far corners and chin wander while a note is held (root mean square).
    give : float
        How far the tension wanders while a note is held (root mean square).
    tired : dict of str to float
        After a long time without a rest.
    vibrato : dict of str to float
        By how much each weight goes up and down in a full vibrato ...
    vibrato_hz : (float, float)
        ... of which players differ in rate between these.
    """

    relaxed: Weights
    tight: Weights
    air: Weights
    effort: Weights
    tongue_stroke: Weights
    inhale: Weights
    tongue_back: Weights = {}
    push: Weights = {}
    opening_m: NotNegative = 0.0
    soft: Weights = {}
    onset: Weights = {}
    corners: Weights = {}
    chin: Weights = {}
    give: Fraction01 = 0.0
    tired: Weights = {}
    vibrato: Weights = {}
    vibrato_hz: tuple[Positive, Positive] = (4.9, 5.6)

    @property
    def usual(self) -> dict[str, float]:
        """Weights of a middling tension."""
        names = sorted(self.relaxed.keys() | self.tight.keys())
        return {name: 0.5 * (self.relaxed.get(name, 0.0) + self.tight.get(name, 0.0)) for name in names}


EmbouchureKind: TypeAlias = Literal["cup", "single_reed", "double_reed", "air_jet", "fipple"]
"""The kinds an instrument map may name."""


class Load(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Cost of a note: weights of its tension (register), its air (loudness) and its effort, less what is easy."""

    tension: NotNegative
    air: NotNegative
    effort: NotNegative
    easy: Fraction01


class FaceMotion(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Motion of the face above the mouth while playing: weights of each thing it follows, added up.

    Attributes
    ----------
    size, lips_size : AmplitudeScale
        Of all of it, and of what the lips do within notes.
    left_right : (float, float)
        By what share of their size left and right differ, at least and at most; each player has an own difference.
    load : Load
    rise_s, decay_s : float
        A strain grows in the first and passes in the second.
    lid_per_rad : float
        Lids go down by this weight when the eyes look down by a radian.
    working : dict of str to float
        At once with the load of a note.
    strain : dict of str to float
        With a load that lasts.
    rising, falling : dict of str to float
        The melody above or below where it was.
    louder, softer : dict of str to float
        The dynamic above or below where it was.
    emptying : dict of str to float
        The air of the last breath used up.
    phrase : dict of str to float
        Two thirds into a phrase that goes somewhere.
    inhale : dict of str to float
        A full breath.
    brows, lids, nose : dict of str to float
        How far each wanders by itself (root mean square).
    """

    size: AmplitudeScale
    lips_size: AmplitudeScale
    left_right: tuple[Fraction01, Fraction01]
    load: Load
    rise_s: Positive
    decay_s: Positive
    lid_per_rad: NotNegative
    working: Weights
    strain: Weights
    rising: Weights
    falling: Weights
    louder: Weights
    softer: Weights
    emptying: Weights
    phrase: Weights
    inhale: Weights
    brows: Weights
    lids: Weights
    nose: Weights


EMBOUCHURE_WEIGHTS = (
    *("relaxed", "tight", "air", "effort", "tongue_stroke", "inhale"),
    *("tongue_back", "push", "soft", "onset", "corners", "chin", "tired", "vibrato"),
)
"""The tables of weights of an `EmbouchureWeights`."""
FACE_WEIGHTS = (
    *("working", "strain", "rising", "falling", "louder", "softer", "emptying", "phrase", "inhale"),
    *("brows", "lids", "nose"),
)
"""The tables of weights of a `FaceMotion`."""
UPPER_FACE = ("brow", "eye", "cheekSquint", "noseSneer")
"""Prefixes of the morphs above the mouth."""
