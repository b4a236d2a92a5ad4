"""Dialog for adding a character from a file: joints, face shapes, and a list of what will not be animated.

The display depends only on `DraftHistory.now` and the figure; every change is made by `CharacterDialog.change` and can
be undone. Pictures are drawn in the background, only for the latest state.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Final

from PySide6.QtCore import QSize, Qt, QTimer, Signal
from PySide6.QtGui import QColor, QImage, QKeyEvent, QKeySequence, QPixmap
from PySide6.QtWidgets import QCheckBox, QDialog, QLineEdit, QScrollArea, QTabWidget, QTreeWidgetItem, QWidget

from app.editor.session import Session
from app.encoding import shown
from app.errors import AppError, Message, Progress, StopRequested
from app.rig.characters.character_library import LEAST_M, MOST_M
from app.rig.characters.figure_build import ODD_HEIGHT, figure_height
from app.rig.figure import Figure
from app.rig.grip.fitting.fitted_instrument import notes_on_body
from widgets.common.character_picture import Crop, Seen, picture, seen
from widgets.common.controls import Button, ColumnList, OkCancel, Retranslated, named, selectable, wrapped
from widgets.common.help import HelpButton
from widgets.common.icons import icon
from widgets.common.layouts import STRETCH, Scrolled, begin_with_size, in_column, in_form, in_row, panel
from widgets.common.plain import Label, verbatim, verbatim_title
from widgets.common.text import message_text, sentence
from widgets.dialogs.automatic_number import AutomaticNumber
from widgets.dialogs.body_map import BodyMap, joints
from widgets.dialogs.bone_tree import BoneTree
from widgets.dialogs.character_draft import (
    CharacterDraft,
    DraftHistory,
    character_of,
    found_by_itself,
    joint_name,
    mapped,
    not_played,
    notes_beside_joints,
    nothing_shown,
)
from widgets.dialogs.face_map_page import FaceMapPage
from widgets.dialogs.mesh_list import MeshList

PICTURE_PX: Final = QSize(250, 340)
_LEAST_WORDS_PX: Final = 72
_LEAST_LIST_PX: Final = 230
_SOON_MS: Final = 60
"""Delay in milliseconds before a picture is drawn during a drag."""


class CharacterDialog(Retranslated, QDialog):
    """Dialog that maps the bones and morphs of a character's file, and adds the character.

    Parameters
    ----------
    path : Path
        Path of the file, for its name.
    draft : CharacterDraft
        Initial settings.
    offered : str
        Name of the player or players that may get the character; empty for none.

    Signals
    -------
    agreed(object, bool)
        The user accepted a `CharacterDraft`; True if the selected players get the character.
    """

    agreed = Signal(object, bool)

    def __init__(
        self,
        session: Session,
        path: Path,
        figure: Figure,
        draft: CharacterDraft,
        offered: str = "",
        parent: QWidget | None = None,
    ) -> None:
        super().__init__(parent)
        self.setObjectName("character")
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self._session, self._path, self._figure, self._offered = session, path, figure, offered
        self._first, self._steps = draft, DraftHistory(draft)
        self._made = mapped(figure, draft)
        self._joint = ""
        self._seen: tuple[tuple[object, ...], Seen, tuple[Message, ...]] | None = None
        """A character ready to be drawn, and what it was made from."""
        self._drawing = False
        self._picture_requested = False
        self.title = named(QLineEdit(draft.title), "character_title")
        self.body_height = self.texted(
            AutomaticNumber("character_height", LEAST_M, MOST_M, step=0.05, decimals=2),
            tip="character_dialog.height_of_player",
        )
        self.body_height.number.setSuffix(" m")
        self._source, self._picture = selectable(wrapped(Label())), named(Label(), "character_picture")
        self._reported = named(wrapped(Label()), "character_status")
        self._legend = [(Label(sign), Label()) for sign in ("●", "◉", "○")]
        self.body = self.texted(BodyMap(session, self._joint_text), name="character_dialog.joints_of_body")
        self.rows = ColumnList("joint_list", "character_dialog.joint", "character_dialog.bone", stretches=(1,))
        self._items = {joint: QTreeWidgetItem() for joint in joints()}
        self.bones = BoneTree(session, figure)
        self.faces = FaceMapPage(session, figure.morph_names)
        self.meshes = MeshList(figure)
        self.tabs = named(QTabWidget(), "character_tabs")
        self._none = Button("character_dialog.no_bone", lambda: self._give_bone(""), "joint_none")
        self._automatic = Button("character_dialog.automatic", lambda: self._give_bone(None), "joint_automatic")
        self._undo = Button("character_dialog.undo", self.undo, "character_undo")
        self._redo = Button("character_dialog.redo", self.redo, "character_redo")
        self._reset = Button("character_dialog.reset_all", lambda: self.change(self._untouched()), "character_reset")
        self.give = named(QCheckBox(), "character_give")
        self._buttons = OkCancel("character_dialog.keep_character", "character_dialog.cancel")
        self._soon = QTimer(self, singleShot=True, interval=_SOON_MS)
        self._soon.timeout.connect(self._draw)
        self._build()
        self._connect()
        self.texted(self.bones.search, placeholder="character_dialog.search_bones")
        self.retranslate()
        begin_with_size(self, QSize(1300, 760))
        self._choose_first()

    def _untouched(self) -> CharacterDraft:
        """Return a draft with the present title and otherwise automatic settings."""
        return found_by_itself(self._figure, self.draft.title)

    # Construction

    def _build(self) -> None:
        self.rows.setMinimumWidth(_LEAST_LIST_PX)
        self.bones.setMinimumWidth(_LEAST_LIST_PX)
        for joint, item in self._items.items():
            item.setData(0, Qt.ItemDataRole.UserRole, joint)
            self.rows.addTopLevelItem(item)
        self._reported.setAlignment(Qt.AlignmentFlag.AlignTop)
        self._reported.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        self._picture.setFixedSize(PICTURE_PX)
        self._picture.setAlignment(Qt.AlignmentFlag.AlignCenter)
        legend = in_row(STRETCH)
        for sign, text in self._legend:
            legend.addWidget(sign)
            legend.addWidget(text)
            legend.addSpacing(8)
        legend.addStretch(1)
        drawn = in_column((self.body, 1), legend)
        choice = in_column((self.bones, 1), in_row(self._none, self._automatic))
        body_page = panel(in_row((drawn, 5), (self.rows, 4), (choice, 5), margins=(0, 8, 0, 0)))
        self.tabs.addTab(body_page, "")
        self.tabs.addTab(self.faces, "")
        self.tabs.addTab(self.meshes, "")
        self.texted(self.tabs, tabs=("character_dialog.body", "character_dialog.face", "character_dialog.meshes"))
        words = QScrollArea()
        words.setWidget(self._reported)
        words.setWidgetResizable(True)
        words.setFrameShape(QScrollArea.Shape.NoFrame)
        words.setMinimumHeight(_LEAST_WORDS_PX)
        title = in_form({"character_dialog.name": self.title, "character_dialog.height": self.body_height})
        shown = (self._picture, 0, Qt.AlignmentFlag.AlignHCenter)
        side = panel(in_column(title, self._source, shown, (words, 1), margins=(8, 0, 0, 0), spacing=8))
        side.setFixedWidth(PICTURE_PX.width() + 20)
        middle = in_row((self.tabs, 1), side)
        bottom = in_row(HelpButton(), self._undo, self._redo, self._reset, STRETCH, self.give, self._buttons)
        in_column((Scrolled(middle), 1), bottom, of=self, margins=8)

    def _connect(self) -> None:
        self.body.chosen.connect(self.choose)
        self.body.opened.connect(self._open)
        self.rows.currentItemChanged.connect(self._row_chosen)
        self.rows.itemActivated.connect(lambda item, column: self._open(item.data(0, Qt.ItemDataRole.UserRole)))
        self.bones.chosen.connect(lambda bone: self._give_bone(bone))
        self.faces.chosen.connect(self._ask_picture)
        self.faces.changed.connect(lambda face, parts, gesture: self.change(self.draft.with_face(face, parts), gesture))
        self.meshes.changed.connect(lambda hidden: self.change(replace(self.draft, hidden=hidden)))
        self.tabs.currentChanged.connect(self._ask_picture)
        self.title.textEdited.connect(self._rename)
        self.body_height.changed.connect(self._resize_figure)
        self._buttons.accepted.connect(self._agree)
        self._buttons.rejected.connect(self.reject)
        self._session.theme_changed.connect(self._show)

    # User actions

    @property
    def draft(self) -> CharacterDraft:
        """The draft of the character as edited so far."""
        return self._steps.now

    @property
    def joint(self) -> str:
        """Name of the selected joint."""
        return self._joint

    def choose(self, joint: str) -> None:
        """Select a joint, whose bone is then shown and can be changed."""
        if joint == self._joint:
            return
        self._joint = joint
        self.body.choose(joint)
        self.rows.setCurrentItem(self._items[joint])
        self.rows.scrollToItem(self._items[joint])
        self.bones.reveal(self._made.joints.bones.get(joint))
        self._show_choice()

    def _choose_first(self) -> None:
        """Select the first joint that is missing or uncertain, else the hips."""
        wrong = [*self._made.lacking, *self._made.joints.doubtful]
        self.choose(wrong[0] if wrong else "hips")

    def _row_chosen(self, item: QTreeWidgetItem | None, before: QTreeWidgetItem | None = None) -> None:
        if item is not None:
            self.choose(item.data(0, Qt.ItemDataRole.UserRole))

    def _open(self, joint: str) -> None:
        self.choose(joint)
        self.bones.search.setFocus(Qt.FocusReason.OtherFocusReason)
        self.bones.search.selectAll()

    def _give_bone(self, bone: str | None) -> None:
        self.change(self.draft.with_joint(self._joint, bone))
        self.bones.search.clear()
        self.bones.reveal(self._made.joints.bones.get(self._joint))

    def _rename(self, title: str) -> None:
        # Typing one title is one step.
        self.change(replace(self.draft, title=title), self.title)

    def _resize_figure(self) -> None:
        self.change(replace(self.draft, height_m=self.body_height.value or 0.0))

    def change(self, draft: CharacterDraft, gesture: object | None = None) -> None:
        """Apply a draft; all changes of one gesture are a single undo step."""
        if self._steps.apply(draft, gesture):
            self._changed()

    def undo(self) -> None:
        """Undo the last change of the character's draft."""
        self._steps.undo()
        self._changed()

    def redo(self) -> None:
        """Redo the last undone change."""
        self._steps.redo()
        self._changed()

    def _changed(self) -> None:
        self._made = mapped(self._figure, self.draft, self._made)
        if self.title.text() != self.draft.title:
            self.title.setText(self.draft.title)
        self._show()

    def _agree(self) -> None:
        self.agreed.emit(self.draft, self.give.isEnabled() and self.give.isChecked())
        self.accept()

    # Display

    def _show(self) -> None:
        made, tokens = self._made, self._session.tokens
        self.body_height.show_value(self.draft.height_m or None, figure_height(self._figure))
        self.body.show_states({joint: made.state(joint) for joint in self._items})
        colours = {"mapped": tokens.text, "doubtful": tokens.warning, "missing": tokens.text_dim}
        marks = {"mapped": ("check", tokens.good), "doubtful": ("warning", tokens.warning)}
        for joint, item in self._items.items():
            state = made.state(joint)
            bone = made.joints.bones.get(joint)
            item.setText(0, joint_name(joint))
            item.setText(1, "—" if bone is None else self._figure.bone_names[bone])
            item.setForeground(0, QColor(colours[state]))
            item.setForeground(1, QColor(tokens.by_hand if joint in self.draft.joints else colours[state]))
            mark, colour = marks.get(state, ("close", tokens.text_dim))
            needed = joint in made.lacking
            item.setIcon(0, icon("error" if needed else mark, tokens, tokens.error if needed else colour))
            item.setToolTip(0, self._joint_text(joint))
        self.bones.show_used({bone: joint_name(joint) for bone, joint in made.used.items()})
        self.faces.show_parts(made.faces.morphs, frozenset(self.draft.morphs))
        self.meshes.show_hidden(self.draft.hidden)
        self._show_reported()
        self._reported.setStyleSheet(f"color: {tokens.error if made.lacking else tokens.text};")
        self._picture.setStyleSheet(
            f"#character_picture {{ background: {tokens.sunken}; border: 1px solid {tokens.line};"
            " border-radius: 6px; }"
        )
        states = (
            (tokens.good, self.tr("character_dialog.found")),
            (tokens.warning, self.tr("character_dialog.guess")),
            (tokens.text_dim, self.tr("character_dialog.none")),
        )
        for (sign, text), (colour, word) in zip(self._legend, states, strict=True):
            sign.setStyleSheet(f"color: {colour};")
            text.setText(word)
        self._undo.setEnabled(self._steps.can_undo)
        self._redo.setEnabled(self._steps.can_redo)
        self._reset.setEnabled(self.draft != self._untouched())
        shown = not nothing_shown(self._figure, self.draft)
        self._buttons.ok.setEnabled(not made.lacking and shown and bool(self.draft.title.strip()))
        self._show_choice()
        self._ask_picture()

    def _show_reported(self) -> None:
        """Show what will not be animated, and whether the character can hold an instrument."""
        reported = [sentence(note) for note in self._figure.notes if note.id != ODD_HEIGHT]
        reported += not_played(self._figure, self._made)
        if self._seen is not None:
            reported += [sentence(note) for note in notes_beside_joints(self._made, self._seen[2])]
        self._reported.setText(
            "\n".join(f"• {text}" for text in reported) if reported else self.tr("character_dialog.all_supported")
        )

    def _show_choice(self) -> None:
        self._none.setEnabled(self._joint in self._made.joints.bones)
        self._automatic.setEnabled(self._joint in self.draft.joints)

    def _joint_text(self, joint: str) -> str:
        """Return a joint, its bone and the bone's reliability as text."""
        state, bone = self._made.state(joint), self._made.joints.bones.get(joint)
        bone_name = "" if bone is None else self._figure.bone_names[bone]
        words = {
            "mapped": self.tr("character_dialog.text"),
            "doubtful": self.tr("character_dialog.bone_guessed"),
            "missing": self.tr("character_dialog.bone_missing"),
        }[state]
        return words.format(joint=joint_name(joint), bone=bone_name)

    # Picture

    def _ask_picture(self, *_: object) -> None:
        if not self._soon.isActive():
            self._soon.start()

    def _draw(self) -> None:
        if self._drawing:
            self._picture_requested = True
            return
        if self._made.lacking:
            self._picture.setText(self.tr("character_dialog.no_preview"))
            return
        figure, made, known = self._figure, self._made, self._seen
        key = (made.joints.bones, made.faces.morphs, made.draft.height_m, made.draft.hidden)
        crop: Crop = "head" if self.tabs.currentIndex() == 1 else "body"
        face, ratio = self.faces.face if crop == "head" else "", self.devicePixelRatioF()
        width, height = round(PICTURE_PX.width() * ratio), round(PICTURE_PX.height() * ratio)

        def work(progress: Progress, stop_requested: StopRequested) -> tuple[Seen, tuple[Message, ...], QImage]:
            if known is not None and known[0] == key:
                _, shown, notes = known
            else:
                character = character_of(figure, made)
                shown, notes = seen(character), notes_on_body(character)
            return shown, notes, picture(shown, width, height, crop, {face: 1.0} if face else None)

        def done(drawn: tuple[Seen, tuple[Message, ...], QImage]) -> None:
            self._seen = (key, *drawn[:2])
            self._show_reported()
            image = QPixmap.fromImage(drawn[2])
            image.setDevicePixelRatio(ratio)
            self._picture.setPixmap(image)

        def failed(error: AppError) -> None:
            self._picture.setText(message_text(error.message))

        self._drawing = True
        self._session.tasks.run(
            Message("work.character_picture"), work, done, failed, key="character_picture", ended=self._drawn
        )

    def _drawn(self) -> None:
        self._drawing = False
        if self._picture_requested:
            self._picture_requested = False
            self._ask_picture()

    # Texts

    def retranslate(self) -> None:
        self.setWindowTitle(verbatim_title(self.tr("character_dialog.character").format(file=shown(self._path.name))))
        self._source.setText(
            self.tr("character_dialog.bones_morphs").format(
                file=shown(self._path.name), bones=len(self._figure.bone_names), morphs=len(self._figure.morph_names)
            )
        )
        self.bones.set_headers([self.tr("character_dialog.bone_of_file"), self.tr("character_dialog.joint")])
        self.body_height.check.setText(self.tr("character_dialog.height_of_file"))
        self.give.setText(verbatim(self.tr("character_dialog.assign_to_players").format(players=self._offered)))
        self.give.setVisible(bool(self._offered))
        self._show()

    # Qt overrides

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Handle the shortcuts of undo and redo, regardless of the field with the keyboard focus."""
        if event.matches(QKeySequence.StandardKey.Undo):
            self.undo()
        elif event.matches(QKeySequence.StandardKey.Redo):
            self.redo()
        else:
            super().keyPressEvent(event)
