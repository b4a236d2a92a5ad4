"""Section for making expressions: sliders of morphs with live preview, stored in the project or for other projects."""

from __future__ import annotations

from collections.abc import Callable

import msgspec
import shiboken6
from PySide6.QtCore import QCoreApplication, QEvent, Qt, Signal
from PySide6.QtWidgets import QGridLayout, QLineEdit, QToolButton, QWidget

from app.editor.session import Session, Severity
from app.errors import AppError, Message
from app.project import presets
from app.project.edit import piece as edit
from app.project.edit.players import free_name
from app.project.model import Project
from app.project.undoable_document import Change
from metadata.load import load_expressions
from metadata.model import ARKIT_MORPHS, Expression
from widgets.common.clicks import on_click, on_switch
from widgets.common.combo import Combo, Option
from widgets.common.controls import Check, Retranslated, named
from widgets.common.event_names import expression_name
from widgets.common.icons import icon
from widgets.common.layouts import in_column, in_row, panel
from widgets.common.morph_names import morph_name
from widgets.common.number_slider import NumberSlider
from widgets.common.plain import Label
from widgets.common.section import Section
from widgets.inspector.face_picture import FacePicture

GROUPS: tuple[tuple[str, tuple[str, ...]], ...] = (
    ("brows", ("brow",)),
    ("eyes", ("eye",)),
    ("jaw", ("jaw",)),
    ("mouth", ("mouth",)),
    ("rest", ("cheek", "nose", "tongue")),
)
"""Groups of morph targets by the beginning of their names."""
_TOOLS = (
    ("duplicate", "duplicate", "expression_maker.duplicate_tip"),
    ("remove", "delete", ""),
    ("keep", "save", "expression_maker.keep_it_for_other_projects"),
    ("both", "link", "expression_maker.both_sides_tip"),
    ("preview", "eye", "expression_maker.preview_tip"),
)
"""Buttons with their pictures and the ids of their tips; the tip of the second depends on the expression."""


def mirrored(morph: str) -> str:
    """Return the name of the corresponding morph target of the other side; the same name for one in the middle."""
    if morph in ("jawLeft", "jawRight", "mouthLeft", "mouthRight"):
        # These move the mouth's middle sideways: they are opposites, not a pair.
        return morph
    if morph.endswith("Left"):
        return morph.removesuffix("Left") + "Right"
    return morph.removesuffix("Right") + "Left" if morph.endswith("Right") else morph


class ExpressionMaker(Retranslated, QWidget):
    """Section that shows an expression as sliders, and previews it on the active player.

    Signals
    -------
    folded()
        The section was folded or unfolded.
    """

    folded = Signal()

    def __init__(self, session: Session, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._session = session
        self._name: str | None = None
        self._kept: dict[str, Expression] = {}
        self._section = Section(session, "inspector_expressions", self, folded=True, remembers=False)
        self._choice = named(Combo(), "expression_choice")
        self._tools = {name: self.texted(QToolButton(), tip=tip_id) for name, _, tip_id in _TOOLS}
        self._title = self.texted(named(QLineEdit(), "expression_name"), placeholder="expression_maker.name")
        self._playing = self.texted(
            named(Check("expression_maker.may_show_while_playing"), "expression_while_playing"),
            tip="expression_maker.lips_hint",
        )
        self._hint = Label()
        self._picture = FacePicture(session)
        self._fades = {
            name: NumberSlider(session, 0.01, 60, step=0.05, fills=(0.0, 3.0), resets=False)
            for name in ("fade_in_s", "fade_out_s")
        }
        for name, slider in self._fades.items():
            text_id = f"expression_maker.{name.removesuffix('_s')}"
            self.texted(slider, words=(text_id, "expression_maker.seconds"))
        self._groups: dict[str, Section] = {}
        self._sliders: dict[str, NumberSlider] = {}
        self._build()
        self._connect()
        self._apply_theme()
        self.texted(self._section.header, words=("expression_maker.expressions",))
        self.retranslate()

    def _build(self) -> None:
        body = self._section.body
        line = in_row((self._choice, 1), spacing=2)
        for name, button in self._tools.items():
            button.setObjectName(f"expression_{name}")
            if name in ("both", "preview"):
                button.setCheckable(True)
                button.setChecked(True)
            line.addWidget(button)
        body.addLayout(line)
        self._hint.setWordWrap(True)
        body.addWidget(self._hint)
        body.addWidget(self._picture)
        body.addWidget(self._title)
        body.addWidget(self._playing)
        fades = QGridLayout()
        fades.setSpacing(4)
        for column, (name, slider) in enumerate(self._fades.items()):
            slider.setObjectName(f"expression_{name}")
            fades.addWidget(slider, 0, column)
        body.addLayout(fades)
        self._faces_layout = in_column(margins=(0, 4, 0, 0), spacing=0)
        self._faces = panel(self._faces_layout)
        body.addWidget(self._faces)
        in_column(self._section, of=self, margins=0)

    def _make_sliders(self) -> None:
        """Make the 52 sliders when they are first visible."""
        for group, beginnings in GROUPS:
            section = Section(self._session, f"morphs_{group}", folded=group not in ("brows", "eyes"))
            section.body.setContentsMargins(0, 4, 0, 6)
            for morph in sorted(ARKIT_MORPHS, key=ARKIT_MORPHS.index):
                if not morph.startswith(beginnings):
                    continue
                slider = named(NumberSlider(self._session, 0, 1, step=0.05), f"morph_{morph}")
                slider.changed.connect(lambda value, token, morph=morph: self._set_morph(morph, value, token))
                slider.released.connect(self._session.document.end_gesture)
                self._sliders[morph] = slider
                section.body.addWidget(slider)
            self._groups[group] = section
            self._faces_layout.addWidget(section)
        self._name_sliders()

    def _connect(self) -> None:
        session = self._session
        self._section.header.toggled.connect(self._unfolded)
        self._choice.chosen.connect(self._choose)
        self._title.editingFinished.connect(self._rename)
        on_switch(self._playing, lambda playing: self._put(None, while_playing=playing))
        for name, slider in self._fades.items():
            slider.changed.connect(lambda value, token, name=name: self._put(token, **{name: value}))
            slider.released.connect(session.document.end_gesture)
        on_click(self._tools["duplicate"], self.duplicate)
        on_click(self._tools["remove"], self._remove)
        on_click(self._tools["keep"], self._keep)
        self._tools["preview"].toggled.connect(self._preview)
        session.changed.connect(self._changed)
        session.players_changed.connect(self._preview)
        session.theme_changed.connect(self._apply_theme)

    # Display

    @property
    def is_open(self) -> bool:
        """True if the sliders are visible."""
        return self._section.is_open

    @property
    def expression(self) -> Expression | None:
        """The displayed expression; it can be edited if it is the project's own."""
        own = {item.name: item for item in self._session.project.expressions}
        return {**self._kept, **load_expressions(), **own}.get(self._name or "")

    @property
    def editable(self) -> bool:
        """True if the expression is the project's own."""
        return any(item.name == self._name for item in self._session.project.expressions)

    def _unfolded(self, is_open: bool) -> None:
        if is_open and not self._sliders:
            self._make_sliders()
        if is_open:
            found = presets.expressions(presets.expression_folder())
            self._kept = dict(found.items)
            for problem in found.problems:
                self._session.notice(problem, Severity.WARNING)
            if self.expression is None:
                own = self._session.project.expressions
                self._name = own[0].name if own else next(iter(load_expressions()))
        self.show_expression()
        self.folded.emit()

    def show_expression(self) -> None:
        """Display the weights of the chosen expression."""
        if not self._section.is_open:
            self._preview()
            return
        own = [item.name for item in self._session.project.expressions]
        bundled = [name for name in load_expressions() if name not in own]
        kept = [name for name in self._kept if name not in own and name not in bundled]
        options = [Option(name, f"● {name}") for name in own]
        options += [Option(name, expression_name(name)) for name in bundled]
        options += [Option(name, self.tr("expression_maker.kept").format(name=name)) for name in kept]
        self._choice.set_options(options)
        expression, editable, from_folder = self.expression, self.editable, self._name in kept
        self._choice.show_option(self._name if expression is not None else None)
        self._hint.setText(
            ""
            if editable
            else self.tr("expression_maker.comes_from_your_folder_use")
            if from_folder
            else self.tr("expression_maker.bundled_hint")
        )
        self._hint.setVisible(not editable)
        self._title.setVisible(editable)
        for widget in (self._playing, *self._fades.values(), *self._sliders.values()):
            widget.setEnabled(editable)
        self._tools["keep"].setEnabled(editable)
        self._tools["remove"].setEnabled(editable or from_folder)
        self._tools["remove"].setToolTip(
            self.tr("expression_maker.delete_it_from_your_folder")
            if from_folder
            else self.tr("expression_maker.remove_it_from_project")
        )
        if expression is not None:
            if not self._title.hasFocus():
                self._title.setText(expression.name)
            self._playing.setChecked(expression.while_playing)
            for name, slider in self._fades.items():
                slider.show_value(getattr(expression, name), by_hand=False)
            for morph, slider in self._sliders.items():
                slider.show_value(expression.weights.get(morph, 0.0))
            self._count_groups(expression)
        self._preview()

    def _count_groups(self, expression: Expression) -> None:
        for group, beginnings in GROUPS:
            used = sum(1 for morph, weight in expression.weights.items() if weight and morph.startswith(beginnings))
            self._groups[group].header.set_texts(self._group_title(group), str(used) if used else "")

    def _preview(self, *_: object) -> None:
        """Preview the expression on the active player while the section is open."""
        expression = self.expression
        seen = self._section.is_open and self.isVisible() and expression is not None
        live = seen and self._tools["preview"].isChecked()
        self._picture.show_face(dict(expression.weights) if seen and expression is not None else None)
        self._session.set_preview_morphs(dict(expression.weights) if live and expression is not None else None)

    def _changed(self, change: Change) -> None:
        if change.before.expressions is not change.after.expressions or change.opened:
            if self.expression is None:
                self._name = next(iter(load_expressions()))
            self.show_expression()

    # Editing

    def _choose(self, name: str) -> None:
        self._name = name
        self.show_expression()

    def _attempt(self, name: str, change: Callable[[Project], Project], token: object | None = None) -> bool:
        message = Message(name, {"expression": self._name or ""})
        return self._session.attempt(message, change, token)

    def _put(self, token: object | None, **fields: object) -> None:
        expression = self.expression
        if expression is not None and self.editable:
            changed = msgspec.structs.replace(expression, **fields)
            self._attempt("edit.change_expression", lambda project: edit.put_expression(project, changed), token)

    def _set_morph(self, morph: str, value: float, token: object | None) -> None:
        expression = self.expression
        if expression is None:
            return
        morphs = {morph, mirrored(morph)} if self._tools["both"].isChecked() else {morph}
        weights = {**expression.weights, **dict.fromkeys(morphs, value)}
        kept = {name: weights[name] for name in ARKIT_MORPHS if weights.get(name)}
        self._put(token, weights=kept)

    def duplicate(self) -> None:
        """Copy the expression into the project under a new name; one from the user's folder keeps its name."""
        expression = self.expression
        if expression is None:
            return
        own = {item.name for item in self._session.project.expressions}
        taken = {*own, *load_expressions(), *self._kept}
        from_folder = expression.name in self._kept and expression.name not in own | set(load_expressions())
        name = expression.name if from_folder else free_name(expression_name(expression.name), taken)
        made = msgspec.structs.replace(expression, name=name)
        if self._attempt("edit.own_expression", lambda project: edit.put_expression(project, made)):
            self._name = name
            self.show_expression()
            self._title.setFocus(Qt.FocusReason.OtherFocusReason)
            self._title.selectAll()

    def _rename(self) -> None:
        expression, name = self.expression, self._title.text()
        if expression is None or not self.editable or name == expression.name:
            return
        renamed = msgspec.structs.replace(expression, name=name)
        former = self._name
        before = {item.name for item in self._session.project.expressions}
        self._name = None
        done = self._attempt(
            "edit.rename_expression", lambda project: edit.put_expression(project, renamed, former_name=former)
        )
        fresh = [item.name for item in self._session.project.expressions if item.name not in before]
        self._name = fresh[0] if done and fresh else former
        self._title.setText(self._name or "")
        self.show_expression()

    def _remove(self) -> None:
        name = self._name
        if name is not None and self.editable:
            self._attempt("edit.remove_expression", lambda project: edit.remove_expression(project, name))
        elif name in self._kept:
            self._forget(name)

    def _forget(self, name: str) -> None:
        """Delete an expression from the user's folder; projects that contain it keep it."""
        try:
            presets.delete_expression(presets.expression_folder(), name)
        except AppError as error:
            self._session.notice(error.message, Severity.ERROR)
            return
        self._kept = dict(presets.expressions(presets.expression_folder()).items)
        self._name = next(iter(load_expressions()))
        self.show_expression()

    def _keep(self) -> None:
        """Save the expression in the user's folder for other projects."""
        expression = self.expression
        if expression is None:
            return
        try:
            presets.save_expression(presets.expression_folder(), expression)
        except AppError as error:
            self._session.notice(error.message, Severity.ERROR)
            return
        self._kept = dict(presets.expressions(presets.expression_folder()).items)
        self._session.notice(Message("expression.kept", {"name": expression.name}))

    # Texts and pictures

    def _group_title(self, group: str) -> str:
        return {
            "brows": self.tr("expression_maker.brows"),
            "eyes": self.tr("expression_maker.eyes"),
            "jaw": self.tr("expression_maker.jaw"),
            "mouth": self.tr("expression_maker.mouth"),
            "rest": self.tr("expression_maker.cheeks_nose_tongue"),
        }[group]

    def _name_sliders(self) -> None:
        for morph, slider in self._sliders.items():
            slider.set_texts(morph_name(morph), "", morph)
        for group, section in self._groups.items():
            section.header.set_texts(self._group_title(group))

    def _apply_theme(self) -> None:
        tokens = self._session.tokens
        for name, drawing, _ in _TOOLS:
            self._tools[name].setIcon(icon(drawing, tokens))
        self._hint.setStyleSheet(f"color: {tokens.text_dim};")

    def retranslate(self) -> None:
        self._name_sliders()
        self.show_expression()

    # Qt overrides

    def showEvent(self, event: QEvent) -> None:
        self._preview()

    def hideEvent(self, event: QEvent) -> None:
        # Windows closed at exit hide their children after everything else was deleted.
        if not QCoreApplication.closingDown() and shiboken6.isValid(self._session):
            self._picture.show_face(None)
            self._session.set_preview_morphs(None)
