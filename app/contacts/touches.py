"""Errors of touches, grips, lips and feet at every frame, and the frames at which each is required.

Based on `Traces`: positions at some frames, from a motion or from a file.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from app.arrays import BoolArray, FloatArray, IndexArray
from app.contacts.bounds import CLEAR_MM, TOUCH_MM
from app.contacts.controls import NoteFrames
from app.motion.contacts.hand_in_bell import FINGERS_KEPT
from app.rig import quaternion
from app.rig.grip.finger_stations import aside_m, only_at, stations, stations_of_notes, worked_by
from app.rig.grip.grip_pose import HandHold, StationBlend, hand_targets
from instrument_maps.hold import Contact
from instrument_maps.model import ROOT, InstrumentMap

LIPS, UPPER_LIP = "lips.contact", "lips.upper"


@dataclass(frozen=True, eq=False)
class Traces:
    """Positions over F frames of the body's landmarks and of the instrument's nodes, from which contacts are checked.

    Attributes
    ----------
    marks_m : dict of str to (F, 3)
        World positions of the body's landmarks.
    nodes : dict of str to (F, 3 or 4, 4)
        ``world_from_node`` of the instrument's nodes; their last rows are not used.
    """

    marks_m: Mapping[str, FloatArray]
    nodes: Mapping[str, FloatArray]

    def point_m(self, node: str, place_m: FloatArray) -> FloatArray:
        """World position (F, 3) of a point (3,) or (F, 3) of a node."""
        rows, (x, y, z) = self.nodes[node][:, :3], place_m[..., None].swapaxes(0, -2)
        moved_m: FloatArray = rows[..., 0] * x + rows[..., 1] * y + rows[..., 2] * z + rows[..., 3]
        return moved_m

    def off_m(self, mark: str, point_m: FloatArray) -> FloatArray:
        """Return the distance (F,) of a landmark from a point (F, 3)."""
        return distance_m(self.marks_m[mark], point_m)

    def from_rim_m(self, instrument: InstrumentMap, mark: str) -> FloatArray:
        """Vector (F, 3) from the centre of the rim to a landmark, in the instrument's frame."""
        rim_m = self.point_m(ROOT, np.asarray(instrument.mouthpiece.position_m))
        offset_m: FloatArray = np.einsum("fji,fj->fi", self.nodes[ROOT][:, :3, :3], self.marks_m[mark] - rim_m)
        return offset_m

    def lips_m(self, instrument: InstrumentMap) -> FloatArray | None:
        """Return the distance (F,) of the lips from the rim; None for a head without a mouth."""
        return np.linalg.norm(self.from_rim_m(instrument, LIPS), axis=1) if LIPS in self.marks_m else None

    def upper_lip_m(self, instrument: InstrumentMap, playing: BoolArray) -> FloatArray | None:
        """Displacement (F,) in metres of the rim on the upper lip, relative to its median position in the frames
        ``playing`` (F,); None for a head without a mouth, or without such frames.
        """
        if not playing.any() or UPPER_LIP not in self.marks_m:
            return None
        offset_m = self.from_rim_m(instrument, UPPER_LIP)
        return distance_m(offset_m, np.median(offset_m[playing], axis=0))


def distance_m(places_m: FloatArray, others_m: FloatArray) -> FloatArray:
    """Return the distances (F,) in metres between positions (F, 3) and others (F, 3)."""
    result: FloatArray = np.linalg.norm(places_m - others_m, axis=1)
    return result


def hand_gaps_m(
    hand: HandHold,
    wrist_m: FloatArray,
    world_from_instrument_m: FloatArray,
    world_from_instrument_rotation: FloatArray,
    controls: Mapping[str, FloatArray],
    placed: Mapping[str, StationBlend] | None = None,
) -> FloatArray:
    """Return the distance (F,) in metres of a hand's wrist from its place on the instrument; parameters as in
    `app.rig.grip.grip_pose.hand_targets`."""
    requested_m, _ = hand_targets(hand, world_from_instrument_m, world_from_instrument_rotation, controls, placed)
    return distance_m(wrist_m, requested_m)


def hole_values(instrument: InstrumentMap, traces: Traces) -> dict[str, FloatArray]:
    """Value (F,) of every hole that has no moving part, by name, derived from the positions of the fingers.

    1 or 0.5 where a finger covers it, 0 where none is near, NaN where a finger is too near for an open hole.
    """
    result = {}
    for control in instrument.controls:
        if control.motion is not None:
            continue
        touches = [contact for contact in instrument.contacts if control.name in worked_by(contact, instrument)]
        if not touches:
            # Fingers that do not bend touch nothing (`app.rig.grip.fitting.fitted_instrument`).
            continue
        whole_m = np.min([_gap_m(contact, instrument, traces) for contact in touches], axis=0)
        values = np.where(whole_m > instrument.size * CLEAR_MM / 1000.0, 0.0, np.nan)
        half = control.half_value
        if half is not None:
            half_m = np.min([_gap_m(contact, instrument, traces, np.full(1, half)) for contact in touches], axis=0)
            values = np.where(half_m <= TOUCH_MM / 1000.0, half, values)
            whole_m = np.where(half_m < whole_m, np.inf, whole_m)
        result[control.name] = np.where(whole_m <= TOUCH_MM / 1000.0, 1.0, values)
    return result


def _gap_m(
    contact: Contact, instrument: InstrumentMap, traces: Traces, targets: FloatArray | None = None
) -> FloatArray:
    """Distance (F,) in metres of a part of a hand from its touch point. For a hole that ``targets`` (F,) or (1,)
    require half closed, it is measured from the side of the hole.
    """
    point_m = np.asarray(contact.position_m)
    if targets is not None and contact.control is not None:
        aside = aside_m(contact, instrument, targets)
        point_m = point_m + (aside[0] if len(aside) == 1 else aside)
    return traces.off_m(contact.part, traces.point_m(contact.node, point_m))


class TouchJudge:
    """Checks the contacts of an instrument map at some frames.

    Parameters
    ----------
    instrument : InstrumentMap
        Instrument with the contacts to check.
    traces : Traces
        Positions of body and instrument.
    values : dict of str to (F,)
        Values of the controls, measured or generated.
    notes : NoteFrames
        Notes that sound in the frames.
    closing : (F,) bool
        Frames in which a hand closes the bell or moves to it, where contacts of its palm do not apply.
    """

    def __init__(
        self,
        instrument: InstrumentMap,
        traces: Traces,
        values: Mapping[str, FloatArray],
        notes: NoteFrames,
        closing: BoolArray,
    ) -> None:
        self._instrument, self._traces, self._values, self._notes = instrument, traces, values, notes
        self._closing = closing
        self._only_at = only_at(instrument)

    @cached_property
    def _stations(self) -> Mapping[str, IndexArray]:
        """For each finger the index of its station (position at a key) in each note (N,)."""
        fingered = ((note.controls, note.fingers) for note in self._notes.notes)
        return stations_of_notes(self._instrument, fingered)

    def gap_m(self, index: int) -> FloatArray:
        """Error (F,) in metres of the contact with this index in the map."""
        contact, targets = self._instrument.contacts[index], None
        if contact.control is not None:
            control = self._instrument.control(contact.control)
            if control.half_value is not None:
                targets = np.nan_to_num(self._notes.targets_at_frames(control), nan=1.0)
        return _gap_m(contact, self._instrument, self._traces, targets)

    def asked(self, index: int) -> BoolArray:
        """Mask (F,) of the frames in which the contact with this index is required: its control is in the position for
        the note, and the finger may not have left yet.
        """
        instrument, notes = self._instrument, self._notes
        contact, frames, place = instrument.contacts[index], notes.sounding, self._only_at[index]
        if contact.control is not None and contact.when != "always":
            pressed, released = notes.working(instrument.control(contact.control), self._values[contact.control])
            frames = pressed if contact.when == "pressed" else released
        if place is not None:
            finger, station = place
            names = sorted({name for found in stations(instrument)[finger] for name in found.controls})
            controls = [instrument.control(name) for name in names]
            frames = frames & notes.kept(station, self._stations[finger], controls)
            for control in map(instrument.control, worked_by(contact, instrument)):
                # An open hole has no moving part: the finger is measured, since it closes the hole itself.
                if control.motion is not None:
                    frames = frames & notes.working(control, self._values[control.name])[0]
        stopped = instrument.stopped
        if stopped is not None and contact.part.startswith(stopped.hand):
            # The fingers stay on the wall of the bell; thumb and palm leave it.
            frames = frames if contact.part.split(".")[1] in FINGERS_KEPT else frames & ~self._closing
        return frames

    def hovering_m(self) -> dict[str, FloatArray]:
        """For each finger, by name, the distance (F,) in metres while idle from its nearest station, or from the line
        between two stations.
        """
        found = {}
        contacts, traces = self._instrument.contacts, self._traces
        for finger, places in stations(self._instrument).items():
            touches = sorted({index for place in places if place.controls for index in place.contacts})
            touches = [index for index in touches if self._only_at[index] is not None]
            if not touches:
                continue
            frames = self._notes.asked(self._stations[finger] < 0)
            points = [
                traces.point_m(contacts[index].node, np.asarray(contacts[index].position_m))[frames]
                for index in touches
            ]
            gaps_m = [
                _to_way_m(traces.marks_m[part][frames], points[a], points[b])
                for part in sorted({contacts[index].part for index in touches})
                for a in range(len(points))
                for b in range(a, len(points))
            ]
            found[finger] = np.min(gaps_m, axis=0)
        return found


def world_from_nodes(
    position_m: FloatArray, rotation: FloatArray, nodes: Mapping[str, tuple[FloatArray, FloatArray]]
) -> dict[str, FloatArray]:
    """World transforms (F, 4, 4) of an instrument's nodes and root.

    Parameters
    ----------
    position_m, rotation : (F, 3) and (F, 4) float64
        ``world_from_instrument``.
    nodes : dict of str to (F, 3) and (F, 4)
        ``instrument_from_node``.
    """
    placed = {ROOT: (position_m, rotation)}
    for node, (local_m, turn) in nodes.items():
        placed[node] = (position_m + quaternion.rotate(rotation, local_m), quaternion.multiply(rotation, turn))
    result = {}
    for node, (place_m, turn) in placed.items():
        matrix = np.tile(np.eye(4), (len(place_m), 1, 1))
        matrix[:, :3, :3], matrix[:, :3, 3] = quaternion.to_matrix(turn), place_m
        result[node] = matrix
    return result


def _to_way_m(place_m: FloatArray, a_m: FloatArray, b_m: FloatArray) -> FloatArray:
    """Distance (F,) in metres of a position (F, 3) from the line segment between ``a_m`` and ``b_m`` (F, 3)."""
    way, off = b_m - a_m, place_m - a_m
    length2 = np.maximum(np.einsum("fi,fi->f", way, way), 1e-12)
    share = np.clip(np.einsum("fi,fi->f", off, way) / length2, 0.0, 1.0)
    return distance_m(off, way * share[:, None])
