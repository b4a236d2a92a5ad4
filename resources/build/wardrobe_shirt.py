"""The shirt that the finished bodies wear: one of MakeHuman's, buttoned to the throat and tucked into the belt."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from character_body import surface_of
from character_cloth import Cloth, cut, drop_unused, folds, join, smoothstep
from character_garments import NECK_HALF_WIDTH_M, above_collar, collar, front_of, placket
from character_surface import Surface, vertex_normals
from scipy.ndimage import gaussian_filter1d
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree
from wardrobe_pieces import Wearer, all_of, connected, piece
from wardrobe_sewn import Sewn, gold, neck_band, plain, sewn_surface, throat

SHIRT, BUTTONS = "shirt", "buttons"
TUCK_M = 0.045
"""Depth of the hem below the top of the belt."""
BLOUSED_M = 0.10
"""Height above the belt over which the shirt is gathered into it."""
COLLAR_M = 0.075
"""Greatest depth in metres below the collar's seam of an asset's own collar."""
CLOSED_M, LIES_M = 0.010, 0.003
"""Distance of the edges of a closed front from the middle, and height of the cloth over the skin about the throat."""
STRIP_M = 0.0025
"""Height of the buttoned strip over the front."""
UNDER_STRIP_M = 0.006
"""Margin of the front under the strip."""
UNDER_M, SUNK_M = 0.008, 0.003
"""Margin of a layer under the border of the cloth that covers it, and its depth there below its own place."""


def _tucked(wearer: Wearer, cloth: Cloth) -> Cloth:
    """The shirt gathered into the belt."""
    tailoring, points = wearer.tailoring, cloth.points
    trunk, belt = tailoring.trunk, tailoring.belt_m
    angle, radius, centre = trunk.polar(points[:, 1], points[:, [0, 2]])
    at_belt = trunk.radius_at(np.full(len(points), belt), angle) + 0.002
    gather = smoothstep(points[:, 1], belt + 0.004, belt + BLOUSED_M)
    pleat = 0.0022 * folds(4.0 * angle / (2 * np.pi), np.zeros_like(angle), 0.23, seed=12) * gather * (1 - gather) * 4
    wanted = at_belt + (np.maximum(radius, at_belt) - at_belt) * gather + pleat
    share = 1.0 - smoothstep(points[:, 1], belt + BLOUSED_M, belt + BLOUSED_M + 0.03)
    share *= np.abs(points[:, 0]) < 0.9 * tailoring.shoulder[0] + 0.05
    moved = radius + (wanted - radius) * share
    points = points.copy()
    points[:, 0] = centre[:, 0] + moved * np.cos(angle)
    points[:, 2] = centre[:, 1] + moved * np.sin(angle)
    return replace(cloth, points=points)


def _without_collar(wearer: Wearer, cloth: Cloth, uvs: np.ndarray) -> Cloth:
    """Cloth without the islands of its texture coordinates that are entirely near the neck."""
    _, place = np.unique(np.round(np.concatenate([cloth.points, uvs], axis=1), 5), axis=0, return_inverse=True)
    faces, count = place.reshape(-1)[cloth.faces], int(place.max()) + 1
    edges = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]]])
    links = coo_array((np.ones(len(edges)), (edges[:, 0], edges[:, 1])), shape=(count, count))
    island = connected_components(links, directed=False)[1][place.reshape(-1)]
    away = (above_collar(wearer.tailoring, cloth.points) < -COLLAR_M) | (np.abs(cloth.points[:, 0]) > 0.15)
    kept = np.isin(island, np.unique(island[away]))
    return replace(cloth, faces=cloth.faces[kept[cloth.faces].all(axis=1)])


def closed(wearer: Wearer, cloth: Cloth) -> Cloth:
    """An open neck drawn together, and down to the skin of the throat."""
    tailoring, points = wearer.tailoring, cloth.points.copy()
    ahead = smoothstep(points[:, 2], tailoring.collar_point[2] + 0.02, tailoring.collar_point[2] + 0.06)
    levels = np.arange(points[:, 1].min(), points[:, 1].max() + 0.01, 0.006)
    front = points[ahead > 0.5]
    open_m = np.array([np.abs(front[np.abs(front[:, 1] - y) < 0.01, 0]).min(initial=0.05) for y in levels])
    wide = np.interp(points[:, 1], levels, gaussian_filter1d(np.maximum(open_m - CLOSED_M, 0.0), 1.0))
    aside = np.abs(points[:, 0])
    pull = wide * ahead * (1.0 - smoothstep(aside, wide + CLOSED_M, wide + 0.07))
    points[:, 0] -= np.sign(points[:, 0]) * pull
    suit = tailoring.suit
    _, rows = cKDTree(suit.points).query(points)
    normals = vertex_normals(suit.points, suit.faces)[rows]
    high = ((points - suit.points[rows]) * normals).sum(axis=1)
    seam = above_collar(tailoring, points)
    about = 1.0 - smoothstep(np.abs(points[:, 0]), 0.10, 0.14)
    down = about * smoothstep(seam, -0.09, -0.03) * np.maximum(high - LIES_M, 0.0)
    up = about * smoothstep(seam, -0.16, -0.10) * np.maximum(LIES_M - high, 0.0)
    return replace(cloth, points=points + (up - down)[:, None] * normals)


def neck_of(wearer: Wearer) -> Cloth:
    """The skin of head and neck in the T-pose."""
    whole = surface_of(wearer.source, wearer.fit, "neck", ("body",), "skin", morphs=False)
    places = wearer.fit.to_t_pose(whole.positions, whole.weights)
    _, first, place = np.unique(whole.origin, return_index=True, return_inverse=True)
    return Cloth(places[first], whole.weights[first], place.reshape(-1)[whole.triangles["skin"]])


def untucked(wearer: Wearer, material: str) -> Cloth:
    """The asset's shirt without its collar, in the T-pose; its texture coordinates are cut as the weights are."""
    surface = piece(
        wearer, SHIRT, wearer.shirt, connected(wearer, wearer.shirt, wearer.tailoring.shoulder[1]), all_of(material)
    )
    places = wearer.fit.to_t_pose(surface.positions, surface.weights)
    cloth = Cloth(places, np.concatenate([surface.weights, surface.uvs], axis=1), surface.triangles[material])
    return drop_unused(_without_collar(wearer, cloth, surface.uvs))


def laid(wearer: Wearer, cloth: Cloth) -> Sewn:
    """Cloth whose weights (N, J + 2) end with its texture coordinates."""
    joints = len(wearer.fit.names)
    return Sewn(replace(cloth, weights=cloth.weights[:, :joints]), cloth.weights[:, joints:])


def without_neck(wearer: Wearer, cloth: Cloth) -> Cloth:
    seam = above_collar(wearer.tailoring, cloth.points)
    return cut(cloth, np.maximum(-seam, np.abs(cloth.points[:, 0]) - NECK_HALF_WIDTH_M))


def neck_under(wearer: Wearer, over: Cloth) -> tuple[Sewn, Sewn]:
    """The layer that closes the neck between a cloth and the collar: all of it, and what of it shows.

    Of what the cloth covers only a margin along the cloth's border stays, deeper: on other bodies the layer would show
    through the cloth in spots.
    """
    whole = neck_band(wearer, -0.06, 0.012, 0.0008, 0.10)
    layer = whole.cloth
    _, place = np.unique(np.round(over.points, 5), axis=0, return_inverse=True)
    edges = over.faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    welded = np.sort(place.reshape(-1)[edges], axis=1)
    _, first, uses = np.unique(welded, axis=0, return_index=True, return_counts=True)
    border = edges[first[uses == 1]]
    shares = np.linspace(0.0, 1.0, 5)[:, None, None]
    along = over.points[border[:, 0]] * (1.0 - shares) + over.points[border[:, 1]] * shares
    corners = over.points[over.faces]
    inner = [corners.mean(axis=1), *(0.5 * (corners[:, k] + corners[:, k - 1]) for k in range(3)), over.points]
    far = cKDTree(np.concatenate(inner)).query(layer.points)[0]
    inside = cKDTree(along.reshape(-1, 3)).query(layer.points)[0]
    # Beyond the border it is what is nearest.
    covered = inside - far
    sunk = SUNK_M * smoothstep(covered, 0.0, UNDER_M)
    points = layer.points - sunk[:, None] * vertex_normals(layer.points, layer.faces)
    return whole, plain(cut(replace(layer, points=points), UNDER_M - covered))


def _under_strip(cloth: Cloth, strip: Cloth) -> np.ndarray:
    """Distance (N,) of a cloth's points inside the outline of a strip down its front, negative outside."""
    low, high = strip.points.min(axis=0), strip.points.max(axis=0)
    points = cloth.points
    inside = np.minimum(high[0] - np.abs(points[:, 0]), np.minimum(points[:, 1] - low[1], high[1] - points[:, 1]))
    return np.where(points[:, 2] > low[2] - TUCK_M, inside, -1.0)


def own_shirt(wearer: Wearer) -> Surface:
    """The shirt of a finished body with collar, placket and buttons."""
    tailoring = wearer.tailoring
    cloth = untucked(wearer, SHIRT)
    cloth = without_neck(wearer, cut(cloth, cloth.points[:, 1] - (tailoring.belt_m - TUCK_M)))
    whole = closed(wearer, _tucked(wearer, cloth))
    cloth = laid(wearer, whole).cloth
    layer, under = neck_under(wearer, cloth)
    front = front_of(join(cloth, layer.cloth))
    top_m = float(throat(wearer, tailoring.suit.points, 0.0)[1]) - 0.006
    strip, row = placket(tailoring, cloth, lambda x, y: front(x, y) + STRIP_M, top_m)
    turned = collar(tailoring, cloth, front, neck_of(wearer))
    sewn = laid(wearer, cut(whole, UNDER_STRIP_M - _under_strip(whole, strip)))
    parts = {SHIRT: [sewn, plain(turned), plain(strip), under], BUTTONS: [gold(row)]}
    return sewn_surface(SHIRT, parts, wearer)
