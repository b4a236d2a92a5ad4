"""Combo boxes of the export dialog, such as texture size and table of bone names."""

from __future__ import annotations

from collections.abc import Callable

from app.formats.images import TEXTURE_SIZES, TextureSize
from app.formats.levels_of_detail import LEVEL_CHOICES, LevelChoice
from metadata.load import load_bone_names
from widgets.common.controls import Retranslated, named, said
from widgets.common.plain import ComboBox


def bone_name_profiles(dialog: Retranslated) -> ComboBox:
    """Return a combo box with the skeleton's own bone names and with tables of bone names, by id."""
    box = named(ComboBox(), "export_bvh_names")
    # As wide as the available room, not as the longest title.
    box.setSizeAdjustPolicy(ComboBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon)
    box.addItem("", "")
    for profile, table in load_bone_names().items():
        box.addItem(table.title, profile)
    return dialog.texted(box, items="export_dialog.same_as_skeleton")


def texture_sizes(dialog: Retranslated, chosen: TextureSize) -> ComboBox:
    """Return a combo box for the largest texture size in an export, from `TEXTURE_SIZES`, with ``chosen`` selected."""
    box = dialog.texted(named(ComboBox(), "export_textures"), tip="export_dialog.textures_tip")
    dialog.texted(box, options={str(px): _size_text(px) for px in TEXTURE_SIZES})
    box.setCurrentIndex(TEXTURE_SIZES.index(chosen))
    return box


def levels_of_detail(dialog: Retranslated, chosen: LevelChoice) -> ComboBox:
    """Return a combo box for the number of levels of detail in an export, from `LEVEL_CHOICES`, with ``chosen``
    selected.
    """
    box = dialog.texted(named(ComboBox(), "export_levels"), tip="export_dialog.levels_tip")
    dialog.texted(box, options={str(count): _level_text(count) for count in LEVEL_CHOICES})
    box.setCurrentIndex(LEVEL_CHOICES.index(chosen))
    return box


def _size_text(px: int) -> Callable[[], str]:
    return said("export_dialog.texture_size", px=str(px)) if px else said("export_dialog.no_textures")


def _level_text(count: int) -> Callable[[], str]:
    return said("export_dialog.levels", count=str(count)) if count else said("export_dialog.usual_levels")
