"""Design tokens: one table of colours and sizes for Qt and vispy.

Player colours are Okabe and Ito's (2008, "Color Universal Design"), distinguished by colour-blind eyes, lightened for
the dark surface and darkened for the light one.
"""

from __future__ import annotations

from importlib.resources import as_file, files
from typing import Final

import msgspec

from app.formats.toml import read_toml, shaped


class Tokens(msgspec.Struct, frozen=True):
    """Colours as ``#rrggbb``.

    Attributes
    ----------
    surface, raised, sunken : str
        Backgrounds of panels, of raised parts (buttons, headers), and of sunken parts (fields, lanes).
    line, line_strong : str
        Colours of hairlines and of bar lines.
    accent, accent_text : str
        Colour of selection, focus and playhead; and of text on it.
    by_hand : str
        Colour that marks changes by the user.
    """

    name: str
    surface: str
    raised: str
    sunken: str
    line: str
    line_strong: str
    text: str
    text_dim: str
    accent: str
    accent_text: str
    by_hand: str
    warning: str
    error: str
    good: str
    players: tuple[str, ...]

    def player(self, index: int) -> str:
        """Return the colour of the player with an index; the theme's colours repeat in larger ensembles."""
        return self.players[index % len(self.players)]


def _themes() -> dict[str, Tokens]:
    with as_file(files("resources") / "themes.toml") as path:
        table = read_toml(path)
    return {name: shaped({"name": name, **colours}, Tokens, path.name) for name, colours in table.items()}


THEMES: Final = _themes()
DARK, LIGHT = THEMES["dark"], THEMES["light"]

LEAST_TEXT_PT = 9
LEAST_TARGET_PX = 24
SPLITTER_PX = 8
"""Width in pixels of the splitters between panels, enough for the mouse and for a visible grip."""
