"""English wording of every message of the program: id -> template, filled with the message's arguments."""

from __future__ import annotations

from typing import Final

from app.errors import AppError, Message

TEMPLATES: Final[dict[str, str]] = {
    # What a person asked for
    "set.syntax": "--set {text}: expected PLAYER.parameter=value",
    "set.player_unknown": "--set: there is no player {player!r}; there are: {possible}",
    "set.parameter_unknown": "--set: there is no parameter {parameter!r}; there are: {possible}",
    "set.value_invalid": "--set: {parameter} cannot be {value!r}; possible: {possible}",
    "player.unknown": "there is no player {player!r}; there are: {possible}",
    "bars.none": "there are no bars {first} to {last}; the piece has {lowest} to {highest}",
    "export.nobody": "{file}: there is nobody to export; 'suisou inspect' says why each part is not played",
    "export.too_long": (
        "{file}: {frames} frames are more than the {most} that one export holds; "
        "take some bars with --from-bar and --to-bar"
    ),
    "piece.too_long": "the piece lasts {hours:g} hours; at most {most_hours} can be played",
    "work.stopped": "stopped; nothing was written",
    # Files
    "file.cannot_read": "{file} cannot be read: {reason}",
    "file.cannot_write": "{file} cannot be written: {reason}",
    "file.unreadable": "{file} cannot be read: {detail}",
    # MIDI files that cannot be read
    "midi.empty": "{file} is empty",
    "midi.not_midi": "{file} is not a MIDI file: byte {byte} has {found} where the header MThd belongs",
    "midi.header_truncated": "{file} ends within its header, at byte {byte}",
    "midi.bad_division": "{file}: the time division at byte {byte} is 0, so the notes have no times",
    "midi.no_tracks": "{file} has no track: byte {byte} has {found} where a track MTrk belongs",
    "midi.unknown_encoding": "{file}: there is no text encoding {encoding!r}",
    "midi.track_unreadable": "{file}: track {track}, which begins at byte {byte}, cannot be read: {detail}",
    # MIDI files that can be read in part, or in an own way
    "midi.header_length": (
        "the header says that it is {length} bytes long and is not (byte {byte}); its first 6 bytes were taken"
    ),
    "midi.unknown_format": "the file says it has the unknown format {format}; its tracks were taken as simultaneous",
    "midi.format_0_tracks": (
        "the file says it has one track (format 0) and has {tracks}; they were taken as simultaneous"
    ),
    "midi.track_length": "the length of track {track} (byte {byte}) is wrong; the track was read up to its real end",
    "midi.tracks_missing": "the header promises {expected} tracks, the file has {found}",
    "midi.bytes_left_out": (
        "{count} bytes after the last track, from byte {byte}, are no part of a MIDI file and were left out"
    ),
    "midi.track_truncated": "track {track} breaks off within an event at byte {byte}; what came before was read",
    "midi.bytes_not_understood": (
        "{count} bytes of track {track} are no MIDI events and were left out, the first at byte {byte}"
    ),
    "midi.smpte_rate": ("the file counts time in frames of 1/{rate} s, which is no SMPTE rate; it was taken literally"),
    "midi.patterns": "the file has {patterns} independent patterns (format 2); they follow one another",
    "midi.hanging_notes": "{count} notes of track {track} never end; they end with the track",
    "midi.zero_length_notes": "{count} notes of track {track} have no length; they last one tick",
    "midi.impossible_metre": "track {track} has an impossible time signature at tick {tick}; it was left out",
    "midi.impossible_tempo": "track {track} has an impossible tempo at tick {tick}; it was left out",
    # Parts and who plays them
    "score.no_map": "there is no instrument map for {instrument} yet",
    "score.percussion": "{instrument} is percussion",
    "score.not_wind": "{instrument} is not a wind instrument",
    "score.outside_ranges": (
        "neither its name nor its program says what it is, and no instrument map reaches its notes "
        "(MIDI {lowest} to {highest})"
    ),
    "score.substituted": "{part}: there is no instrument map for {instrument}; {map} plays it instead",
    "score.chosen_by_range": (
        "{part}: neither its name nor its program says what it is; {map} plays it because the range fits"
    ),
    "score.chosen_by_range_partly": (
        "{part}: neither its name nor its program says what it is; {map} plays it, though {outside} of {total} notes "
        "lie outside its range"
    ),
    "score.voices": "{part}: up to {voices} notes sound together, so {voices} players share it",
    # Instrument maps, metadata, models
    "vocabulary.invalid": "{file}: {detail}",
    "gltf.not_gltf": "{file} is not a glTF 2.0 file",
    "gltf.damaged": "{file} is damaged: {what} is wrong",
    "gltf.external": "{file} needs the file {uri} beside it; only files that hold everything themselves are read",
    "gltf.unsupported": "{file} uses {what}, which is not supported",
    "gltf.too_large": "{file} describes more data than any character has",
    "instruments.invalid": "{file} is not valid; problems: {count}",
    "map.unreadable": "{file}: cannot be read: {detail}",
    "map.syntax": "{file}, line {line}, column {column}: {detail}",
    "map.invalid": "{file}: {path}: {detail}",
    "map.unknown": "there is no instrument map named {id!r}",
    "metadata.missing": "there is no {kind} named {name!r}; there are: {known}",
    "metadata.syntax": "{file}: {detail}",
    "metadata.invalid": "{file}: {key}: {detail}",
    "character.missing": "there is no character named {id!r}; there are: {known}",
    "character.landmarks_missing": "the character {id!r} lacks what playing needs: {missing}",
    "model.invalid": "{file}: {detail}",
    # FBX and BVH
    "fbx.not_binary": "{file} is not a binary FBX file",
    "fbx.truncated": "{file} ends in the middle of a record (byte {offset})",
    "fbx.bad_record": "{file}: the record at byte {offset} does not fit into its surroundings",
    "fbx.bad_property": "{file}: the property at byte {offset} is of an unknown kind or too long for its record",
    "fbx.bad_array": "{file}: the array at byte {offset} is damaged",
    "fbx.too_deep": "{file}: the records at byte {offset} are nested too deeply",
    "fbx.missing": "{file} has no {what}",
    "fbx.unsupported": "{file}: {what} is not supported",
    "fbx.contradiction": "{file} contradicts itself: {detail}",
    "bvh.syntax": "{file}, line {line}: {found} does not belong here",
    "bvh.truncated": "{file} ends too early",
    "bvh.motion": "{file}: the motion does not fit the skeleton ({detail})",
    "bvh.unsupported": "{file}, line {line}: {what} is not supported",
    # The plan: fingerings
    "fingering.first_choice": "{label}: the first choice",
    "fingering.trill": "{label} instead of {first}: less motion in a trill at {time_ms} ms a note",
    "fingering.speed": "{label} instead of {first}: less motion where a note has {time_ms} ms",
    "fingering.by_hand": "{label}: set by hand",
    "fingering.out_of_range": (
        "note {note} (MIDI {pitch}) lies outside the range {low}-{high} of this instrument; "
        "shown with the fingering of {played_pitch}"
    ),
    "fingering.starts_early": (
        "the way to {label} takes {needed_ms} ms, but only {available_ms} ms are free before note {note}; "
        "it starts earlier"
    ),
    # The plan: breaths
    "breath.first": "the first breath, in the {beats:g} beats before the entry",
    "breath.rest_whole": (
        "a rest of {rest_beats:g} beats (from {min_beats:g} to below {last_beat_beats:g}): the breath takes all of it"
    ),
    "breath.last_beat": (
        "a rest of {rest_beats:g} beats (from {last_beat_beats:g} to below {prepare_beats:g}): "
        "the breath takes its last beat"
    ),
    "breath.prepared": "a rest of {rest_beats:g} beats (from {prepare_beats:g}): prepared, then the last beat",
    "breath.preparation": "a rest of {rest_beats:g} beats (from {prepare_beats:g}): getting ready to breathe",
    "breath.catch": (
        "a catch breath after note {after_note}: {phrase_s:g} s without a rest ask for more than the {lung_s:g} s of "
        "a full lung; {from_note_ms:g} ms come out of that note's tail"
    ),
    "breath.too_long": (
        "from note {note} on, {phrase_s:g} s must be played on one breath; it takes {air_s:g} s of air, and there are "
        "{lung_s:g}"
    ),
    "breath.inside_note": "this breath, placed by hand, lies inside the sounding note {note}",
    # The plan: cues, gestures, faces
    "cue.start": "starts the piece ({leader_reason}); the preparatory beat lasts {beat_s:g} s",
    "cue.after_rest": (
        "brings everyone in after {rest_s:g} s of common rest ({leader_reason}); "
        "the preparatory beat lasts {beat_s:g} s"
    ),
    "gesture.sway": "half a swing in {beats:g} beats of {beat_s:g} s",
    "gesture.weight_shift": "a shift of weight to the {side} foot",
    "gesture.bell_height": "the melody is around MIDI {pitch:g}; the line's mean is {mean_pitch:g}",
    "gesture.lower_instrument": "{rest_s:g} s of rest: the instrument comes down and is up again before the entry",
    "gesture.lower_at_end": "{after_s:g} s after the last note the instrument comes down",
    "gesture.lower_at_start": "the entry is {rest_s:g} s away: the instrument is still down",
    "embouchure.register": "MIDI {pitch} in a range of {low}-{high}, loudness {loudness:g}",
    "expression.default": "the face at rest",
    "expression.effort": "effort {effort:g} (from {threshold:g}): high, loud or long",
    "expression.low_loud": "MIDI {pitch} lies below {easy_low} and is loud ({loudness:g})",
    "expression.gives_entry": "gives the entry",
    "expression.takes_entry": "comes in after {rest_s:g} s of rest",
    "expression.end": "the last note is over",
    # Corrections
    "correction.by_hand": "set by hand",
    "correction.orphaned": "the correction ({kind}) for {anchor} has lost its place: it is kept, but does nothing",
    "correction.unknown_expression": "there is no expression {name!r}; there are: {known}",
    "correction.empty_span": "the correction ({kind}) for {anchor} ends before it begins: it is kept, but does nothing",
    "correction.no_such_fingering": "{label} is not a fingering of note {note} on this instrument; the search chose",
}


def text(message: Message) -> str:
    """The message as an English sentence."""
    return TEMPLATES[message.id].format(**message.arguments)


def error_text(error: AppError) -> str:
    """What went wrong, as an English sentence."""
    return text(error.message)
