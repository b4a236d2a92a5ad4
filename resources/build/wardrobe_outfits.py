"""The outfits: what each is made of, for whom, and in which colours."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from character_surface import Surface
from wardrobe_pieces import ACCENT, MAIN, SECOND, Wearer, all_of, linen_apart, piece, skin

Colour = tuple[float, float, float]
Pieces = list[tuple[Surface, str]]
BLACK, NEAR_BLACK, WHITE = (0.012, 0.012, 0.014), (0.018, 0.018, 0.021), (0.80, 0.80, 0.79)


@dataclass(frozen=True)
class Outfit:
    """One outfit.

    Attributes
    ----------
    title : in English and Japanese.
    pieces : makes, by the ending of the file's name ("man", "woman"; "" where one cut does for all), the surfaces with
        their slots.
    colours : linear, by material.
    """

    id: str
    title: tuple[str, str]
    pieces: dict[str, Callable[[Wearer], Pieces]]
    colours: dict[str, Colour]
    hides: tuple[str, ...] = ("shirt", "trousers")


def _trousers_part(uvs: np.ndarray) -> np.ndarray:
    return (uvs[:, 1] < 0.53) & (uvs[:, 0] < 0.745)


def _jacket_part(uvs: np.ndarray) -> np.ndarray:
    return ~_trousers_part(uvs)


def _skirt_part(uvs: np.ndarray) -> np.ndarray:
    """Faces of the skirt; a sleeve and the band of the collar reach into its rectangle."""
    u, v = uvs[:, 0], uvs[:, 1]
    return (v > 0.457) & (u < 0.79) & ~((v < 0.474) & (u < 0.145)) & ~((v > 0.60) & (u > 0.783))


def suit_jacket(wearer: Wearer, linen: str = SECOND, tie: str = ACCENT) -> Surface:
    """A jacket over shirt and tie."""
    return piece(wearer, "jacket", "suit", _jacket_part, linen_apart(MAIN, linen, tie))


def suit_trousers(wearer: Wearer, material: str = MAIN) -> Surface:
    """Straight trousers."""
    return piece(wearer, "trousers", "suit", _trousers_part, all_of(material))


def blouse(wearer: Wearer, material: str = MAIN) -> Surface:
    """A fitted blouse with a collar and long sleeves."""
    return piece(wearer, "blouse", "blouse", lambda uvs: ~_skirt_part(uvs), all_of(material))


def _suit(wearer: Wearer) -> Pieces:
    return [(suit_jacket(wearer), "top"), (suit_trousers(wearer), "bottom")]


def _blouse_and_trousers(wearer: Wearer) -> Pieces:
    return [(blouse(wearer), "top"), (suit_trousers(wearer), "bottom"), (bare_chest(wearer), "skin")]


def bare_chest(wearer: Wearer, depth_m: float = 0.17, width_m: float = 0.05) -> Surface:
    """The skin below the throat that an open collar leaves bare."""

    def shown(places: np.ndarray, weights: np.ndarray) -> np.ndarray:
        low = wearer.tailoring.collar_point[1] - depth_m
        front = places[:, 2] > wearer.tailoring.collar_point[2] + 0.02
        wide = width_m + 1.2 * np.maximum(places[:, 1] - low - 0.08, 0.0)
        return (np.abs(places[:, 0]) < wide) & (places[:, 1] > low) & front

    return skin(wearer, "skin_chest", shown)


OUTFITS = (
    Outfit(
        "concert_black",
        ("Concert black", "黒の演奏会服"),
        {"man": _suit, "woman": _blouse_and_trousers},
        {MAIN: BLACK, SECOND: NEAR_BLACK, ACCENT: (0.008, 0.008, 0.009)},
    ),
)
