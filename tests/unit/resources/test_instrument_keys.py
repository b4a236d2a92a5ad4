"""Parts of woodwinds: keys rotate in the direction of pressing, cups close or open, rings become level with their
holes.
"""

from __future__ import annotations

import tomllib

import numpy as np
import pytest

from resources.build.instrument_keys import Cup, Keywork, RingOn, Wall, entry, oval, pearl, post, slab, turn_of
from resources.build.instrument_mesh import Shape
from resources.build.instrument_reeds import DoubleReed, SingleReed, thumb_rest

X, Y, Z = np.eye(3)


def _body() -> Wall:
    return Wall((0.0, 0.005, 0.06), Z, Y, [(0.0, 0.0145), (0.3, 0.0145)])


def _turned(points: np.ndarray, motion: dict[str, object]) -> np.ndarray:
    """Points after the complete motion of a key (Rodrigues)."""
    axis, pivot = np.asarray(motion["axis"]), np.asarray(motion["pivot_m"])
    angle, off = float(motion["angle_rad"]), points - pivot
    turned = (
        off * np.cos(angle) + np.cross(axis, off) * np.sin(angle) + np.outer(off @ axis, axis) * (1 - np.cos(angle))
    )
    return turned + pivot


def _volume(shape: Shape) -> float:
    a, b, c = (shape.points[shape.faces[:, k]] for k in range(3))
    return float(np.einsum("ij,ij->", a, np.cross(b, c))) / 6


def test_a_place_on_the_wall_is_found_again() -> None:
    wall = Wall((0.01, 0.02, 0.03), -X, Y, [(0.0, 0.013), (0.6, 0.009)])
    assert wall.place(wall.point(0.2, -70.0, 0.004)) == pytest.approx((0.2, -70.0, 0.004))
    assert np.allclose(_body().normal(90.0), X), "90 degrees of an upright instrument is the player's left"


def test_a_pressed_key_goes_down_by_its_travel_and_opens_the_cup_across_its_rod() -> None:
    work, body = Keywork(), _body()
    cup = Cup(body, 0.08, 30.0, 0.005)
    touch = slab(body.point(0.12, 30.0, 0.006), body.normal(30.0), Z, oval(0.02, 0.008))
    work.key("key_A", "A", "left.index.side", body.cross_rod(0.10, 30.0, height=0.006), touch, [cup], travel_m=0.004)
    motion = work.controls[0]["motion"]
    moved = _turned(touch.point[None], motion)[0]
    assert (touch.point - moved) @ touch.normal == pytest.approx(0.004, abs=2e-4)
    opened = _turned(cup.seat[None], motion)[0]
    assert (opened - cup.seat) @ cup.normal > 0.002
    pads = [part.shape for part in work.model.parts if part.node == "key_A" and part.material == "pad"]
    assert min((pads[0].points - cup.seat) @ cup.normal) == pytest.approx(0.0, abs=1e-6), "closed while at rest"


def test_an_open_cup_stands_off_its_hole_and_closes_it_when_pressed() -> None:
    work, body = Keywork(), _body()
    cup = Cup(body, 0.24, -20.0, 0.008)
    touch = slab(body.point(0.15, -100.0, 0.008), body.normal(-100.0), Z, oval(0.018, 0.009))
    work.key("key_E", "LE", "left.little.pad", body.rod(0.12, 0.25, 45.0, 0.005), touch, [cup])
    motion = work.controls[0]["motion"]
    pad = next(part.shape.points for part in work.model.parts if part.node == "key_E" and part.material == "pad")
    heights = (pad - cup.seat) @ cup.normal, (_turned(pad, motion) - cup.seat) @ cup.normal
    assert heights[0].min() > 0.001
    assert abs(heights[1].mean()) < 0.0016, "the pad lies on the rim"


def test_a_rod_under_its_own_touch_piece_is_refused() -> None:
    body = _body()
    with pytest.raises(ValueError, match="turn nothing"):
        turn_of(body.rod(0.1, 0.2, 0.0), body.point(0.15, 0.0, 0.008), body.normal(0.0), 0.004)


def test_a_ring_goes_level_with_the_rim_of_its_hole() -> None:
    work, body = Keywork(), _body()
    work.hole("hole_R1", "R1", "right.index.pad", body, along=0.05, angle_deg=0.0, radius=0.004)
    ring = RingOn(body, 0.05, 0.0, 0.0075)
    work.linked("rings", ("hole_R1",), body.rod(0.02, 0.07, -55.0, 0.005), rings=[ring], drop_m=0.0012)
    points = next(part.shape.points for part in work.model.parts if part.node == "rings" and part.shape.proxies
                  and part.shape.proxies[0]["shape"] == "ring")  # fmt: skip
    rim = body.point(0.05, 0.0, ring.rim_m)
    down = (_turned(points, work.links[0]["motion"]) - rim) @ ring.normal
    assert (points - rim).dot(ring.normal).max() > 0.001
    assert -0.0006 < down.max() < 0.0012


def test_a_plateau_is_touched_on_its_cup() -> None:
    work, body = Keywork(), _body()
    cup = Cup(body, 0.2, 10.0, 0.009)
    work.plateau("key_F", "1R", "right.index.pad", body.rod(0.17, 0.22, 70.0, 0.005), cup, opening_m=0.003)
    point = np.asarray(work.contacts[0]["point"])
    points = np.vstack([part.shape.points for part in work.model.parts if part.node == "key_F"])
    assert np.linalg.norm(points - point, axis=1).min() < 0.001


def test_the_tables_of_the_map_can_be_read_and_come_in_the_order_of_the_calls() -> None:
    def make() -> Keywork:
        work, body = Keywork(), _body()
        work.hole("hole_L1", "L1", "left.index.pad", body, along=0.05, angle_deg=0.0, radius=0.004, half_value=0.5)
        touch = pearl(body.point(0.12, 60.0, 0.006), body.normal(60.0))
        work.key("key_A", "A", "left.index.side", body.rod(0.1, 0.14, 10.0), touch)
        work.linked("ring", ("hole_L1",), body.rod(0.02, 0.07, -55.0), rings=[RingOn(body, 0.05, 0.0, 0.0075)])
        work.also("left.middle.pad", "key_A", ("hole_L1",))
        return work

    model, contacts, tables = entry(make)
    reported = tomllib.loads(tables())
    assert [row["name"] for row in reported["controls"]] == ["hole_L1", "key_A"]
    assert reported["controls"][0]["half_value"] == 0.5
    assert reported["controls"][0]["finger"] == "left.index"
    assert reported["links"][0]["controls"] == ["hole_L1"]
    assert [row["part"] for row in contacts()] == ["left.index.pad", "left.index.side", "left.middle.pad"]
    assert contacts()[2]["together"] == ["hole_L1"]
    assert set(model().origins) == {"root", "key_A", "ring"}


@pytest.mark.parametrize("reed", [SingleReed(), DoubleReed(), SingleReed(length=0.09, radius=0.0125, tip_m=0.014)])
def test_what_is_between_the_lips_is_as_high_as_it_says_and_centred(reed: SingleReed | DoubleReed) -> None:
    pieces = reed.pieces()
    points = np.vstack([shape.points for material, shape in pieces if material in ("ebonite", "cane")])
    band = points[np.abs(points[:, 2]) < 0.0022]
    assert np.ptp(band[:, 1]) == pytest.approx(reed.lips_apart_m, abs=0.0022)
    assert abs(band[:, 1].max() + band[:, 1].min()) < 0.0016
    assert points[:, 2].min() == pytest.approx(-reed.tip_m, abs=1e-6)


def test_shapes_are_not_inside_out() -> None:
    body = _body()
    touch = thumb_rest(body, 0.2, 180.0)
    hook = next(shape for _, shape in touch.pieces if shape.proxies and shape.proxies[0]["half_m"][1] < 0.002
                and len(shape.faces) > 40)  # fmt: skip
    spatula = slab((0, 0, 0), Y, Z, oval(0.02, 0.008)).pieces[0][1]
    ball = post(body, body.point(0.1, 20.0, 0.005))[0][1]
    for shape in (hook, spatula, ball, *(shape for _, shape in (*SingleReed().pieces()[:2], DoubleReed().pieces()[0]))):
        assert _volume(shape) > 0
        faces = np.cross(
            shape.points[shape.faces[:, 1]] - shape.points[shape.faces[:, 0]],
            shape.points[shape.faces[:, 2]] - shape.points[shape.faces[:, 0]],
        )
        agree = np.einsum("ij,ij->i", faces, shape.normals[shape.faces].mean(axis=1))
        assert (agree > -1e-12).mean() > 0.98
