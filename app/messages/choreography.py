"""Choreographies: learning them from motion and music, dancing them, and their files."""

from __future__ import annotations

from typing import Final

TEMPLATES: Final[dict[str, str]] = {
    "generate.no_source": "the choreography has no source {source}; --prefer one of {sources}",
    "choreography.damaged": (
        "{file} is not a choreography file or is damaged ({place}: {detail}); copy it again from where it is whole, "
        "or learn it again with 'suisou choreography learn'"
    ),
    "choreography.newer": (
        "{file} was written by a newer version of the program (its file version is {version}, this program knows up "
        "to {known}); use the newer version"
    ),
    "cuts.line": "{file}, line {line}: {text!r} is no time; write one time in seconds in each line",
    "cuts.order": (
        "{file}, line {line}: a motion needs a time at which it starts and a later one at which it ends; put the times "
        "in order"
    ),
    "cuts.wrong": (
        "{motion} cannot be cut into a motion from frame {start} to {end} with its accent at {accent}: cuts have to be "
        "in order, with their accents between them, within the {frames} frames of the motion"
    ),
    "dance.no_percussion": (
        "the piece has no percussion: dancers take their rhythm from its melody, its bass and its accents"
    ),
    "dance.state_not_held": (
        "basic motion {number} is not danced here although it is pinned: the choreography does not have it, or another "
        "correction is too near; unpin it or pin another one"
    ),
    "dance.segment_not_held": (
        "segment {number} is not danced here although it is selected: the choreography does not have it, or another "
        "correction is too near; unpin it or select another one"
    ),
    "dance.state_not_avoided": (
        "basic motion {number} is danced here although it is forbidden: nothing else fits; forbid fewer basic motions, "
        "or for a shorter time"
    ),
    "dance.seam_shows": (
        "the change from basic motion {before} to {after} can be seen: pin another motion here, or move this one"
    ),
    "dance.foot_slides": (
        "the {side} foot slides over the floor while it stands: pin another motion here, or move this one"
    ),
    "learn.no_motion": "there is no motion to learn from in {motions}: the body is still, or the clips are too short",
    "learn.states": "{states} basic motions cannot be learned from {segments} motions; ask for fewer states",
    "learn.no_overlap": (
        "no percussion of {music} sounds during the motions of {motion}; correct the offset of this pair, or leave it "
        "to be found"
    ),
    "learn.done": (
        "{file}: {states} basic {states:motion|motions} (states) of {segments} {segments:segment|segments}, "
        "{length_s:.1f} s ({frames} {frames:frame|frames})"
    ),
    "learn.no_percussion": (
        "{file} has no percussion to learn from (notes on channel 10); pair the motion with a file that has a drum part"
    ),
    "motion.apart": "arms up to {apart_mm} mm from their place in the file: its collars move",
    "motion.doubtful": "joints that are guessed: {joints}",
    "motion.flips": "{n} {n:flip|flips} of the capture mended",
    "motion.lead_in": "{n} {n:frame|frames} of a rest pose at its start left out",
    "motion.no_unit": "its unit is not known: the body is made 1.7 m high",
    "motion.rate": "{rate} frames/s (its file says {said})",
}
