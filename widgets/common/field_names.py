"""Names of stored values as used in the panels, for messages about a value that cannot be saved."""

from __future__ import annotations

import re
from typing import Final

from app.editor.translated import tr
from app.plan.parameters import PARAMETERS

FIELDS: Final = {
    **dict.fromkeys(("tick", "start_tick", "onset_tick", "start_offset_tick"), "event_section.start"),
    **dict.fromkeys(("end_tick", "end_offset_tick"), "event_section.end"),
    **dict.fromkeys(("fade_in_s", "fade_in_ticks"), "event_section.fade_in"),
    **dict.fromkeys(("fade_out_s", "fade_out_ticks"), "event_section.fade_out"),
    "blend_in_ticks": "field_name.blend_in",
    "blend_out_ticks": "field_name.blend_out",
    "amount": "event_section.amount",
    "depth": "event_section.depth",
    "strength": "event_section.strength",
    "beats": "event_section.preparatory_beat",
    "number": "field_name.number",
    "tension": "note_section.tension",
    "effort": "note_section.effort",
    "air": "note_section.air",
    "up_deg": "event_section.up",
    "left_deg": "event_section.left",
    "roll_deg": "event_section.roll",
    "value": "field_name.value",
    "ticks": "field_name.handle",
    "weight": "field_name.weight",
    "channel": "additive_lane.channel",
    "seed": "parameter.seed",
    "label": "correction_kind.pin_fingering",
    **dict.fromkeys(("name", "title"), "import_dialog.name"),
    "pitch": "note_section.pitch",
    "velocity": "note_section.velocity",
    "duration_tick": "note_section.length",
    "offset_s": "video_strip.offset",
    "path": "playblast_dialog.file",
    "colour": "parameter_sections.colour",
    **{name: parameter.label for name, parameter in PARAMETERS.items() if parameter.label},
}
"""Text ids by the last name of a key path."""
_GROUPS: Final = {"audio": "waveform_lane.recording", "video": "field_name.video"}
_LAST: Final = re.compile(r"(\w+)(?:\[[^]]*\])?$")


def field_name(place: str) -> str:
    """Return the name of a stored value by its key path; the path if there is no name."""
    found = _LAST.search(place)
    if found is None or found[1] not in FIELDS:
        return place
    name, group = tr(FIELDS[found[1]]), _GROUPS.get(place.partition(".")[0])
    return name if group is None else tr("channel.of").format(part=tr(group), way=name)
