"""The files of the results."""

from __future__ import annotations

import csv
import io
import re
from pathlib import Path
from xml.etree import ElementTree

import msgspec
import pytest

from app.errors import FileError
from app.evaluation.measures import VariantMeasures, VariantPlayerMeasures, read_measures, write_measures
from app.evaluation.plot import plot
from app.evaluation.report import write_results
from app.evaluation.results import EvaluationResults, tabulate
from app.evaluation.tables import tables
from tests.support.viewers import key_of, viewers

SVG = "{http://www.w3.org/2000/svg}"
KEY = key_of(piece="Air | <b>*in G*</b>")
RESULTS = tabulate(KEY, viewers(KEY, 6, presentations=("single", "pair"), skips=0.1))
PLAYER = msgspec.json.decode(
    b'{"player": "Trumpet 1", "head_mm_s": 38.49, "notes": 10, "contact": 1.0,'
    b'"lag": {"notes": 9, "missed": 0, "median_ms": -17.1, "latest_ms": -16.0, "detectable": 0.0, "unacceptable": 0},'
    b'"breath": {"breaths": 1, "chest_mm": {"at_breaths": 1, "between": null}, "shoulders_mm": {"at_breaths": 9.2,'
    b'"between": 1.5}, "ribs": {"at_breaths": 1, "between": 0}, "mouth": {"at_breaths": 0.29, "between": null}}}',
    type=VariantPlayerMeasures,
)
MEASURES = (VariantMeasures("generated", (PLAYER,)),)


def written(results: EvaluationResults, folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in write_results(results, MEASURES, folder)}


def test_the_same_answers_give_the_same_bytes(tmp_path: Path) -> None:
    one = written(RESULTS, tmp_path / "one" / "deep")
    again = tabulate(KEY, viewers(KEY, 6, presentations=("single", "pair"), skips=0.1)[::-1])
    assert one == written(again, tmp_path / "two")
    assert set(one) == {"results.md", "results_ja.md", "results.svg", "results_ja.svg", "results.csv", "results.json"}


def test_markdown_has_all_and_the_names_are_no_markdown(tmp_path: Path) -> None:
    found = written(RESULTS, tmp_path)
    english, japanese = found["results.md"].decode(), found["results_ja.md"].decode()
    assert english.startswith("# Evaluation of Air \\| \\<b\\>\\*in G\\*\\</b\\>\n")
    assert "## What may not be concluded" in english
    assert "## 結論できないこと" in japanese
    assert "(results_ja.svg)" in japanese
    assert "| generated | Trumpet 1 | -17 | 0.0 | 0.0 | 38.5 | 9.2 / 1.5 | 29 / - | 100.0 |" in english
    # Every row has as many cells as its table's head.
    for table in re.findall(r"(?:^\|.*\n)+", english, re.MULTILINE):
        cells = {len(re.findall(r"(?<!\\)\|", line)) for line in table.splitlines()}
        assert len(cells) == 1
    assert not re.search(r"\bnan\b|None", english + japanese)


def test_the_table_for_spreadsheets_holds_the_scores(tmp_path: Path) -> None:
    content = written(RESULTS, tmp_path)["results.csv"]
    assert content.startswith(b"\xef\xbb\xbf")
    rows = list(csv.DictReader(io.StringIO(content.decode("utf-8-sig"))))
    assert len(rows) == len(RESULTS.scores)
    for row, score in zip(rows, RESULTS.scores, strict=True):
        assert score.over_viewers is not None
        assert (row["variant"], int(row["answers"])) == (score.variant, score.answers)
        assert float(row["mean"]) == pytest.approx(score.over_viewers.mean, abs=5e-5)


def test_json_is_read_back(tmp_path: Path) -> None:
    found = msgspec.json.decode(written(RESULTS, tmp_path)["results.json"])
    assert msgspec.convert(found["results"], EvaluationResults) == RESULTS
    assert msgspec.convert(found["measures"], tuple[VariantMeasures, ...]) == MEASURES
    assert len(found["may_not_be_concluded"]) > 3


@pytest.mark.parametrize("language", ["en", "ja"])
def test_the_picture_shows_every_mean_where_it_is(language: str) -> None:
    root = ElementTree.fromstring(plot(RESULTS, language))
    circles = root.findall(f"{SVG}circle")
    singles = [score for score in RESULTS.scores if score.question.presentation == "single" and score.over_viewers]
    # And one in the legend.
    assert len(circles) == len(singles) + 1
    # Steps are evenly spaced: of every field the five lines, by the numbers under them.
    numbers = [(float(text.get("x", "")), text.text) for text in root.findall(f"{SVG}text") if text.text in "12345"]
    lines = sorted({x for x, text in numbers if text == "1"})
    step = next(x for x, text in numbers if text == "2") - lines[0]
    shown = sorted(
        round(min((x - left) / step + 1 for left in lines if x >= left), 2)
        for x in (float(circle.get("cx", "")) for circle in circles[1:])
    )
    assert shown == pytest.approx(sorted(score.over_viewers.mean for score in singles if score.over_viewers), abs=0.01)
    width, height = (float(root.get(name, "")) for name in ("width", "height"))
    for circle in circles:
        assert 0.0 < float(circle.get("cx", "")) < width
        assert 0.0 < float(circle.get("cy", "")) < height


def test_tables_have_a_name_for_every_column() -> None:
    for language in ("en", "ja"):
        for table in tables(RESULTS, MEASURES, language):
            assert {len(row) for row in table.rows} == {len(table.head)}


def test_measures_are_read_back(tmp_path: Path) -> None:
    path = tmp_path / "measures.json"
    write_measures(MEASURES, path)
    assert read_measures(path) == MEASURES
    path.write_text("{}")
    with pytest.raises(FileError) as raised:
        read_measures(path)
    assert raised.value.message.id == "results.not_measures"


def test_a_folder_that_cannot_be(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    with pytest.raises(FileError) as raised:
        write_results(RESULTS, (), tmp_path / "file" / "folder")
    assert raised.value.message.id == "file.cannot_write"
