"""The outfits: their pieces, their wearers and their colours."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from character_cloth import Cloth, cut, join
from character_surface import Surface, modelled
from wardrobe_fitted import LAP_M, going_with, over_lap, over_throat, straight_legs, tail
from wardrobe_marching import belt, cuffs, epaulettes, shako, stripes
from wardrobe_pieces import ACCENT, MAIN, SECOND, Wearer, all_of, few_bones, linen_apart, piece, skin
from wardrobe_polo import polo_shirt
from wardrobe_sailor import sailor_collar, scarf
from wardrobe_seated import OVER_LAP_M
from wardrobe_sewn import SKIRT_BONES, Skirt, bow_tie, garment, moved_to, over, plain, shell, skirt, throat
from wardrobe_shirt import own_shirt
from wardrobe_tunic import (
    TUNIC_M,
    buttons,
    close_dress,
    front_strip,
    neckline,
    ribbon,
    stand_collar,
    tunic,
    tunic_drape,
)

Colour = tuple[float, float, float]
Pieces = list[tuple[Surface, str]]
BLACK, NEAR_BLACK, WHITE = (0.012, 0.012, 0.014), (0.018, 0.018, 0.021), (0.80, 0.80, 0.79)
NAVY, GOLD = (0.012, 0.016, 0.042), (0.55, 0.36, 0.10)
OWN = ("shirt", "trousers")
OVER_PLEATS_M = 0.024
"""Distance by which a jacket lies over a pleated skirt on the lap."""
ANKLE_M = 0.18
"""Height over the sole of the base mesh up to which legs show under a long dress in a stride."""


@dataclass(frozen=True)
class Outfit:
    """One outfit.

    Attributes
    ----------
    title : in English and Japanese.
    pieces : makes, by the ending of the file's name ("man" or "woman"), the surfaces with their slots.
    colours : linear, by material.
    hides : the finished bodies' meshes that it takes the place of.
    """

    id: str
    title: tuple[str, str]
    pieces: dict[str, Callable[[Wearer], Pieces]]
    colours: dict[str, Colour]
    hides: tuple[str, ...] = OWN


def _trousers_part(uvs: np.ndarray) -> np.ndarray:
    return (uvs[:, 1] < 0.53) & (uvs[:, 0] < 0.745)


def _jacket_part(uvs: np.ndarray) -> np.ndarray:
    return ~_trousers_part(uvs)


def _skirt_part(uvs: np.ndarray) -> np.ndarray:
    """Faces of the skirt; a sleeve and the band of the collar reach into its rectangle."""
    u, v = uvs[:, 0], uvs[:, 1]
    return (v > 0.457) & (u < 0.79) & ~((v < 0.474) & (u < 0.145)) & ~((v > 0.60) & (u > 0.783))


def suit_jacket(wearer: Wearer, linen: str = SECOND, tie: str = ACCENT) -> Surface:
    """A jacket over shirt and tie, whose front covers the skin of the throat."""
    jacket = piece(wearer, "jacket", "suit", _jacket_part, linen_apart(MAIN, linen, tie))
    return moved_to(wearer, jacket, over_throat(wearer, cloth_of(wearer, jacket).points, jacket.triangles[linen]))


def suit_trousers(wearer: Wearer, material: str = MAIN, patch: str = "suit") -> Surface:
    """Straight trousers of a suit."""
    return straight_legs(wearer, piece(wearer, "trousers", patch, _trousers_part, all_of(material)))


def grey_trousers(wearer: Wearer) -> Surface:
    """Trousers of the linen's material that stay grey beside it."""
    return suit_trousers(wearer, SECOND, "dark_trousers")


def blouse(wearer: Wearer, material: str = MAIN) -> Surface:
    """A fitted blouse with a collar and long sleeves."""
    return piece(wearer, "blouse", "blouse", lambda uvs: ~_skirt_part(uvs), all_of(material))


def tee(wearer: Wearer, material: str = MAIN) -> Surface:
    """A shirt with short sleeves."""
    return piece(wearer, "shirt", "tee", lambda uvs: uvs[:, 1] > 0.58, all_of(material))


def bare_chest(wearer: Wearer, depth_m: float = 0.17, width_m: float = 0.05) -> Surface:
    """The skin below the throat that an open collar leaves bare."""

    def shown(places: np.ndarray, weights: np.ndarray) -> np.ndarray:
        low = wearer.tailoring.collar_point[1] - depth_m
        front = places[:, 2] > wearer.tailoring.collar_point[2] + 0.02
        wide = np.minimum(width_m + 1.2 * np.maximum(places[:, 1] - low - 0.08, 0.0), 0.11)
        return (np.abs(places[:, 0]) < wide) & (places[:, 1] > low) & front

    return skin(wearer, "skin_chest", shown)


def bare_shoulders(wearer: Wearer) -> Surface:
    """The skin about the neck that a round neckline leaves bare."""

    def shown(places: np.ndarray, weights: np.ndarray) -> np.ndarray:
        return (np.abs(places[:, 0]) < 0.16) & (places[:, 1] > wearer.tailoring.collar_point[1] - 0.25)

    return skin(wearer, "skin_chest", shown)


def bare_arms(wearer: Wearer, from_m: float) -> Surface:
    """Skin of the arms from a distance to the body's middle, in the T-pose, to the hands."""
    return skin(wearer, "skin_arms", lambda places, weights: np.abs(places[:, 0]) > from_m)


def bare_legs(wearer: Wearer, low_m: float, high_m: float) -> Surface:
    """The skin of the legs between two heights."""

    def shown(places: np.ndarray, weights: np.ndarray) -> np.ndarray:
        legs = np.abs(places[:, 0]) < wearer.tailoring.shoulder[0]
        return legs & (places[:, 1] > low_m) & (places[:, 1] < high_m)

    return skin(wearer, "skin_legs", shown)


def sleeve_end_m(wearer: Wearer, surface: Surface) -> float:
    """Distance off the middle of the body where the sleeves end in the T-pose."""
    return float(np.abs(wearer.fit.to_t_pose(surface.positions, surface.weights)[:, 0]).max())


def cloth_of(wearer: Wearer, surface: Surface) -> Cloth:
    """A surface in the T-pose."""
    return Cloth(wearer.fit.to_t_pose(surface.positions, surface.weights), surface.weights, surface.all_triangles())


def on_lap(wearer: Wearer, jacket: Surface, legs: Surface, lies_m: float = OVER_LAP_M) -> Surface:
    """A jacket that lies on the lap of a seated player in trousers or a skirt."""
    lap = over_lap(wearer, cloth_of(wearer, jacket), cloth_of(wearer, legs), lies_m)
    return going_with(wearer, jacket, lap, wearer.tailoring.belt_m + LAP_M)


def _suit(wearer: Wearer) -> Pieces:
    legs = suit_trousers(wearer)
    return [(on_lap(wearer, suit_jacket(wearer), legs), "top"), (legs, "bottom")]


def _blouse_and_trousers(wearer: Wearer) -> Pieces:
    top = blouse(wearer)
    hem_m = float(cloth_of(wearer, top).points[:, 1].min())
    legs = hemmed(wearer, suit_trousers(wearer), hem_m + 0.022, -1.0)
    return [(worn_over(wearer, top, legs, 0.010), "top"), (legs, "bottom"), (bare_chest(wearer), "skin")]


def _tie_alone(wearer: Wearer) -> Pieces:
    own = cloth_of(wearer, own_shirt(wearer))
    tie = bow_tie(wearer, throat(wearer, own.points, 0.008) + np.array([0.0, 0.0, 0.009]))
    return [(garment("bow_tie", {ACCENT: [tie]}, wearer), "tie")]


def _blazer(wearer: Wearer) -> Pieces:
    legs = grey_trousers(wearer)
    return [(on_lap(wearer, suit_jacket(wearer), legs), "top"), (legs, "bottom")]


def socks(wearer: Wearer, material: str, high_m: float) -> Surface:
    """Socks from the shoes to a height."""
    return garment("socks", {material: [shell(wearer, wearer.tailoring.foot_m + 0.045, high_m, 0.002)]}, wearer)


def _school_legs(wearer: Wearer, material: str, checked: bool, socks_material: str) -> Pieces:
    """A pleated skirt to the knee, bare knees, socks below them."""
    tailoring = wearer.tailoring
    hem, sock = tailoring.knee_m - 0.025, tailoring.knee_m - 0.10
    pleated = skirt(wearer, Skirt(tailoring.belt_m - 0.015, hem, 0.035, 0.012, 16, other_leg=0.2), checked=checked)
    return [
        (garment("skirt", {material: [pleated]}, wearer, SKIRT_BONES), "bottom"),
        (socks(wearer, socks_material, sock), "bottom"),
        (bare_legs(wearer, sock - 0.05, hem + 0.20), "skin"),
    ]


def worn_over(wearer: Wearer, outer: Surface, inner: Surface, margin_m: float = 0.007) -> Surface:
    """A top that hangs over the garment below it."""
    cloth = cloth_of(wearer, outer)
    moved = over(wearer, cloth, cloth_of(wearer, inner), wearer.tailoring.belt_m + 0.05, margin_m)
    return moved_to(wearer, outer, moved.points)


def _blazer_and_skirt(wearer: Wearer) -> Pieces:
    legs = _school_legs(wearer, SECOND, True, MAIN)
    return [(_roomy_jacket(wearer, legs[0][0]), "top"), *legs]


def _roomy_jacket(wearer: Wearer, below: Surface) -> Surface:
    """A jacket that leaves room for a skirt and goes with it."""
    cloth, waist = cloth_of(wearer, below), wearer.tailoring.belt_m
    jacket = on_lap(wearer, suit_jacket(wearer), below, OVER_PLEATS_M)
    return moved_to(wearer, jacket, over(wearer, cloth_of(wearer, jacket), cloth, waist + 0.05, 0.016, 0.05).points)


def _suit_of_women(wearer: Wearer) -> Pieces:
    """A suit whose jacket lies on its trousers and goes with them."""
    legs = suit_trousers(wearer)
    return [(worn_over(wearer, on_lap(wearer, suit_jacket(wearer), legs), legs), "top"), (legs, "bottom")]


def hemmed(wearer: Wearer, top: Surface, hem_m: float, side: float = 1.0) -> Surface:
    """The part of a garment above a height in the T-pose, or with a side of -1 below it."""
    joints = top.weights.shape[1]
    places = wearer.fit.to_t_pose(top.positions, top.weights)
    ((material, faces),) = top.triangles.items()
    # Texture coordinates are cut as the weights are.
    own = cut(Cloth(places, np.concatenate([top.weights, top.uvs], axis=1), faces), side * (places[:, 1] - hem_m))
    weights, uvs = own.weights[:, :joints], own.weights[:, joints:]
    rest = wearer.fit.to_rest_pose(own.points, weights)
    return modelled(top.name, rest, few_bones(weights), {material: own.faces}, uvs=uvs)


def _sailor(wearer: Wearer) -> Pieces:
    legs = _school_legs(wearer, MAIN, False, MAIN)
    whole = worn_over(wearer, tee(wearer, SECOND), legs[0][0], 0.014)
    top = hemmed(wearer, whole, wearer.tailoring.belt_m - 0.05)
    cloth = cloth_of(wearer, top)
    cape, stripes = sailor_collar(wearer, cloth)
    over_it = garment("collar", {MAIN: [cape], SECOND: [stripes], ACCENT: scarf(wearer, cloth)}, wearer)
    arms = bare_arms(wearer, sleeve_end_m(wearer, top) - 0.06)
    return [(top, "top"), (over_it, "top"), *legs, (bare_chest(wearer), "skin"), (arms, "skin")]


def _hip_m(wearer: Wearer) -> float:
    """Height of the hip joints."""
    return float(wearer.fit.positions_t[wearer.fit.index("leftUpperLeg")][1])


def _closed(wearer: Wearer, hem_m: float, below: Surface) -> Cloth:
    """A tunic from the neck to its hem, over trousers."""
    waist, drape = wearer.tailoring.belt_m, tunic_drape(wearer)
    own, legs = tunic(wearer, waist), cloth_of(wearer, below)
    low = tail(wearer, own, legs, np.linspace(waist + 0.002, hem_m, 11), drape, TUNIC_M)
    low = over(wearer, low, legs, waist, 0.006)
    return join(own, low)


def _gakuran(wearer: Wearer) -> Pieces:
    hem, legs = _hip_m(wearer) - 0.10, suit_trousers(wearer)
    own = _closed(wearer, hem, legs)
    top = wearer.tailoring.collar_point[1] - 0.055
    heights = np.linspace(top - 0.025, wearer.tailoring.belt_m - 0.01, 5)
    row = buttons(own, np.stack([np.zeros(5), heights], axis=1))
    edge = front_strip(own, top, hem + 0.01)
    parts = {MAIN: [plain(own), plain(neckline(wearer, own)), plain(stand_collar(wearer, own)), edge], ACCENT: [row]}
    return [(garment("tunic", parts, wearer), "top"), (legs, "bottom")]


def _marching(wearer: Wearer) -> Pieces:
    tailoring, legs = wearer.tailoring, grey_trousers(wearer)
    hem = _hip_m(wearer) - 0.055
    own = _closed(wearer, hem, legs)
    top, low = tailoring.collar_point[1] - 0.085, tailoring.belt_m + 0.055
    heights = np.linspace(top, low, 6)
    cords, places = [], []
    for height in heights:
        half = 0.085 + 0.045 * (height - low) / (top - low)
        x = np.linspace(-half, half, 25)
        cords.append(
            plain(ribbon(own, np.stack([x, height + 0.012 * np.cos(x / half * np.pi)], axis=1), 0.0055, 0.004))
        )
        places += [(-half, height - 0.012), (0.0, height + 0.012), (half, height - 0.012)]
    crown, metal, plume = shako(wearer)
    parts = {
        MAIN: [plain(own), plain(neckline(wearer, own)), front_strip(own, top + 0.03, hem + 0.01)],
        SECOND: [plain(stand_collar(wearer, own)), belt(wearer, own), cuffs(wearer, own), *cords],
        ACCENT: [buttons(own, np.array(places), 0.010), *epaulettes(wearer, own)],
    }
    hat = {SECOND: crown, ACCENT: metal, MAIN: plume}
    striped = {MAIN: [stripes(wearer, cloth_of(wearer, legs))]}
    return [
        (garment("tunic", parts, wearer), "top"),
        (legs, "bottom"),
        (garment("stripes", striped, wearer), "bottom"),
        (garment("shako", hat, wearer), "hat"),
    ]


def _polo(wearer: Wearer) -> Pieces:
    legs = grey_trousers(wearer)
    top, trim, ends = polo_shirt(wearer, cloth_of(wearer, legs))
    return [
        (garment("shirt", {MAIN: [top, *trim]}, wearer), "top"),
        (legs, "bottom"),
        (bare_arms(wearer, ends - 0.06), "skin"),
    ]


def _dress(wearer: Wearer) -> Pieces:
    tailoring = wearer.tailoring
    waist = tailoring.belt_m + 0.01
    long = skirt(wearer, Skirt(waist + 0.012, tailoring.foot_m + 0.06, 0.090, 0.010, 22, 0.15, 0.977, other_leg=0.25))
    bodice = plain(close_dress(wearer, waist - 0.01))
    start = (tailoring.wrist_m - tailoring.shoulder[0]) * 0.60 + tailoring.shoulder[0]
    return [
        (garment("dress", {MAIN: [bodice, long]}, wearer, SKIRT_BONES), "dress"),
        (socks(wearer, MAIN, tailoring.foot_m + ANKLE_M), "bottom"),
        (bare_shoulders(wearer), "skin"),
        (bare_arms(wearer, start), "skin"),
    ]


def _dinner_suit(wearer: Wearer) -> Pieces:
    legs = suit_trousers(wearer)
    jacket = on_lap(wearer, suit_jacket(wearer, SECOND, SECOND), legs)
    tie = bow_tie(wearer, throat(wearer, cloth_of(wearer, jacket).points, 0.0))
    return [
        (jacket, "top"),
        (legs, "bottom"),
        (garment("bow_tie", {MAIN: [tie]}, wearer), "tie"),
    ]


OUTFITS = (
    Outfit(
        "concert_black",
        ("Concert black", "黒の演奏会服"),
        {"man": _suit, "woman": _blouse_and_trousers},
        {MAIN: BLACK, SECOND: NEAR_BLACK, ACCENT: (0.008, 0.008, 0.009)},
    ),
    Outfit(
        "white_shirt",
        ("White shirt and bow tie", "白シャツに蝶ネクタイ"),
        {"man": _tie_alone, "woman": _tie_alone},
        {ACCENT: (0.010, 0.010, 0.011)},
        (),
    ),
    Outfit(
        "school_blazer",
        ("School blazer", "制服（ブレザー）"),
        {"man": _blazer, "woman": _blazer_and_skirt},
        {MAIN: NAVY, SECOND: WHITE, ACCENT: (0.26, 0.02, 0.03)},
    ),
    Outfit(
        "school_uniform",
        ("Sailor uniform and gakuran", "制服（セーラー服・学ラン）"),
        {"woman": _sailor},
        {MAIN: NAVY, SECOND: WHITE, ACCENT: (0.36, 0.02, 0.03)},
    ),
    Outfit(
        "school_uniform",
        ("Sailor uniform and gakuran", "制服（セーラー服・学ラン）"),
        {"man": _gakuran},
        {MAIN: (0.010, 0.010, 0.013), ACCENT: GOLD},
    ),
    Outfit(
        "marching",
        ("Marching uniform", "マーチングの制服"),
        {"man": _marching, "woman": _marching},
        {MAIN: (0.30, 0.012, 0.02), SECOND: WHITE, ACCENT: GOLD},
    ),
    Outfit(
        "polo",
        ("Polo shirt", "ポロシャツ"),
        {"man": _polo, "woman": _polo},
        {MAIN: (0.02, 0.09, 0.26), SECOND: (0.75, 0.72, 0.62)},
    ),
    Outfit(
        "jazz_suit",
        ("Jazz suit", "ジャズのスーツ"),
        {"man": _suit, "woman": _suit_of_women},
        {MAIN: (0.045, 0.010, 0.020), SECOND: (0.012, 0.012, 0.014), ACCENT: (0.42, 0.40, 0.36)},
    ),
    Outfit(
        "evening",
        ("Long dress and dinner suit", "ロングドレス・タキシード"),
        {"man": _dinner_suit, "woman": _dress},
        {MAIN: BLACK, SECOND: WHITE},
    ),
)
