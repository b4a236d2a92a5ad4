"""Every declared setting is restored, stored, and shown in the preferences if it has a label."""

from __future__ import annotations

from typing import Any

from PySide6.QtWidgets import QApplication, QComboBox, QRadioButton

from app.editor.listening import SOURCES
from app.editor.session import Session
from app.editor.settings import SETTINGS, Settings
from app.editor.stored_settings import Setting
from app.editor.translated import tr
from app.editor.video_state import PLACEMENTS
from app.editor.viewport_state import FOLLOWS
from app.shell.app import Program
from app.shell.language import TEXTS
from app.shell.preferences import show_preferences
from tests.gui.conftest import quartet_project
from tests.support.tasks import ImmediateTasks


def other(setting: Setting[Any]) -> object:
    """Another value than the default."""
    if setting.options:
        return setting.options[-1][0]
    if isinstance(setting.default, bool):
        return not setting.default
    others = {
        "camera_follows": FOLLOWS[-1],
        "volume": 0.25,
        "source": SOURCES[-1],
        "video_placement": PLACEMENTS[-1],
        "video_opacity": 0.25,
    }
    return {"folded": {"a part": True}, **others}[setting.name]


def test_what_the_session_holds_is_remembered_and_restored(program: Program, settings: Settings) -> None:
    held = [(setting, setting.held) for setting in SETTINGS if setting.held is not None]
    assert len(held) >= 10
    for setting, place in held:
        value = other(setting)
        assert getattr(settings, setting.name) != value
        place.set(program.session, value)
        assert getattr(settings, setting.name) == value
    settings.sync()
    session = Session(quartet_project(), ImmediateTasks())
    again = Settings(settings.path)
    again.hold(session)
    for setting, place in held:
        assert place.get(session) == other(setting) != setting.default, setting.name
    session.deleteLater()


def test_every_setting_with_a_label_is_chosen_in_the_preferences(program: Program, settings: Settings) -> None:
    program.editor.speak("en")
    dialog = show_preferences(program.editor, "general")
    for setting in [one for one in SETTINGS if one.label]:
        options, value = list(setting.options), other(setting)
        if setting.name == "language":
            languages = dialog.findChild(QComboBox, "preferences_language")
            assert [languages.itemText(index) for index in range(languages.count())] == [
                tr(word) for _, word in options
            ]
            languages.activated.emit(len(options) - 1)
        else:
            radios = [dialog.findChild(QRadioButton, f"preferences_{setting.name}_{option}") for option, _ in options]
            chosen = [option for (option, _), radio in zip(options, radios, strict=True) if radio.isChecked()]
            assert chosen == [getattr(settings, setting.name)]
            radios[-1].click()
            assert radios[-1].isChecked()
        assert getattr(settings, setting.name) == value
    QApplication.processEvents()
    # All that can be translated is in the other language now.
    ids = {word for one in SETTINGS if one.label for word in (one.label, *(text for _, text in one.options))}
    english = {TEXTS[id][0] for id in ids & TEXTS.keys() if len(set(TEXTS[id])) == 2}
    assert not english & {radio.text() for radio in dialog.findChildren(QRadioButton)}
    dialog.close()


def test_a_value_that_is_no_option_is_a_problem(program: Program, settings: Settings) -> None:
    settings.sync()
    path = settings.path
    path.write_text("[interface]\ntheme = 'blue'\ntime_display = 'ticks'\n[sound]\nsource = 'radio'\n")
    read = Settings(path)
    assert (read.theme, read.time_display, read.source) == ("dark", "bars", "recording")
    places = {problem.arguments["place"] for problem in read.problems}
    assert places == {"interface.theme", "interface.time_display", "sound.source"}
