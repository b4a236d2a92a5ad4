"""Players by section: folded, selected, muted and moved together by mouse and keys, compared with the project."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest
from msgspec.structs import replace as replace_player
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QLineEdit

from app.editor.session import Session
from app.editor.settings import Settings
from app.project.edit.players import duplicate_players
from app.shell.commands import players as commands
from tests.gui.conftest import quartet_project
from tests.gui.japanese import speaking
from tests.gui.players.conftest import ShowPlayers
from tests.support.tasks import ImmediateTasks
from tests.support.windows import child
from widgets.common.chip import Chip
from widgets.common.number_slider import NumberSlider
from widgets.players.panel import PlayersPanel
from widgets.players.player_rows import SectionRow

TRUMPETS, HORNS, TROMBONES = "players_section_trumpets", "players_section_horns", "players_section_trombones"
CTRL, SHIFT, ALT = (
    Qt.KeyboardModifier.ControlModifier,
    Qt.KeyboardModifier.ShiftModifier,
    Qt.KeyboardModifier.AltModifier,
)
Listed = Callable[[], list[str]]


@pytest.fixture
def session(session: Session) -> Session:
    """The quartet twice: four trumpets, two horns, two trombones, with sections interleaved."""
    project, _ = duplicate_players(session.project, [player.id for player in session.project.players])
    order = [project.players[number] for number in (0, 2, 4, 6, 1, 3, 5, 7)]
    horns = {number: replace_player(order[number], instrument_id="horn_double_F_Bb") for number in (2, 6)}
    players = tuple(horns.get(number, player) for number, player in enumerate(order))
    session.document.open(replace(project, players=players))
    session.set_players((session.project.players[0].id,))
    return session


@pytest.fixture
def panel(session: Session, show_players: ShowPlayers) -> PlayersPanel:
    return show_players(session)


def listed(panel: PlayersPanel) -> list[str]:
    """Ids of the visible rows from top to bottom."""
    model = panel.list.rows
    return [row.id for number, row in enumerate(model.rows) if panel.list.visualRect(model.index(number)).isValid()]


def section_ids(session: Session, family: str) -> tuple[str, ...]:
    return tuple(player.id for player in session.project.players if player.instrument_id.startswith(family))


def at(panel: PlayersPanel, id: str, x: int = 60) -> QPoint:
    number = panel.list.rows.number(id)
    assert number is not None
    box = panel.list.visualRect(panel.list.rows.index(number))
    return QPoint(x if x >= 0 else box.right() + x, box.center().y())


def click(
    panel: PlayersPanel, id: str, x: int = 60, modifier: Qt.KeyboardModifier = Qt.KeyboardModifier.NoModifier
) -> None:
    QTest.mouseClick(panel.list.viewport(), Qt.MouseButton.LeftButton, modifier, at(panel, id, x))


def press(panel: PlayersPanel, key: Qt.Key, modifier: Qt.KeyboardModifier = Qt.KeyboardModifier.NoModifier) -> None:
    QTest.keyClick(panel.list, key, modifier)


def header(panel: PlayersPanel, id: str) -> SectionRow:
    return next(row for row in panel.list.rows.rows if isinstance(row, SectionRow) and row.id == id)


def test_players_stand_under_the_sections_of_their_instruments(panel: PlayersPanel, session: Session) -> None:
    trumpets, horns, trombones = (section_ids(session, name) for name in ("trumpet", "horn", "trombone"))
    assert (len(trumpets), len(horns), len(trombones)) == (4, 2, 2)
    assert listed(panel) == [TRUMPETS, *trumpets, HORNS, *horns, TROMBONES, *trombones]
    assert header(panel, HORNS).name == "Horns"
    with speaking("ja"):
        panel.retranslate()
        assert header(panel, HORNS).name == "ホルン"


def test_a_small_piece_has_no_sections_and_the_command_ends_them(show_players: ShowPlayers, session: Session) -> None:
    panel = show_players(session)
    rows = {row.id: row for row in commands.ACTIONS}
    rows["players.grouped"].run(session, False)
    assert listed(panel) == [player.id for player in session.project.players]
    rows["players.grouped"].run(session, True)
    assert listed(panel)[0] == TRUMPETS
    session.document.open(quartet_project())
    assert listed(panel) == [player.id for player in session.project.players]
    enabled = rows["players.grouped"].enabled
    assert enabled is not None
    assert not enabled(session)


def test_a_section_folds_by_arrow_double_click_and_keys(panel: PlayersPanel, session: Session) -> None:
    horns = section_ids(session, "horn")
    everything = listed(panel)
    folded = [id for id in everything if id not in horns]
    click(panel, HORNS, x=10)
    assert listed(panel) == folded
    assert session.players == (session.project.players[0].id,), "folding selects nobody"
    click(panel, HORNS, x=10)
    assert listed(panel) == everything
    QTest.mouseDClick(panel.list.viewport(), Qt.MouseButton.LeftButton, pos=at(panel, HORNS))
    assert listed(panel) == folded
    click(panel, HORNS)
    assert session.players == horns
    press(panel, Qt.Key.Key_Right)
    assert listed(panel) == everything
    press(panel, Qt.Key.Key_Right)
    assert session.players == horns[:1], "to the first player"
    press(panel, Qt.Key.Key_Left)
    assert session.players == horns, "to the header"
    press(panel, Qt.Key.Key_Left)
    assert listed(panel) == folded
    press(panel, Qt.Key.Key_Down)
    assert session.players == section_ids(session, "trombone")
    click(panel, HORNS, x=10, modifier=SHIFT)
    assert listed(panel) == everything
    click(panel, HORNS, x=10, modifier=SHIFT)
    assert listed(panel) == [TRUMPETS, HORNS, TROMBONES]
    assert not session.document.done


def test_what_is_folded_is_found_and_stays_folded(panel: PlayersPanel, session: Session) -> None:
    horns = section_ids(session, "horn")
    click(panel, HORNS, x=10)
    search = child(panel, QLineEdit, "players_search")
    panel.list.search("horn")
    assert listed(panel) == [HORNS, *horns]
    panel.list.search("")
    assert search.text() == ""
    assert not {*horns} & {*listed(panel)}


def test_folding_is_remembered(session: Session, show_players: ShowPlayers, tmp_path: Path) -> None:
    settings = Settings(tmp_path / "editor.toml")
    settings.hold(session)
    session.set_folded(HORNS, True)
    session.set_groups_players(False)
    settings.sync()
    other = Session(session.project, ImmediateTasks())
    Settings(tmp_path / "editor.toml").hold(other)
    assert not other.groups_players
    other.set_groups_players(True)
    panel = show_players(other)
    assert not {*section_ids(session, "horn")} & {*listed(panel)}
    other.deleteLater()


def test_a_header_selects_mutes_and_solos_all_of_its_section(panel: PlayersPanel, session: Session) -> None:
    trumpets, horns = section_ids(session, "trumpet"), section_ids(session, "horn")
    click(panel, TRUMPETS)
    assert session.players == trumpets
    click(panel, HORNS, modifier=CTRL)
    assert session.players == (*trumpets, *horns)
    click(panel, TRUMPETS, modifier=CTRL)
    assert session.players == horns
    click(panel, trumpets[1], modifier=CTRL)
    assert {*session.players} == {*horns, trumpets[1]}
    before = session.project.players
    click(panel, trumpets[1], x=-40)
    assert header(panel, TRUMPETS).marked("muted") is None
    session.document.undo()
    click(panel, trumpets[0], x=60)
    click(panel, trumpets[0], x=-40)
    assert header(panel, TRUMPETS).marked("muted") is None, "some"
    click(panel, TRUMPETS, x=-40)
    assert [player.muted for player in session.project.players] == [p.id in trumpets for p in before]
    click(panel, TRUMPETS, x=-40)
    assert not any(player.muted for player in session.project.players)
    click(panel, HORNS, x=-14)
    assert [player.soloed for player in session.project.players] == [p.id in horns for p in before]
    assert len(session.document.done) == 4, "each click one step"
    for _ in range(4):
        session.document.undo()
    assert session.project.players == before


def test_commands_mute_solo_and_select_the_section_of_the_player_in_front(session: Session) -> None:
    rows = {row.id: row for row in commands.ACTIONS}
    horns = section_ids(session, "horn")
    session.set_players(horns[1:])
    rows["players.select_section"].run(session)
    assert session.players == (horns[1], horns[0])
    session.set_players(horns[1:])
    for name, field in (("mute", "muted"), ("solo", "soloed")):
        row = rows[f"players.{name}_section"]
        assert row.checked is not None
        assert not row.checked(session)
        row.run(session, True)
        assert row.checked(session)
        assert [getattr(player, field) for player in session.project.players] == [
            player.id in horns for player in session.project.players
        ]
        row.run(session, False)
        assert not any(getattr(player, field) for player in session.project.players)


def type_into(panel: PlayersPanel, name: str, text: str) -> None:
    control = child(panel, NumberSlider, name)
    control.type_value()
    field = control.findChildren(QLineEdit, "number_field")[-1]
    QTest.keyClicks(field, text)
    QTest.keyClick(field, Qt.Key.Key_Return)


def test_a_section_is_given_amplitude_breath_and_habit_in_one_step_each(panel: PlayersPanel, session: Session) -> None:
    # One player differs from the others beforehand.
    session.set_players(section_ids(session, "trombone")[:1])
    type_into(panel, "parameter_amplitude", "0.2")
    click(panel, TROMBONES)
    type_into(panel, "parameter_amplitude", "0.9")
    type_into(panel, "parameter_breath_need", "0.7")
    chip = child(panel, Chip, "habit_tapper")
    session.set_folded("players_acting", False)
    QTest.mouseClick(chip, Qt.MouseButton.LeftButton)
    own = section_ids(session, "trombone")
    for player in session.project.players:
        given = player.parameters
        assert (given.amplitude == 0.9, given.breath_need == 0.7, given.habits == "tapper") == (player.id in own,) * 3
    assert len(session.document.done) == 4


def test_the_player_in_front_of_a_folded_section_is_renamed(panel: PlayersPanel, session: Session) -> None:
    horns = section_ids(session, "horn")
    click(panel, HORNS)
    press(panel, Qt.Key.Key_Left)
    panel.list.rename_current()
    field = child(panel, QLineEdit, "player_name")
    assert field.isVisible()
    assert field.text() == session.project.player(horns[0]).name
    assert session.players == horns


def drag(panel: PlayersPanel, id: str, to: QPoint) -> None:
    view = panel.list.viewport()
    QTest.mousePress(view, Qt.MouseButton.LeftButton, pos=at(panel, id))
    QTest.mouseMove(view, at(panel, id) + QPoint(0, 12))
    QTest.mouseMove(view, to)
    QTest.mouseRelease(view, Qt.MouseButton.LeftButton, pos=to)


def test_a_player_is_dragged_within_the_section_and_a_header_with_all_of_it(
    panel: PlayersPanel, session: Session
) -> None:
    trumpets, horns, trombones = (section_ids(session, name) for name in ("trumpet", "horn", "trombone"))
    drag(panel, trumpets[0], at(panel, trumpets[2]) + QPoint(0, 15))
    moved = (trumpets[1], trumpets[2], trumpets[0], trumpets[3])
    assert section_ids(session, "trumpet") == moved
    drag(panel, trumpets[1], at(panel, trombones[1]))
    assert section_ids(session, "trumpet") == (*moved[1:], trumpets[1]), "no further than the section's end"
    press(panel, Qt.Key.Key_Up, ALT)
    assert section_ids(session, "trumpet") == (*moved[1:3], trumpets[1], moved[3])
    drag(panel, TROMBONES, at(panel, TRUMPETS) - QPoint(0, 8))
    assert listed(panel)[:3] == [TROMBONES, *trombones]
    press(panel, Qt.Key.Key_Down, ALT)
    press(panel, Qt.Key.Key_Down, ALT)
    assert [id for id in listed(panel) if id.startswith("players_")] == [TRUMPETS, HORNS, TROMBONES]
    press(panel, Qt.Key.Key_Up, ALT)
    assert [id for id in listed(panel) if id.startswith("players_")] == [TRUMPETS, TROMBONES, HORNS]
    assert {*horns} <= {*listed(panel)}
