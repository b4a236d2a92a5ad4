"""Names of instruments, their families, characters and outfits in the user's language."""

from __future__ import annotations

from app.editor.translated import tr
from app.rig.characters.character_library import character_library
from app.rig.people.bundled_people import our_name
from app.rig.people.wardrobe import OWN_CLOTHES, wardrobe
from instrument_maps.instrument_names import vocabulary
from instrument_maps.model import InstrumentMap


def language() -> str:
    """Return the language of the editor: ``"en"`` or ``"ja"``."""
    # The text "language.tag" is translated as the tag of its language, which therefore agrees with all other texts.
    return tr("language.tag")


def instrument_name(instrument: InstrumentMap) -> str:
    """Return the name of an instrument in the user's language."""
    return instrument.name.ja if language() == "ja" else instrument.name.en


def family_name(family: str) -> str:
    """Return the name of a family of instruments, as for a section of players; there is also a name for the empty
    family.
    """
    name = vocabulary().family_names.get(family)
    if name is None:
        return tr("instrument_family.others")
    return name.ja if language() == "ja" else name.en


def outfit_names() -> dict[str, str]:
    """Return the names of all outfits by id, beginning with the character's own clothes."""
    japanese = language() == "ja"
    names = {id: outfit.title.ja if japanese else outfit.title.en for id, outfit in wardrobe().items()}
    return {OWN_CLOTHES: tr("outfit_name.own_clothes"), **names}


def character_name(character_id: str) -> str:
    """Return the name of a character: translated for bundled ones, else from its file."""
    name, own = our_name(character_id), character_library().own.get(character_id)
    if name is not None:
        return name.ja if language() == "ja" else name.en
    return (own.title if own is not None else "") or character_id
