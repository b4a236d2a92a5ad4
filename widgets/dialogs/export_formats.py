"""Choice of formats for an export into a folder, and of stage and sound files."""

from __future__ import annotations

from functools import partial

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QCheckBox, QGridLayout, QWidget

from app.errors import AppError, Message
from app.export.formats import FILE_FORMATS, Format, requested
from widgets.common.controls import Check, Retranslated, named, said
from widgets.common.text import message_text

_COLUMNS = 2


def _missing() -> dict[Format, Message]:
    """Return the reason why a format is not available on this computer, by format; available ones are left out."""
    missing: dict[Format, Message] = {}
    for name, kind in FILE_FORMATS.items():
        try:
            kind.refuse()
        except AppError as error:
            missing[name] = error.message
    return missing


class FormatChooser(Retranslated, QWidget):
    """A check box for every format; unavailable ones show the reason."""

    changed = Signal()

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        missing = _missing()
        self._boxes: dict[Format, QCheckBox] = {name: QCheckBox() for name in FILE_FORMATS}
        for name, box in self._boxes.items():
            box.setObjectName(f"export_{name}")
            box.setChecked(FILE_FORMATS[name].usual)
            box.setEnabled(name not in missing)
            kind = FILE_FORMATS[name]
            text = "characters_and_instruments" if "instrument" in kind.holds else "body_motion"
            text = "motion_and_instruments" if kind.held_in else text
            if name in missing:
                text = "requires_package"
                self.texted(box, tip=partial(message_text, missing[name]))
            held = FILE_FORMATS[kind.held_in or name].label
            words = said(f"format_chooser.{text}", format=kind.label, package=kind.package, instruments=held)
            self.texted(box, text=words)
        self._sound = named(Check("format_chooser.sound_wav"), "export_sound")
        self._stage = named(Check("format_chooser.whole_stage_in_one_file"), "export_stage")
        self._stage.setChecked(True)
        self._motion_only = named(Check("format_chooser.motion_only"), "export_motion_only")
        self.texted(self._motion_only, tip="format_chooser.motion_only_tip")
        self._props = named(Check("format_chooser.props"), "export_props")
        self._props.setChecked(True)
        self.texted(self._props, tip="format_chooser.props_tip")
        layout = QGridLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setHorizontalSpacing(18)
        for index, box in enumerate((*self._boxes.values(), self._sound, self._stage, self._motion_only, self._props)):
            layout.addWidget(box, *divmod(index, _COLUMNS), Qt.AlignmentFlag.AlignLeft)
            box.toggled.connect(self._change)
        layout.setColumnStretch(_COLUMNS, 1)
        self._into_folder = True

    def show_for(self, into_folder: bool) -> None:
        """Show what can be chosen for a folder, or for an Unreal project, whose kinds of files are given."""
        self._into_folder = into_folder
        for box in (*self._boxes.values(), self._sound, self._stage, self._motion_only):
            box.setVisible(into_folder)
        self._enable()

    @property
    def formats(self) -> frozenset[Format]:
        """The file formats ticked for the export."""
        return frozenset(name for name, box in self._boxes.items() if box.isChecked())

    @property
    def sound(self) -> bool:
        """True if the sound is written as well."""
        return self._sound.isChecked()

    @property
    def stage(self) -> bool:
        """True if the whole stage is also written as one file; False if no chosen format supports this."""
        return self._stage.isChecked() and self._stage.isEnabledTo(self)

    @property
    def motion_only(self) -> bool:
        """True if meshes are omitted; False if no chosen format supports this."""
        return self._motion_only.isChecked() and self._motion_only.isEnabledTo(self)

    @property
    def props(self) -> bool:
        """True if straps and chairs are written as well; False if no chosen format can hold them."""
        return self._props.isChecked() and self._props.isEnabledTo(self)

    def _change(self) -> None:
        self._enable()
        self.changed.emit()

    def _enable(self) -> None:
        self._motion_only.setEnabled(any(kind.without_meshes for kind in requested(self.formats)))
        holding = any("props" in kind.holds or kind.held_in for kind in requested(self.formats))
        self._props.setEnabled(not self._into_folder or (holding and not self.motion_only))
        self._stage.setEnabled(any(kind.stage for kind in requested(self.formats)))
