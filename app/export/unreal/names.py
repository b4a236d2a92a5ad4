"""Names of Unreal assets, made from arbitrary names.

They consist of ASCII letters, digits and ``_``, since command lines, version control, packaging and scripts do not
support everything that Unreal allows. The level sequence shows the original name. Kana are transliterated (Nihon-shiki,
as in Unicode names); a name with other characters (kanji, emoji) gets eight digits hashed from it, so that different
names stay different and equal names stay equal.
"""

from __future__ import annotations

import hashlib
import re
import unicodedata
from typing import Final

LONGEST: Final = 32
"""Greatest number of characters of a name, so that paths stay within Windows' limit of 260 characters."""

# Device names of Windows ("Naming Files, Paths, and Namespaces", Microsoft Learn), and Unreal's own word for no name.
_RESERVED: Final = re.compile(r"(con|prn|aux|nul|none|(com|lpt)[0-9])", re.IGNORECASE)
_KANA: Final = re.compile(r"(?:HIRAGANA|KATAKANA) LETTER (SMALL )?([A-Z]+)")
_NO_SPELLING: Final = re.compile(r"[LNSC]")
"""Unicode categories of characters without which a name would lose information; marks and punctuation may be
dropped.
"""


def asset_name(text: str, otherwise: str) -> str:
    """Return the name of an asset or folder, without prefix.

    Parameters
    ----------
    text : str
        Any name.
    otherwise : str
        Word to begin with if nothing of the text can be spelt in ASCII, or if it is a reserved name.
    """
    spelt, whole = _spelt(text)
    name = re.sub(r"_+", "_", re.sub(r"[^A-Za-z0-9]", "_", spelt)).strip("_")
    if not name or _RESERVED.fullmatch(name):
        whole = whole and bool(name)
        name = f"{otherwise}_{name}".rstrip("_")
    if whole and len(name) <= LONGEST:
        return name
    mark = hashlib.sha256(unicodedata.normalize("NFC", text).encode("utf-8", "surrogatepass")).hexdigest()[:8]
    return f"{name[: LONGEST - 9].rstrip('_')}_{mark}"


def _spelt(text: str) -> tuple[str, bool]:
    """Return a name spelt in ASCII, and whether all its characters could be spelt."""
    spelt: list[str] = []
    whole, double = True, False
    for character in unicodedata.normalize("NFKC", text):
        kana = _KANA.match(unicodedata.name(character, ""))
        if kana is not None:
            small, sound = bool(kana[1]), kana[2].lower()
            if small and sound == "tu":
                double = True
                continue
            if small and sound in ("ya", "yu", "yo") and spelt and spelt[-1].endswith("i"):
                spelt[-1] = spelt[-1][:-1]
            spelt.append(sound[0] + sound if double else sound)
        elif character.isascii():
            spelt.append(character)
        elif character == "ー":
            pass  # a long vowel
        else:
            plain = unicodedata.normalize("NFKD", character).encode("ascii", "ignore").decode()
            whole = whole and (bool(plain) or not _NO_SPELLING.match(unicodedata.category(character)))
            spelt.append(plain or "_")
        double = False
    return "".join(spelt), whole
