"""Options for exported skeletons: attachment of instruments, root bone, rest pose, twist bones, eyes."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QGridLayout, QWidget

from app.export.rig_options import ATTACHMENTS, EYE_TURNS, REST_POSES, ROOT_BONES, RigOptions
from widgets.common.controls import Check, Retranslated, named
from widgets.common.plain import ComboBox


class RigChooser(Retranslated, QWidget):
    """Combo or check boxes for the options of exported skeletons; the first choice of each is the default."""

    changed = Signal()

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._instrument = _box("export_instrument", ATTACHMENTS)
        self._root_bone = _box("export_root_bone", ROOT_BONES)
        self._rest_pose = _box("export_rest_pose", REST_POSES)
        self._twist_bones = named(Check("rig_chooser.twist_bones"), "export_twist_bones")
        self._eyes = _box("export_eyes", EYE_TURNS)
        layout = QGridLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        fields = (self._instrument, self._root_bone, self._rest_pose, self._eyes, self._twist_bones)
        for index, field in enumerate(fields):
            layout.addWidget(field, *divmod(index, 2))
        self._instrument.currentIndexChanged.connect(self.changed)
        self.texted(self._eyes, items=("rig_chooser.eyes_by_shapes", "rig_chooser.eyes_by_bones"))
        self.texted(
            self._instrument,
            items=(
                "rig_chooser.instrument_free",
                "rig_chooser.instrument_on_socket",
                "rig_chooser.instrument_on_ik_target",
            ),
        )
        self.texted(
            self._root_bone,
            items=("rig_chooser.root_at_origin", "rig_chooser.root_at_place", "rig_chooser.root_in_motion"),
        )
        self.texted(
            self._rest_pose,
            items=("rig_chooser.rest_as_modelled", "rig_chooser.rest_t_pose", "rig_chooser.rest_a_pose"),
        )

    @property
    def options(self) -> RigOptions:
        """The chosen options for the skeleton: attachment of the instrument, root bone, rest pose and so on."""
        return RigOptions(
            ATTACHMENTS[self._instrument.currentIndex()],
            ROOT_BONES[self._root_bone.currentIndex()],
            REST_POSES[self._rest_pose.currentIndex()],
            self._twist_bones.isChecked(),
            EYE_TURNS[self._eyes.currentIndex()],
        )


def _box(name: str, choices: Sequence[str]) -> ComboBox:
    box = named(ComboBox(), name)
    # As wide as the available room.
    box.setSizeAdjustPolicy(ComboBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon)
    for choice in choices:
        box.addItem("", choice)
    return box
