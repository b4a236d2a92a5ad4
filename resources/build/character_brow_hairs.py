"""Hairs of a brow, drawn one by one where MakeHuman's picture of it is painted.

The painted brow is closed in its middle and ends in edges: seen near, it is a wedge. Its shape and density stay. Hairs
stand up at the inner end, lean outwards from there on, those of the lower edge up and those of the upper edge down, and
get short and few towards the outer end; skin is seen between them.
"""

from __future__ import annotations

from typing import Final

import numpy as np
from PIL import Image, ImageDraw
from scipy.ndimage import gaussian_filter, gaussian_filter1d, label

SUPERSAMPLED: Final = (7, 4)
"""Rows and columns drawn for each of the picture, whose pixels are that much higher than wide on the face."""
MM: Final = 4 / 0.055
"""Drawn pixels of a millimetre on the face."""
HAIRS: Final = 380
LEAST: Final = 0.05
"""Density below which there are no hairs."""
DENSITY_PX: Final = (4.0, 9.0)
"""Reach, down and along, over which the painted picture says how many hairs there are."""
PLACES: Final = (0.0, 0.08, 0.17, 0.3, 0.55, 0.8, 0.95)
"""Shares of the way from the inner end to the outer one at which the following are given."""
NUMBER: Final = (0.0, 0.42, 0.8, 1.0, 1.0, 0.8, 0.0)
"""Number of hairs, relative to that of the painted picture."""
LENGTH_MM: Final = (5.0, 6.2, 7.5, 8.5, 8.0, 6.5, 4.5)
RISE_DEG: Final = (78.0, 62.0, 42.0, 27.0, 14.0, 6.0, 3.0)
"""Angle of hairs in the middle to the course of the brow, upwards."""
MEETING_DEG: Final = (8.0, 12.0, 16.0, 20.0, 20.0, 14.0, 8.0)
"""Additional angle of hairs of the lower edge, upwards, and of those of the upper edge, downwards."""
UNEVEN_DEG, BEND_DEG, UPRIGHT_DEG = 8.0, 16.0, 86.0
"""Deviation of single hairs, the bend of a hair outwards from root to tip, and its greatest angle."""
WIDE_MM: Final = (0.09, 0.14)
"""Widths of hairs near their roots."""
SHADES: Final = 0.28
"""Deviation of the logarithm of the shades of hairs."""
STEPS, BORDER = 9, 12.0
"""Corners of a hair's line, and drawn pixels along the upper and lower border of the picture that stay free."""


def brow_hairs(painted: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Shade (about 1 on average) and alpha of hairs, both (H, W).

    `painted` (H, W) is the alpha of the painted brow, its inner end at the left.
    """
    rng = np.random.Generator(np.random.PCG64(47))
    height, width = painted.shape
    density = _largest(gaussian_filter(painted, DENSITY_PX))
    most = density.max(initial=0.0)
    size = (width * SUPERSAMPLED[1], height * SUPERSAMPLED[0])
    shade, alpha = Image.new("F", size, 1.0), Image.new("L", size)
    if most > 0.0:
        draw_shade, draw_alpha = ImageDraw.Draw(shade), ImageDraw.Draw(alpha)
        for line, wide, tone in _hairs(density / most, rng):
            for i in range(STEPS - 1):
                share = (i + 0.5) / (STEPS - 1)
                thick = max(1, round(wide * min(1.0, 0.75 + 2.0 * share, 0.35 + 1.6 * (1.0 - share))))
                ends = [tuple(line[i]), tuple(line[i + 1])]
                draw_alpha.line(ends, fill=255, width=thick)
                draw_shade.line(ends, fill=tone, width=thick + 3)
    reduced = (height, SUPERSAMPLED[0], width, SUPERSAMPLED[1])
    return (
        np.asarray(shade).reshape(reduced).mean(axis=(1, 3)),
        np.asarray(alpha, dtype=np.float64).reshape(reduced).mean(axis=(1, 3)) / 255.0,
    )


def _largest(density: np.ndarray) -> np.ndarray:
    """The density of the largest part alone: beside a brow may be the tail of another."""
    parts, _ = label(density > LEAST)
    sizes = np.bincount(parts.ravel(), minlength=2)[1:]
    return np.where(parts == 1 + sizes.argmax(), density, 0.0)


def _hairs(density: np.ndarray, rng: np.random.Generator) -> list[tuple[np.ndarray, float, float]]:
    """Lines (STEPS, 2) from root to tip in drawn pixels (column, row), widths and tones of hairs."""
    rows = np.arange(density.shape[0])[:, None]
    columns = np.flatnonzero(density.max(axis=0))
    first, last = columns[0], columns[-1]
    weight = density[:, first : last + 1] + 1e-9
    middle = (rows * weight).sum(axis=0) / weight.sum(axis=0)
    half = 1.7 * np.sqrt(((rows - middle) ** 2 * weight).sum(axis=0) / weight.sum(axis=0))
    middle, half = gaussian_filter1d(middle, 25.0), gaussian_filter1d(half, 12.0)
    course = np.gradient(middle) * SUPERSAMPLED[0] / SUPERSAMPLED[1]
    share = (np.arange(first, last + 1) - first) / max(last - first, 1)
    chance = weight**1.3 * np.interp(share, PLACES, NUMBER)
    # As many as are due in every part of the way, or they would stand in tufts.
    reached = chance.T.ravel().cumsum()
    chosen = np.searchsorted(reached, (np.arange(HAIRS) + rng.uniform(size=HAIRS)) / HAIRS * reached[-1])
    lowest = density.shape[0] * SUPERSAMPLED[0]
    found = []
    for column, row in rng.permutation(np.stack(np.unravel_index(chosen, chance.T.shape), axis=1)):
        at = share[column]
        aside = np.clip((row - middle[column]) / max(half[column], 1.0), -1.0, 1.0)
        rise = np.interp(at, PLACES, RISE_DEG) + aside * np.interp(at, PLACES, MEETING_DEG) + rng.normal(0, UNEVEN_DEG)
        length = np.interp(at, PLACES, LENGTH_MM) * rng.uniform(0.55, 1.1) * MM
        rise = min(rise - np.degrees(np.arctan(course[column])), UPRIGHT_DEG)
        angles = np.radians(rise + BEND_DEG * np.linspace(0.5, -0.5, STEPS - 1))
        steps = length / (STEPS - 1) * np.stack([np.cos(angles), -np.sin(angles)], axis=1)
        line = np.concatenate([np.zeros((1, 2)), steps.cumsum(axis=0)])
        centre = np.array([first + column + rng.uniform(), row + rng.uniform()]) * SUPERSAMPLED[::-1]
        line += centre - line.mean(axis=0)
        line[:, 1] += max(0.0, BORDER - line[:, 1].min()) - max(0.0, line[:, 1].max() - (lowest - BORDER))
        found.append((line, rng.uniform(*WIDE_MM) * MM, float(np.exp(rng.normal(0.0, SHADES)))))
    return found
