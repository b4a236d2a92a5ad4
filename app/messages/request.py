"""What a person asked for on the command line or in a dialog."""

from __future__ import annotations

from typing import Final

TEMPLATES: Final[dict[str, str]] = {
    "set.syntax": "--set {text}: expected PLAYER.parameter=value",
    "set.player_unknown": "--set: there is no player {player!r}; there are: {possible}",
    "set.parameter_unknown": "--set: there is no parameter {parameter!r}; there are: {possible}",
    "set.posture_impossible": "--set: {player} plays {instrument}, which is not played {value}; possible: {possible}",
    "set.value_invalid": "--set: {parameter} cannot be {value!r}; possible: {possible}",
    "player.unknown": "there is no player {player!r}; there are: {possible}",
    "bars.none": "there are no bars {first} to {last}; the piece has {lowest} to {highest}",
    "export.nobody": "{file}: there is nobody to export; 'suisou inspect' says why each part is not played",
    "player.left_out": "{player} is left out: {reason}",
    "player.fault": "{player} cannot be seen because of a fault of the program: {detail}",
    "player.not_seen": "these players cannot be seen: {players}; the list of problems says why",
    "player.all_left_out": "{file}: none of the players can be seen: {reasons}",
    "export.too_long": (
        "{file}: {frames} frames are more than the {most} that one export holds; "
        "take some bars with --from-bar and --to-bar"
    ),
    "piece.too_long": (
        "the piece would last {hours:g} hours, with {quarters} quarter notes and {bars} bars; at most {most_hours} "
        "hours, {most_quarters} quarter notes and {most_bars} bars can be played; shorten it"
    ),
    "open.audio_alone": "{file} is a recording; open the piece that it belongs to first, then drop it again",
    "program.fault": (
        "something went wrong in the program: {detail}; your work was written down; please report this with the file "
        "{log}"
    ),
    "work.stopped": "stopped; nothing was written",
}
