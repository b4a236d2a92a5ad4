"""An unsavable value is reported in the window with the names of its panel: player, bar and field."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import get_args

import msgspec
import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QLabel, QPushButton

from app.errors import Message
from app.plan.by_hand.additive_curve import AdditiveCurve, CurveKey, Tangent
from app.plan.by_hand.corrections import Correction, PoseCorrection, SetBreath
from app.project.check import faults
from app.project.model import Project
from app.shell.app import Program
from tests.gui.conftest import quartet_project
from tests.support import mouse
from tests.support.windows import child
from widgets.common.field_names import FIELDS
from widgets.common.text import message_text

BAR_3 = quartet_project().score.metre_map.span_of_bar(3)[0]
CURVE = AdditiveCurve("a1", "bell.up", (CurveKey(0, 1.0), CurveKey(BAR_3, 5e9)))
SAID = {
    "en": "Value: must be from -180 to 180 (player 'Trumpet 1', bar 3, body curve 'Bell: Up')",
    "ja": "値: -180～180 の範囲にしてください（奏者 'Trumpet 1'、第 3 小節、体のカーブ 'ベル: 上'）",
}


def corrected(project: Project, *items: Correction) -> Project:
    return replace(project, corrections={project.players[0].id: items})


def banner_text(program: Program) -> str:
    label = child(program.window.banner, QLabel, "banner_text")
    assert label.isVisible()
    return label.text().replace("\u200b", "")


@pytest.mark.parametrize("language", ["en", "ja"])
def test_the_banner_names_it_and_removes_it(program: Program, monkeypatch: pytest.MonkeyPatch, language: str) -> None:
    program.editor.language.set(language)
    with monkeypatch.context() as unchecked:
        # No edit makes such a value; a fault of ours would.
        unchecked.setattr("app.project.undoable_document.require_sound", lambda *projects: None)
        assert program.session.attempt(Message("edit.set_audio"), lambda project: corrected(project, CURVE))
    program.editor.files.write_soon()
    assert SAID[language] in banner_text(program)
    mouse.press(child(program.window.banner, QPushButton, "banner_answer_1"))
    assert program.session.project.corrections == {}
    QTest.keyClick(program.window.palette_field, Qt.Key.Key_Z, Qt.KeyboardModifier.ControlModifier)
    assert program.session.project.corrections != {}


BAD = {
    "pose": (PoseCorrection("p1", "head", BAR_3, BAR_3 + 960, up_deg=float("nan")), "Up: ", "bar 3, pose 'Head')"),
    "breath": (SetBreath("2:1", -(10**12)), "Start: ", "bar 1, breath)"),
    "handle": (
        AdditiveCurve("a1", "head.left", (CurveKey(BAR_3, 1.0, arrive=Tangent(10, 1e9)),)),
        "Value: ",
        "bar 3, body curve 'Head: Left')",
    ),
    "title": (AdditiveCurve("a1", "head.left", CURVE.keys, title="Nod"), "Value: ", "bar 3, body curve 'Nod')"),
}


@pytest.mark.parametrize("name", BAD)
def test_every_kind_is_named_by_what_the_user_sees(program: Program, name: str) -> None:
    item, field, place = BAD[name]
    project = corrected(program.session.project, item)
    found, detail = next(faults(project))
    said = message_text(Message("project.not_storable", {"place": found, "detail": detail}), program.session)
    assert f": {field}" in said
    assert said.endswith(place)
    assert not re.search(r"[a-z]_[a-z]|\[\d|a1|p1", said), said


def test_every_field_that_a_person_can_set_has_a_name() -> None:
    structs = (*get_args(Correction), CurveKey, Tangent)
    numbers = {
        field.name
        for struct in structs
        for field in msgspec.structs.fields(struct)
        if {int, float} & {field.type, *get_args(field.type)}
    }
    assert numbers - FIELDS.keys() == set()
    assert {item.tag for item, *_ in BAD.values()} == {"additive", "pose", "set_breath"}
