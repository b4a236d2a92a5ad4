"""Controls for outfits and the colours of their parts."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QWidget

from app.editor.session import Session
from app.project.performers import Dancer, Player
from app.rig.characters.dressed_characters import person_behind, worn_colours
from app.rig.people.wardrobe import OWN_CLOTHES, TINTS, Tint, wardrobe
from widgets.common.combo import Combo, Option
from widgets.common.controls import Caption, Retranslated
from widgets.common.instrument_name import outfit_names
from widgets.common.layouts import in_row
from widgets.common.swatch import ColourSwatch


class OutfitChooser(Retranslated, Combo):
    """Combo box of outfits, including the character's own clothes."""

    def __init__(self, prefix: str) -> None:
        super().__init__()
        self.setObjectName(f"{prefix}_outfit")
        self.retranslate()

    def show_worn(self, performers: Sequence[Player | Dancer]) -> None:
        """Show the outfits of performers; disabled for characters that are not people."""
        worn = {one.outfit.id for one in _people(performers)}
        self.setEnabled(bool(worn))
        self.setToolTip("" if worn else self.tr("outfit_rows.own_figure"))
        # Outfits that are not installed come from a project of another version.
        unknown = [Option(id, id) for id in sorted(worn) if id != OWN_CLOTHES and id not in wardrobe()]
        self.set_options([*_outfits(), *unknown])
        self.show_option(OWN_CLOTHES if not worn else worn.pop() if len(worn) == 1 else None)

    def retranslate(self) -> None:
        self.set_options(_outfits())


class OutfitColours(Retranslated, QWidget):
    """Buttons for the selectable colours of outfits.

    Signals
    -------
    chosen(str, str)
        The user chose a colour for a part (`TINTS`); empty for the outfit's own colour.
    """

    chosen = Signal(str, str)

    def __init__(self, session: Session, prefix: str) -> None:
        super().__init__()
        self.caption = Caption("outfit_rows.colours")
        self._swatches: dict[Tint, ColourSwatch] = {}
        for tint in TINTS:
            swatch = self._swatches[tint] = ColourSwatch(session, title="outfit_rows.colour_of_outfit")
            swatch.setObjectName(f"{prefix}_outfit_{tint}")
            swatch.chosen.connect(partial(self.chosen.emit, tint))
            self.texted(swatch, explained=f"outfit_rows.{tint}")
        row = in_row(*self._swatches.values(), of=self, margins=0, spacing=4)
        row.setAlignment(Qt.AlignmentFlag.AlignLeft)
        self.caption.setBuddy(self._swatches["main"])

    def show_worn(self, performers: Sequence[Player | Dancer]) -> None:
        """Show the colours of performers' outfits; hidden if none can be chosen."""
        people = _people(performers)
        tints = {tint for one in people if one.outfit.id in wardrobe() for tint in wardrobe()[one.outfit.id].tints}
        for one in (self, self.caption):
            one.setVisible(bool(tints))
        for tint, swatch in self._swatches.items():
            swatch.setVisible(tint in tints)
            swatch.show_colours(tuple(dict.fromkeys(filter(None, (_seen(one, tint) for one in people)))))


def _outfits() -> list[Option]:
    return [Option(id, name) for id, name in outfit_names().items()]


def _people(performers: Sequence[Player | Dancer]) -> list[Player | Dancer]:
    """Return the performers that can wear outfits."""
    return [one for one in performers if person_behind(one.character_id) is not None]


def _seen(one: Player | Dancer, tint: Tint) -> str:
    """Return the colour of a part of a performer's outfit as worn; empty if the outfit has no such part."""
    return (worn_colours(one.character_id, one.outfit) or {}).get(tint, "")
