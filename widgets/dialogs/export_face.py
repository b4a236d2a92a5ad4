"""Options for face curves in exported files: names and parts of the face."""

from __future__ import annotations

from PySide6.QtWidgets import QCheckBox, QGridLayout, QWidget

from app.export.face_curves import CURVE_NAMES, FACE_PARTS, FaceOptions
from widgets.common.controls import Check, Retranslated, named
from widgets.common.plain import ComboBox

_COLUMNS = 3


class FaceChooser(Retranslated, QWidget):
    """Choice of the naming convention of face curves, and a check box for every part of a face; initially all parts
    under ARKit's names.
    """

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._names = named(ComboBox(), "export_face_names")
        self._names.setSizeAdjustPolicy(ComboBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon)
        for name in CURVE_NAMES:
            self._names.addItem("", name)
        self.texted(
            self._names,
            items=("face_chooser.arkit", "face_chooser.metahuman", "face_chooser.audio2face"),
            tip="face_chooser.names_tip",
        )
        self._parts: dict[str, QCheckBox] = {}
        layout = QGridLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(self._names, 0, 0, 1, _COLUMNS)
        for index, part in enumerate(FACE_PARTS):
            box = self._parts[part] = named(Check(f"face_chooser.{part}"), f"export_face_{part}")
            box.setChecked(True)
            self.texted(box, tip="face_chooser.parts_tip")
            row, column = divmod(index, _COLUMNS)
            layout.addWidget(box, 1 + row, column)

    def set_names_shown(self, shown: bool) -> None:
        """Show or hide the choice of names, which is useless if only ARKit's are possible."""
        self._names.setVisible(shown)

    @property
    def options(self) -> FaceOptions:
        """The chosen options for the face: names of its curves, and the parts to export."""
        parts = tuple(part for part in FACE_PARTS if self._parts[part].isChecked())
        names = CURVE_NAMES[self._names.currentIndex()] if self._names.isVisibleTo(self) else CURVE_NAMES[0]
        return FaceOptions(names, parts)
