"""MIDI files, parts and who plays them."""

from __future__ import annotations

from typing import Final

TEMPLATES: Final[dict[str, str]] = {
    # MIDI files that cannot be read
    "midi.empty": "{file} is empty",
    "midi.not_midi": "{file} is not a MIDI file: byte {byte} has {found} where the header MThd belongs",
    "midi.header_truncated": "{file} ends within its header, at byte {byte}",
    "midi.bad_division": "{file}: the time division at byte {byte} is 0, so the notes have no times",
    "midi.no_tracks": "{file} has no track: byte {byte} has {found} where a track MTrk belongs",
    "midi.unknown_encoding": "{file}: there is no text encoding {encoding!r}",
    "midi.track_unreadable": "{file}: track {track}, which begins at byte {byte}, cannot be read: {detail}",
    "midi.too_many_parts": (
        "{file}: {parts} parts (channels of tracks) have notes; at most {most} can be read; delete those that no wind "
        "player plays, in the program that the file comes from"
    ),
    "midi.too_long": (
        "{file}: the last note of track {track} ends after {hours:g} hours, {quarters} quarter notes and {bars} bars; "
        "at most {most_hours} hours, {most_quarters} quarter notes and {most_bars} bars can be played; delete what "
        "lies far behind the music, or correct the tempo, in the program that the file comes from"
    ),
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
        "{count} {count:byte|bytes} after the last track, from byte {byte}, {count:is|are} no part of a MIDI file "
        "and {count:was|were} left out"
    ),
    "midi.track_truncated": "track {track} breaks off within an event at byte {byte}; what came before was read",
    "midi.bytes_not_understood": (
        "{count} {count:byte|bytes} of track {track} {count:is no MIDI event and was|are no MIDI events and were} "
        "left out, the first at byte {byte}"
    ),
    "midi.smpte_rate": ("the file counts time in frames of 1/{rate} s, which is no SMPTE rate; it was taken literally"),
    "midi.patterns": "the file has {patterns} independent patterns (format 2); they follow one another",
    "midi.hanging_notes": (
        "{count} {count:note|notes} of track {track} never {count:ends; it ends|end; they end} where the next note of "
        "the channel begins, and after four quarters at the latest"
    ),
    "midi.zero_length_notes": (
        "{count} {count:note|notes} of track {track} {count:has no length; it lasts|have no length; they last} one tick"
    ),
    "midi.beyond_all_music": (
        "{count} {count:event|events} of track {track} {count:lies|lie} beyond the last possible tick and "
        "{count:was|were} left out"
    ),
    "midi.impossible_metre": (
        "track {track} has {count} impossible time {count:signature|signatures}, the first at tick {tick}; "
        "{count:it was|they were} left out"
    ),
    "midi.impossible_tempo": (
        "track {track} has {count} impossible {count:tempo|tempos}, the first at tick {tick}; {count:it was|they were} "
        "left out"
    ),
    # MIDI files that were written, and what they cannot hold
    "midi.written": "{file} is written: {count} {count:track|tracks}",
    "midi.written_but": "{file} is written, but: {first} ({count} {count:remark|remarks} in all)",
    "midi.tempo_unwritable": (
        "bar {bar}: a MIDI file cannot hold a tempo of {bpm:g} quarters per minute, only {low:g} to {high:g}; change "
        "it and export again"
    ),
    "midi.nested_notes": (
        "{part}: {count} {count:note sounds|notes sound} within another of the same pitch; in a MIDI file the two "
        "exchange their ends"
    ),
    "midi.name_says_other": (
        "{part}: its name says {said}, so who reads the file takes it for that and not for {played}"
    ),
    "midi.shared_again": "{part}: notes sound together; who reads the file shares them among players",
    "midi.onto_source": (
        "{file} is what the piece was read from, and holds {count} {count:part|parts} more that nobody plays here; "
        "write to another file"
    ),
    "midi.onto_itself": "{file} would be replaced by what was read from it; write to another file",
    # Parts and who plays them
    "score.no_map": "there is no instrument map for {instrument} yet",
    "score.left_out": "left out on import",
    "score.percussion": "{instrument} is percussion",
    "score.not_wind": "{instrument} is not a wind instrument",
    "score.outside_ranges": (
        "neither its name nor its program says what it is, and no instrument map reaches its notes "
        "({lowest} to {highest})"
    ),
    "score.substituted": "{part}: there is no instrument map for {instrument}; {map} plays it instead",
    "score.told_by_file": (
        "{part}: neither its name nor its program says what it is; the file's name does, so {map} plays it"
    ),
    "score.chosen_by_range": (
        "{part}: neither its name nor its program says what it is; {map} plays it because the range fits"
    ),
    "score.chosen_by_range_partly": (
        "{part}: neither its name nor its program says what it is; {map} plays it, though {outside} of {total} notes "
        "lie outside its range, the first at bar {bar}, beat {beat:g} ({pitch})"
    ),
    "score.looks_written": (
        "{part}: {outside} of {total} notes lie outside the range of {map}, the first at bar {bar}, beat {beat:g} "
        "({pitch}), but all fit as written pitches: the part looks untransposed; import its pitches as written"
    ),
    "score.too_many_players": "the piece has {most} players already, and more cannot play",
    "score.unknown_instrument": "nothing says which instrument plays it ({lowest} to {highest}); choose one",
    "score.notes_left_out": (
        "{part}: split between {most} players; {count} {count:note that sounds|notes that sound} together with theirs "
        "{count:is|are} left out, the first at bar {bar}, beat {beat:g} ({pitch})"
    ),
    "score.doubling": (
        "{part}: the player of this track changes to {instrument} for {count} {count:note|notes}, the first at bar "
        "{bar}, beat {beat:g} ({pitch})"
    ),
    "score.stray_notes": (
        "{count} {count:note sounds|notes sound} together with others, the first at bar {bar}, beat {beat:g} "
        "({pitch}); too few and too short for another player"
    ),
    "score.slurred": (
        "{count} {count:note lasts|notes last} into the next one and {count:ends|end} there, slurred; the first in "
        "{part} at bar {bar}, beat {beat:g} ({pitch})"
    ),
    "score.key_switches": (
        "{count} {count:note|notes} far from the range of the instrument {count:is a key switch|are key switches}, "
        "the first at bar {bar}, beat {beat:g} ({pitch})"
    ),
    "score.voices": (
        "{part}: split between {voices} players, because {count} {count:note keeps|notes keep} sounding together with "
        "others, the first at bar {bar}, beat {beat:g} ({pitch})"
    ),
}
