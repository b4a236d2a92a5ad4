"""Names of MIDI ports without the parts added by the system, such as numbers that change with every connection.

===========  ==============================================  ======================================
system       its name of a port                              ours
===========  ==============================================  ======================================
ALSA         ``EWI5000:EWI5000 MIDI 1 20:0``                 ``EWI5000 MIDI 1``
JACK         ``a2j:EWI5000 [20] (capture): EWI5000 MIDI 1``  ``EWI5000 MIDI 1``
PipeWire     ``Midi-Bridge:EWI5000:(capture_0) EWI5000 ...``  ``EWI5000 ...``
Windows      ``2- EWI5000 1``                                ``EWI5000``
macOS        ``EWI5000``                                     ``EWI5000``
===========  ==============================================  ======================================

The second of two equal devices is called ``EWI5000 (2)``.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Mapping, Sequence
from typing import Final

import msgspec

CLIENT: Final = "Suisou"
NAMELESS: Final = "MIDI"
_OWN: Final = re.compile(rf"{CLIENT}(-\d+)?:")
_ALSA: Final = re.compile(r"(?P<client>[^:]+):(?P<port>.*) \d+:\d+")
_BRIDGES: Final = (
    re.compile(r"a2j:(?P<client>.+) \[\d+\] \((?:capture|playback)\): (?P<port>.+)"),
    # PipeWire appends a number to ports of the same name; numbers in device names are shorter.
    re.compile(r"Midi-Bridge:(?P<client>[^:]+):\((?:capture|playback)_\d+\) (?P<port>.+?)(?:-\d{2,})?"),
    re.compile(r"Midi-Bridge:(?P<client>)(?P<port>.+) \((?:capture|playback)\)"),
)
_WINDOWS_COUNT: Final = re.compile(r"(^|\()\d+- ")
"""Number that Windows adds for each socket a device was ever connected to: ``MIDIIN2 (3- EWI5000)``."""
_END_NUMBER: Final = re.compile(r" \d+$")
_OF_A_KIND: Final = re.compile(r" \(\d+\)$")


class Port(msgspec.Struct, frozen=True):
    """A connected port.

    Attributes
    ----------
    name : str
        Name that is unique among connected ports.
    identity : str
        Identity that changes when a device is reconnected, if the system reveals this.
    index : int
        Index in the system's list.
    """

    name: str
    identity: str
    index: int


def named(found: Sequence[str], system: str, known: Mapping[str, str] | None = None) -> tuple[Port, ...]:
    """Return the ports in a system's list under stable names, without the ports of this program.

    Parameters
    ----------
    found : sequence of str
        Names given by the system.
    system : {"alsa", "jack", "core", "winmm"}
        MIDI system that gave the names.
    known : mapping of str to str, optional
        Names of ports connected before, by identity: of two equal devices, the one that stays connected keeps its name.
    """
    known = {} if known is None else known
    listed = [(index, full) for index, full in enumerate(found) if not _OWN.match(full)]
    identities = _identities([_identity(full, index, system) for index, full in listed])
    kept: dict[str, str] = {}
    for identity in identities:
        if identity in known and known[identity] not in kept.values():
            kept[identity] = known[identity]
    taken = set(kept.values())
    ports = []
    for (index, full), identity in zip(listed, identities, strict=True):
        name = kept.get(identity) or _free(_plain(full, index, system), taken)
        taken.add(name)
        ports.append(Port(name, identity, index))
    return tuple(ports)


def matching(requested: str, names: Sequence[str], *, partly: bool = False) -> tuple[str, ...]:
    """Select the port names that a text means: equal names or, if there are none, names of the same device on any
    system.

    Parameters
    ----------
    requested : str
        A name as in `Port`, or one that a system gave the port at any time.
    partly : bool
        Whether the text may be a part of the name, ignoring case.
    """
    if requested in names:
        return (requested,)
    plain = _of_any_system(requested)
    candidates = {_key(plain), _key(_END_NUMBER.sub("", plain))}
    same = tuple(name for name in names if _key(name) in candidates)
    if same or not partly:
        return same
    return tuple(name for name in names if requested.casefold() in name.casefold())


def _identity(full: str, index: int, system: str) -> str:
    """Return the identity of a port: its full system name, without the index in the list where the system
    appends one.
    """
    return full.removesuffix(f" {index}") if system == "winmm" else full


def _identities(plain: Sequence[str]) -> list[str]:
    """Make names without the system's numbers unique, as "EWI5000" and "EWI5000 (2)"."""
    seen: Counter[str] = Counter()
    found = []
    for name in plain:
        seen[name] += 1
        found.append(name if seen[name] == 1 else f"{name} ({seen[name]})")
    return found


def _free(plain: str, taken: set[str]) -> str:
    name, number = plain, 1
    while name in taken:
        number += 1
        name = f"{plain} ({number})"
    return name


def _plain(full: str, index: int, system: str) -> str:
    if system == "alsa":
        return _without_numbers(full, (_ALSA,))
    if system == "jack":
        return _without_numbers(full, _BRIDGES)
    if system == "winmm":
        full = _WINDOWS_COUNT.sub(r"\1", full.removesuffix(f" {index}").strip())
    return full.strip() or NAMELESS


def _of_any_system(name: str) -> str:
    return _WINDOWS_COUNT.sub(r"\1", _without_numbers(name, (_ALSA, *_BRIDGES)))


def _without_numbers(full: str, forms: Sequence[re.Pattern[str]]) -> str:
    for form in forms:
        if match := form.fullmatch(full.strip()):
            return _of_client(match["client"].strip(), match["port"].strip()) or NAMELESS
    return full.strip() or NAMELESS


def _of_client(client: str, port: str) -> str:
    return port if port.startswith(client) else f"{client}:{port}"


def _key(name: str) -> str:
    """Return the part of a port's name that is equal on all MIDI systems."""
    client, colon, port = _OF_A_KIND.sub("", name).partition(":")
    return (_of_client(client, port) if colon else client).casefold()
