"""Dialog for making a person for the user from a bundled one, with another height, age and build."""

from __future__ import annotations

from typing import Final

import msgspec
from PySide6.QtCore import QSize, Qt, QTimer, Signal
from PySide6.QtGui import QImage, QPixmap
from PySide6.QtWidgets import QDialog, QLineEdit, QWidget

from app.editor.session import Session
from app.editor.translated import tr
from app.errors import AppError, Message, Progress, StopRequested
from app.performance.bodies import strained_on
from app.rig.characters.character_library import MOST_TITLE, character_named
from app.rig.people.body_shapes import age_of, years_of
from app.rig.people.bundled_people import bundled_people, like, person_of
from app.rig.people.looks_by_age import YOUNG_YEARS
from app.rig.people.person import Person, ranges
from instrument_maps.load import bundled_maps
from widgets.common.character_picture import Crop, picture, seen
from widgets.common.clicks import on_switch
from widgets.common.controls import Caption, Check, OkCancel, Retranslated, named, wrapped
from widgets.common.help import with_help
from widgets.common.instrument_name import character_name, instrument_name
from widgets.common.layouts import STRETCH, begin_with_size, in_column, in_form, in_row
from widgets.common.number_slider import NumberSlider
from widgets.common.plain import ComboBox, Label
from widgets.common.text import message_text

PICTURES_PX: Final[dict[Crop, QSize]] = {"head": QSize(280, 220), "body": QSize(280, 250)}
SOON_MS: Final = 60
"""Delay in milliseconds before a picture is drawn during a drag."""
LATER_MS: Final = 500
"""Delay in milliseconds after a drag before the instruments are tried, which takes a second or two."""


class PersonDialog(Retranslated, QDialog):
    """Dialog with sliders and a picture of a person.

    Parameters
    ----------
    title : str
        Name of the person.
    person : Person or None
        An existing person of the user to change; None for a new one.

    Signals
    -------
    agreed(str, object)
        The user accepted a title and a `Person`.
    """

    agreed = Signal(str, object)

    def __init__(
        self, session: Session, title: str = "", person: Person | None = None, parent: QWidget | None = None
    ) -> None:
        super().__init__(parent)
        self.setObjectName("person")
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self._session = session
        self.person = person or like(next(iter(bundled_people())), {})
        self._drawing = self._picture_requested = False
        self.title = named(QLineEdit(title), "person_title")
        self.title.setMaxLength(MOST_TITLE)
        self.like = named(ComboBox(), "person_like")
        self._is_new = person is None
        heights_m, years = ranges([self.person.original])
        self.sliders = {
            "height_m": NumberSlider(session, *heights_m, step=0.01, resets=False),
            "age": NumberSlider(session, *years, step=1.0, decimals=0, resets=False),
            "muscle": NumberSlider(session, 0.0, 100.0, default=50.0, step=5.0, decimals=0),
            "weight": NumberSlider(session, 0.0, 100.0, default=50.0, step=5.0, decimals=0),
        }
        for name, slider in self.sliders.items():
            slider.setObjectName(f"person_{name}")
            slider.changed.connect(lambda value, token, name=name: self._set(name, value))
        self.texted(self.sliders["height_m"], words=("person_dialog.height", "m", "person_dialog.height_tip"))
        self.texted(self.sliders["age"], words=("person_dialog.age", "person_dialog.years", "person_dialog.age_tip"))
        self.texted(self.sliders["muscle"], words=("person_dialog.muscle", "%", "person_dialog.muscle_tip"))
        self.texted(self.sliders["weight"], words=("person_dialog.weight", "%", "person_dialog.weight_tip"))
        self._pictures = {crop: named(Label(), f"person_{crop}") for crop in PICTURES_PX}
        self._looks_years = self.person.looks_years or YOUNG_YEARS
        self.looks_age = named(Check("person_dialog.looks_age"), "person_looks_age")
        self.texted(self.looks_age, tip="person_dialog.looks_age_tip")
        on_switch(self.looks_age, self._follow_age)
        self._explained = wrapped(Caption("person_dialog.hands_and_arms_stay"))
        self._buttons = OkCancel("person_dialog.keep", "person_dialog.cancel")
        self._soon = QTimer(self, singleShot=True, interval=SOON_MS)
        self._soon.timeout.connect(self._draw)
        self._strained = named(wrapped(Label()), "person_strained")
        self._strained_on: tuple[str, ...] | None = None
        self._later = QTimer(self, singleShot=True, interval=LATER_MS)
        self._later.timeout.connect(self._try_instruments)
        self._lay_out()
        self.like.activated.connect(lambda index: self._be_like(self.like.itemData(index)))
        self.title.textChanged.connect(lambda text: self._buttons.ok.setEnabled(bool(text.strip())))
        self._buttons.accepted.connect(self._agree)
        self._buttons.rejected.connect(self.reject)
        self._buttons.ok.setEnabled(bool(title.strip()))
        self.texted(self, title="person_dialog.title")
        self.retranslate()
        begin_with_size(self, QSize(700, 560))
        self.title.setFocus()
        self._show()

    def _lay_out(self) -> None:
        rows: dict[str, QWidget] = {"person_dialog.name": self.title}
        if self._is_new:
            rows["person_dialog.like"] = self.like
        for crop, size in PICTURES_PX.items():
            self._pictures[crop].setFixedSize(size)
            self._pictures[crop].setAlignment(Qt.AlignmentFlag.AlignCenter)
        fields = in_column(
            in_form(rows), *self.sliders.values(), self.looks_age, self._explained, self._strained, STRETCH
        )
        in_column(
            in_row(in_column(*self._pictures.values()), (fields, 1)),
            with_help(self._buttons),
            of=self,
            margins=14,
            spacing=10,
        )

    def _be_like(self, id: str) -> None:
        self.person = like(id, {})
        self._looks_years = self.person.looks_years
        self._show()

    def _follow_age(self, follows: bool) -> None:
        """Let hair and skin change with the age, or keep them as given."""
        self.person = msgspec.structs.replace(self.person, looks_years=self._looks_years if follows else 0.0)
        self._change()

    def _set(self, name: str, value: float) -> None:
        changed = {"height_m": value, "age": age_of(value)}.get(name, value / 100.0)
        phenotype = msgspec.structs.replace(self.person.phenotype, **{name: changed})
        self.person = msgspec.structs.replace(self.person, phenotype=phenotype)
        self._change()

    def _show(self) -> None:
        """Show the person's numbers, and redraw the person."""
        phenotype = self.person.phenotype
        heights_m, years = ranges([self.person.original])
        self.sliders["height_m"].set_range(*heights_m)
        self.sliders["age"].set_range(*years)
        self.sliders["height_m"].show_value(phenotype.height_m)
        self.sliders["age"].show_value(round(years_of(phenotype.age)))
        self.looks_age.setChecked(self.person.looks_years > 0.0)
        for name in ("muscle", "weight"):
            self.sliders[name].show_value(round(100.0 * getattr(phenotype, name)))
        self._change()

    def _change(self) -> None:
        """Redraw the person after a short delay, and later show which instruments it does not play."""
        self._strained_on = None
        self._say_strained()
        if not self._soon.isActive():
            # A drag that goes on must not put the picture off.
            self._soon.start()
        self._later.start()

    def _try_instruments(self) -> None:
        person = self.person

        def work(progress: Progress, stop_requested: StopRequested) -> tuple[str, ...]:
            return strained_on(person_of("person", person, character_named), person)

        def done(found: tuple[str, ...]) -> None:
            if person is self.person:
                self._strained_on = found
                self._say_strained()

        def failed(error: AppError) -> None:
            self._strained.setText(message_text(error.message))

        self._session.tasks.run(Message("work.person_instruments"), work, done, failed, key="person_instruments")

    def _say_strained(self) -> None:
        found = self._strained_on
        if found is None:
            self._strained.setText(tr("person_dialog.trying"))
        elif found:
            names = ", ".join(instrument_name(bundled_maps()[id]) for id in found)
            self._strained.setText(tr("person_dialog.strained").format(names=names))
        else:
            self._strained.setText(tr("person_dialog.plays_all"))

    def _draw(self) -> None:
        if self._drawing:
            self._picture_requested = True
            return
        person, ratio = self.person, self.devicePixelRatioF()

        def work(progress: Progress, stop_requested: StopRequested) -> dict[Crop, QImage]:
            shown = seen(person_of("person", person, character_named))
            sizes = {crop: size * ratio for crop, size in PICTURES_PX.items()}
            return {crop: picture(shown, size.width(), size.height(), crop) for crop, size in sizes.items()}

        def done(drawn: dict[Crop, QImage]) -> None:
            for crop, one in drawn.items():
                image = QPixmap.fromImage(one)
                image.setDevicePixelRatio(ratio)
                self._pictures[crop].setPixmap(image)

        def failed(error: AppError) -> None:
            self._pictures["body"].setText(message_text(error.message))

        self._drawing = True
        self._session.tasks.run(
            Message("work.character_picture"), work, done, failed, key="person_picture", ended=self._drawn
        )

    def _drawn(self) -> None:
        self._drawing = False
        if self._picture_requested:
            self._picture_requested = False
            self._soon.start()

    def _agree(self) -> None:
        self.agreed.emit(self.title.text(), self.person)
        self.accept()

    def retranslate(self) -> None:
        chosen = self.like.currentIndex()
        self.like.clear()
        for id in bundled_people():
            self.like.addItem(character_name(id), id)
        self.like.setCurrentIndex(max(chosen, 0))
        self._say_strained()
