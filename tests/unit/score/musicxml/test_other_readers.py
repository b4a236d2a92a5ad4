"""Scores from several programs compared with the readings of music21 and partitura (`tests.support.notation`)."""

from __future__ import annotations

import pytest

from tests.support.notation import DATA, EXAMPLES, READERS, corpus, differences, others, ours, python_of_readers
from tests.support.notation_differences import known

SUITE = (
    *("01a-Pitches-Pitches", "02a-Rests-Durations", "03aa-Rhythm-Durations", "11c-TimeSignatures-CompoundSimple"),
    *("21f-Chord-ElementInBetween", "23c-Tuplet-Display-NonStandard", "24b-ChordAsGraceNote", "33b-Spanners-Tie"),
    *("33c-Spanners-Slurs", "33i-Ties-NotEnded", "41c-StaffGroups", "42a-MultiVoice-TwoVoicesOnStaff-Lyrics"),
    *(
        "43a-PianoStaff",
        "45b-RepeatWithAlternatives",
        "45c-RepeatMultipleTimes",
        "46e-PickupMeasure-SecondVoiceStartsLater",
    ),
    *("46d-PickupMeasure-ImplicitMeasures", "72b-TransposingInstruments-Full"),
)
"""Files of the LilyPond project's MusicXML test suite, one for each subject, as included in music21."""


@pytest.mark.readers
@pytest.mark.parametrize("reader", READERS)
def test_scores_of_several_programs(reader: str) -> None:
    if not python_of_readers():
        pytest.skip("music21 and partitura are set up by ./test")
    suite = corpus() / "musicxml/lilypondTestSuite"
    paths = [
        *sorted(path for path in DATA.iterdir() if path.suffix in (".xml", ".musicxml")),
        *sorted(EXAMPLES.glob("quartet.musicxml")),
        *(suite / f"{name}.xml" for name in SUITE),
    ]
    found = {
        path.name: differences(ours(path), other) for path, other in zip(paths, others(reader, paths), strict=True)
    }
    assert found == {path.name: known(str(path), reader)[0] for path in paths}
