"""Fingerings, breaths, cues, gestures, faces, corrections: reasons and problems."""

from __future__ import annotations

from typing import Final

TEMPLATES: Final[dict[str, str]] = {
    "doubling.rest_short": (
        "the rest of {rest_s:g} s is too short to change from {before} to {after}: about {needed_s:g} s are needed"
    ),
    "doubling.overlap": (
        "{before} still sounds {seconds:g} s into {after}, but one person plays both: the change takes notes away"
    ),
    # The plan: fingerings
    "fingering.first_choice": "{label}: the first choice",
    "fingering.trill": "{label} instead of {first}: less motion in a trill at {time_ms} ms a note",
    "fingering.speed": "{label} instead of {first}: less motion where a note has {time_ms} ms",
    "fingering.by_hand": "{label}: set by hand",
    "fingering.out_of_range": (
        "note {note}: {pitch} lies outside the range of this instrument, {low} to {high}; "
        "shown with the fingering of {played_pitch}"
    ),
    "fingering.starts_early": (
        "the way to {label} takes {needed_ms} ms, but only {available_ms} ms are free before note {note}; "
        "it starts earlier"
    ),
    # The plan: notes that cannot sound together
    "note.struck_together": (
        "note {note} is struck together with the higher note {other}: only one can sound, and it is left out"
    ),
    "note.overlaps": "note {note} still sounds for {overlap_ms} ms when {other} begins: it ends there",
    "contact.out_of_reach": (
        "{label} is out of this player's reach: {control} stops {gap_mm} mm short of it; "
        "take another fingering, or a character with longer arms"
    ),
    # The body: what it lacks
    "character.instrument_size": "plays an instrument of {percent} % of its size: so hands and arms reach it",
    "character.no_fingers": (
        "the {side} hand has fingers that do not bend: it lies on the instrument as a whole, and what they would press "
        "moves by itself"
    ),
    "character.no_hand": "the {side} hand has no skin to touch with: it hangs down while the other one plays",
    "character.no_lips": "the head has no skin to find a mouth on: the instrument is held where lips would be",
    "character.lips_still": "the mouth has no morph that opens it: breaths do not show on it, and lips stay shut",
    "character.hold_failed": (
        "{character} cannot be made to hold {instrument} ({detail}); correct the instrument's map, or take another "
        "character"
    ),
    "character.hold_waiting": (
        "how the instrument is held is being found out; the player is seen as soon as that is known"
    ),
    "character.touches_missed": (
        "{count} {count:touch does|touches do} not meet this instrument, the {touch} misses by {gap_mm} mm: hands "
        "and instrument are of too different sizes or shapes"
    ),
    # The motion: contacts
    "contact.hand_off": (
        "the {side} hand comes off the instrument: it stays {gap_mm} mm from its place; "
        "lessen the pose correction or the gesture here, or take a character of another size"
    ),
    "contact.stops_short": (
        "{control} stops {gap_mm} mm short of its place: the {side} hand comes no farther; "
        "lessen the pose correction or the gesture here, or take a character with longer arms"
    ),
    "contact.finger_off": (
        "the {touch} misses {control} by {gap_mm} mm; "
        "lessen the pose correction here, or take a character of another size"
    ),
    "contact.grip_off": (
        "the {touch} does not touch the instrument: {gap_mm} mm are missing; "
        "lessen the pose correction here, or take a character of another size"
    ),
    "contact.lips_off": (
        "the lips are {gap_mm} mm off the mouthpiece while a note sounds; "
        "move or remove the gesture that lowers the instrument here"
    ),
    "contact.foot_off": (
        "the {side} foot leaves its place on the floor by {gap_mm} mm; lessen sway, weight shift or the pose correction"
    ),
    # The plan: breaths
    "breath.first": "the first breath, in the {beats:g} beats before the entry",
    "breath.rest_whole": (
        "a rest of {rest_beats:g} beats (from {min_beats:g} to below {last_beat_beats:g}): the breath takes all of it"
    ),
    "breath.heard": "heard in the breath: {gap_s:g} s without blowing",
    "breath.heard_preparation": "heard in the breath: {gap_s:g} s without blowing; getting ready to breathe",
    "breath.heard_short": "heard in the breath: {gap_s:g} s without blowing, taken because air was needed",
    "breath.last_beat": (
        "a rest of {rest_beats:g} beats (from {last_beat_beats:g} to below {prepare_beats:g}): "
        "the breath takes its last beat"
    ),
    "breath.prepared": "a rest of {rest_beats:g} beats (from {prepare_beats:g}): prepared, then the last beat",
    "breath.preparation": "a rest of {rest_beats:g} beats (from {prepare_beats:g}): getting ready to breathe",
    "breath.catch": (
        "a catch breath after note {after_note}: {phrase_s:g} s without a breath in a rest need more than the "
        "{lung_s:g} s of air there are; {from_note_ms:g} ms come out of that note's tail"
    ),
    "breath.catch_dropped": (
        "a catch breath instead of note {after_note}, which is left out: {phrase_s:g} s without a breath in a rest "
        "need more than the {lung_s:g} s of air there are, and no note is long enough to take it from"
    ),
    "breath.catch_dropped_two": (
        "a catch breath instead of notes {first_note} and {after_note}, which are left out: {phrase_s:g} s without a "
        "breath in a rest need more than the {lung_s:g} s of air there are, and no note is long enough to take it from"
    ),
    "breath.staggered": (
        "a breath within a note that others of the line hold on: it takes {air_s:g} s of air, and there are {lung_s:g}"
    ),
    "breath.too_long": (
        "from note {note} on, {phrase_s:g} s must be played on one breath; it takes {air_s:g} s of air, and there are "
        "{lung_s:g}"
    ),
    "breath.inside_note": "this breath, placed by hand, lies inside the sounding note {note}",
    # The plan: cues, gestures, faces
    "cue.start": "starts the piece ({leader_reason}); the preparatory beat lasts {beat_s:g} s",
    "cue.after_pause": (
        "brings everyone in after a general pause of {rest_s:g} s ({leader_reason}); "
        "the preparatory beat lasts {beat_s:g} s"
    ),
    "cue.after_fermata": "goes on after a fermata ({leader_reason}); the preparatory beat lasts {beat_s:g} s",
    "cue.tempo": (
        "gives the new tempo of {bpm:g} beats a minute ({leader_reason}); the preparatory beat lasts {beat_s:g} s"
    ),
    "cue.section": (
        "brings in {count} {count:player|players} after {rest_s:g} s of rest, while others play ({leader_reason}); "
        "the preparatory beat lasts {beat_s:g} s"
    ),
    "cue.joins": "comes in after {rest_s:g} s of rest, while others play; the preparatory beat lasts {beat_s:g} s",
    "cue.after_rest": (
        "brings everyone in after {rest_s:g} s of common rest ({leader_reason}); "
        "the preparatory beat lasts {beat_s:g} s"
    ),
    "gesture.sway": "half a swing in {beats:g} beats of {beat_s:g} s",
    "gesture.weight_shift": "a shift of weight to the {side} foot",
    "gesture.bell_height": "the melody is around {pitch}; the line's mean is {mean_pitch}",
    "gesture.bell_accent": "an accent, {more:g} louder than the notes around it",
    "gesture.lower_instrument": "{rest_s:g} s of rest: the instrument comes down and is up again before the entry",
    "gesture.lower_at_end": "{after_s:g} s after the last note the instrument comes down",
    "gesture.lower_at_start": "the entry is {rest_s:g} s away: the instrument is still down",
    "embouchure.register": "{pitch} in a range of {low} to {high}, loudness {loudness:g}",
    "embouchure.heard": "{pitch} in a range of {low} to {high}; heard in the breath: loudness {loudness:g} on average",
    "expression.default": "the face at rest",
    "expression.effort": "effort {effort:g} (from {threshold:g}): high, loud or long",
    "expression.low_loud": "{pitch} lies below {easy_low} and is loud ({loudness:g})",
    "expression.gives_entry": "gives the entry",
    "expression.takes_entry": "comes in after {rest_s:g} s of rest",
    "expression.end": "the last note is over: a bright end, in major, {bpm:g} beats a minute and not soft",
    # Corrections
    "correction.by_hand": "set by hand",
    "correction.orphaned": "the correction ({kind}) for {anchor} has lost its place: it is kept, but does nothing",
    "correction.unknown_expression": "there is no expression {name!r}; there are: {known}",
    "correction.empty_span": "the correction ({kind}) for {anchor} ends before it begins: it is kept, but does nothing",
    "pose.beyond_reach": (
        "the {target} was to be held {asked_deg:g} degrees ({angle}), but a body or the instrument's hold goes no "
        "further than {most_deg:g}"
    ),
    "correction.no_such_fingering": "{label} is not a fingering of note {note} on this instrument; the search chose",
}
