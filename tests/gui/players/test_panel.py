"""The players' panel by mouse and keys, judged by the project."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest
from msgspec.structs import replace as replace_struct
from PySide6.QtCore import QPoint, QPointF, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QComboBox, QLineEdit, QMenu, QPushButton, QToolButton, QWidget
from pytestqt.qtbot import QtBot

from app.editor.session import Session
from app.errors import Message
from app.project.casting import stage_arc
from app.project.edit import players as players_edit
from app.project.edit.players import cast_parameters, duplicate_players
from app.project.performers import Player
from app.shell.commands.players import toggle_posture
from instrument_maps.library import find_map
from tests.gui.players.conftest import ShowPlayers
from tests.support.windows import child
from widgets.common.combo import Combo
from widgets.common.number_slider import NumberSlider
from widgets.players.panel import LEAST_LIST_PX, PlayersPanel
from widgets.players.player_list import PlayerList
from widgets.players.stage import StageView


@pytest.fixture
def panel(session: Session, show_players: ShowPlayers) -> PlayersPanel:
    session.performance.plans  # noqa: B018 - made, as the shell does
    return show_players(session)


def row_point(panel: PlayersPanel, number: int, x: int = 40) -> QPoint:
    box = panel.list.visualRect(panel.list.rows.index(number))
    return QPoint(x if x >= 0 else box.right() + x, box.center().y())


def click_row(
    panel: PlayersPanel, number: int, modifier: Qt.KeyboardModifier = Qt.KeyboardModifier.NoModifier, x: int = 40
) -> None:
    QTest.mouseClick(panel.list.viewport(), Qt.MouseButton.LeftButton, modifier, row_point(panel, number, x))


def ids(session: Session) -> list[str]:
    return [player.id for player in session.project.players]


def front(session: Session) -> Player:
    assert session.player is not None
    return session.player


def slider(panel: PlayersPanel, name: str) -> NumberSlider:
    found = child(panel, NumberSlider, name)
    assert isinstance(found, NumberSlider)
    return found


def type_into(control: NumberSlider, text: str) -> None:
    control.type_value()
    field = control.findChildren(QLineEdit, "number_field")[-1]
    QTest.keyClicks(field, text)
    QTest.keyClick(field, Qt.Key.Key_Return)


def test_a_click_puts_a_player_in_front_and_ctrl_adds(panel: PlayersPanel, session: Session) -> None:
    everyone = ids(session)
    click_row(panel, 2)
    assert session.players == (everyone[2],)
    click_row(panel, 0, Qt.KeyboardModifier.ControlModifier)
    assert session.players == (everyone[0], everyone[2])
    click_row(panel, 3, Qt.KeyboardModifier.ShiftModifier)
    assert set(session.players) == set(everyone)
    QTest.keyClick(panel.list, Qt.Key.Key_Home)
    assert session.players == (everyone[0],)


def test_the_list_follows_the_session(panel: PlayersPanel, session: Session) -> None:
    session.set_players((ids(session)[3], ids(session)[1]))
    assert {index.row() for index in panel.list.selectionModel().selectedIndexes()} == {1, 3}
    assert panel.list.currentIndex().row() == 3


def test_f2_and_double_click_rename(panel: PlayersPanel, session: Session, qtbot: QtBot) -> None:
    click_row(panel, 0)
    QTest.keyClick(panel.list, Qt.Key.Key_F2)
    field = child(panel, QLineEdit, "player_name")
    QTest.keyClicks(field, "Anna")
    QTest.keyClick(field, Qt.Key.Key_Return)
    # Qt's delegates hand over what was typed from the event loop.
    qtbot.waitUntil(lambda: session.project.players[0].name == "Anna")
    QTest.mouseDClick(panel.list.viewport(), Qt.MouseButton.LeftButton, pos=row_point(panel, 1))
    field = [one for one in panel.findChildren(QLineEdit, "player_name") if one.isVisible()][-1]
    QTest.keyClicks(field, "anna")
    QTest.keyClick(field, Qt.Key.Key_Return)
    qtbot.waitUntil(lambda: session.project.players[1].name == "anna 2")
    assert [step.name.id for step in session.document.done] == ["edit.rename_player"] * 2


def test_mute_and_solo(panel: PlayersPanel, session: Session) -> None:
    click_row(panel, 1, x=-40)
    assert [player.muted for player in session.project.players] == [False, True, False, False]
    click_row(panel, 2, x=-14)
    assert [player.soloed for player in session.project.players] == [False, False, True, False]
    assert session.players == (ids(session)[0],)
    session.set_players(tuple(ids(session)[:2]))
    click_row(panel, 0, x=-40)
    assert [player.muted for player in session.project.players] == [True, True, False, False]


def test_players_of_a_large_piece_are_searched_and_muted_by_section(panel: PlayersPanel, session: Session) -> None:
    search = child(panel, QLineEdit, "players_search")
    assert not search.isVisible()
    panel.resize(panel.width(), 2 * LEAST_LIST_PX)
    QApplication.processEvents()
    rows_px = panel.list.height()
    for _ in range(2):
        session.attempt(
            Message("edit.duplicate_players", {"of": "Trumpet 1"}),
            lambda project: duplicate_players(project, [player.id for player in project.players])[0],
        )
    players = session.project.players
    assert len(players) == 16
    assert search.isVisible()
    QApplication.processEvents()
    assert panel.list.height() >= rows_px, "the search takes nothing from the list"
    QTest.keyClicks(search, "TROMB")
    trombones = [number for number, player in enumerate(players) if player.name.startswith("Trombone")]
    rows = panel.list.rows
    shown = [row.id for n, row in enumerate(rows.rows) if panel.list.visualRect(rows.index(n)).isValid()]
    assert shown == ["players_section_trombones", *(players[number].id for number in trombones)]
    QTest.keyClick(search, Qt.Key.Key_Return)
    assert set(session.players) == {players[number].id for number in trombones}
    # The button of one mutes all of them, and one step brings them back.
    panel.list.mute_clicked.emit((players[trombones[0]].id,))
    assert [player.muted for player in session.project.players] == [number in trombones for number in range(16)]
    session.document.undo()
    assert session.project.players == players
    QTest.keyClicks(search, "x")
    QTest.keyClick(search, Qt.Key.Key_Return)
    assert len(session.players) == len(trombones), "nobody is found: the selection stays"
    search.clear()
    assert not any(panel.list.isRowHidden(number) for number in range(rows.rowCount()))


def test_who_is_recorded_is_armed_where_there_is_something_to_record_from(
    panel: PlayersPanel, session: Session
) -> None:
    recording = session.recording
    click_row(panel, 1, x=-68)
    assert recording.armed == ""
    assert session.players == (ids(session)[1],)
    recording.set(port="EWI5000")
    click_row(panel, 2, x=-68)
    assert recording.armed == ids(session)[2]
    assert session.players == (ids(session)[1],)
    click_row(panel, 0, x=-68)
    assert recording.armed == ids(session)[0]
    click_row(panel, 0, x=-68)
    assert recording.armed == ""
    assert not session.document.done


def test_dragging_a_row_reorders(panel: PlayersPanel, session: Session) -> None:
    before = ids(session)
    view = panel.list.viewport()
    QTest.mousePress(view, Qt.MouseButton.LeftButton, pos=row_point(panel, 0))
    for number in (1, 2):
        QTest.mouseMove(view, row_point(panel, number) + QPoint(0, 15))
    QTest.mouseRelease(view, Qt.MouseButton.LeftButton, pos=row_point(panel, 2) + QPoint(0, 15))
    assert ids(session) == [before[1], before[2], before[0], before[3]]
    assert session.players == (before[0],)
    QTest.keyClick(panel.list, Qt.Key.Key_Up, Qt.KeyboardModifier.AltModifier)
    assert ids(session) == [before[1], before[0], before[2], before[3]]
    session.document.undo()
    session.document.undo()
    assert ids(session) == before
    assert not session.document.done


def test_escape_drops_a_dragged_row_where_it_was(panel: PlayersPanel, session: Session) -> None:
    view = panel.list.viewport()
    QTest.mousePress(view, Qt.MouseButton.LeftButton, pos=row_point(panel, 0))
    QTest.mouseMove(view, row_point(panel, 2) + QPoint(0, 15))
    QTest.keyClick(panel.list, Qt.Key.Key_Escape)
    QTest.mouseRelease(view, Qt.MouseButton.LeftButton, pos=row_point(panel, 2))
    assert not session.document.done


def test_add_duplicate_and_remove(panel: PlayersPanel, session: Session, qtbot: QtBot) -> None:
    QTest.mouseClick(child(panel, QToolButton, "players_add_button"), Qt.MouseButton.LeftButton)
    menu = child(panel, QMenu, "instrument_menu")
    assert isinstance(menu, QMenu)
    menu.actions()[-1].trigger()
    menu.close()
    assert len(session.project.players) == 5
    assert session.players == (session.project.players[-1].id,)
    QTest.mouseClick(child(panel, QToolButton, "players_duplicate_button"), Qt.MouseButton.LeftButton)
    assert len(session.project.players) == 6
    assert session.players == (session.project.players[-1].id,)
    assert session.project.players[-1].instrument_id == session.project.players[-2].instrument_id
    QTest.mouseClick(child(panel, QToolButton, "players_remove_button"), Qt.MouseButton.LeftButton)
    assert len(session.project.players) == 5
    assert len(session.players) == 1


def test_a_slider_drag_is_one_step_and_the_undo_shows(panel: PlayersPanel, session: Session) -> None:
    control = slider(panel, "parameter_amplitude")
    before = front(session).parameters.amplitude
    start = QPoint(60, 10)
    QTest.mousePress(control, Qt.MouseButton.LeftButton, pos=start)
    for x in (64, 90, 120):
        QTest.mouseMove(control, QPoint(x, 10))
    QTest.mouseRelease(control, Qt.MouseButton.LeftButton, pos=QPoint(120, 10))
    assert front(session).parameters.amplitude > before + 0.1
    assert len(session.document.done) == 1
    assert control.by_hand
    session.document.undo()
    assert control.value == pytest.approx(before)


def test_a_drag_back_to_the_start_is_no_step(panel: PlayersPanel, session: Session) -> None:
    control = slider(panel, "parameter_sway")
    QTest.mousePress(control, Qt.MouseButton.LeftButton, pos=QPoint(60, 10))
    for x in (64, 90, 60):
        QTest.mouseMove(control, QPoint(x, 10))
    QTest.mouseRelease(control, Qt.MouseButton.LeftButton, pos=QPoint(60, 10))
    assert front(session).parameters.sway == 1.0
    assert not session.document.done


def test_several_players_at_once(panel: PlayersPanel, session: Session) -> None:
    first, second = ids(session)[:2]
    session.set_players((second, first))
    control = slider(panel, "parameter_amplitude")
    assert control.mixed
    type_into(control, "3/4")
    assert [session.project.player(id).parameters.amplitude for id in (first, second)] == [0.75, 0.75]
    assert not control.mixed
    QTest.keyClick(control, Qt.Key.Key_Backspace)
    for id in (first, second):
        assert session.project.player(id).parameters.amplitude == cast_parameters(session.project, id).amplitude


def test_escape_restores_the_value_of_each_player(panel: PlayersPanel, session: Session) -> None:
    first, second = ids(session)[:2]
    session.set_players((second, first))
    control = slider(panel, "parameter_amplitude")
    assert control.mixed
    before = session.project
    QTest.mousePress(control, Qt.MouseButton.LeftButton, pos=QPoint(60, 10))
    for x in (64, 90, 120):
        QTest.mouseMove(control, QPoint(x, 10))
    assert session.project.player(first).parameters.amplitude == session.project.player(second).parameters.amplitude
    QTest.keyClick(control, Qt.Key.Key_Escape)
    QTest.mouseRelease(control, Qt.MouseButton.LeftButton, pos=QPoint(120, 10))
    assert session.project is before
    assert not session.document.done
    assert control.mixed


@pytest.mark.parametrize(
    ("name", "text", "value"),
    [
        ("weight_shift", "0.4", 0.4),
        ("bell_height", "1.5", 1.5),
        ("breath_min_beats", "1/3", 0.33),
        ("breath_last_beat_beats", "16", 16.0),
        ("breath_prepare_beats", "3", 3.0),
        ("breath_need", "0.5", 0.5),
        ("lung_s", "12.5", 12.5),
        ("embouchure_tension", "0.9", 0.9),
        ("seed", "77", 77),
    ],
)
def test_every_number_is_typed_and_reset(
    panel: PlayersPanel, session: Session, name: str, text: str, value: float
) -> None:
    before = getattr(front(session).parameters, name)
    control = slider(panel, f"parameter_{name}")
    type_into(control, text)
    assert getattr(front(session).parameters, name) == value
    assert isinstance(getattr(front(session).parameters, name), int if name == "seed" else float)
    QTest.mouseDClick(control, Qt.MouseButton.LeftButton, pos=QPoint(30, 10))
    assert getattr(front(session).parameters, name) == before


@pytest.mark.parametrize(
    ("name", "read"),
    [
        ("player_part", lambda player: player.part_id),
        ("player_instrument", lambda player: player.instrument_id),
        ("player_character", lambda player: player.character_id),
        ("parameter_posture", lambda player: player.parameters.posture),
        ("parameter_cue_leader", lambda player: player.parameters.cue_leader),
        ("parameter_circular_breathing", lambda player: player.parameters.circular_breathing),
    ],
)
def test_every_choice_is_made_by_keys(panel: PlayersPanel, session: Session, name: str, read: object) -> None:
    assert callable(read)
    before = read(front(session))
    combo = child(panel, QComboBox, name)
    combo.setFocus()
    QTest.keyClick(combo, Qt.Key.Key_Down)
    if read(front(session)) == before:
        QTest.keyClick(combo, Qt.Key.Key_Up)
    assert read(front(session)) != before
    assert len(session.document.done) == 1


def test_a_posture_in_which_an_instrument_is_not_played_cannot_be_chosen(
    panel: PlayersPanel, session: Session, monkeypatch: pytest.MonkeyPatch
) -> None:
    seated = ids(session)[0]
    instrument = find_map(front(session).instrument_id)
    only = replace_struct(instrument, hold=replace_struct(instrument.hold, standing=None, lowered_standing=None))
    monkeypatch.setattr(players_edit, "instrument_of", lambda player: only if player.id == seated else instrument)
    session.set_players((ids(session)[1],))
    session.set_players((seated,))
    combo = child(panel, QComboBox, "parameter_posture")
    assert isinstance(combo, Combo)
    # Shows the actual posture of the player, whatever the project says; the reason names the player.
    assert combo.shown == "seated"
    assert front(session).name in combo.toolTip()
    combo.setFocus()
    QTest.keyClick(combo, Qt.Key.Key_Up)
    assert combo.shown == "seated"
    assert session.document.done == ()
    # Selected together with players who may stand, only those sit down and stand up.
    session.set_players(tuple(ids(session)))
    before = session.project
    toggle_posture(session)
    assert [player.parameters.posture for player in session.project.players] == [
        before.players[0].parameters.posture, "seated", "seated", "seated",
    ]  # fmt: skip
    session.document.undo()
    session.set_players((ids(session)[1],))
    assert combo.toolTip() == ""
    QTest.keyClick(combo, Qt.Key.Key_Down)
    assert front(session).parameters.posture == "seated"


def test_dice_and_reset(panel: PlayersPanel, session: Session) -> None:
    before = session.project
    QTest.mouseClick(child(panel, QPushButton, "randomise"), Qt.MouseButton.LeftButton)
    assert all(
        one.parameters != other.parameters for one, other in zip(before.players, session.project.players, strict=True)
    )
    session.set_players(tuple(ids(session)))
    QTest.mouseClick(child(panel, QPushButton, "reset_parameters"), Qt.MouseButton.LeftButton)
    assert session.project.players == before.players
    QTest.mouseClick(child(panel, QToolButton, "seed_dice"), Qt.MouseButton.LeftButton)
    assert len({player.parameters.seed for player in session.project.players}) == 4
    assert session.project.players[0].parameters.seed != before.players[0].parameters.seed


def stage(panel: PlayersPanel) -> StageView:
    found = child(panel, StageView, "stage")
    assert isinstance(found, StageView)
    return found


def pull(view: StageView, start: QPointF, end: QPointF) -> None:
    QTest.mousePress(view, Qt.MouseButton.LeftButton, pos=start.toPoint())
    for share in (0.3, 0.7, 1.0):
        QTest.mouseMove(view, (start + (end - start) * share).toPoint())
    QTest.mouseRelease(view, Qt.MouseButton.LeftButton, pos=end.toPoint())


def test_a_player_is_dragged_on_the_stage(panel: PlayersPanel, session: Session) -> None:
    view = stage(panel)
    player = session.project.players[1]
    start = view.point(player.stage.x_m, player.stage.z_m)
    pull(view, start, view.point(player.stage.x_m + 0.5, player.stage.z_m - 0.4))
    moved = session.project.players[1].stage
    assert moved.x_m == pytest.approx(player.stage.x_m + 0.5, abs=0.03)
    assert moved.z_m == pytest.approx(player.stage.z_m - 0.4, abs=0.03)
    assert moved.turn_rad == player.stage.turn_rad
    assert session.players == (player.id,)
    assert len(session.document.done) == 1
    QTest.mouseClick(child(panel, QToolButton, "stage_arc"), Qt.MouseButton.LeftButton)
    assert tuple(one.stage for one in session.project.players) == stage_arc(4)


def test_a_place_that_shows_another_number_than_the_arc_is_marked_as_set_by_hand(
    panel: PlayersPanel, session: Session
) -> None:
    control = slider(panel, "stage_x_m")
    assert not control.by_hand
    for by_m, by_hand in ((0.008, True), (0.003, False)):
        arc = stage_arc(4)[0]
        moved = replace_struct(arc, x_m=arc.x_m + by_m)
        session.attempt(
            Message("edit.place_players", {"of": "Trumpet 1"}),
            lambda project, to=moved: players_edit.place(project, {ids(session)[0]: to}),
        )
        assert control.by_hand is by_hand


def test_the_nose_turns(panel: PlayersPanel, session: Session) -> None:
    view = stage(panel)
    player = session.project.players[0]
    centre = view.point(player.stage.x_m, player.stage.z_m)
    pull(view, view.nose_point(player), centre + QPointF(60.0, 0.0))
    turned = session.project.players[0].stage
    assert turned.turn_rad == pytest.approx(math.pi / 2, abs=0.03)
    assert (turned.x_m, turned.z_m) == (player.stage.x_m, player.stage.z_m)


def test_escape_puts_a_dragged_player_back(panel: PlayersPanel, session: Session) -> None:
    view = stage(panel)
    player = session.project.players[0]
    start = view.point(player.stage.x_m, player.stage.z_m)
    QTest.mousePress(view, Qt.MouseButton.LeftButton, pos=start.toPoint())
    QTest.mouseMove(view, start.toPoint() + QPoint(40, 0))
    assert session.project.players[0].stage != player.stage
    QTest.keyClick(view, Qt.Key.Key_Escape)
    QTest.mouseRelease(view, Qt.MouseButton.LeftButton)
    assert session.project.players[0].stage == player.stage
    assert not session.document.done


def test_snapping_arrows_and_numbers(panel: PlayersPanel, session: Session) -> None:
    view = stage(panel)
    QTest.mouseClick(child(panel, QToolButton, "stage_snap"), Qt.MouseButton.LeftButton)
    player = session.project.players[0]
    start = view.point(player.stage.x_m, player.stage.z_m)
    pull(view, start, start + QPointF(33, 21))
    placed = session.project.players[0].stage
    assert placed.x_m * 10 == pytest.approx(round(placed.x_m * 10), abs=1e-6)
    assert placed.z_m * 10 == pytest.approx(round(placed.z_m * 10), abs=1e-6)
    view.setFocus()
    QTest.keyClick(view, Qt.Key.Key_Right)
    assert session.project.players[0].stage.x_m == pytest.approx(placed.x_m + 0.05)
    QTest.keyClick(view, Qt.Key.Key_Right, Qt.KeyboardModifier.ControlModifier)
    assert session.project.players[0].stage.turn_rad == pytest.approx(placed.turn_rad + math.radians(5), abs=1e-4)
    type_into(slider(panel, "stage_turn_rad"), "-90")
    assert session.project.players[0].stage.turn_rad == pytest.approx(-math.pi / 2)
    type_into(slider(panel, "stage_x_m"), "2.5")
    assert session.project.players[0].stage.x_m == 2.5


def test_characters_have_portraits(panel: PlayersPanel, qtbot: QtBot) -> None:
    combo = child(panel, QComboBox, "player_character")
    assert isinstance(combo, QComboBox)
    qtbot.waitUntil(lambda: not any(combo.itemIcon(number).isNull() for number in range(combo.count())))
    heads = [combo.itemIcon(number).pixmap(28, 28).toImage() for number in range(combo.count())]
    for head in heads:
        # Skin or hair in the middle, nothing in the upper corners.
        assert head.pixelColor(head.width() // 2, head.height() // 2).alpha() == 255
        assert head.pixelColor(0, 0).alpha() == 0
    assert heads[0] != heads[1]


def test_many_players_are_few_widgets(session: Session, show_players: ShowPlayers) -> None:
    project = session.project
    while len(project.players) < 50:
        project, _ = duplicate_players(project, [player.id for player in project.players])
    session.document.open(project)
    panel = show_players(session)
    assert len(panel.findChildren(QWidget)) < 310
    assert isinstance(panel.list, PlayerList)
    session.set_players(tuple(ids(session)))
    assert len(panel.list.selectionModel().selectedIndexes()) == len(project.players)


def test_an_empty_project_teaches(session: Session, show_players: ShowPlayers) -> None:
    panel = show_players(session)
    session.document.open(replace(session.project, players=()))
    assert not panel.list.isVisible()
    panel.add("trumpet_Bb")
    assert panel.list.isVisible()
    assert front(session).stage.x_m == 0.0
