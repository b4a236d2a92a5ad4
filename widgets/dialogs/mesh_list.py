"""List of a character file's meshes with check boxes, for hiding some (a sword, a shield, a hat)."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QTreeWidgetItem, QWidget

from app.rig.figure import Figure
from widgets.common.controls import ColumnList, Retranslated, wrapped
from widgets.common.layouts import in_column
from widgets.common.plain import Label, verbatim


class MeshList(Retranslated, QWidget):
    """List of meshes by name; meshes of the same name are one row.

    Signals
    -------
    changed(object)
        The user hid or showed a mesh; the object is a tuple of the names of hidden ones.
    """

    changed = Signal(object)

    def __init__(self, figure: Figure, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.list = ColumnList("mesh_list", "mesh_list.mesh", "mesh_list.triangles")
        triangles: Counter[str] = Counter()
        for mesh in figure.meshes:
            triangles[mesh.name] += len(mesh.triangles)
        self._items = {name: QTreeWidgetItem([verbatim(name), f"{count:,}"]) for name, count in triangles.items()}
        for item in self._items.values():
            item.setTextAlignment(1, Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
            item.setCheckState(0, Qt.CheckState.Checked)
            self.list.addTopLevelItem(item)
        self.list.itemChanged.connect(self._switched)
        in_column(self.texted(wrapped(Label()), text="mesh_list.help"), (self.list, 1), of=self, margins=(0, 8, 0, 0))

    def show_hidden(self, hidden: Collection[str]) -> None:
        """Check the meshes in the list except the hidden ones."""
        self.list.blockSignals(True)
        for name, item in self._items.items():
            item.setCheckState(0, Qt.CheckState.Unchecked if name in hidden else Qt.CheckState.Checked)
        self.list.blockSignals(False)

    def _switched(self, *_: object) -> None:
        off = [name for name, item in self._items.items() if item.checkState(0) is Qt.CheckState.Unchecked]
        self.changed.emit(tuple(off))
