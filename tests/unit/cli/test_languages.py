"""The command line in both languages: texts are completely translated, and output for scripts stays the same."""

from __future__ import annotations

import argparse
import ast
import inspect
import io
import json
import re
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from app.cli import main, parser
from app.cli.commands import CommandParser, argparse_words, help_texts, worded_argparse
from app.cli.speech import Speech, requested_speech, speaking, system_language
from app.cli.status import BAD_USE, DONE
from app.cli.summary import columns
from app.cli.widths import width, wrapped
from app.errors import Message
from app.plan.problem_lines import problem_lines
from instrument_maps.library import find_map
from tests.unit.plan.test_problem_lines import SCORE, early

QUARTET = Path(__file__).parents[3] / "resources" / "examples" / "quartet.mid"
JAPANESE = re.compile("[\u3041-\u30ff\u4e00-\u9fff]")
FIELD = re.compile(r"%\((\w+)\)s|%s|%%")
TEXTS = [(f"{name} {option}", text) for name, options in help_texts().items() for option, text in options.items()]
FOR_PROGRAMMERS = {
    *(".__call__() not defined", "'required' is an invalid argument for positionals", "%r is not callable"),
    *("mutually exclusive arguments must be optional", "cannot merge actions - two groups are named %r"),
    "invalid option string %(option)r: must start with a character %(prefix_chars)r",
    *("dest= is required for options like %r", "invalid conflict_resolution value: %r"),
    *("cannot have multiple subparser arguments", "conflicting subparser: %s", "conflicting subparser alias: %s"),
    *('argument "-" with mode %r', "conflicting option string: %s", "conflicting option strings: %s"),
    *("%(heading)s:", "subcommands", " (default: %(default)s)"),
    *("command '%(parser_name)s' is deprecated", "option '%(option)s' is deprecated"),
    "argument '%(argument_name)s' is deprecated",
}
"""Texts of argparse that users never see: about declarations, and about unused functions."""


def commands() -> Iterator[CommandParser]:
    """Every sub-command, including nested ones."""
    pending: list[argparse.ArgumentParser] = [parser()]
    while pending:
        command = pending.pop()
        assert isinstance(command, CommandParser)
        command.complete()
        pending += [
            part
            for action in command._actions
            if isinstance(action, argparse._SubParsersAction)
            for part in action.choices.values()
        ]
        yield command


@pytest.fixture
def in_japanese(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    monkeypatch.setenv("COLUMNS", "80")
    with speaking(Speech("ja")), worded_argparse():
        yield


@pytest.mark.parametrize(("place", "text"), TEXTS, ids=[place for place, _ in TEXTS])
def test_every_text_of_the_help_has_both_languages_and_the_same_values(place: str, text: dict[str, str]) -> None:
    assert text.keys() == {"en", "ja"}
    assert not JAPANESE.search(text["en"])
    assert JAPANESE.search(text["ja"]) or text["ja"].startswith("%(")
    assert sorted(FIELD.findall(text["en"])) == sorted(FIELD.findall(text["ja"]))


def test_everything_that_argparse_says_to_users_is_in_the_table() -> None:
    said = {
        argument.value
        for node in ast.walk(ast.parse(inspect.getsource(argparse)))
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id in ("_", "ngettext")
        for argument in node.args
        if isinstance(argument, ast.Constant) and isinstance(argument.value, str)
    }
    assert len(said) > 20
    with speaking(Speech("ja")):
        words = argparse_words()
    assert said - words.keys() - FOR_PROGRAMMERS == set()
    for english, japanese in words.items():
        assert sorted(re.findall(r"%(?:\(\w+\))?[sr]", english)) == sorted(re.findall(r"%(?:\(\w+\))?[sr]", japanese))


@pytest.mark.usefixtures("in_japanese")
def test_no_help_has_an_english_sentence_left_or_lines_too_wide() -> None:
    english = {" ".join(text["en"].split()[:4]) for _, text in TEXTS if len(text["en"].split()) >= 3}
    found = list(commands())
    assert len(found) >= 18
    for command in found:
        help = command.format_help()
        usage, _, rest = help.partition("\n\n")
        assert usage.startswith("使い方: suisou")
        assert all(width(line) <= 80 or "suisou" in line or "|" in line for line in help.splitlines()), command.prog
        collapsed = " ".join(re.sub(r"'[^']*'|`[^`]*`", "", rest.partition("例:")[0]).split())
        assert not [words for words in english if words in collapsed], command.prog
        # Names of parameters and values of options follow.
        prose = re.sub(r"パラメーター: [\w, ]+|\{[^}]*\}|\[[^\]]*\]", "", collapsed)
        assert not re.findall(r"\b[a-z]{2,} [a-z]{2,} [a-z]{2,}\b", prose), command.prog


@pytest.mark.usefixtures("in_japanese")
def test_helps_of_options_stand_in_one_column() -> None:
    for command in commands():
        lines = command.format_help().partition("\n\n")[2].partition("例:")[0].splitlines()
        places = {len(found[0]) for line in lines if (found := re.match(r"  -.*?\w  +(?=\S)| {10,}(?=\S)", line))}
        assert len(places) == 1, (command.prog, places)


def test_columns_line_up_by_what_characters_take() -> None:
    rows = columns([("奏者", "音符"), ("Horn", "12"), ("ホルン 1", "5")])
    assert rows == ["奏者      音符", "Horn        12", "ホルン 1     5"]
    assert len({width(row) for row in rows}) == 1


def test_lines_break_between_japanese_characters_and_before_no_punctuation() -> None:
    assert wrapped("奏者を描きます。例は", 14) == ["奏者を描きま", "す。例は"]
    assert wrapped("one two 三四 five", 8) == ["one two", "三四", "five"]
    assert wrapped("音（楽器）と", 4) == ["音", "（楽", "器）", "と"]
    assert wrapped("（既定: 音", 6) == ["（既", "定: 音"]
    assert wrapped("", 10) == []


@pytest.mark.parametrize(
    ("environment", "language"),
    [
        ({"LANG": "ja_JP.UTF-8"}, "ja"),
        ({"LC_ALL": "C", "LANG": "ja_JP.UTF-8"}, "en"),
        ({"LC_MESSAGES": "ja_JP", "LANG": "en_GB.UTF-8"}, "ja"),
        ({"LANG": "de_DE.UTF-8", "LANGUAGE": "de:ja"}, "ja"),
        ({"LANG": "C.UTF-8", "LANGUAGE": "ja"}, "en"),
        ({"LANG": "ja_JP.UTF-8", "LANGUAGE": "en"}, "en"),
        ({"LANG": "de_DE.UTF-8"}, "en"),
        ({"LANG": "jam_JM"}, "en"),
    ],
)
def test_the_language_of_the_system(environment: dict[str, str], language: str) -> None:
    assert system_language(environment) == language


def test_english_where_standard_output_has_no_japanese(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "stdout", io.TextIOWrapper(io.BytesIO(), encoding="latin-1"))
    assert system_language({"LANG": "ja_JP.UTF-8"}) == "en"


def test_the_option_is_found_before_anything_is_read() -> None:
    assert requested_speech(["inspect", "x.mid", "--language", "ja"]).language == "ja"
    assert requested_speech(["--language=ja", "inspect"]).language == "ja"
    assert requested_speech(["inspect", "--", "--language=ja"]).language == "en"
    assert requested_speech(["inspect", "--language"]).language == "en"
    assert requested_speech(["inspect", "--pitch-names=german", "--middle-c", "C3"]).pitch(70) == "B3"


@pytest.mark.parametrize(
    ("arguments", "complaint"),
    [
        (["export", "x.mid", "--to"], "引数 --to: 値が 1 つ必要です"),
        (["inspect", "x.mid", "--fps", "x"], "'x' は 24、29.97、30000/1001 のようなフレームレート"),
        (["dance"], "'dance' は使えません"),
        (["inspect"], "次の引数が必要です: FILE"),
        (["inspect", "no_such.mid"], "no_such.mid"),
    ],
)
def test_errors_are_in_japanese(arguments: list[str], complaint: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["--language", "ja", *arguments]) in (BAD_USE, 1)
    error = capsys.readouterr().err
    assert complaint in error
    assert JAPANESE.search(error)
    assert "error:" not in error


def test_a_locale_of_japan_makes_a_report_japanese(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    for variable in ("LANGUAGE", "LC_ALL"):
        monkeypatch.delenv(variable, raising=False)
    monkeypatch.setenv("LANG", "ja_JP.UTF-8")
    assert main(["inspect", str(QUARTET), "--no-contacts"]) == DONE
    report = capsys.readouterr().out
    assert "奏者" in report
    assert "確認してください:" in report
    assert not re.findall(r"\b[a-z]{2,} [a-z]{2,} [a-z]{2,}\b", report)


def test_json_is_the_same_in_every_language(capsys: pytest.CaptureFixture[str]) -> None:
    printed = []
    for language in ("en", "ja"):
        assert main(["inspect", str(QUARTET), "--no-contacts", "--json", "--language", language]) == DONE
        printed.append(json.loads(capsys.readouterr().out))
    assert printed[0] == printed[1]


def test_pitches_by_the_german_system(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["inspect", str(QUARTET), "--no-contacts", "--pitch-names", "german"]) == DONE
    report = capsys.readouterr().out
    assert "F2-B3" in report
    assert "Es3-G4" in report
    assert "Cis3 (15.2.000)" in report
    assert main(["instruments", "scale", "trumpet_Bb", "--pitch-names", "syllables", "--language", "ja"]) == DONE
    assert "シ♭3" in capsys.readouterr().out


def test_pitches_as_the_parts_have_them(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["inspect", str(QUARTET), "--no-contacts", "--pitches", "written"]) == DONE
    report = capsys.readouterr().out
    assert "F♯4-B♭5" in report, "a trumpet in B flat sounds E4 to A♭5"
    assert "E♭3-G4" in report, "a trombone is written as it sounds"


@pytest.mark.parametrize(("speech", "named"), [(Speech(), "F♯4"), (Speech(written=True), "A♭4")], ids=str)
def test_problems_name_pitches_as_the_part_has_them(speech: Speech, named: str) -> None:
    (line,) = problem_lines([early(6)], SCORE, speech, instrument=find_map("trumpet_Bb"))
    assert f"before note {named} (2.3.000)" in line


def test_a_file_of_an_export_keeps_its_words(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    said = ["export", str(QUARTET), "--to", str(tmp_path / "out"), "--player", "Trombone 2", "--format", "bvh"]
    assert main([*said, "--from-bar", "15", "--to-bar", "15", "--language", "ja"]) == DONE
    assert "確認してください:" in capsys.readouterr().out
    report = json.loads((tmp_path / "out" / "report.json").read_text(encoding="utf-8"))
    assert report["warnings"]
    assert not any(JAPANESE.search(line) for line in report["warnings"])


def test_reasons_for_alternate_fingerings_are_said_in_japanese(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["instruments", "scale", "trumpet_Bb", "--language", "ja"]) == DONE
    shown = capsys.readouterr().out
    assert "トリル" in shown
    assert not re.search(r"\b(trill|rare|alternate)\b", shown)


def test_every_bundled_table_is_described_in_japanese(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["metadata", "--language", "ja"]) == DONE
    listed = [line for line in capsys.readouterr().out.splitlines() if line.startswith(("expressions ", "rules "))]
    assert len(listed) >= 16
    assert [line for line in listed if not JAPANESE.search(line)] == []


def test_instruments_in_messages_have_their_japanese_names() -> None:
    refused = Message("score.not_wind", {"instrument": "Double Bass"})
    assert "コントラバス" in Speech("ja")(refused)
    assert "Double Bass" not in Speech("ja")(refused)
    assert "Double Bass" in Speech("en")(refused)
