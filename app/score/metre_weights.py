"""Weights of what speaks for a metre, fitted to 2,427 pieces: see `app.score.metre_guess`.

A conditional logit over all metres and places of the bar line, by L2-regularised maximum likelihood. The pieces are
those of music21's corpus in one metre: folk songs (Essen, O'Neill, Ryan, Aird), chorales and quartets.
"""

from __future__ import annotations

from typing import Final

CONTRASTS: Final = (
    (3.09, -0.67, 0.60, 1.99, 0.03, 0.30, -1.04, 2.21, 2.15, 1.41, 1.95),
    (1.88, 1.52, 0.00, -0.78, -0.92, 0.64, -2.53, 2.00, 2.06, 0.59, 2.34),
    (-0.99, -0.87, 1.20, -5.53, -0.21, 0.71, -3.54, 2.01, -3.44, 1.44, 0.03),
    (0.36, 0.03, -0.59, -2.91, -0.51, 0.24, -0.02, 0.45, -0.36, -0.66, -1.50),
)
"""A column a signal; rows: bar line against beats, beats against the rest, half bar against beats, bar line against the
eighth before it."""
COMPOUND_CONTRASTS: Final = (
    (-0.33, -1.31, -1.58, 4.32, -0.09, 0.65, 1.00, -0.39, 0.12, 0.18, -0.42),
    (-1.37, -0.86, -0.58, 5.31, -0.77, 1.25, -1.42, 0.35, -2.13, 0.79, 0.40),
    (0.15, -1.65, 1.09, 5.15, 1.30, -1.44, -0.21, -2.20, -1.01, -1.94, 0.29),
    (-0.64, 0.87, 2.26, -2.55, 1.46, -0.52, 1.03, 0.96, -0.94, -0.27, -0.22),
)
"""The same, added where the metre is compound or counts in eighths."""
SHORT_CONTRASTS: Final = (
    (-3.38, 2.10, -1.97, 16.17, 0.23, -0.26, -2.31, 0.01, -1.93, 0.23, -1.42),
    (-1.29, 0.03, 0.16, 13.24, 1.45, -1.20, 2.63, 1.11, -0.36, 1.17, -2.89),
    (0.00, 0.00, 0.00, 0.00, 0.00, 0.00, 0.00, 0.00, 0.00, 0.00, 0.00),
    (-0.72, 1.32, 0.23, -11.35, 0.38, 0.97, 1.63, -0.61, 0.90, -0.98, 1.38),
)
"""The same, added in bars of two quarters and less."""
PLACES: Final = ((10.29, 7.33, 16.22, 17.78, -0.34, -0.22, -4.38, -1.43, -0.88, 0.66, -1.09, 2.23, 0.07, -0.30),)
"""A column each: what repeats after a bar, two bars, half a bar and two beats; the file begins at a bar line, at a
beat, between eighths; the first note at a bar line, the last one there, or at a beat; sixteenths after the bar line;
the end at whole bars, at a bar line, at a beat."""
METRES: Final = (
    (3.94, 0.40, 0.91, 3.25, 1.91, -2.26, -3.40, -3.29),
    (-0.67, 23.41, 15.00, 20.05, -8.86, 5.96, -14.15, 12.76),
    (24.17, 29.81, -0.81, 21.42, 11.24, 17.11, -14.22, 4.68),
    (1.01, 0.58, 2.00, 1.82, 2.57, 4.90, 4.28, 2.51),
)
"""A column a metre; rows: by itself, what repeats after a bar, after two bars, and where the file begins with a bar."""
