"""The list of a file's bones at its smallest size."""

from __future__ import annotations

import numpy as np
import pytest
from PySide6.QtCore import Qt

from app.editor.session import Session
from app.rig.figure import Figure
from widgets.dialogs.bone_tree import BoneTree

EXACTLY = Qt.MatchFlag.MatchExactly | Qt.MatchFlag.MatchRecursive
WIDTH_PX, LEAST_NAME_PX = 250, 55


@pytest.mark.parametrize("depth", [0, 4, 16])
def test_the_joints_are_in_sight_beside_the_deepest_bones(session: Session, depth: int) -> None:
    count = depth + 1
    names = tuple(f"CC_Base_L_Finger{bone}" for bone in range(count))
    turns = np.tile([0.0, 0.0, 0.0, 1.0], (count, 1))
    figure = Figure(
        file="deep.fbx",
        origin="fbx",
        bone_names=names,
        parents=tuple(range(-1, depth)),
        translations_m=np.zeros((count, 3)),
        rotations=turns,
        meshes=(),
    )
    bones = BoneTree(session, figure)
    bones.set_headers(["Bone", "Joint"])
    bones.show_used({depth: "Left Thumb Proximal"})
    bones.resize(WIDTH_PX, 400)
    bones.show()
    header, view = bones.tree.header(), bones.tree.viewport()
    assert header.sectionViewportPosition(1) + header.sectionSize(1) <= view.width()
    assert bones.tree.sizeHintForColumn(1) <= header.sectionSize(1)
    items = [item for name in names for item in bones.tree.findItems(name, EXACTLY)]
    shown = [bones.tree.visualItemRect(item) for item in items]
    assert [item.toolTip(0) for item in items] == list(names)
    assert len(items) == count
    assert header.sectionSize(0) - max(rect.left() for rect in shown) >= LEAST_NAME_PX
