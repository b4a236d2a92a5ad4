"""Bones of a pair's motion corrected by mouse and keys, compared with the learned motion."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QPushButton, QToolButton
from pytestqt.qtbot import QtBot

from app.choreography.body import SEGMENTS
from app.choreography.read_motion import read_motion
from app.editor.session import Session
from app.formats.bvh.read import read_bvh
from app.formats.bvh.write import write_bvh
from tests.gui.choreography.test_learn_dialog import drop, shown, state
from tests.support.rerigged import together, with_prop, without_names
from tests.support.windows import child
from tests.unit.choreography.test_command import write_clip, write_drums
from tests.unit.choreography.test_cuts import arm_swings
from widgets.common.combo import Combo
from widgets.dialogs.bone_tree import BoneTree
from widgets.dialogs.choreography.body_view import VIEWS, BodyView
from widgets.dialogs.choreography.learn import LearnDialog

SWORD = [(30.0, 0.0, 0.0)] * 4
"""Bones of a sword, with which an arm's lengths are no longer those of an arm."""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    named = read_bvh(write_clip(tmp_path / "swings.bvh", arm_swings(60)))
    armed = with_prop(named, "leftHand", SWORD)
    write_bvh(tmp_path / "sword.bvh", without_names(armed))
    write_drums(tmp_path / "drums.mid")
    return tmp_path


@pytest.fixture
def dialog(session: Session, qtbot: QtBot, folder: Path) -> LearnDialog:
    made = shown(session, qtbot, folder)
    drop(made, folder / "sword.bvh", folder / "drums.mid")
    return made


def tree(dialog: LearnDialog) -> BoneTree:
    assert dialog.body.bones is not None
    return dialog.body.bones


def give(dialog: LearnDialog, joint: str, bone: str) -> None:
    """Click a joint of the drawn body and type its bone."""
    place = dialog.body.body.place(joint).toPoint()
    QTest.mouseClick(dialog.body.body, Qt.MouseButton.LeftButton, pos=place)
    assert dialog.body.joint == joint
    QTest.keyClick(dialog.body.body, Qt.Key.Key_Return)
    QTest.keyClicks(tree(dialog).search, bone)
    QTest.keyClick(tree(dialog).search, Qt.Key.Key_Return)


def true_bones(folder: Path) -> dict[str, str]:
    """Bones of the file without names by joint."""
    named = read_bvh(folder / "swings.bvh")
    return dict(zip(named.names, without_names(with_prop(named, "leftHand", SWORD)).names, strict=False))


def wrong_bones(dialog: LearnDialog, folder: Path) -> dict[str, str]:
    """Wrong bones for the user to correct."""
    skeleton = dialog._rows[0].found.skeleton
    assert skeleton is not None
    shown = {joint: skeleton.figure.bone_names[bone] for joint, bone in skeleton.found.bones.items()}
    return {
        joint: bone
        for joint, bone in true_bones(folder).items()
        if joint not in ("spine", "chest") and shown.get(joint) != bone
    }


def test_a_motion_that_is_not_understood_is_corrected_bone_by_bone(dialog: LearnDialog, folder: Path) -> None:
    assert "bones were not found for" in state(dialog) or "not recognised" in state(dialog)
    # The bones to correct are shown, with the file's skeleton.
    assert dialog.tabs.currentWidget().isAncestorOf(dialog.body)
    assert dialog.body.raw.skeleton is not None
    assert dialog.body.first.pose is dialog.body.rest.pose is None
    corrections = wrong_bones(dialog, folder)
    for joint, bone in corrections.items():
        give(dialog, joint, bone)
    assert dialog.drafts[0].joints == corrections
    assert child(dialog, QPushButton, "learn_start").isEnabled()
    read = dialog._rows[0].found.read
    assert read is not None
    expected = read_motion(folder / "swings.bvh").clip
    assert np.abs(read.motion.clip.rotations - expected.rotations).max() < 0.05
    assert dialog.body.first.pose is not None
    # In the T-pose both hands are as high as the shoulders.
    arms = [at for at, name in enumerate(SEGMENTS) if "Arm" in name or "Hand" in name]
    rest = dialog.body.rest.pose
    assert rest is not None
    assert np.ptp(rest.points[arms, 1]) < 0.05


def test_corrections_are_taken_back(dialog: LearnDialog, folder: Path) -> None:
    joint, bone = next(iter(wrong_bones(dialog, folder).items()))
    give(dialog, joint, bone)
    assert dialog.drafts[0].joints == {joint: bone}
    # The field in which the name was typed has nothing of its own to undo.
    ctrl, shift = Qt.KeyboardModifier.ControlModifier, Qt.KeyboardModifier.ShiftModifier
    for modifiers, joints in ((ctrl, {}), (ctrl | shift, {joint: bone})):
        QTest.keyClick(tree(dialog).search, Qt.Key.Key_Z, modifiers)
        assert dialog.drafts[0].joints == joints
    QTest.mouseClick(child(dialog, QToolButton, "body_undo"), Qt.MouseButton.LeftButton)
    assert dialog.drafts[0].joints == {}
    QTest.keyClick(dialog.body, Qt.Key.Key_Z, Qt.KeyboardModifier.ControlModifier | Qt.KeyboardModifier.ShiftModifier)
    assert dialog.drafts[0].joints == {joint: bone}
    QTest.mouseClick(child(dialog, QPushButton, "body_automatic"), Qt.MouseButton.LeftButton)
    assert dialog.drafts[0].joints == {}
    give(dialog, joint, bone)
    QTest.mouseClick(child(dialog, QPushButton, "body_no_bone"), Qt.MouseButton.LeftButton)
    assert dialog.drafts[0].joints == {joint: ""}
    QTest.mouseClick(child(dialog, QPushButton, "body_reset"), Qt.MouseButton.LeftButton)
    assert dialog.drafts[0].joints == {}
    # Another motion has other bones.
    give(dialog, joint, bone)
    dialog.form._change(motion=folder / "swings.bvh")
    assert dialog.drafts[0].joints == {}
    assert child(dialog, QPushButton, "learn_start").isEnabled()


def test_of_a_file_with_two_figures_either_is_learned_from(session: Session, qtbot: QtBot, folder: Path) -> None:
    swings, both = folder / "swings.bvh", folder / "both.bvh"
    later = write_clip(folder / "later.bvh", arm_swings(60, swings_s=(1.5, 3.0, 5.0, 6.5)))
    both.write_text(together(swings.read_text(), later.read_text()))
    dialog = shown(session, qtbot, folder)
    drop(dialog, both, folder / "drums.mid")
    figures = child(dialog, Combo, "learn_figure")
    assert figures.isVisible()
    assert [figures.itemText(at) for at in range(figures.count())] == ["hips", "hips (2)"]
    give(dialog, "neck", "chest")
    for index, file in ((1, later), (0, swings)):
        figures.setFocus()
        QTest.keyClick(figures, Qt.Key.Key_Down if index else Qt.Key.Key_Up)
        read = dialog._rows[0].found.read
        assert read is not None
        assert figures.currentIndex() == index
        np.testing.assert_array_equal(read.motion.clip.rotations, read_motion(file).clip.rotations)
        # Bones are corrected for each figure.
        assert not dialog.drafts[0].joints
    # A file with one figure leaves nothing to choose.
    dialog.form._change(motion=swings)
    assert not figures.isVisible()
    assert dialog.drafts[0].figure == ""


def test_all_three_pictures_are_orbited_together(session: Session, qtbot: QtBot, folder: Path) -> None:
    dialog = shown(session, qtbot, folder)
    drop(dialog, folder / "swings.bvh", folder / "drums.mid")
    dialog.tabs.setCurrentWidget(dialog.tabs.widget(1))
    figures = (dialog.body.raw, dialog.body.first, dialog.body.rest)
    buttons = {name: child(dialog, QToolButton, f"body_view_{name}") for name in VIEWS}

    def shows(view: BodyView) -> bool:
        lit = {name for name, button in buttons.items() if button.isChecked()}
        return all(figure.view == view for figure in figures) and lit == {name for name in VIEWS if VIEWS[name] == view}

    assert shows(VIEWS["front"])
    seen = {}
    for name in ("side", "three_quarter", "three_quarter", "front"):
        QTest.mouseClick(buttons[name], Qt.MouseButton.LeftButton)
        assert shows(VIEWS[name])
        seen[name] = [figure.grab().toImage() for figure in figures]
    for at in range(len(figures)):
        assert seen["front"][at] != seen["side"][at] != seen["three_quarter"][at]
    for figure in figures:
        before, middle = figure.view, figure.rect().center()
        QTest.mousePress(figure, Qt.MouseButton.LeftButton, pos=middle)
        QTest.mouseMove(figure, middle + QPoint(40, 10))
        QTest.mouseRelease(figure, Qt.MouseButton.LeftButton, pos=middle + QPoint(40, 10))
        assert shows(before.dragged(40.0, 10.0))
        # Without a held button the mouse turns nothing.
        QTest.mouseMove(figure, middle)
        assert shows(before.dragged(40.0, 10.0))
    # The view stays with another motion.
    dialog.form._change(motion=folder / "sword.bvh")
    assert dialog.body.raw.view == figures[0].view != VIEWS["front"]
