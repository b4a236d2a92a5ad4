"""Panel that shows the body read from a motion file next to the file's own skeleton, with correction of bones."""

from __future__ import annotations

from typing import Final

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QColor, QKeySequence, QShortcut
from PySide6.QtWidgets import QSizePolicy, QToolButton, QTreeWidgetItem, QWidget

from app.choreography.body_pose import body_pose, knee_caps, t_pose_of
from app.choreography.raw_skeleton import JOINTS, REQUIRED, RawSkeleton
from app.editor.design_tokens import LEAST_TARGET_PX
from app.editor.session import Session
from app.rig.characters.joint_mapping import JointMapping
from widgets.common.clicks import on_click
from widgets.common.controls import Button, Caption, ColumnList, IconButton, Retranslated, named, wrapped
from widgets.common.icons import icon
from widgets.common.layouts import in_column, in_row
from widgets.common.plain import Label
from widgets.common.text import message_text
from widgets.dialogs.body_map import BodyMap, joints
from widgets.dialogs.bone_tree import BoneTree
from widgets.dialogs.character_draft import DraftHistory, State, joint_name
from widgets.dialogs.choreography.body_view import VIEWS, BodyView, ViewName
from widgets.dialogs.choreography.cut_figure import PoseFigure, SkeletonFigure, skeleton_pose
from widgets.dialogs.choreography.learn_draft import PairContents

_LEAST_MAP_PX: Final = 190
_LEAST_LIST_PX: Final = 250
_PICTURE_PX: Final = 136
_VIEW_TEXTS: Final[dict[ViewName, tuple[str, str]]] = {
    "front": ("body_panel.front", "body_panel.from_front"),
    "side": ("body_panel.side", "body_panel.from_right"),
    "three_quarter": ("body_panel.three_quarter", "body_panel.from_front_right"),
}
"""Text and tool tip ids of the views."""


class BodyPanel(Retranslated, QWidget):
    """Panel with three pictures of the body that are orbited together, and lists of the joints and of the file's bones.

    Signals
    -------
    changed()
        The user corrected a bone or undid that; the present corrections are in `DraftHistory.now`.
    """

    changed = Signal()

    def __init__(self, session: Session, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._session = session
        self._found, self._history = PairContents(), DraftHistory.empty()
        self._skeleton: RawSkeleton | None = None
        self._mapping = JointMapping("", {}, (), ())
        self._joint = ""
        self.raw = named(SkeletonFigure(session, is_fitted=True), "body_raw")
        self.first = named(PoseFigure(session, is_fitted=True), "body_first")
        self.rest = named(PoseFigure(session, is_fitted=True), "body_rest")
        self._views = {name: self._view_button(name) for name in VIEWS}
        self.body = self.texted(BodyMap(session, self._joint_text), name="character_dialog.joints_of_body")
        self.rows = ColumnList("body_joints", "character_dialog.joint", "character_dialog.bone", stretches=(1,))
        self._items = {joint: QTreeWidgetItem() for joint in joints() if joint in JOINTS}
        self._bones: BoneTree | None = None
        self._none = Button("character_dialog.no_bone", lambda: self._give(""), "body_no_bone")
        self._automatic = Button("character_dialog.automatic", lambda: self._give(None), "body_automatic")
        self._undo = IconButton(session, "undo", "cut_panel.undo_ctrl_z", self.undo, "body_undo")
        self._redo = IconButton(session, "redo", "cut_panel.redo_ctrl_shift_z", self.redo, "body_redo")
        self._reset = Button("character_dialog.reset_all", self._reset_all, "body_reset")
        self._said = wrapped(named(Label(), "body_said"))
        self._build()
        self.body.chosen.connect(self.choose)
        self.body.opened.connect(self._open)
        self.rows.currentItemChanged.connect(self._row_chosen)
        self.rows.itemActivated.connect(lambda item, column: self._open(item.data(0, Qt.ItemDataRole.UserRole)))
        for key, step in ((QKeySequence.StandardKey.Undo, self.undo), (QKeySequence.StandardKey.Redo, self.redo)):
            QShortcut(QKeySequence(key), self).activated.connect(step)
        session.theme_changed.connect(self._show)
        self.show_from(VIEWS["front"])
        self.retranslate()

    def _build(self) -> None:
        for figure in (self.raw, self.first, self.rest):
            figure.setMinimumWidth(_PICTURE_PX)
            figure.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)
            figure.orbited.connect(self.show_from)
            self.texted(figure, tip="body_panel.figure_tip")
        for joint, item in self._items.items():
            item.setData(0, Qt.ItemDataRole.UserRole, joint)
            self.rows.addTopLevelItem(item)
        self.body.setMinimumSize(_LEAST_MAP_PX, _LEAST_MAP_PX)
        self.rows.setMinimumWidth(_LEAST_LIST_PX)
        pictures = [
            in_column(Caption(text_id), (figure, 1), spacing=2)
            for text_id, figure in (
                ("body_panel.in_file", self.raw),
                ("body_panel.as_read", self.first),
                ("body_panel.t_pose", self.rest),
            )
        ]
        self._choice = in_column(in_row(self._none, self._automatic, margins=0), margins=0)
        shown = in_row(
            *((picture, wide) for picture, wide in zip(pictures, (3, 3, 5), strict=True)),
            (self.body, 4),
            (self.rows, 5),
            (self._choice, 5),
            margins=0,
        )
        views = in_row(*self._views.values(), margins=0, spacing=1)
        tools = in_row(views, 8, (self._said, 1), self._undo, self._redo, self._reset, margins=0)
        in_column(tools, (shown, 1), of=self, margins=0)

    def _view_button(self, name: ViewName) -> QToolButton:
        text_id, tip_id = _VIEW_TEXTS[name]
        button = self.texted(named(QToolButton(), f"body_view_{name}"), text=text_id, tip=tip_id)
        button.setCheckable(True)
        button.setAutoRaise(True)
        button.setMinimumSize(LEAST_TARGET_PX + 2, LEAST_TARGET_PX + 2)
        on_click(button, self.show_from, VIEWS[name])
        return button

    # User actions

    @property
    def joint(self) -> str:
        """Name of the selected joint."""
        return self._joint

    @property
    def found(self) -> PairContents:
        """Contents of the displayed pair of motion and music."""
        return self._found

    @property
    def bones(self) -> BoneTree | None:
        """Tree of the file's bones; None before a file is read."""
        return self._bones

    def show_from(self, view: BodyView) -> None:
        """Show all three pictures from one direction."""
        for figure in (self.raw, self.first, self.rest):
            figure.show_from(view)
        for name, button in self._views.items():
            button.setChecked(view == VIEWS[name])

    def choose(self, joint: str) -> None:
        """Select a joint, and its bone in the tree and the picture."""
        self._joint = joint
        self.body.choose(joint)
        self.rows.setCurrentItem(self._items[joint])
        self._show_choice()

    def undo(self) -> None:
        """Undo the last correction of the mapping of bones."""
        if self._history.can_undo and self.isEnabled():
            self._history.undo()
            self.changed.emit()

    def redo(self) -> None:
        """Redo the last undone correction."""
        if self._history.can_redo and self.isEnabled():
            self._history.redo()
            self.changed.emit()

    def _give(self, bone: str | None) -> None:
        if self._skeleton is not None and self._history.apply(self._history.now.with_joint(self._joint, bone)):
            self.changed.emit()

    def _reset_all(self) -> None:
        if self._history.apply(DraftHistory.empty().now):
            self.changed.emit()

    def _row_chosen(self, item: QTreeWidgetItem | None, before: QTreeWidgetItem | None = None) -> None:
        if item is not None and item.data(0, Qt.ItemDataRole.UserRole) != self._joint:
            self.choose(item.data(0, Qt.ItemDataRole.UserRole))

    def _open(self, joint: str) -> None:
        self.choose(joint)
        if self._bones is not None:
            self._bones.search.setFocus(Qt.FocusReason.OtherFocusReason)
            self._bones.search.selectAll()

    # Display

    def show_pair(self, found: PairContents, history: DraftHistory) -> None:
        """Show the skeleton of a pair's motion with the user's corrections, which can be undone."""
        before = self._skeleton
        self._found, self._history, self._skeleton = found, history, found.skeleton
        skeleton = found.skeleton
        self.setEnabled(skeleton is not None)
        if skeleton is None:
            self._mapping = JointMapping("", {}, (), ())
        else:
            self._mapping = skeleton.corrected(history.now.joints)
        if skeleton is not None and (before is None or before.figure.bone_names != skeleton.figure.bone_names):
            self._show_bones(skeleton)
        self._show()

    def _show_bones(self, skeleton: RawSkeleton) -> None:
        if self._bones is not None:
            self._bones.deleteLater()
            self._choice.removeWidget(self._bones)
        self._bones = BoneTree(self._session, skeleton.figure)
        self._bones.setMinimumWidth(_LEAST_LIST_PX)
        self._bones.chosen.connect(self._give)
        self.texted(self._bones.search, placeholder="character_dialog.search_bones")
        self._choice.insertWidget(0, self._bones, 1)
        self._name_columns()
        wrong = [joint for joint in REQUIRED if joint not in self._mapping.bones]
        wrong += [joint for joint in self._mapping.doubtful if joint in self._items]
        self._joint = ""
        self.choose(wrong[0] if wrong else "hips")

    def _state(self, joint: str) -> State:
        if joint not in self._mapping.bones:
            return "missing"
        return "doubtful" if joint in self._mapping.doubtful else "mapped"

    def _show(self) -> None:
        tokens, skeleton = self._session.tokens, self._skeleton
        colours = {"mapped": tokens.text, "doubtful": tokens.warning, "missing": tokens.text_dim}
        marks = {"mapped": ("check", tokens.good), "doubtful": ("warning", tokens.warning)}
        self.body.show_states({joint: self._state(joint) for joint in self._items})
        for joint, item in self._items.items():
            state, bone = self._state(joint), self._mapping.bones.get(joint)
            item.setText(0, joint_name(joint))
            item.setText(1, "—" if bone is None or skeleton is None else skeleton.figure.bone_names[bone])
            by_hand = joint in self._history.now.joints
            item.setForeground(1, QColor(tokens.by_hand if by_hand else colours[state]))
            mark, colour = marks.get(state, ("close", tokens.text_dim))
            needed = state == "missing" and joint in REQUIRED
            item.setIcon(0, icon("error" if needed else mark, tokens, tokens.error if needed else colour))
            item.setToolTip(0, self._joint_text(joint))
        if self._bones is not None:
            used = {bone: joint for joint, bone in self._mapping.bones.items() if joint in self._items}
            self._bones.show_used({bone: joint_name(joint) for bone, joint in used.items()})
        self._show_poses()
        self._say()
        self._show_choice()

    def _show_poses(self) -> None:
        read = self._found.read
        if read is None:
            self.first.show_pose(None)
            self.rest.show_pose(None)
        else:
            clip = read.motion.clip
            caps = knee_caps(clip)
            self.first.show_pose(body_pose(clip, 0, caps))
            self.rest.show_pose(body_pose(t_pose_of(clip), 0, caps))

    def _say(self) -> None:
        if self._found.error is not None and self._skeleton is not None:
            self._said.setText(self.tr("body_panel.assign_bones"))
        elif self._found.read is not None:
            self._said.setText(message_text(self._found.read.motion.checked))
        else:
            self._said.setText(self.tr("body_panel.no_motion"))

    def _show_choice(self) -> None:
        skeleton, bone = self._skeleton, self._mapping.bones.get(self._joint)
        self._none.setEnabled(bone is not None)
        self._automatic.setEnabled(self._joint in self._history.now.joints)
        self._undo.setEnabled(self._history.can_undo)
        self._redo.setEnabled(self._history.can_redo)
        self._reset.setEnabled(bool(self._history.now.joints))
        if self._bones is not None:
            self._bones.reveal(bone)
        motion = None if self._found.read is None else self._found.read.motion
        self.raw.show_skeleton(None if skeleton is None else skeleton_pose(skeleton, self._mapping, motion, bone))

    def _joint_text(self, joint: str) -> str:
        """Return a joint, its bone and the bone's reliability as text."""
        bone, skeleton = self._mapping.bones.get(joint), self._skeleton
        words = {
            "mapped": self.tr("character_dialog.text"),
            "doubtful": self.tr("character_dialog.bone_guessed"),
            "missing": self.tr("character_dialog.bone_missing"),
        }[self._state(joint)]
        bone_name = "" if bone is None or skeleton is None else skeleton.figure.bone_names[bone]
        return words.format(joint=joint_name(joint), bone=bone_name)

    def _name_columns(self) -> None:
        if self._bones is not None:
            self._bones.set_headers([self.tr("character_dialog.bone_of_file"), self.tr("character_dialog.joint")])

    def retranslate(self) -> None:
        self._name_columns()
        self._show()
