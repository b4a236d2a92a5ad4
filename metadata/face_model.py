"""Faces during playing as data: embouchures, and the motion of brows, lids, cheeks and nostrils."""

from __future__ import annotations

from typing import Literal, TypeAlias

import msgspec

from metadata.units import AmplitudeScale, Fraction01, NotNegative, Positive, Weights


class EmbouchureWeights(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """ARKit weights of one kind of embouchure (the map's ``embouchure.kind``).

    The face during playing is ``relaxed * (1 - tension) + tight * tension + air * air + soft * (1 - air) + effort *
    effort``; the jaw opens in addition as far as lips need to close around a mouthpiece or to leave an opening
    (`app.motion.faces.morph_weights`). The tables from ``onset`` on describe the lips within a note.

    Attributes
    ----------
    relaxed, tight : dict of str to float
        Weights of the lips on low notes, fully relaxed, and on high notes, drawn tight.
    air, effort : dict of str to float
        Weights at full air and at full effort.
    tongue_stroke, tongue_back : dict of str to float
        Weights in a plain stroke of the tongue's tip before an attack, and in one of its back in double and triple
        tonguing (shown at half size).
    push : dict of str to float
        Weights in a marcato attack with breath pressure.
    inhale : dict of str to float
        Weights of the mouth in a full breath.
    opening_m : float
        Height in metres of the opening between the lips beside the mouthpiece; 0 if the weights alone determine the
        lips.
    soft : dict of str to float
        Weights in the softest playing: a smaller, firmer opening.
    onset : dict of str to float
        Additional weights just before an attack, which fade soon after it.
    corners, chin : dict of str to float
        Random variation of corners and chin during a held note (root mean square).
    give : float
        Random variation of the tension during a held note (root mean square).
    tired : dict of str to float
        Weights after a long time without a rest.
    vibrato : dict of str to float
        Amplitude of each weight in a full vibrato.
    vibrato_hz : (float, float)
        Range of the players' vibrato rates in Hz.
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
        """Weight of each morph at medium tension: the mean of `relaxed` and `tight`."""
        names = sorted(self.relaxed.keys() | self.tight.keys())
        return {name: 0.5 * (self.relaxed.get(name, 0.0) + self.tight.get(name, 0.0)) for name in names}


EmbouchureKind: TypeAlias = Literal["cup", "single_reed", "double_reed", "air_jet", "fipple"]
"""Kinds of embouchure in instrument maps."""


class Load(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Formula for the load of a note: weights of its tension (register), air (loudness) and effort, minus a level that
    is easy.
    """

    tension: NotNegative
    air: NotNegative
    effort: NotNegative
    easy: Fraction01


class FaceMotion(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Motion of the face above the mouth during playing: the sum of weights for each influence.

    Attributes
    ----------
    size, lips_size : AmplitudeScale
        Size of all motion, and of the lips' motion within notes.
    left_right : (float, float)
        Least and greatest difference of left and right as a share of their size; each player has an individual
        difference.
    load : Load
        Formula of the load of a note.
    rise_s, decay_s : float
        Seconds in which strain grows under a lasting load, and in which it passes afterwards.
    lid_per_rad : float
        Weight by which lids are lowered when the eyes look down by a radian.
    working : dict of str to float
        Weights that follow the load of a note immediately.
    strain : dict of str to float
        Weights for a lasting load.
    rising, falling : dict of str to float
        Weights for a melody above or below its recent pitch.
    louder, softer : dict of str to float
        Weights for a dynamic above or below its recent level.
    emptying : dict of str to float
        Weights when the air of the last breath is used up.
    phrase : dict of str to float
        Weights at the peak of a phrase, two thirds of the way through it.
    inhale : dict of str to float
        Weights in a full breath.
    brows, lids, nose : dict of str to float
        Random variation of each (root mean square).
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
"""Names of the tables of weights in an `EmbouchureWeights`."""
FACE_WEIGHTS = (
    *("working", "strain", "rising", "falling", "louder", "softer", "emptying", "phrase", "inhale"),
    *("brows", "lids", "nose"),
)
"""Names of the tables of weights in a `FaceMotion`."""
UPPER_FACE = ("brow", "eye", "cheekSquint", "noseSneer")
"""Prefixes of the morphs above the mouth."""
