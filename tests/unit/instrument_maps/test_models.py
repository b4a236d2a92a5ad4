"""Bundled models compared with their maps: sizes, valid meshes, touch points on surfaces, collision bodies."""

from __future__ import annotations

import math
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial import cKDTree

from app.arrays import BoolArray, FloatArray
from app.formats.gltf.model import GltfModel
from app.formats.gltf.read import read_glb
from app.rig.grip import instrument_proxy
from instrument_maps.check_model import model_problems, node_triangles
from instrument_maps.load import bundled_maps, model_path
from instrument_maps.model import ROOT, InstrumentMap
from instrument_maps.surface import nearest_point
from resources.build import build_instruments
from resources.build.instrument_glb import MATERIALS, write

pytestmark = pytest.mark.slow

MAPS = [pytest.param(instrument, id=name) for name, instrument in bundled_maps().items()]


@cache
def model_of(name: str) -> GltfModel:
    return read_glb(model_path(bundled_maps()[name]))


@cache
def surfaces_of(name: str) -> dict[str, FloatArray]:
    """Triangles of each node in its own frame."""
    return node_triangles(bundled_maps()[name], model_of(name))


def origins(model: GltfModel) -> dict[str, FloatArray]:
    return {node.name: node.translation for node in model.nodes}


def everything(instrument: InstrumentMap) -> FloatArray:
    """All triangles at rest in the root frame."""
    places = origins(model_of(instrument.id))
    return np.concatenate([triangles + places[name] for name, triangles in surfaces_of(instrument.id).items()])


def radius_about(points: FloatArray, x: float, y: float) -> FloatArray:
    return np.hypot(points[:, 0] - x, points[:, 1] - y)


@pytest.mark.parametrize("instrument", MAPS)
def test_map_and_model_agree(instrument: InstrumentMap) -> None:
    assert list(model_problems(instrument, model_path(instrument))) == []


@pytest.mark.parametrize("instrument", MAPS)
def test_touch_points_lie_on_the_mesh_with_normals_outward(instrument: InstrumentMap) -> None:
    for contact in instrument.contacts:
        distance_m, normal = nearest_point(surfaces_of(instrument.id)[contact.node], np.array(contact.position_m))
        assert distance_m < 0.0005, contact
        assert normal @ np.array(contact.normal) > math.cos(math.radians(30)), contact


@pytest.mark.parametrize("instrument", MAPS)
def test_meshes_are_sound(instrument: InstrumentMap) -> None:
    model = model_of(instrument.id)
    total = 0
    for mesh in model.meshes:
        for primitive in mesh.primitives:
            assert primitive.normals is not None
            assert primitive.uvs is not None
            assert np.allclose(np.linalg.norm(primitive.normals, axis=1), 1, atol=1e-4)
            assert primitive.uvs.min() >= 0
            assert primitive.uvs.max() <= 1
            corners = primitive.positions[primitive.triangles]
            faces = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
            area = np.linalg.norm(faces, axis=1)
            real = area > 1e-10
            facing = np.einsum(
                "ti,tki->tk", faces / np.maximum(area, 1e-20)[:, None], primitive.normals[primitive.triangles]
            )
            assert np.mean(facing[real].min(axis=1) > 0) > 0.999  # counter-clockwise seen from outside
            assert real.mean() > 0.97
            total += len(primitive.triangles)
    assert 5_000 < total < 60_000
    assert {material.name for material in model.materials} <= set(MATERIALS)


@pytest.mark.parametrize("instrument", MAPS)
def test_mouthpiece_frame_is_the_rim(instrument: InstrumentMap) -> None:
    if instrument.embouchure.kind != "cup":
        pytest.skip("no rim")
    points = everything(instrument).reshape(-1, 3)
    mouthpiece = instrument.mouthpiece
    rim = points[(np.abs(points[:, 2]) < 1e-5) & (radius_about(points, 0, 0) < 0.03)]
    assert mouthpiece.position_m == (0, 0, 0)
    assert np.allclose(radius_about(rim, 0, 0), mouthpiece.rim_radius_m, atol=2e-4)
    cup = points[(np.abs(points[:, 2] - 0.006) < 0.003) & (radius_about(points, 0, 0) < 0.03)]
    assert radius_about(cup, 0, 0).max() == pytest.approx(mouthpiece.rim_outer_radius_m, abs=5e-4)
    # nothing of the instrument is where the player's lips and nose are
    before = points[(points[:, 2] < -1e-5) & (np.abs(points[:, 0]) < 0.03) & (np.abs(points[:, 1]) < 0.04)]
    assert len(before) == 0


@pytest.mark.parametrize("instrument", MAPS)
def test_reeds_and_beaks_lie_between_the_lips(instrument: InstrumentMap) -> None:
    if instrument.embouchure.kind not in ("single_reed", "double_reed", "fipple"):
        pytest.skip("nothing between the lips")
    points = everything(instrument).reshape(-1, 3)
    assert instrument.mouthpiece.position_m == (0, 0, 0)
    band = points[(np.abs(points[:, 2]) < 0.0025) & (radius_about(points, 0, 0) < 0.03)]
    assert np.ptp(band[:, 1]) == pytest.approx(instrument.embouchure.lips_apart_m, abs=0.003)
    assert abs(band[:, 1].max() + band[:, 1].min()) < 0.002
    assert np.abs(band[:, 0]).max() == pytest.approx(instrument.mouthpiece.rim_outer_radius_m, abs=0.002)
    # the tip is in the mouth, and nothing of the instrument is where chin and nose are
    before = points[(points[:, 2] < -0.003) & (radius_about(points, 0, 0) < 0.1)]
    assert -0.025 < before[:, 2].min() < -0.004
    assert radius_about(before, 0, 0).max() < 0.013


def test_trumpet_has_real_sizes() -> None:
    instrument = bundled_maps()["trumpet_Bb"]
    points = everything(instrument).reshape(-1, 3)
    assert 0.48 < np.ptp(points[:, 2]) < 0.55  # with the mouthpiece
    rim = points[points[:, 2] > points[:, 2].max() - 0.002]
    assert np.ptp(rim[:, 0]) == pytest.approx(0.123, abs=0.002)
    places = origins(model_of(instrument.id))
    valves = [places[f"valve_{k}"] for k in (1, 2, 3)]
    assert np.allclose(np.diff(valves, axis=0), [0, 0, 0.0275], atol=1e-6)
    for k in (1, 2, 3):
        motion = instrument.control(f"valve_{k}").motion
        assert motion.travel_m is not None
        assert 0.016 <= motion.travel_m <= 0.017
    # the leadpipe passes right of the valves, the bell left of them
    bell = rim.mean(axis=0)
    assert 0 < valves[0][0] < bell[0]


def test_trombone_has_real_sizes() -> None:
    instrument = bundled_maps()["trombone_tenor_F_attachment"]
    points = everything(instrument).reshape(-1, 3)
    assert np.ptp(points[:, 2]) == pytest.approx(1.15, abs=0.03)
    bell = points[np.abs(points[:, 2] - 0.335) < 0.0005]
    bell = bell[bell[:, 0] > 0.05]
    size = np.linalg.norm(bell - (bell.max(axis=0) + bell.min(axis=0)) / 2, axis=1).max() * 2
    assert size == pytest.approx(0.216, abs=0.004)
    assert bell.mean(axis=0)[0] > 0.1  # on the player's left
    slide = instrument.control("slide").motion
    assert slide.travel_m is not None
    assert origins(model_of(instrument.id))["slide"][2] == pytest.approx(0.15, abs=0.01)
    # at the end of its travel the outer slide still covers the inner one
    outer_start = (surfaces_of(instrument.id)["slide"][..., 2] + 0.15).min()
    legs = surfaces_of(instrument.id)[ROOT].reshape(-1, 3)
    inner_end = legs[radius_about(legs, 0, 0) < 0.0080][:, 2].max()
    assert inner_end - (outer_start + slide.travel_m) > 0.03


def moved(instrument: InstrumentMap, name: str, value: float) -> FloatArray:
    """Triangles of a control's node in the root frame at a value of the control."""
    control = instrument.control(name)
    origin = origins(model_of(instrument.id))[control.node]
    triangles = surfaces_of(instrument.id)[control.node]
    axis = np.array(control.motion.axis)
    if control.motion.travel_m is not None:
        return triangles + origin + axis * control.motion.travel_m * value
    assert control.motion.angle_rad is not None
    assert control.motion.pivot_m is not None
    assert np.allclose(control.motion.pivot_m, origin, atol=1e-5)
    angle = control.motion.angle_rad * value
    cross = np.cross(axis, triangles)
    along = (triangles @ axis)[..., None] * axis
    return triangles * math.cos(angle) + cross * math.sin(angle) + along * (1 - math.cos(angle)) + origin


def test_buttons_stay_above_the_caps_and_pistons_inside_the_casings() -> None:
    instrument = bundled_maps()["trumpet_Bb"]
    casing = surfaces_of(instrument.id)[ROOT].reshape(-1, 3)
    for k in (1, 2, 3):
        origin = origins(model_of(instrument.id))[f"valve_{k}"]
        around = casing[radius_about(casing[:, [0, 2]], origin[0], origin[2]) < 0.008]
        pressed = moved(instrument, f"valve_{k}", 1.0).reshape(-1, 3)
        button = pressed[radius_about(pressed[:, [0, 2]], origin[0], origin[2]) > 0.0075]
        button = button[button[:, 1] > 0.03]
        assert button[:, 1].min() > around[:, 1].max()
        assert pressed[:, 1].min() > around[:, 1].min()


def test_trigger_moves_its_pad_forward_by_a_thumbs_stroke() -> None:
    instrument = bundled_maps()["trombone_tenor_F_attachment"]
    contact = next(c for c in instrument.contacts if c.control == "trigger")
    motion = instrument.control("trigger").motion
    assert motion.angle_rad is not None
    arm = np.array(contact.position_m)
    stroke = np.cross(np.array(motion.axis), arm) * motion.angle_rad
    assert 0.005 < stroke[2] < 0.015
    assert stroke @ np.array(contact.normal) < 0  # away from the thumb


def bodies_of(instrument: InstrumentMap) -> tuple[instrument_proxy.Bodies, instrument_proxy.InstrumentNodes]:
    """Collision bodies, and their nodes at rest."""
    places = origins(model_of(instrument.id))
    place_m = np.array(list(places.values()))
    return instrument_proxy.bodies(instrument.proxy, list(places)), instrument_proxy.InstrumentNodes(
        place_m, np.tile(np.eye(3), (len(place_m), 1, 1))
    )


@pytest.mark.parametrize("instrument", MAPS)
def test_bodies_hold_the_mesh_near_the_hands(instrument: InstrumentMap) -> None:
    places = origins(model_of(instrument.id))
    centres = everything(instrument).mean(axis=1)
    touches = np.array([np.array(contact.position_m) + places[contact.node] for contact in instrument.contacts])
    away_m = np.array(
        [instrument_proxy.signed_distance(body, touches - places[body.node]) for body in instrument.proxy]
    )
    around = cKDTree(centres).query_ball_point(touches, 0.06)
    for contact, rows, bodies_m in zip(instrument.contacts, around, away_m.T, strict=True):
        near = centres[rows]
        assert len(near) > 50
        # The nearest first: few points are left for the others.
        for row in np.argsort(bodies_m):
            body = instrument.proxy[row]
            if bodies_m[row] < 0.065 and len(near):
                near = near[instrument_proxy.signed_distance(body, near - places[body.node]) >= 0.0022]
        assert len(near) == 0, contact
        # and the touch point itself is on their surface, so that a finger there does not go into them
        assert abs(bodies_m.min()) < 0.002, contact


@pytest.mark.parametrize("instrument", MAPS)
def test_bodies_are_not_fatter_than_the_mesh_near_the_hands(instrument: InstrumentMap) -> None:
    places = origins(model_of(instrument.id))
    bodies, nodes = bodies_of(instrument)
    triangles = everything(instrument)
    # Axis by axis, which lie together.
    low, high = np.ascontiguousarray(triangles.min(axis=1).T), np.ascontiguousarray(triangles.max(axis=1).T)
    # A triangle is near if a corner, the middle of a side or its centre is near.
    sides = (triangles + np.roll(triangles, 1, axis=1)) / 2
    marks = cKDTree(np.concatenate([triangles.reshape(-1, 3), sides.reshape(-1, 3), triangles.mean(axis=1)]))
    rng = np.random.default_rng(7)
    for contact in instrument.contacts:
        touch = np.array(contact.position_m) + places[contact.node]
        samples = touch + rng.uniform(-0.03, 0.03, (1500, 3))
        close = instrument_proxy.near(bodies, nodes.place_m, touch, 0.055)
        reached_m, _ = instrument_proxy.inside(close, nodes, samples, np.full(len(samples), 0.0015))
        # Outside of every body, and near one.
        samples = samples[(reached_m > 0.0) & (reached_m <= 0.0015)]
        unclear = samples[marks.query(samples, distance_upper_bound=0.0036)[0] > 0.0035]
        boxes = [overlapping(low, high, sample - 0.0035, sample + 0.0035) for sample in unclear]
        far = [
            sample
            for sample, box in zip(unclear, boxes, strict=True)
            if not box.any() or nearest_point(triangles[box], sample)[0] > 0.0035
        ]
        assert len(samples) > 10
        assert far == [], contact


def overlapping(low: FloatArray, high: FloatArray, least: FloatArray, most: FloatArray) -> BoolArray:
    """Return a mask of the boxes (3, T) that meet another box."""
    meets = (low[0] <= most[0]) & (high[0] >= least[0])
    for axis in (1, 2):
        meets &= (low[axis] <= most[axis]) & (high[axis] >= least[axis])
    return meets


@pytest.mark.parametrize("instrument", MAPS)
def test_bodies_hold_the_whole_mesh(instrument: InstrumentMap) -> None:
    bodies, nodes = bodies_of(instrument)
    centres = everything(instrument).mean(axis=1)[::7]
    reached_m, _ = instrument_proxy.inside(bodies, nodes, centres, np.full(len(centres), 0.002))
    assert np.mean(reached_m > 0.0) > 0.97
    assert len(instrument.proxy) < 260


def test_models_are_small_enough_to_ship() -> None:
    for instrument in bundled_maps().values():
        assert Path(model_path(instrument)).stat().st_size < 3_000_000


@pytest.mark.parametrize("instrument", MAPS)
def test_models_and_maps_are_what_the_script_builds(instrument: InstrumentMap, tmp_path: Path) -> None:
    build, requested_contacts, *_ = build_instruments.INSTRUMENTS[instrument.id]
    built = build()
    write(built, tmp_path / "again.glb")
    again, shipped = node_triangles(instrument, read_glb(tmp_path / "again.glb")), surfaces_of(instrument.id)
    assert again.keys() == shipped.keys()
    for name, triangles in shipped.items():
        assert np.allclose(again[name], triangles, atol=1e-6)
    contacts = requested_contacts()
    assert [contact["part"] for contact in contacts] == [contact.part for contact in instrument.contacts]
    for requested, contact in zip(contacts, instrument.contacts, strict=True):
        place = np.asarray(requested["point"]) - built.origins[contact.node]
        assert np.allclose(place, contact.position_m, atol=2e-5)
    assert sum(len(part.shape.proxies) for part in built.parts) == len(instrument.proxy)
