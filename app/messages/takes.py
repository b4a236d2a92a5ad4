"""What is done with takes, and why not."""

from __future__ import annotations

from typing import Final

TEMPLATES: Final[dict[str, str]] = {
    "edit.comp": "some bars from {take}",
    "edit.comp_whole": "all of {take}",
    "edit.comp_before": "what was there before the takes",
    "edit.rename_take": "call a take {take}",
    "edit.colour_take": "colour of {take}",
    "edit.remove_take": "delete {take}",
    "edit.move_take": "another place for {take}",
    "edit.clean_take": "clean {take}",
    "edit.follow_beats": "tempo of {take}",
    "work.find_beats": "Finding the beats of {take}",
    "take.beats_found": "The piece follows {take}: {count} {count:beat|beats}, {bpm:.0f} a minute.",
    "take.changed": "{take} was changed while its beats were looked for; nothing was done.",
    "take.none": "There is no take {take} any more.",
    "take.too_many": "A project has room for {most} takes: delete some first.",
    "take.invalid": "What was recorded cannot be used: {place}: {detail}. Its journal is damaged.",
    "take.not_free": "{part} has notes already, so the tempo cannot follow one take. Quantise the take instead.",
    "take.too_few_notes": "The take has {count} {count:note|notes}; beats can be found from {least} on.",
    "take.no_beats": "No beat can be heard in this take.",
}
