"""Exports into an Unreal project."""

from __future__ import annotations

from typing import Final

TEMPLATES: Final[dict[str, str]] = {
    "unreal.not_found": "{file} is not there; choose the .uproject file, or the folder that it is in",
    "unreal.no_project": "{file} is no Unreal project; choose the .uproject file, or the folder that it is in",
    "unreal.several": "{file} holds several Unreal projects ({names}); choose one of the .uproject files",
    "unreal.not_a_project": "{file} cannot be read as an Unreal project: {detail}",
    "unreal.too_old": "{file} belongs to Unreal Engine {version}; version {least} or newer is needed",
    "unreal.read_only": (
        "{file} is write-protected; nothing was written; allow writing into the project's folder and export again"
    ),
    "unreal.locked": (
        "{file} is write-protected, as version control leaves it; nothing was written; check it out, then export again"
    ),
    "unreal.manifest": (
        "{file} is damaged ({detail}), so that nobody knows which files are whose; nothing was written; move its "
        "folder away, then export again"
    ),
    "unreal.in_the_way": (
        "{file} is not from this program and would be replaced; nothing was written; move it or rename it, then "
        "export again"
    ),
    "unreal.changed": (
        "{file} was changed by somebody since it was exported; nothing was written; move it away to keep it, or delete "
        "it, then export again"
    ),
    "unreal.kept": "{file} is not needed any more, but was changed by somebody and is left alone",
    "unreal.plugin_foreign": (
        "{file} is a plug-in of that name that is not from this program; nothing was written; move it away, then "
        "export again"
    ),
    "unreal.file_wrong": (
        "{file} was written wrongly ({what}: {found}, not {wanted}); nothing was changed in the project; please report "
        "this"
    ),
    "unreal.done": "files written into the Unreal project {project}: {count}",
    "unreal.formats": "--format is for a folder of files; an Unreal project gets what Unreal reads",
    "tree.busy": "{file}: another export into it is under way; wait until it has finished, then export again",
    "tree.leads_outside": (
        "{file} is a link to {target}, out of the folder that is exported into; nothing was written; put a folder in "
        "its place, then export again"
    ),
    "tree.not_restored": (
        "{file} was to be given back as it was before the export and cannot be: {reason}; close the program that has "
        "it open, then export again"
    ),
    "tree.refused": (
        "{file} cannot be replaced: {reason}; everything is as it was; close the program that has it open, then export "
        "again"
    ),
}
