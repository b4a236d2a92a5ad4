"""Hair as cards: MakeHuman's meshes, their painted strands made grey, so that any colour tints them.

The painted pictures are 512 pixels wide. Finer strands are drawn along those that are painted: noise smeared along the
direction in which the picture changes least.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from character_assets import Asset, asset_surface, read_asset, read_material
from character_fine_hair import CURLY, PATCH_PX, STRAIGHT, drawn_hairs, free_patch, skin_of, with_fine_hairs
from character_fringe import FRINGED, strips, with_fringe
from character_skin import read_picture
from character_surface import Surface, parts_of, smooth_normals, triangulate, vertex_normals, weld
from character_textures import Texture, jpeg, noise, normals_of, png, sampled, spread, to_linear, to_srgb
from PIL import Image, ImageDraw
from scipy.ndimage import binary_opening, distance_transform_edt, gaussian_filter, label, map_coordinates, maximum
from scipy.spatial import cKDTree
from scipy.special import erf

if TYPE_CHECKING:
    from character_skeleton import SkeletonFit
    from character_source import Source

HAIR_PX = 1024
STRAND_STEPS, STRAND_STEP_PX, LOCK_STEP_PX = 14, 1.5, 3.0
STRANDS_MEAN_LINEAR = 0.32
"""Mean of the grey strands, by which a hair colour is divided to tint them, up to fair hair."""
ALPHA_CUTOFF = 0.4
LOCK_HEIGHT, STRAND_SLOPE = 0.45, 0.2
HAIR_HEIGHT = 2.0
"""Height of single hairs, in deviations of strands."""
STRAND_CONTRAST, LOCK_CONTRAST = 0.48, 0.2
"""Deviations of the grey of single strands and of locks."""
PAINTED_CONTRAST = 0.75
"""Power of the painted shades: as they are, grey hair is a heap of shards."""
FLECK_PX = 150
CAP_HALF_PX, HAIRLINE_PX, EDGE_PX = 40, 40, 10
"""Distances in pixels: half the width of parts that cover the scalp, width of faint hairs before their edge, and width
behind it in which shades are evened, since painted edges are pale.
"""
BAND_HALF_PX = 80
"""Half the width of parts of the scalp's hair below which they are bands, whose edges do not dissolve."""
FRINGE_PX, FRINGE_STEEP, FRINGE_STEPS = 14, 4.0, 2
"""Width over which an edge of the scalp's hair dissolves into fine hairs, the steepness of their ends, their length."""
LEAST_LEFT, FRINGE_SHARES = 0.85, (1.0, 0.5, 0.25)
"""Share of a style's opaque pixels that dissolving edges leaves at least, and shares of the widths tried for it."""
EVEN_PX = 9.0
"""Reach over which the painted spikes of a hairline are evened before it dissolves."""
WELD_M, ROOT_M, ROOT_PX = 0.0015, 0.003, 20
"""Distance within which faces of a mesh that end at one place are taken for joined, that from the skin within which
the end of a lock is its root, and the width over which roots dissolve.
"""
CURLED = frozenset({"afro01"})
"""Styles of curls, whose painted lace has the grid of a repeated tile; curls are drawn instead."""
HANGING = frozenset({"braid01", "long01"})
"""Styles whose edges hang in front of forehead, cheeks and neck, up to 12 mm from the skin: they end as painted,
without single hairs, which would have to bend back to the skin.
"""
CAP_ALONE, CAP_FACES = frozenset({"afro01", "short01", "short04"}), 100
"""Styles without their locks, half of which are lit from behind or end bluntly on the forehead, and the least number
of faces of a cap.
"""
TUFT_M = 0.04
"""Extent below which a part is a tuft."""
CURLS_PX, CURL_STEPS, CURL_BLUR_PX, LACE, LACE_CLOSED = (7.0, 30.0), 7, 1.1, (0.3, 0.8, 0.35), 1.5
"""Waves of the directions of curls, half their length in steps and their width; least and greatest median of the
alpha of lace and the greatest spread of it, and by how much it is closed."""
OVER_AN_EYE = {
    "bob02": ((0.0, 0.035, 0.085), (1.0, 0.8, 0.0)),
    "braid01": ((0.0, 0.018, 0.042), (1.0, 0.7, 0.0)),
}
"""Styles that are combed aside: share of the way by height over the eyes, metres."""
AXIS_M, FREE_DEG, BEHIND_DEG = 0.07, 58.0, 105.0
"""Distance of the head's axis behind the eyes; angles about it, from ahead to the right, of the edge of hair that is
combed aside, and of that which stays."""
FAINT, EDGE_SHADE = 0.25, 0.85
"""Alpha below which hairs before the edge are invisible except as fragments, and shade of the others."""
GREYS, ALPHAS = 32, 8
"""Number of steps of grey and alpha, which halve the size of the pictures."""


def covered(uvs: np.ndarray, uv_faces: np.ndarray, size: int) -> np.ndarray:
    """Mask (size, size) of the texture's pixels used by faces."""
    canvas = Image.new("1", (size, size))
    drawing = ImageDraw.Draw(canvas)
    for face in uv_faces:
        drawing.polygon([(u * size, (1 - v) * size) for u, v in uvs[face]], fill=1, outline=1)
    return np.asarray(canvas)


def directions(grey: np.ndarray, reach_px: float) -> tuple[np.ndarray, np.ndarray]:
    """(H, W, 2) unit vectors (row, column) along which a picture changes least (its structure tensor), and how clearly.

    The second is (H, W), from 0, alike in all directions, to 1.
    """
    down, right = np.gradient(gaussian_filter(grey, 1.0))
    dd, dr, rr = (gaussian_filter(product, reach_px) for product in (down * down, down * right, right * right))
    across = 0.5 * np.arctan2(2 * dr, dd - rr)
    clear = np.hypot(dd - rr, 2 * dr) / np.maximum(dd + rr, 1e-12)
    return np.stack([-np.sin(across), np.cos(across)], axis=-1), clear


def strands(
    along: np.ndarray, seed: int, steps: int = STRAND_STEPS, blur_px: float = 0.55, step_px: float = STRAND_STEP_PX
) -> np.ndarray:
    """(H, W) fine strands, mean 0 and deviation 1: white noise averaged along the directions, both ways."""
    height, width = along.shape[:2]
    white = gaussian_filter(np.random.Generator(np.random.PCG64(seed)).normal(0, 1, (height, width)), blur_px)
    total = white.copy()
    start = np.stack(np.meshgrid(np.arange(height), np.arange(width), indexing="ij"), axis=-1).astype(float)
    for sign in (1.0, -1.0):
        place, heading = start.copy(), along * sign
        for _ in range(steps):
            place += heading * step_px
            rows = np.clip(np.round(place[..., 0]).astype(int), 0, height - 1)
            columns = np.clip(np.round(place[..., 1]).astype(int), 0, width - 1)
            ahead = along[rows, columns]
            # A direction has no sign: keep on.
            heading = ahead * np.where((ahead * heading).sum(axis=-1) < 0, -1.0, 1.0)[..., None]
            total += map_coordinates(white, [place[..., 0], place[..., 1]], order=1, mode="nearest")
    return (total - total.mean()) / total.std()


def in_steps(picture: np.ndarray, count: int) -> np.ndarray:
    return np.round(np.clip(picture, 0, 1) * (count - 1)) / (count - 1)


def enlarged(picture: np.ndarray, size: int) -> np.ndarray:
    centres = (np.arange(size) + 0.5) / size
    u, v = np.meshgrid(centres, centres[::-1])
    return np.clip(sampled(picture, u, v), 0.0, 1.0)


def _flecks(seen: np.ndarray) -> np.ndarray:
    """Mask (H, W) of spots too small for a lock, which would float beside the hair."""
    spots, count = label(seen)
    sizes = np.bincount(spots.ravel(), minlength=count + 1)
    return seen & (sizes[spots] < FLECK_PX)


def _caps(alpha: np.ndarray, least_px: float = CAP_HALF_PX) -> np.ndarray:
    """Mask (H, W) of the parts that cover the scalp, half of whose width is at least `least_px`, unlike any lock's."""
    parts, count = label(alpha > 0.5)
    half = maximum(distance_transform_edt(parts > 0), parts, np.arange(count + 1))
    return (parts > 0) & (half >= least_px)[parts]


def _bare(alpha: np.ndarray, used: np.ndarray, mesh_ends_here: np.ndarray) -> np.ndarray:
    """Mask (H, W) of what faces show without hair, and of the lines where the mesh ends."""
    # Painted spikes are evened, or the hairline would be a saw.
    even = gaussian_filter(alpha * used, EVEN_PX) / np.maximum(gaussian_filter(used.astype(float), EVEN_PX), 1e-6)
    # A line of few pixels is where the drawing of a face ends.
    return binary_opening(used & (even < 0.5), iterations=3) | mesh_ends_here


def _fringe(
    alpha: np.ndarray, along: np.ndarray, used: np.ndarray, ends_here: tuple[np.ndarray, np.ndarray]
) -> np.ndarray:
    """Alpha (H, W) with the hairline dissolved into fine hairs: the nearer to where nothing is painted, or to where
    the mesh ends (masks `ends_here`), the fewer. Roots of locks dissolve likewise.

    Where only the drawing of a face ends, as at a seam of the texture, nothing changes, nor at edges of bands. The
    edges are narrower, or stay, in a style that would lose more than a small share of its hair.
    """
    bare = _bare(alpha, used, ends_here[0])
    single = strands(along, 33, FRINGE_STEPS, 0.3)
    ends = 0.5 * (1.0 + erf(single / np.sqrt(2.0)))
    # Of a band little wider than its edges single hairs would be left, apart from all others.
    scalp, locks = _caps(alpha, BAND_HALF_PX), ~_caps(alpha)
    for share in FRINGE_SHARES:
        thinned = alpha
        for edge, parts, width in ((bare, scalp, FRINGE_PX), (ends_here[1], locks, ROOT_PX)):
            if not edge.any():
                continue
            inside = distance_transform_edt(~edge) / (share * width)
            left = np.clip(ALPHA_CUTOFF + (inside - ends) * FRINGE_STEEP, 0.0, 1.0)
            thinned = np.where(parts & (inside < 1.0), np.minimum(thinned, left), thinned)
        if (thinned > ALPHA_CUTOFF).sum() >= LEAST_LEFT * (alpha > ALPHA_CUTOFF).sum():
            return thinned
    return alpha


def _hairline(grey: np.ndarray, alpha: np.ndarray, fine: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Grey and alpha with an even shade and without fragments along the edges of the parts that cover the scalp."""
    caps = _caps(alpha)
    if not caps.any():
        return grey, alpha
    outside = distance_transform_edt(~caps)
    near = (outside > 0) & (outside < HAIRLINE_PX) & (alpha < 0.5)
    even = np.clip(STRANDS_MEAN_LINEAR * EDGE_SHADE * (1 + 0.34 * fine), 0.02, 0.95)
    own = np.clip(distance_transform_edt(caps) / EDGE_PX, 0.0, 1.0)
    shaded = np.where(caps, grey * own + even * (1 - own), np.where(near, even, grey))
    seen = np.clip((alpha - FAINT) * ALPHA_CUTOFF / (ALPHA_CUTOFF - FAINT), 0.0, 1.0)
    return shaded, np.where(near, seen, alpha)


def mesh_ends(asset: Asset, positions: np.ndarray, near_skin: np.ndarray, size: int) -> tuple[np.ndarray, np.ndarray]:
    """Masks (size, size) of the lines of the texture along which a mesh ends in space, and of those near the skin.

    Parameters
    ----------
    positions : (N, 3) places of the mesh's vertices in metres.
    near_skin : (N,) bool, whether they lie on the skin.
    """
    places = cKDTree(positions).query_ball_point(positions, WELD_M)
    welded = np.array([min(near) for near in places])
    edges, lines, roots = [], [], []
    for face, uv_face in zip(asset.faces, asset.uv_faces, strict=True):
        for a, b in zip(range(4), (1, 2, 3, 0), strict=True):
            if face[a] != face[b]:
                edges.append(sorted(welded[face[[a, b]]]))
                lines.append(uv_face[[a, b]])
                roots.append(near_skin[face[[a, b]]].all())
    numbered, counts = np.unique(edges, axis=0, return_inverse=True, return_counts=True)[1:]
    ends = counts[numbered.ravel()] == 1
    masks = []
    for kept in (ends, ends & np.array(roots)):
        canvas = Image.new("1", (size, size))
        drawing = ImageDraw.Draw(canvas)
        for line in np.array(lines)[kept]:
            drawing.line([(u * size, (1 - v) * size) for u, v in asset.uvs[line]], fill=1, width=2)
        masks.append(np.asarray(canvas))
    return masks[0], masks[1]


def _near_skin(positions: np.ndarray, source: Source) -> np.ndarray:
    """Mask (N,) of positions on the skin of a body, or beneath it."""
    quads = source.groups["body"].vertices
    normals = vertex_normals(source.vertices, triangulate(quads, source.vertices))
    rows = np.unique(quads)
    nearest = rows[cKDTree(source.vertices[rows]).query(positions)[1]]
    above = np.einsum("nk,nk->n", positions - source.vertices[nearest], normals[nearest])
    return above < ROOT_M


@dataclass(frozen=True)
class Strands:
    """Pictures (H, W) of a style of hair: linear grey, alpha, heights, directions (H, W, 2).

    Attributes
    ----------
    scalp : the parts that cover the scalp.
    bare : where they end.
    """

    grey: np.ndarray
    alpha: np.ndarray
    heights: np.ndarray
    along: np.ndarray
    scalp: np.ndarray
    bare: np.ndarray


def with_single_hairs(strands: Strands, corner: tuple[int, int], curled: bool = False) -> Strands:
    """The pictures with the hairs of cards drawn from a corner on."""
    place = tuple(slice(start, start + length) for start, length in zip(corner, PATCH_PX, strict=True))
    shade, hairs = drawn_hairs(curled)
    grey, alpha, heights = strands.grey.copy(), strands.alpha.copy(), strands.heights.copy()
    grey[place], alpha[place] = np.clip(STRANDS_MEAN_LINEAR * shade, 0.02, 0.95), hairs
    heights[place] = HAIR_HEIGHT * gaussian_filter(hairs, 0.8)
    return replace(strands, grey=grey, alpha=alpha, heights=heights)


def _curls(painted: np.ndarray, used: np.ndarray) -> np.ndarray:
    """A painted (H, W, 4) picture with curls drawn over the parts of even shade and over lace."""
    size = len(used)
    angle = 2.0 * np.pi * noise(size, *CURLS_PX, 35)
    curls = strands(np.stack([np.sin(angle), np.cos(angle)], axis=-1), 36, CURL_STEPS, CURL_BLUR_PX)
    covering = gaussian_filter(painted[..., 3], CURLS_PX[1])
    drawn = painted.copy()
    parts, count = label(used)
    for part in range(1, count + 1):
        own = parts == part
        inner = own & (distance_transform_edt(own) > CAP_HALF_PX)
        if not inner.any():
            continue
        low, median, high = np.quantile(covering[inner], (0.1, 0.5, 0.9))
        if median > LACE[1] or (median > LACE[0] and high - low < LACE[2]):
            drawn[own, :3] = to_srgb(0.3 * np.exp(STRAND_CONTRAST * curls[own]))[:, None]
        if LACE[0] < median < LACE[1] and high - low < LACE[2]:
            share = np.clip(LACE_CLOSED * covering[own], 0.0, 1.0)
            drawn[own, 3] = np.clip(0.5 + 2.0 * (share - 0.5 * (1.0 + erf(curls[own] / np.sqrt(2.0)))), 0.0, 1.0)
    return drawn


def hair_strands(
    painted: np.ndarray, used: np.ndarray, ends_here: tuple[np.ndarray, np.ndarray], *, dissolved: bool = True
) -> Strands:
    """Grey strands from a painted (H, W, 4) picture of the wanted size; unused parts are empty.

    `used` is the mask of the pixels that faces use, `ends_here` are those where the mesh ends (`mesh_ends`). The
    hairline is `dissolved` into single hairs, or ends as painted.
    """
    alpha = painted[..., 3] * used
    solid = alpha > 0.5
    grey = to_linear(painted[..., :3]) @ np.array([0.2126, 0.7152, 0.0722])
    smooth = gaussian_filter(spread(grey, solid), 6)
    # Shine and shade painted over whole locks are mostly taken out; light does that.
    grey = spread(grey, solid) / (smooth + 1e-3) ** 0.75
    along, clear = directions(grey / grey[solid].mean(), 4.0)
    # Without a clear direction strands would curl like wood grain.
    fine = strands(along, 31) * np.minimum(1.0, 0.25 + 1.25 * clear)
    locks = strands(along, 34, 2 * STRAND_STEPS, 3.0, LOCK_STEP_PX) * np.minimum(1.0, 0.25 + 1.25 * clear)
    grey = (grey / grey[solid].mean()) ** PAINTED_CONTRAST * np.exp(STRAND_CONTRAST * fine + LOCK_CONTRAST * locks)
    grey = np.clip(grey / grey[solid].mean() * STRANDS_MEAN_LINEAR, 0.02, 0.95)
    # Strands end apart: the edge of a lock is where its alpha falls, sooner between strands.
    alpha = np.clip(alpha * 1.35 + 0.15 * fine * (alpha > 0.02) * (alpha < 0.95), 0.0, 1.0)
    grey, alpha = _hairline(spread(grey, solid), alpha, fine)
    for least in (0.0, ALPHA_CUTOFF):
        alpha[_flecks(alpha > least)] = 0.0
    even = gaussian_filter(alpha, EVEN_PX / 3.0) * used
    scalp, bare = _caps(even), _bare(alpha, used, ends_here[0])
    alpha = _fringe(alpha, along, used, ends_here) if dissolved else alpha
    # Locks follow the painted picture, strands the noise.
    heights = gaussian_filter(locks, 1.5) * LOCK_HEIGHT + gaussian_filter(fine, 0.6)
    return Strands(grey, alpha, heights, along, scalp, bare)


def hair_textures(style: str, strands: Strands) -> tuple[Texture, Texture]:
    """Grey strands with alpha, and their normals, which have half the size."""
    shade = in_steps(to_srgb(strands.grey), GREYS)
    colour = png(f"hair_{style}_color", np.stack([shade, shade, shade, in_steps(strands.alpha, ALPHAS)], axis=-1))
    heights = strands.heights[::2, ::2]
    return colour, jpeg(f"hair_{style}_normal", normals_of(heights, STRAND_SLOPE), quality=85)


def hair(folder: Path, style: str, source: Source, fit: SkeletonFit) -> tuple[Surface, Texture, Texture]:
    """A style of hair on a body, its colour and its normals."""
    base, boxes = FRINGED.get(style, (style, ()))
    asset = read_asset(folder / "hair" / base / f"{base}.mhclo")
    if asset.material is None:
        raise ValueError(f"{style} has no material")
    painted = read_picture(read_material(asset.material).textures["diffuseTexture"])
    curled = style in CURLED
    # Beyond its edge a picture begins again, in files of whole numbers too.
    asset = replace(asset, uvs=np.clip(asset.uvs, 0.0, 1.0))
    if style in CAP_ALONE:
        asset = _without_locks(asset)
    used = covered(asset.uvs, asset.uv_faces, HAIR_PX)
    surface = lit_like_the_cap(asset_surface(asset, source, fit, "hair", "hair"))
    positions = asset.binding.positions(source.vertices)
    ends_here = mesh_ends(asset, positions, _near_skin(positions, source), HAIR_PX)
    if style in OVER_AN_EYE:
        surface = _combed(surface, fit, *OVER_AN_EYE[style])
    large = enlarged(painted, HAIR_PX)
    made = hair_strands(_curls(large, used) if curled else large, used, ends_here, dissolved=style not in HANGING)
    if style in HANGING:
        return surface, *hair_textures(style, made)
    corner = free_patch(used)
    if corner is None:
        raise ValueError(f"the picture of {style} has no room for single hairs")
    standing = CURLY if curled else STRAIGHT
    skin = skin_of(source)
    surface = with_fine_hairs(surface, skin, made.along, made.scalp, made.bare, corner, standing)
    if boxes:
        surface = with_fringe(
            surface, skin.points, fit.world_from_joint_rest[fit.index("rightEye"), :3, 3], strips(painted, boxes)
        )
    return surface, *hair_textures(style, with_single_hairs(made, corner, curled))


def _without_locks(asset: Asset) -> Asset:
    """The asset without its locks: parts of few faces that are connected to no others."""
    parts = parts_of(asset.faces, len(asset.binding.corners))[asset.faces[:, 0]]
    kept = np.bincount(parts)[parts] >= CAP_FACES
    return replace(asset, faces=asset.faces[kept], uv_faces=asset.uv_faces[kept])


def lit_like_the_cap(surface: Surface) -> Surface:
    """The surface with tufts, which stand on the cap of hair, turned and lit as the cap is beneath them."""
    (material,) = surface.triangles
    faces = surface.triangles[material]
    labels = weld(surface)
    parts = parts_of(labels[faces], labels.max() + 1)[labels]
    extents = np.array([np.ptp(surface.positions[parts == part], axis=0).max() for part in range(parts.max() + 1)])
    tuft = extents[parts] < TUFT_M
    if not tuft.any() or tuft.all():
        return surface
    nearest = cKDTree(surface.positions[~tuft]).query(surface.positions[tuft])[1]
    normals = surface.normals.copy()
    normals[tuft] = surface.normals[~tuft][nearest]
    a, b, c = (surface.positions[faces[:, k]] for k in range(3))
    inwards = np.einsum("nk,nk->n", np.cross(b - a, c - a), normals[faces[:, 0]]) < 0.0
    turned = np.where((inwards & tuft[faces[:, 0]])[:, None], faces[:, [0, 2, 1]], faces)
    return replace(surface, normals=normals, triangles={material: turned})


def _combed(surface: Surface, fit: SkeletonFit, heights_m: tuple[float, ...], shares: tuple[float, ...]) -> Surface:
    """Hair whose parting falls over the right eye, combed to the temple."""
    points = fit.to_t_pose(surface.positions, surface.weights)
    eye = fit.positions_t[fit.index("rightEye")]
    off = points - np.array([0.0, 0.0, eye[2] - AXIS_M])
    angle, radius = np.degrees(np.arctan2(-off[:, 0], off[:, 2])), np.hypot(off[:, 0], off[:, 2])
    levels = np.arange(points[:, 1].min(), points[:, 1].max() + 0.01, 0.005)
    own = (angle > -25.0) & (angle < BEHIND_DEG)
    first = [angle[own & (np.abs(points[:, 1] - y) < 0.012)].min(initial=BEHIND_DEG - 1.0) for y in levels]
    edge = np.interp(points[:, 1], levels, gaussian_filter(np.array(first), 1.5))
    free = np.interp(points[:, 1] - eye[1], heights_m, shares)
    goal = np.maximum(edge, edge + (FREE_DEG - edge) * free)
    share = np.clip((angle - edge) / (BEHIND_DEG - edge), 0.0, 1.0)
    turned = np.radians(np.where(own, goal + share * (BEHIND_DEG - goal), angle))
    moved = np.stack([-radius * np.sin(turned), points[:, 1], radius * np.cos(turned) + eye[2] - AXIS_M], axis=1)
    return smooth_normals(replace(surface, positions=fit.to_rest_pose(moved, surface.weights)))
