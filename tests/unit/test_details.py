"""What is wrong with tables of acting is worded in Japanese too."""

from __future__ import annotations

from pathlib import Path

import pytest

from app.errors import MapError
from app.messages import text
from metadata.library import READERS

GESTURE = 'title = { en = "x" }\nlength_s = 2.0\n'
TRACK = '[[tracks]]\ntarget = "head"\nturn = "up"\n'
TRACK += "keys = [{ at = 0, deg = 0 }, { at = 0.5, deg = 5 }, { at = 1, deg = 0 }]\n"
RULE = 'description = ""\n[[rules]]\nname = "a"\n'
FACE = 'description = ""\nwhile_playing = true\nfade_in_s = 0.2\n'
WRONG = {
    "styles": ('title = { en = "x" }\n[factors]\nsway = 14', 'title = { en = "x" }\n[factors]\nswy = 1'),
    "habits": ('title = { en = "x" }\n[factors]\n', "title = 3"),
    "expressions": (FACE, f"{FACE}fade_out_s = -1\n[weights]", f"{FACE}fade_out_s = 0.2\n[weights]\nbrow = 0.5"),
    "gestures": (
        GESTURE + TRACK.replace("head", "tail"),
        GESTURE + TRACK.replace("at = 1, deg = 0", "at = 1, deg = 2"),
        GESTURE + TRACK.replace("head", "left_elbow").replace('"up"', '"left"'),
        GESTURE + TRACK + TRACK.replace('"up"', '"roll"').replace("at = 1,", "at = 0.9,"),
        GESTURE,
    ),
    "rules": (
        f'{RULE}when = {{ loudness_abov = 0.5 }}\ndo = {{ expression = "smile" }}',
        f'{RULE}when = {{ }}\ndo = {{ expression = "smile" }}',
        f"{RULE}when = {{ longer_s = 1.0 }}\ndo = {{ }}",
        f'{RULE}when = {{ accent = 0.1 }}\ndo = {{ gesture = "shrug", grows_with = "height" }}',
    ),
}


@pytest.mark.parametrize(("kind", "wrong"), [(kind, wrong) for kind, some in WRONG.items() for wrong in some])
def test_what_is_wrong_is_said_in_japanese(tmp_path: Path, kind: str, wrong: str) -> None:
    (tmp_path / kind).mkdir()
    file = tmp_path / kind / "mine.toml"
    file.write_text(f'name = "mine"\n{wrong}', encoding="utf-8")
    with pytest.raises(MapError) as raised:
        READERS[kind](file)
    english, japanese = (text(raised.value.message, language) for language in ("en", "ja"))
    place = f"{kind}/mine.toml: {raised.value.message.arguments['place']}: "
    assert english.startswith(place)
    assert japanese.startswith(place)
    assert any("぀" <= letter <= "鿿" for letter in japanese), japanese
