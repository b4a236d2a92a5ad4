"""Section with the dancers: list, choreography, options and place."""

from __future__ import annotations

import os
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Final

from PySide6.QtCore import QTimer, Signal
from PySide6.QtGui import QContextMenuEvent
from PySide6.QtWidgets import QGridLayout, QWidget

from app.chance import next_seed
from app.choreography.model_file import read_model
from app.editor.design_tokens import LEAST_TARGET_PX
from app.editor.session import Session
from app.encoding import shown
from app.errors import AppError, Message
from app.project.choreography_files import SUFFIX, bundled_choreographies, choreography_path
from app.project.edit import dancers as edit
from app.project.edit.outfits import colour_outfit, give_outfit
from app.project.model import DANCER_PARAMETERS, Project
from app.project.performers import Dancer
from app.project.undoable_document import Change
from app.rig.characters.character_library import characters
from app.rig.people.wardrobe import Tint
from widgets.common.actions import actions
from widgets.common.clicks import on_click, on_switch
from widgets.common.combo import Combo, Option
from widgets.common.controls import Caption, Check, IconButton, Retranslated, named
from widgets.common.instrument_name import character_name
from widgets.common.layouts import in_column, in_row
from widgets.common.menus import offer_actions, passing_menu
from widgets.common.paths import ask_for_file
from widgets.common.plain import verbatim
from widgets.common.section import Section
from widgets.players.choreography.dancer_list import DancerList
from widgets.players.outfit_rows import OutfitChooser, OutfitColours
from widgets.players.parameter_rows import ParameterSlider, rows_of
from widgets.players.performer_edits import add_dancer, duplicate_dancer, remove_dancer
from widgets.players.place_numbers import place_sliders, shown_number, with_number

MENU = ("dancers.add", "dancers.rename", "dancers.duplicate", "dancers.remove", "", "dancers.choreography")
"""Action ids of the list's context menu; an empty one is a separator."""
_FROM_FILE = "\0file"
_LEARN = "\0learn"
"""Value of the option that opens the learning dialog; no choreography has this name."""
_MOST_ROWS = 5
_SOURCE = DANCER_PARAMETERS["source"]


class DancersSection(Retranslated, QWidget):
    """List of dancers, and the choreography, options and place of the selected one.

    Signals
    -------
    sought()
        A dancer was selected, whom the panel scrolls to.
    """

    sought = Signal()

    def __init__(self, session: Session, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("dancers")
        self._session = session
        self._section = Section(session, "players_dancers", self)
        duplicate, remove = partial(duplicate_dancer, session), partial(remove_dancer, session)
        self._tools = {
            "add": self._tool("add", "dancers_section.add_dancer", self.offer),
            "duplicate": self._tool("duplicate", "dancers_section.duplicate_another_one_dances_same", duplicate),
            "remove": self._tool("delete", "dancers_section.remove_selected_dancer", remove),
        }
        self.list = self.texted(named(DancerList(session), "dancer_list"), name="dancers_section.dancers")
        self._form = QWidget()
        self._choreography, self._character, self._source = Combo(), Combo(), Combo()
        self._outfit, self._outfit_colours = OutfitChooser("dancer"), OutfitColours(session, "dancer")
        self.texted(self._source, tip=_SOURCE.tip)
        self._mirrored = self.texted(
            named(Check("dancers_section.mirrored"), "dancer_mirrored"), tip="dancers_section.left_and_right_exchanged"
        )
        look_tip, dice_tip = (
            "dancers_section.show_choreography",
            "dancers_section.new_seed_tip",
        )
        self._look = IconButton(session, "information", look_tip, self._show_choreography, "dancer_look")
        self._dice = IconButton(session, "dice", dice_tip, self._new_variation, "dancer_dice")
        numbers = rows_of("dancer", DANCER_PARAMETERS)
        self._numbers = {number.name: ParameterSlider(session, number, "dancer") for number in numbers}
        self._places = place_sliders(self, session, "dancer")
        self._read: tuple[str, list[Option]] | None = None
        """A choreography whose sources are known."""
        self._build()
        self._connect()
        self.retranslate()

    @property
    def dancer(self) -> Dancer | None:
        """The dancer selected in the editor; None if none is."""
        return self._session.dancer

    def _tool(self, picture: str, tip_id: str, run: Callable[[], object]) -> IconButton:
        name = "remove" if picture == "delete" else picture
        return IconButton(self._session, picture, tip_id, run, f"dancers_{name}_button")

    def _build(self) -> None:
        for button in self._tools.values():
            self._section.header.add_button(button)
        grid = QGridLayout(self._form)
        grid.setContentsMargins(0, 0, 0, 0)
        grid.setSpacing(4)
        grid.setColumnStretch(1, 1)
        combos = {
            "choreography": (self._choreography, "dancers_section.choreography"),
            "character": (self._character, "dancers_section.character"),
            "outfit": (self._outfit, "outfit_rows.outfit"),
            "source": (self._source, _SOURCE.label),
        }
        for row, (name, (combo, text_id)) in enumerate(combos.items()):
            combo.setObjectName(f"dancer_{name}")
            grid.addWidget(Caption(text_id, combo), row, 0)
            if combo is not self._choreography:
                grid.addWidget(combo, row, 1)
        choreography = in_row((self._choreography, 1), self._look, spacing=4)
        grid.addLayout(choreography, 0, 1)
        seed = in_row(spacing=4)
        grid.addWidget(self._outfit_colours.caption, len(combos), 0)
        grid.addWidget(self._outfit_colours, len(combos), 1)
        for row, (name, slider) in enumerate(self._numbers.items(), len(combos) + 1):
            if name == "seed":
                seed.addWidget(slider, 1)
                seed.addWidget(self._dice)
                grid.addLayout(seed, row, 0, 1, 2)
            else:
                grid.addWidget(slider, row, 0, 1, 2)
        place = in_row(spacing=4)
        for name in ("x_m", "z_m"):
            place.addWidget(self._places[name], 1)
        grid.addWidget(self._mirrored, grid.rowCount(), 0, 1, 2)
        grid.addLayout(place, grid.rowCount(), 0, 1, 2)
        grid.addWidget(self._places["turn_rad"], grid.rowCount(), 0, 1, 2)
        self._section.body.addWidget(self.list)
        self._section.body.addWidget(self._form)
        in_column(self._section, of=self, margins=0)

    def _seek(self) -> None:
        if self._session.dancer is not None:
            self.sought.emit()

    def _connect(self) -> None:
        session = self._session
        session.changed.connect(self._changed)
        session.characters_changed.connect(self._show)
        session.choreographies_changed.connect(self._read_again)
        session.dancer_changed.connect(self._show)
        session.dancer_changed.connect(self._seek)
        session.problems_changed.connect(self._show_list)
        session.performance_changed.connect(self._show_list)
        self.list.chosen.connect(session.set_dancer)
        self.list.renamed.connect(self._rename)
        self.list.moved.connect(self._move)
        self._choreography.chosen.connect(self._choose_choreography)
        self._character.chosen.connect(lambda id: self._change("character", character_id=id))
        self._outfit.chosen.connect(self._wear)
        self._outfit_colours.chosen.connect(self._tint)
        self._source.chosen.connect(lambda number: self._change("source", source=int(number)))
        on_switch(self._mirrored, lambda on: self._change("mirrored", mirrored=bool(on)))
        for name, number in self._numbers.items():
            number.changed.connect(
                lambda value, token, name=name, kind=number.parameter.kind: self._change(
                    name, token, **{name: kind(value)}
                )
            )
        for name, slider in self._places.items():
            slider.changed.connect(lambda value, token, name=name: self._place(name, value, token))
        for slider in (*self._numbers.values(), *self._places.values()):
            slider.released.connect(session.document.end_gesture)

    # Display

    def _changed(self, change: Change) -> None:
        if change.opened or change.before.dancers is not change.after.dancers:
            self._show()

    def _show(self) -> None:
        dancers = self._session.project.dancers
        self._show_list()
        self._section.header.set_texts(self.tr("dancers_section.dancers"), str(len(dancers)) if dancers else "")
        self._show_form()

    def _show_list(self) -> None:
        dancers = self._session.project.dancers
        self.list.show_dancers(dancers, self.dancer)
        rows = min(max(len(dancers), 1), _MOST_ROWS)
        self.list.setFixedHeight(rows * max(self.list.sizeHintForRow(0), LEAST_TARGET_PX) + 4)
        self.list.setVisible(bool(dancers))

    def _show_form(self) -> None:
        dancer = self.dancer
        self._form.setVisible(dancer is not None)
        for name in ("duplicate", "remove"):
            self._tools[name].setEnabled(dancer is not None)
        if dancer is None:
            return
        options = [Option(name, name) for name in bundled_choreographies()]
        if dancer.choreography not in {option.id for option in options}:
            options.append(Option(dancer.choreography, shown(Path(dancer.choreography).stem)))
        more = [Option(_FROM_FILE, self.tr("dancers_section.from_file"))]
        if "dancers.learn" in actions(self._session):
            more.append(Option(_LEARN, self.tr("dancers_section.learn")))
        self._choreography.set_options([*options, *more])
        self._choreography.show_option(dancer.choreography)
        self._choreography.setToolTip(shown(dancer.choreography))
        self._character.set_options([Option(id, character_name(id)) for id in characters()])
        self._character.show_option(dancer.character_id)
        self._outfit.show_worn([dancer])
        self._outfit_colours.show_worn([dancer])
        self._source.set_options([Option("-1", self.tr("dancers_section.none")), *self._sources(dancer)])
        self._source.show_option(str(dancer.source))
        self._mirrored.setChecked(dancer.mirrored)
        for name, number in self._numbers.items():
            value, default = float(getattr(dancer, name)), float(number.parameter.default)
            number.show_value(value, default=default, by_hand=not number.parameter.is_own and value != default)
        for name, slider in self._places.items():
            slider.show_value(shown_number(dancer.stage, name), by_hand=False)

    def _sources(self, dancer: Dancer) -> list[Option]:
        """Return the motion files from which a choreography was learned, as options; empty if it cannot be read, which
        is reported as a problem.
        """
        if self._read is None or self._read[0] != dancer.choreography:
            try:
                model = read_model(choreography_path(dancer.choreography))
            except AppError:
                return [] if dancer.source < 0 else [Option(str(dancer.source), str(dancer.source + 1))]
            names = [Path(source.motion_name).stem for source in model.sources]
            self._read = dancer.choreography, [Option(str(at), name) for at, name in enumerate(names)]
        return self._read[1]

    def _read_again(self) -> None:
        self._read = None
        self._show()

    # Editing

    def offer(self) -> None:
        """Open the menu that chooses the choreography of a new dancer."""
        menu = passing_menu(self, "choreography_menu")
        for name in bundled_choreographies():
            on_click(menu.addAction(verbatim(name)), self.add, name)
        on_click(menu.addAction(self.tr("dancers_section.from_file")), self._add_from_file)
        learn = actions(self._session).get("dancers.learn")
        if learn is not None:
            menu.addAction(learn)
        button = self._tools["add"]
        menu.popup(button.mapToGlobal(button.rect().bottomLeft()))

    def add(self, choreography: str) -> None:
        """Add a dancer with a choreography, and select it."""
        add_dancer(self._session, choreography, self.tr("dancers_section.dancer"))

    def _add_from_file(self) -> None:
        path = self._ask_for_choreography()
        if path is not None:
            self.add(os.fspath(path))

    def _ask_for_choreography(self) -> Path | None:
        source = self._session.project.source
        start = Path(source).parent if source else None
        kind = self.tr("dancers_section.choreographies")
        return ask_for_file(self, self.tr("dancers_section.choreography"), start, f"{kind} (*{SUFFIX})")

    def _choose_choreography(self, id: str) -> None:
        dancer = self.dancer
        if dancer is None:
            return
        if id == _LEARN:
            self._choreography.show_option(dancer.choreography)
            actions(self._session)["dancers.learn"].trigger()
            return
        path = self._ask_for_choreography() if id == _FROM_FILE else id
        if path is None:
            self._choreography.show_option(dancer.choreography)
            return
        self._edit("choreography", lambda project, id: edit.set_choreography(project, (id,), path))

    def _move(self, dancer_ids: tuple[str, ...], before: int) -> None:
        self._session.attempt(
            Message("edit.move_dancers"), lambda project: edit.move_dancers(project, dancer_ids, before)
        )

    def _rename(self, dancer_id: str, name: str) -> None:
        dancer = self._session.project.dancer(dancer_id)
        self._session.attempt(
            Message("edit.rename_dancer", {"dancer": dancer.name}),
            lambda project: edit.rename_dancer(project, dancer_id, name),
        )
        # After the editor of the row is closed: a refused name disappears.
        QTimer.singleShot(0, self, self._show)

    def rename_selected(self) -> None:
        """Open the field for the name of the selected dancer."""
        self._section.set_open(True)
        self.list.rename_current()

    def _show_choreography(self) -> None:
        action = actions(self._session).get("dancers.choreography")
        if action is not None:
            action.trigger()

    def _new_variation(self) -> None:
        dancer = self.dancer
        if dancer is not None:
            self._change("seed", seed=next_seed(dancer.id, dancer.seed))

    def _change(self, name: str, token: object | None = None, **fields: object) -> None:
        self._edit(name, lambda project, id: edit.change_dancers(project, (id,), **fields), token)

    def _wear(self, outfit: str) -> None:
        self._edit("outfit", lambda project, id: give_outfit(project, (id,), outfit))

    def _tint(self, tint: Tint, colour: str) -> None:
        self._edit("outfit_colour", lambda project, id: colour_outfit(project, (id,), tint, colour))

    def _place(self, name: str, value: float, token: object | None) -> None:
        dancer = self.dancer
        if dancer is not None:
            place = with_number(dancer.stage, name, value)
            self._edit("place", lambda project, id: edit.place_dancers(project, {id: place}), token)

    def _edit(self, name: str, change: Callable[[Project, str], Project], token: object | None = None) -> None:
        dancer = self.dancer
        if dancer is not None:
            self._session.attempt(
                edit.dancer_edit(name, dancer.name), lambda project: change(project, dancer.id), token
            )

    # Texts

    def retranslate(self) -> None:
        self._show()

    # Qt overrides

    def contextMenuEvent(self, event: QContextMenuEvent) -> None:
        inside = self.list.rect().contains(self.list.mapFromGlobal(event.globalPos()))
        if inside:
            offer_actions(self._session, MENU, self, "dancers_menu", event.globalPos())
        else:
            super().contextMenuEvent(event)


SECTION: Final = DancersSection
"""Section that the panel includes if the feature is installed."""
