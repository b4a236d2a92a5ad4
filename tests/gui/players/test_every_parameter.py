"""The panel shows every declared parameter, and its changes match the undo history."""

from __future__ import annotations

import pytest
from PySide6.QtWidgets import QWidget

from app.editor.session import Session
from app.messages import WORDINGS
from app.plan.parameters import PARAMETERS, Parameter
from app.project.edit.dancers import add_dancer, set_body_dance
from app.project.model import DANCER_PARAMETERS
from metadata.acting import names_in
from tests.gui.japanese import speaking
from tests.gui.players.conftest import ShowPlayers
from tests.support.parameters import others
from widgets.common.chip import Chip
from widgets.common.combo import Combo
from widgets.common.number_slider import NumberSlider
from widgets.common.text import sentence
from widgets.players.panel import PlayersPanel

SHOWN = {name: parameter for name, parameter in PARAMETERS.items() if name != "layers_off"}
"""Parameters with a control of their own; disabled layers are boxes beside the amounts (see test_acting)."""


@pytest.fixture
def panel(session: Session, show_players: ShowPlayers) -> PlayersPanel:
    players = tuple(player.id for player in session.project.players)
    project, dancer = add_dancer(set_body_dance(session.project, players, "salsa"), "salsa", "Anna")
    session.document.open(project)
    session.set_players(players)
    session.set_dancer(dancer)
    session.set_folded("players_acting", False)
    return show_players(session)


def choose(control: QWidget, value: object) -> None:
    """Set a value like a user."""
    if control.objectName() == "parameter_habits":
        for habit in names_in(str(value)):
            chip = control.findChild(Chip, f"habit_{habit}")
            assert isinstance(chip, Chip)
            chip.click()
    elif isinstance(control, Combo):
        control.chosen.emit(str(value))
    else:
        assert isinstance(control, NumberSlider)
        control.changed.emit(float(str(value)), None)


@pytest.mark.parametrize("parameter", SHOWN.values(), ids=SHOWN)
def test_every_parameter_is_changed_for_all_who_are_selected(
    panel: PlayersPanel, session: Session, parameter: Parameter
) -> None:
    control = panel.findChild(QWidget, f"parameter_{parameter.name}")
    assert isinstance(control, QWidget)
    assert control.isVisibleTo(panel)
    now = getattr(session.project.players[0].parameters, parameter.name)
    values = {"choreography": "", "habits": "swayer"}
    value = values[parameter.name] if parameter.name in values else others(parameter, now)[-1]
    choose(control, value)
    assert {getattr(player.parameters, parameter.name) for player in session.project.players} == {value}
    assert len(session.document.done) == 1
    label = WORDINGS[parameter.label][0]
    first, second = (player.name for player in session.project.players[:2])
    expected = f"{label}: {first}, {second}, … ({len(session.project.players)})"
    assert sentence(session.document.done[0].name) == expected


@pytest.mark.parametrize("parameter", DANCER_PARAMETERS.values(), ids=DANCER_PARAMETERS)
def test_every_parameter_of_a_dancer_is_changed(panel: PlayersPanel, session: Session, parameter: Parameter) -> None:
    control = panel.findChild(QWidget, f"dancer_{parameter.name}")
    assert isinstance(control, QWidget)
    value = 0 if parameter.name == "source" else others(parameter, parameter.default)[-1]
    choose(control, value)
    assert getattr(session.project.dancers[0], parameter.name) == value
    assert sentence(session.document.done[0].name) == f"{WORDINGS[parameter.label][0]} of Anna"


def test_words_are_those_of_the_declaration_in_both_languages(panel: PlayersPanel) -> None:
    for language, code in enumerate(("en", "ja")):
        with speaking(code):
            for table, prefix in ((SHOWN, "parameter"), (DANCER_PARAMETERS, "dancer")):
                for parameter in table.values():
                    control = panel.findChild(QWidget, f"{prefix}_{parameter.name}")
                    assert isinstance(control, QWidget)
                    assert not parameter.tip or control.toolTip().startswith(WORDINGS[parameter.tip][language])
                    label = WORDINGS[parameter.label][language]
                    assert not isinstance(control, NumberSlider) or control.accessibleName() == label
