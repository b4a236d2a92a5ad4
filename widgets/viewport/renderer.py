"""Renderer of a stage with gloo, which owns all objects on the graphics card.

Near players are drawn one by one, with faces morphed on the processor and only moved vertices sent; far players are
drawn by a single draw call with coarser shapes. The bones of all players are in one float texture, uploaded once per
frame.
"""

from __future__ import annotations

from collections import OrderedDict
from itertools import chain
from pathlib import Path
from typing import Any

import numpy as np
from vispy import gloo
from vispy.gloo import gl

from app.arrays import FloatArray, IndexArray, SingleArray
from app.formats.video import Picture
from widgets.viewport.camera import Camera
from widgets.viewport.cast import Stage
from widgets.viewport.colours_and_lights import Emphasis, ViewportLook
from widgets.viewport.geometry import (
    LEVELS,
    Crowd,
    crowd_edges,
)
from widgets.viewport.limb_capsules import HELD, LIMBS, SHADING, LimbCapsules
from widgets.viewport.shape_model import Geometry, LevelsOfDetail
from widgets.viewport.shapes import MOST_NEAR, MOST_NEAR_AT_REST, Shapes, Solid, draw_sides, looks_same, sides, unmade
from widgets.viewport.texture_maps import MULTISAMPLED, WHOLE_PIXELS, TextureMaps

FINE_PX_PER_M = 620.0
"""Pixels per metre above which a player is drawn with all vertices."""
COARSE_PX_PER_M = 120.0
"""Pixels per metre below which a player is drawn with the fewest vertices, together with all others."""
HASTY_FACTOR = 1.7
"""Factor by which sizes are reduced for choosing levels of detail in fast pictures."""
SOFTWARE = ("llvmpipe", "softpipe", "swiftshader", "software", "basic render", "gdi generic")
"""Parts of the names of software renderers."""
GL_MULTISAMPLE, GL_SAMPLE_ALPHA_TO_COVERAGE, GL_SAMPLES = 0x809D, 0x809E, 0x80A9
_ALL = 2**30
_NO_LOOK = (0.0, 0.0, 0.0, 0.0)
MIDDLE_M = np.array([0.0, 1.0, 0.0])
"""Approximate position of a player's chest in metres."""
SPREAD_M = 1.25
"""Greatest distance in metres of parts of a player or instrument from the chest."""
SHADOW_RADIUS_M = 1.9
OVER = ("src_alpha", "one_minus_src_alpha", "zero", "one")
"""Blending over the existing picture, which stays opaque."""

_SHADERS = Path(__file__).with_name("shaders")
"""Folder of the programs in GLSL 120, which all drivers of the last fifteen years support."""
RING_M = 0.48
PODIUM_M = (0.28, 0.55)
"""Radii in metres of the rings around a player, and of those at the conductor's place."""


def _program(name: str) -> Any:
    """Return a shader program, read from files, with constants such as the number of limbs inserted."""
    numbers = {"SHADERS": str(SHADING + 1), "HELD": f"{HELD}.0", "LIMBS": str(LIMBS)}
    sources = [(_SHADERS / f"{name}.{end}").read_text("utf-8") for end in ("vert", "frag")]
    for word, number in numbers.items():
        sources = [source.replace(word, number) for source in sources]
    return gloo.Program(*sources)


class Renderer:
    """Draws the performers of a `Stage` with OpenGL into the current context."""

    def __init__(self) -> None:
        self._figures, self._batch = _program("figure"), _program("figure")
        self._backdrop, self._shadows, self._ring = _program("backdrop"), _program("shadow"), _program("ring")
        corners = np.array([(-1, -1), (1, -1), (-1, 1), (1, 1)], np.float32)
        self._backdrop["a_corner"] = corners
        self._ring["a_corner"] = corners
        self._maps = TextureMaps()
        self._video = _program("video")
        self._video["a_corner"] = corners
        self._video_picture: Picture | None = None
        self._solids: dict[int, Solid] = {}
        self._morphed: OrderedDict[tuple[int, int], tuple[Any, object]] = OrderedDict()
        self._stage: Stage | None = None
        self._shapes: Shapes | None = None
        self._limbs: LimbCapsules | None = None
        self._middles_m = np.zeros((0, 3))
        self._sent: dict[object, object] = {}
        """Sources of the programs' uniforms: most pictures have the camera and look of the one before."""
        self._software: bool | None = None
        self.missing: tuple[LevelsOfDetail, ...] = ()
        """Performers' levels of detail that the last picture would have needed, had they been made, the nearest
        first."""

    def set_stage(self, stage: Stage, shapes: Shapes, everyone: Crowd | None) -> None:
        """Set the stage to draw.

        Parameters
        ----------
        stage : Stage
            Stage with at least one performer: see `clear_stage`.
        shapes : Shapes
            Geometries of its performers.
        everyone : Crowd or None
            Crowd of this stage and these shapes (`crowd_of`), made outside the window's thread. None to keep the
            previous crowd, if only places have changed.
        """
        same = self._stage is not None and shapes is self._shapes and looks_same(stage, self._stage)
        self._stage, self._shapes = stage, shapes
        floor_m = np.array([member.world_from_player[:, 3] for member in stage.members]).reshape(-1, 3)
        self._middles_m = floor_m + MIDDLE_M
        self._sent.clear()
        if same:
            # The same players at other positions: uploaded data remains valid.
            self._limbs = LimbCapsules(stage)
            return
        figures = (*shapes.characters.values(), *shapes.instruments.values())
        alive = {id(level) for levels in figures for level in levels.made} | {
            id(shapes.stand),
            *map(id, shapes.supports.values()),
        }
        self._solids = {key: solid for key, solid in self._solids.items() if key in alive}
        self._morphed.clear()
        count = len(stage.members)
        if everyone is None:
            raise ValueError("other figures need their crowd")
        self._limbs = LimbCapsules(stage)
        self._bone_rows = np.zeros((count, 3 * stage.bones.shape[1] + 1, 4), np.float32)
        self._bones = gloo.Texture2D(self._bone_rows, internalformat="rgba32f", interpolation="nearest")
        self._limb_rows = np.zeros((count, 2 * LIMBS + 1, 4), np.float32)
        self._limb_texture = gloo.Texture2D(self._limb_rows, internalformat="rgba32f", interpolation="nearest")
        size = (float(self._bone_rows.shape[1]), float(count))
        for program, batched in ((self._figures, 0.0), (self._batch, 1.0)):
            program["u_bones"] = self._bones
            program["u_bones_size"] = size
            program["u_batched"] = batched
            program["u_row"] = 0.0
            program["u_lift"] = 0.0
            program["u_line"] = (0.0, 0.0, 0.0, 0.0)
            program["u_limbs"] = self._limb_texture
            program["u_limbs_size"] = (float(self._limb_rows.shape[1]), float(count))
            program["u_shaded"] = 0.0
            self._maps.undress(program)
            program["a_uv"] = (0.0, 0.0)
            program["u_factor"], program["u_surface"], program["u_shared"] = _NO_LOOK, _NO_LOOK, (0.0, 0.0, 1.0)
            program["u_color_px"], program["u_least"] = 1.0, WHOLE_PIXELS
            for place in ("u_color_place", "u_surface_place", "u_normal_place"):
                program[place] = _NO_LOOK
        self._figures["a_row"] = 0.0
        self._shadows["u_limbs"] = self._limb_texture
        self._shadows["u_limbs_size"] = (float(self._limb_rows.shape[1]), float(count))
        square = np.array([(-1, -1), (1, -1), (-1, 1), (-1, 1), (1, -1), (1, 1)], np.float32)
        corners = np.zeros((count, 6, 3), np.float32)
        corners[:, :, :2] = square
        corners[:, :, 2] = np.arange(count)[:, None]
        self._shadows["a_corner"] = corners.reshape(-1, 3)
        self._fill_batch(everyone)

    def clear_stage(self) -> None:
        """Remove all players; the graphics card frees them with the next picture."""
        self._stage = self._shapes = self._limbs = None
        self._solids.clear()
        self._maps.clear()
        self._morphed.clear()
        self._sent.clear()

    def _draws_without_card(self) -> bool:
        if self._software is None:
            name = str(gl.glGetParameter(gl.GL_RENDERER)).lower()
            self._software = any(part in name for part in SOFTWARE)
        return self._software

    def _fill_batch(self, everyone: Crowd) -> None:
        """Send the vertices of the crowd to the graphics card, without keeping a copy."""
        self._batch.bind(gloo.VertexBuffer(everyone.shape))
        self._batch.bind(gloo.VertexBuffer(everyone.surface))
        self._batch["a_row"] = gloo.VertexBuffer(everyone.rows)
        self._batch_triangles = sides(everyone)
        self._batch_edges: Any = None
        self._batch_parts = everyone.parts

    def draw(self, camera: Camera, size_px: tuple[int, int], look: ViewportLook, emphasis: Emphasis) -> None:
        """Draw a picture of a size into the framebuffer that is bound."""
        width, height = size_px
        aspect = width / max(height, 1)
        gloo.set_viewport(0, 0, width, height)
        self.missing = ()
        gloo.set_state(depth_test=False, blend=False, cull_face=False)
        gloo.clear(color=(*look.horizon, 1.0), depth=True)
        hasty = emphasis.in_motion and self._draws_without_card()
        context = gloo.get_current_canvas().context
        context.glir.command("FUNC", "glDisable" if hasty else "glEnable", GL_MULTISAMPLE)
        matrix = camera.clip_from_world(aspect)
        if self._is_other(self._backdrop, camera, aspect, look):
            self._dress_backdrop(camera, aspect, look)
        self._backdrop.draw("triangle_strip")
        if emphasis.video is not None:
            self._draw_video(emphasis.video, emphasis.video_opacity, aspect)
        stage, shapes, limbs = self._stage, self._shapes, self._limbs
        if stage is None or shapes is None or limbs is None or not stage.members or not stage.shown.any():
            return
        # While the camera moves, drawing waits for no texture; a still picture uses all of them.
        self._maps.left = 1 if emphasis.in_motion else _ALL
        most = MOST_NEAR if emphasis.in_motion else MOST_NEAR_AT_REST
        level = self._levels(stage, camera, matrix, height / HASTY_FACTOR if hasty else height, most)
        near = np.flatnonzero((level >= 0) & (level < LEVELS - 1))
        away_m = np.linalg.norm(self._middles_m[near] - camera.eye_m, axis=1)
        coarse = unmade(stage, shapes, near[np.argsort(away_m, kind="stable")])
        # The one in close-up is worth a short wait.
        awaited = [row for row in coarse if emphasis.is_final or (row == near[np.argmin(away_m)] and level[row] == 0)]
        for levels in chain(*(coarse.pop(row) for row in awaited)):
            levels.complete()
        if coarse:
            level[[*coarse]] = LEVELS - 1
            self.missing = tuple(dict.fromkeys(chain(*coarse.values())))
        self._upload(stage, limbs, level, emphasis)
        clip = matrix.T.astype(np.float32)
        gloo.set_state(blend=True, blend_func=OVER)
        if self._is_other(self._shadows, camera, aspect, look):
            self._shadows["u_clip_from_world"] = clip
            self._shadows["u_key"] = look.key
            self._shadows["u_strength"] = look.shadow
        self._shadows.draw("triangles")
        self._draw_rings(stage, clip, emphasis)
        gloo.set_state(blend=False, depth_test=True)
        for program in (self._figures, self._batch):
            if self._is_other(program, camera, aspect, look):
                self._light(program, camera, clip, look)
        if (level == LEVELS - 1).any():
            draw_sides(self._batch, self._batch_triangles)
        # For cut-out materials alpha is the share of samples drawn; the picture itself stays opaque.
        gloo.set_color_mask(True, True, True, False)
        whole = hasty or gl.glGetParameter(GL_SAMPLES) < 2
        self._figures["u_least"] = WHOLE_PIXELS if whole else MULTISAMPLED
        context.glir.command("FUNC", "glEnable", GL_SAMPLE_ALPHA_TO_COVERAGE)
        self._draw_near(stage, shapes, level, "triangles")
        context.glir.command("FUNC", "glDisable", GL_SAMPLE_ALPHA_TO_COVERAGE)
        gloo.set_color_mask(True, True, True, True)
        if emphasis.wireframe:
            # Lines closer together than pixels would hide the players.
            opacity = 0.4 * float(np.clip(camera.pixels_per_metre(height) / 900.0, 0.25, 1.0))
            self._draw_wires(stage, shapes, level, 0.0006 * camera.distance_m, (*look.wire, opacity))

    def _is_other(self, program: Any, *source: object) -> bool:
        """Return whether a program's uniforms were last set from another ``source``, and record the new one."""
        if self._sent.get(program) == source:
            return False
        self._sent[program] = source
        return True

    def _dress_backdrop(self, camera: Camera, aspect: float, look: ViewportLook) -> None:
        program = self._backdrop
        tangent = float(np.tan(np.radians(camera.fov_deg) / 2.0))
        program["u_eye"] = camera.eye_m
        program["u_forward"] = -camera.backward
        program["u_across"] = camera.right * tangent * aspect
        program["u_over"] = camera.up * tangent
        program["u_top"], program["u_horizon"] = look.top, look.horizon
        program["u_floor"], program["u_lines"] = look.floor, look.lines
        middle, radius = (0.0, 0.0), 4.5
        if len(self._middles_m):
            places = self._middles_m[:, [0, 2]]
            low, high = places.min(axis=0), places.max(axis=0)
            middle = tuple(((low + high) / 2.0).tolist())
            radius = 4.5 + 1.2 * float(np.linalg.norm(high - low)) / 2.0
        program["u_middle"], program["u_radius"] = middle, radius

    def _draw_video(self, picture: Picture, opacity: float, aspect: float) -> None:
        """Draw a frame of the reference video as large as possible behind the players."""
        if picture is not self._video_picture:
            before, self._video_picture = self._video_picture, picture
            if before is not None and before.shape == picture.shape:
                self._video["u_picture"].set_data(picture)
            else:
                self._video["u_picture"] = gloo.Texture2D(picture, interpolation="linear", internalformat="rgb8")
        ratio = picture.shape[1] / picture.shape[0]
        self._video["u_share"] = min(ratio / aspect, 1.0), min(aspect / ratio, 1.0)
        self._video["u_opacity"] = opacity
        gloo.set_state(blend=True, blend_func=OVER)
        self._video.draw("triangle_strip")
        gloo.set_state(blend=False)

    def _levels(self, stage: Stage, camera: Camera, matrix: FloatArray, height_px: float, most: int) -> IndexArray:
        """Return the level of detail (N,) of all performers: 0 is the finest, -1 outside the picture; ``most`` have
        finer ones than the last.
        """
        middles = self._middles_m
        away = np.linalg.norm(middles - camera.eye_m, axis=1)
        scale = camera.pixels_per_metre(height_px, 1.0) / np.maximum(away - 0.35, 0.2)
        level = np.where(scale > FINE_PX_PER_M, 0, np.where(scale > COARSE_PX_PER_M, 1, LEVELS - 1))
        # A sphere wholly outside one side of the frustum is invisible.
        planes = matrix[3] + np.array([sign * matrix[axis] for axis in (0, 1) for sign in (1.0, -1.0)])
        planes /= np.linalg.norm(planes[:, :3], axis=1, keepdims=True)
        outside = (middles @ planes[:, :3].T + planes[:, 3] < -SPREAD_M).any(axis=1)
        unseen = outside | ~stage.shown
        nearest = np.argsort(np.where(unseen, np.inf, away), kind="stable")
        level[nearest[most:]] = LEVELS - 1
        level[unseen] = -1
        return level

    def _upload(self, stage: Stage, limbs: LimbCapsules, level: IndexArray, emphasis: Emphasis) -> None:
        count = len(stage.members)
        rows = self._bone_rows
        rows[:, :-1] = stage.bones.reshape(count, -1, 4)
        if not emphasis.props:
            # Parts that have shrunk to a point are not drawn, nor are their edges.
            rows[:, 3 * stage.first_support : -1] = 0.0
        rows[:, -1] = 0.0
        rows[:, -1, 0] = level == LEVELS - 1
        for row, omitted in emphasis.in_the_way.items():
            if row < count:
                rows[row, -1, 2] = omitted
        self._bones.set_data(rows)
        capsules = limbs.capsules()
        self._limb_rows[:, :-1] = capsules.reshape(count, -1, 4)
        # For a player without a body of its own only the instrument is drawn.
        first = [0 if member.has_body else HELD for member in stage.members]
        middle = capsules[np.arange(count), first, 0, :3]
        self._limb_rows[:, -1, :3] = middle
        self._limb_rows[:, -1, 3] = np.where(stage.shown, SHADOW_RADIUS_M, 0.0)
        self._limb_texture.set_data(self._limb_rows)

    def _draw_rings(self, stage: Stage, clip: SingleArray, emphasis: Emphasis) -> None:
        rings = []
        for row, color in emphasis.rings.items():
            if row < len(stage.members) and stage.shown[row]:
                place = stage.members[row].world_from_player[:, 3]
                rings.append((float(place[0]), float(place[2]), RING_M, color))
        if emphasis.podium is not None:
            x_m, z_m, color = emphasis.podium
            rings += [(x_m, z_m, radius_m, color) for radius_m in PODIUM_M]
        for x_m, z_m, radius_m, color in rings:
            self._ring["u_clip_from_world"] = clip
            self._ring["u_middle"] = (x_m, 0.001, z_m)
            self._ring["u_radius"] = radius_m
            self._ring["u_color"] = (*color, 0.9)
            self._ring.draw("triangle_strip")

    @staticmethod
    def _light(program: Any, camera: Camera, clip: SingleArray, look: ViewportLook) -> None:
        program["u_clip_from_world"] = clip
        program["u_eye"] = camera.eye_m
        program["u_key"] = look.key
        # The fill light comes from the camera, on the side away from the key light.
        fill = camera.backward + 0.7 * camera.right + 0.15 * camera.up
        program["u_fill"] = fill / np.linalg.norm(fill)
        program["u_rim"], program["u_sky"], program["u_ground"] = look.rim, look.sky, look.ground
        program["u_key_light"], program["u_fill_light"] = look.key_light, look.fill_light

    def _draw_near(self, stage: Stage, shapes: Shapes, level: IndexArray, mode: str) -> None:
        """Draw all near performers; those with the same geometry together, so that buffers are bound once."""
        near = [int(row) for row in np.flatnonzero((level >= 0) & (level < LEVELS - 1))]
        if not near:
            return
        program = self._figures
        program["u_shaded"] = 1.0
        bodies = [row for row in near if stage.members[row].has_body]
        for row in sorted(bodies, key=lambda row: (stage.members[row].assets.character.id, level[row])):
            solid = self._solid(shapes.characters[stage.members[row].assets.character.id][level[row]], level[row] == 0)
            program.bind(self._shape(stage, row, int(level[row]), solid))
            program.bind(solid.surface)
            self._draw_solid(solid, row, mode)
        # Capsules are too coarse to shade the instrument itself.
        program["u_shaded"] = 0.0
        bound: Solid | None = None
        holding = [row for row in near if stage.members[row].assets.held is not None]
        for row in sorted(holding, key=lambda row: (stage.members[row].assets.map.id, level[row])):
            solid = self._solid(shapes.instruments[stage.members[row].assets.map.id][level[row]], level[row] == 0)
            bound = self._draw_shared(solid, bound, row, mode)
        for row in near:
            if stage.members[row].supports is not None:
                solid = self._solid(shapes.supports[stage.members[row].player_id])
                bound = self._draw_shared(solid, bound, row, mode)
        for row in near:
            if stage.members[row].stand_m is not None:
                bound = self._draw_shared(self._solid(shapes.stand), bound, row, mode)

    def _draw_shared(self, solid: Solid, bound: Solid | None, row: int, mode: str) -> Solid:
        if solid is not bound:
            self._figures.bind(solid.shape)
            self._figures.bind(solid.surface)
        self._draw_solid(solid, row, mode)
        return solid

    def _draw_solid(self, solid: Solid, row: int, mode: str) -> None:
        self._figures["u_row"] = float(row)
        if mode == "triangles":
            self._draw_looks(solid)
        else:
            self._figures.draw(mode, solid.edges)

    def _draw_looks(self, solid: Solid) -> None:
        """Draw a geometry with its textures, or with the colours of its vertices."""
        program, looks = self._figures, solid.geometry.looks
        if solid.uvs is not None:
            program["a_uv"] = solid.uvs
        for culled, look, triangles in solid.triangles:
            if look >= 0:
                # Only the finest level is seen near enough for its surface to have a relief.
                self._maps.dress(program, looks[look], solid.fine)
            gloo.set_state(cull_face=culled)
            program.draw("triangles", triangles)
            if look >= 0:
                self._maps.undress(program)
        if solid.uvs is not None:
            program["a_uv"] = (0.0, 0.0)

    def _draw_wires(
        self,
        stage: Stage,
        shapes: Shapes,
        level: IndexArray,
        lift_m: float,
        color: tuple[float, float, float, float],
    ) -> None:
        gloo.set_state(blend=True, blend_func=OVER)
        for program in (self._figures, self._batch):
            program["u_line"] = color
            program["u_lift"] = lift_m
        if (level == LEVELS - 1).any():
            if self._batch_edges is None:
                self._batch_edges = gloo.IndexBuffer(crowd_edges(self._batch_parts))
            self._batch.draw("lines", self._batch_edges)
        self._draw_near(stage, shapes, level, "lines")
        for program in (self._figures, self._batch):
            program["u_line"] = (0.0, 0.0, 0.0, 0.0)
            program["u_lift"] = 0.0

    def _solid(self, geometry: Geometry, fine: bool = False) -> Solid:
        solid = self._solids.get(id(geometry))
        if solid is None:
            solid = self._solids[id(geometry)] = Solid(geometry, fine)
        return solid

    def _shape(self, stage: Stage, row: int, level: int, solid: Solid) -> Any:
        """Return the vertex buffer of a player with the face of the present pose, sent to the graphics card only if
        changed.
        """
        pose, face = stage.poses[row], solid.geometry.face
        if face is None or pose is None:
            return solid.shape
        kept = self._morphed.get((row, level))
        buffer, shown = kept if kept is not None else (gloo.VertexBuffer(solid.geometry.shape.copy()), None)
        if shown is not pose:
            weights = np.array([pose.morphs.get(name, 0.0) for name in face.names], np.float32)
            buffer.set_subdata(face.morphed(weights), offset=0)
        self._morphed[row, level] = (buffer, pose)
        self._morphed.move_to_end((row, level))
        while len(self._morphed) > MOST_NEAR_AT_REST:
            self._morphed.popitem(last=False)
        return buffer
