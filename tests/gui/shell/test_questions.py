"""Which file is written: nothing is replaced that no one was asked about."""

from __future__ import annotations

from pathlib import Path

import pytest
from PySide6.QtCore import Qt, QTimer, QUrl
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QFileDialog, QMessageBox

from app.shell.questions import DialogQuestions

SUFFIXES = (".mid", ".midi")


class Typed:
    """Names that someone types one after the other, and what they answer when asked about a file."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch, folder: Path, *names: str) -> None:
        self.left = [str(folder / name) if name else "" for name in names]
        self.proposals: list[str] = []
        self.asked: list[str] = []
        monkeypatch.setattr(QFileDialog, "getSaveFileUrl", self._type)

    def _type(self, parent: object, title: str, proposal: QUrl, filters: str, **more: object) -> tuple[QUrl, str]:
        self.proposals.append(proposal.toLocalFile())
        typed = self.left.pop(0)
        return QUrl.fromLocalFile(typed) if typed else QUrl(), filters

    def answer(self, button: str) -> None:
        def click() -> None:
            box = QApplication.activeModalWidget()
            assert isinstance(box, QMessageBox)
            self.asked.append(box.text())
            requested = next(one for one in box.buttons() if one.text() == button)
            QTest.mouseClick(requested, Qt.MouseButton.LeftButton)

        QTimer.singleShot(50, click)


def save(folder: Path) -> Path | None:
    return DialogQuestions().save_file("Export MIDI", str(folder / "x.mid"), "MIDI (*.mid)", SUFFIXES)


@pytest.mark.parametrize("typed", ["piece", "piece.v2", "piece.MID", "piece.midi"])
def test_a_name_gets_its_suffix(
    qt_app: QApplication, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, typed: str
) -> None:
    Typed(monkeypatch, tmp_path, typed)
    kept = typed.lower().endswith(SUFFIXES)
    assert save(tmp_path) == tmp_path / (typed if kept else f"{typed}.mid")


def test_a_file_of_the_completed_name_is_asked_about(
    qt_app: QApplication, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "piece.mid").write_bytes(b"mine")
    typed = Typed(monkeypatch, tmp_path, "piece")
    typed.answer("Replace")
    assert save(tmp_path) == tmp_path / "piece.mid"
    assert typed.asked == ["Replace piece.mid?"]


def test_who_does_not_replace_it_types_another_name(
    qt_app: QApplication, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "piece.mid").write_bytes(b"mine")
    typed = Typed(monkeypatch, tmp_path, "piece", "other")
    typed.answer("Cancel")
    assert save(tmp_path) == tmp_path / "other.mid"
    assert typed.proposals == [str(tmp_path / "x.mid"), str(tmp_path / "piece.mid")]
    typed = Typed(monkeypatch, tmp_path, "piece", "")
    typed.answer("Cancel")
    assert save(tmp_path) is None


def test_what_the_systems_dialog_asked_about_is_not_asked_again(
    qt_app: QApplication, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "piece.mid").write_bytes(b"mine")
    Typed(monkeypatch, tmp_path, "piece.mid")
    assert save(tmp_path) == tmp_path / "piece.mid"
