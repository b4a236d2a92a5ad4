"""The guides inside the program: the window, F1 and the help buttons of dialogs, by mouse and keys."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path

import pytest
from PySide6.QtCore import QPoint, Qt, QTimer, QUrl
from PySide6.QtGui import QCursor, QDesktopServices, QTextDocument
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QDialog, QDockWidget, QMessageBox, QPushButton, QTabWidget, QWidget
from pytestqt.qtbot import QtBot

from app.shell.app import Program
from app.shell.first_steps.tour import FirstSteps
from app.shell.help import guides
from app.shell.help.guides import FOLDER, anchor_of, guide, names, search, sections
from app.shell.help.places import ACTIONS, PLACES, place_of
from app.shell.help.window import HelpWindow
from app.shell.menus import BAR
from tests.gui.conftest import QUARTET
from tests.gui.shell.conftest import trigger
from tests.gui.shell.test_dialogs_are_deleted import OPENED
from tests.support import mouse
from tests.support.studio import Studio
from tests.support.windows import child, show_in_front, wait_until
from widgets.common.actions import actions
from widgets.common.section import Section
from widgets.dialogs.piece_settings import PieceSettingsDialog
from widgets.timeline.lanes import LANES

F1 = Qt.Key.Key_F1


def help_window(program: Program) -> HelpWindow:
    """Window of the guides, open and in front."""
    trigger(program, "help.guides")
    window = child(program.window, HelpWindow)
    assert wait_until(lambda: QApplication.activeWindow() is window)
    return window


def shown(program: Program) -> str:
    """Displayed place in the form used by the table."""
    window = program.window.findChild(HelpWindow)
    if window is None or not window.isVisible() or window.place is None:
        return ""
    name, number = window.place
    anchor = guide(name, "en").sections[number].anchor
    return f"{name}#{anchor}" if number else name


# The guides


def test_every_place_is_a_heading_of_a_guide() -> None:
    for place in (*PLACES.values(), *ACTIONS.values()):
        name, _, anchor = place.partition("#")
        assert name in names(), place
        assert guide(name, "en").number(anchor) is not None, place
        section = guide(name, "en").sections[guide(name, "en").number(anchor) or 0]
        below = [other.text for other in guide(name, "en").sections if other.block >= section.block]
        assert len("".join(below[:2])) > 60, f"{place} says nothing"


def test_links_between_guides_lead_to_headings() -> None:
    for path in FOLDER.glob("*.md"):
        text = path.read_text(encoding="utf-8")
        for link in re.findall(r"\]\(([^)]+)\)", text):
            name, _, anchor = link.partition("#")
            if "://" in link or (name and not name.endswith(".md")) or "/" in name:
                continue
            language = "ja" if path.stem.endswith("_ja") else "en"
            target = guide((Path(name).stem if name else path.stem).removesuffix("_ja"), language)
            assert target.number(anchor) is not None, f"{path.name}: {link}"


def test_a_translation_has_the_headings_of_its_guide() -> None:
    for path in FOLDER.glob("*_ja.md"):
        translated, english = guide(path.stem.removesuffix("_ja"), "ja"), guide(path.stem.removesuffix("_ja"), "en")
        assert translated.is_translated
        assert [one.level for one in translated.sections] == [one.level for one in english.sections], path.name


@pytest.mark.parametrize(
    ("heading", "anchor"),
    [
        ("3. What is read, and what is played", "3-what-is-read-and-what-is-played"),
        ("A style: `styles/crooner.toml`", "a-style-stylescroonertoml"),
        ("What `suisou inspect --json` prints", "what-suisou-inspect---json-prints"),
        ("ブレス レーン", "ブレス-レーン"),
    ],
)
def test_anchors_are_those_of_code_hosts(heading: str, anchor: str) -> None:
    assert anchor_of(heading) == anchor


def test_a_repeated_heading_has_an_anchor_of_its_own(qapp: QApplication) -> None:
    found = sections("# A\n\none\n\n## Again\n\ntwo\n\n```\n# no heading\n```\n\n## Again\n\nthree")
    assert [one.anchor for one in found] == ["a", "again", "again-1"]
    assert [one.text for one in found] == ["one", "two # no heading", "three"]


def test_a_search_finds_the_section_that_is_about_the_words_first(qapp: QApplication) -> None:
    first = search("breaths rests", "en")[0]
    assert (first.guide, first.heading) == ("acting", "Breaths in rests")
    every = search("circular breathing", "en")
    assert {hit.guide for hit in every} >= {"editor", "glossary"}
    assert search("xyzzy", "en") == search("", "en") == ()


def test_the_guides_and_their_pictures_are_packaged() -> None:
    root = Path(__file__).parents[3]
    setuptools = tomllib.loads((root / "pyproject.toml").read_text(encoding="utf-8"))["tool"]["setuptools"]
    assert "docs" in setuptools["packages"]["find"]["include"]
    packed = {path for pattern in setuptools["package-data"]["docs"] for path in (root / "docs").glob(pattern)}
    needed = set((root / "docs").glob("*.md"))
    for path in tuple(needed):
        pictures = re.findall(r"!\[[^\]]*\]\(([^)]+)\)", path.read_text(encoding="utf-8"))
        needed |= {root / "docs" / picture for picture in pictures}
    assert len(needed) > 25
    assert needed <= packed
    assert (root / "docs").samefile(FOLDER)


# Places


def test_every_panel_lane_section_tab_and_menu_has_a_place(program: Program) -> None:
    window = program.window
    FirstSteps(program.editor)
    lanes = [lane.id for lane in LANES]
    assert {f"lane_{id}" for id in (*lanes, "roll")} <= PLACES.keys()
    assert {f"menu_{name}" for name in BAR} <= PLACES.keys()
    assert {dock.objectName() for dock in window.findChildren(QDockWidget)} <= PLACES.keys()
    assert set(window.panels) <= PLACES.keys()
    for section in window.findChildren(Section):
        assert section.objectName() in PLACES.keys() | {"players_dancers"}, section.objectName()
    tabs = child(window, QTabWidget, "inspector_tabs")
    assert {tabs.widget(place).objectName() for place in range(tabs.count())} <= PLACES.keys()
    for menu in window.menus.menus.values():
        assert place_of(menu) != PLACES["window"], menu.objectName()
    # A name of the table that no widget has any more would never be found.
    known = {widget.objectName() for widget in window.findChildren(QWidget)} | {"window"}
    of_dialogs = {name for name in PLACES if name in DIALOGS} | {"shortcuts_page", "export_skeleton"}
    assert set(PLACES) - known <= of_dialogs | {"lane_dance"}


DIALOGS = {
    *("about", "licences", "preferences", "instruments", "piece_settings", "import_midi", "reimport_midi"),
    *("export_files", "playblast", "stream", "midi_devices", "latency", "follow_recording", "characters", "character"),
    *("person", "rules", "metadata_differences"),
    *("choreography", "learn_choreography", "evaluation", "evaluation_results"),
}


def test_f1_shows_the_place_of_what_is_under_the_mouse(program: Program) -> None:
    window = program.window
    for name, place in {
        "lane_fingering": "editor#fingering",
        "lane_breath": "editor#breath",
        "parameter_amplitude": "editor#motion",
        "play_toggle": "editor#transport",
        "ruler": "editor#ruler",
        "viewport_pose": "editor#pose-tool",
    }.items():
        show_in_front(window)
        part = child(window, QWidget, name)
        mouse.bring_into_view(part)
        QApplication.processEvents()
        there = part.mapToGlobal(part.visibleRegion().boundingRect().center())
        QCursor.setPos(there)
        assert wait_until(lambda there=there: QCursor.pos() == there)
        QTest.keyClick(window, F1)
        assert shown(program) == place
        child(window, HelpWindow).close()


def test_f1_elsewhere_is_about_what_has_the_keyboard(program: Program) -> None:
    mouse.park_pointer()
    program.window.players.list.setFocus()
    QTest.keyClick(program.window, F1)
    assert shown(program) == "editor#players"


def test_f1_in_an_open_menu_is_about_the_command(program: Program) -> None:
    menu = program.window.menus.menu("file")
    menu.popup(program.window.mapToGlobal(QPoint(20, 40)))
    assert wait_until(menu.isVisible)
    menu.setActiveAction(actions(program.session)["file.piece_settings"])
    QTest.keyClick(menu, F1)
    assert shown(program) == "piece-settings"
    assert QApplication.activePopupWidget() is None


# The window


def test_links_lead_to_guides_and_by_the_browser_to_the_web(program: Program, monkeypatch: pytest.MonkeyPatch) -> None:
    opened: list[str] = []
    monkeypatch.setattr(QDesktopServices, "openUrl", lambda url: opened.append(url.toString()))
    window = help_window(program)
    follow = window.page.followed.emit
    follow(QUrl("acting.md#breaths-in-rests"))
    assert shown(program) == "acting#breaths-in-rests"
    follow(QUrl("#a-conductor"))
    assert shown(program) == "acting#a-conductor"
    QTest.mouseClick(window.back, Qt.MouseButton.LeftButton)
    assert shown(program) == "acting#breaths-in-rests"
    QTest.keyClick(window, Qt.Key.Key_Right, Qt.KeyboardModifier.AltModifier)
    assert shown(program) == "acting#a-conductor"
    assert not window.forward.isEnabled()
    follow(QUrl("https://protocol.vmc.info/"))
    assert opened == ["https://protocol.vmc.info/"]
    notice = child(window, QWidget, "help_notice")
    for bad in ("file:///etc/passwd", "javascript:alert(1)", "../CONTRIBUTING.md", "../../etc/passwd", "tin-whistle"):
        notice.hide()
        follow(QUrl(bad))
        assert notice.isVisible(), bad
    assert len(opened) == 1
    assert shown(program) == "acting#a-conductor"


def test_a_guide_reads_no_file_but_pictures_beside_it(
    program: Program, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "a.md").write_text(
        "# A\n\n<img src='b.png'>\n\n![x](../b.png) ![y](file:///b.png) ![z](c.png)\n\n<b>bold</b>", encoding="utf-8"
    )
    monkeypatch.setattr(guides, "FOLDER", tmp_path)
    monkeypatch.setattr("app.shell.help.page.FOLDER", tmp_path)
    (tmp_path.parent / "b.png").write_bytes((FOLDER / "timeline.png").read_bytes())
    (tmp_path / "c.png").write_bytes((FOLDER / "timeline.png").read_bytes())
    guide.cache_clear()
    try:
        page = help_window(program).page
        page.show_guide(guide("a", "en"))
        assert set(page._pictures) == {"c.png"}
        assert "<b>bold</b>" in page.toPlainText()
        kind = QTextDocument.ResourceType.ImageResource.value
        assert page.document().resource(kind, QUrl("../b.png")) is None
        assert page.document().resource(kind, QUrl("c.png")) is not None
    finally:
        guide.cache_clear()


def test_a_search_lists_places_and_marks_the_words(program: Program, qtbot: QtBot) -> None:
    window = help_window(program)
    QTest.keyClick(window, Qt.Key.Key_F, Qt.KeyboardModifier.ControlModifier)
    assert window.search_field.hasFocus()
    qtbot.keyClicks(window.search_field, "circular breathing")
    assert window.hits.isVisible()
    assert window.hits.count() >= 2
    qtbot.keyClick(window.search_field, Qt.Key.Key_Return)
    first = search("circular breathing", "en")[0]
    assert window.place == (first.guide, first.number)
    assert window.page.extraSelections()
    qtbot.keyClicks(window.search_field, "zzz")
    assert window.hits.item(0).text() == "No matches in the guides."
    QTest.keyClick(window, Qt.Key.Key_Escape)
    assert window.contents.isVisible()
    QTest.keyClick(window, Qt.Key.Key_Escape)
    assert not window.isVisible()


def test_a_japanese_guide_is_shown_where_there_is_one_and_else_said_to_be_missing(
    program: Program, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name, text in (("a", "# A\n\n## B\n\nc"), ("a_ja", "# あ\n\n## い\n\nう"), ("d", "# D\n\ne")):
        (tmp_path / f"{name}.md").write_text(text, encoding="utf-8")
    monkeypatch.setattr(guides, "FOLDER", tmp_path)
    guide.cache_clear()
    try:
        program.editor.speak("ja")
        window = HelpWindow(program.session, program.editor.language, program.window)
        window.read("a", "b")
        notice = child(window, QWidget, "help_notice")
        assert "う" in window.page.toPlainText()
        assert window.place == ("a", 1)
        assert not notice.isVisible()
        window.read("d")
        assert "日本語版はまだありません" in notice.text()  # type: ignore[attr-defined]
        window.read("a", "b")
        program.editor.speak("en")
        QApplication.processEvents()
        assert "c" in window.page.toPlainText()
        assert not notice.isVisible()
        assert names() == ("a", "d")
    finally:
        guide.cache_clear()


def test_larger_letters_keep_the_place(program: Program) -> None:
    window = help_window(program)
    window.read("acting", "long-rests")
    QApplication.processEvents()
    place, size = window.page.section_in_sight(), window.page.font().pointSizeF()
    QTest.mouseClick(child(window, QWidget, "help_larger"), Qt.MouseButton.LeftButton)
    assert window.page.font().pointSizeF() > size
    assert window.page.section_in_sight() == place
    QTest.keyClick(window, Qt.Key.Key_0, Qt.KeyboardModifier.ControlModifier)
    assert window.page.font().pointSizeF() == size


# Dialogs


@pytest.mark.drawn
def test_every_dialog_has_a_button_that_opens_its_guide(studio: Studio) -> None:
    """The dialog stays open, and the guides accept clicks meanwhile."""
    program = studio.program
    program.editor.files.open(QUARTET, ask=False)
    window = HelpWindow(program.session, program.editor.language, program.window)
    seen, wrong = set[str](), list[str]()

    def press() -> None:
        for dialog in QApplication.topLevelWidgets():
            if not isinstance(dialog, QDialog) or isinstance(dialog, QMessageBox | HelpWindow):
                continue
            if not dialog.isVisible():
                continue
            seen.add(dialog.objectName())
            button = dialog.findChild(QPushButton, "help_button")
            if button is None:
                wrong.append(f"{dialog.objectName()}: no button")
            else:
                QTest.mouseClick(button, Qt.MouseButton.LeftButton)
                if shown(program) != PLACES.get(dialog.objectName()):
                    wrong.append(f"{dialog.objectName()}: {shown(program)}")
                if not dialog.isVisible():
                    wrong.append(f"{dialog.objectName()}: closed")
                handle = window.windowHandle()
                if dialog.isModal() and handle.transientParent() is not dialog.windowHandle():
                    wrong.append(f"{dialog.objectName()}: blocks the guides")
            dialog.reject()
        window.close()

    for name, show in OPENED.items():
        if name.startswith("MessageBox") or name == "HelpWindow":
            continue
        QTimer.singleShot(0, press)
        show(program)
        QApplication.processEvents()
        press()
    assert wrong == []
    assert seen == DIALOGS


@pytest.mark.parametrize("modality", [Qt.WindowModality.WindowModal, Qt.WindowModality.ApplicationModal])
def test_the_guides_take_clicks_while_a_dialog_waits_for_an_answer(
    program: Program, modality: Qt.WindowModality
) -> None:
    window = help_window(program)
    dialog = PieceSettingsDialog(program.session, program.window)
    dialog.setWindowModality(modality)
    show_in_front(dialog)
    # The display may be late with the window of the guides, which then is in front once more.
    assert wait_until(lambda: (QTest.keyClick(dialog, F1), shown(program))[1] == "piece-settings")
    first = window.contents.visualItemRect(window.contents.topLevelItem(0)).center()
    # Through the window, as the display sends it: what is sent to a widget itself is never blocked.
    place = window.contents.viewport().mapTo(window, first)
    QTest.mouseClick(window.windowHandle(), Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier, place)
    assert wait_until(lambda: shown(program) == "editor")
    dialog.close()
    show_in_front(program.window)
    assert wait_until(lambda: window.windowHandle().transientParent() is program.window.windowHandle())
