"""Writes resources/icons/*.svg: line drawings on a grid of 24, drawn for this program.

Run from the repository: ``python resources/build/build_icons.py``.
"""

from __future__ import annotations

import math
from pathlib import Path

TARGET = Path(__file__).parents[1] / "icons"
HEAD = (
    '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 24 24" fill="none" stroke="currentColor" '
    'stroke-width="1.75" stroke-linecap="round" stroke-linejoin="round">'
)


def line(path: str) -> str:
    """A drawn line."""
    return f'<path d="{path}"/>'


def fill(path: str) -> str:
    """A filled shape."""
    return f'<path d="{path}" fill="currentColor" stroke="none"/>'


def faint(path: str) -> str:
    """A line that stands back."""
    return f'<path d="{path}" opacity="0.5"/>'


def ring(x: float, y: float, radius: float) -> str:
    """A circle."""
    return f'<circle cx="{x:g}" cy="{y:g}" r="{radius:g}"/>'


def disc(x: float, y: float, radius: float) -> str:
    """A filled circle."""
    return f'<circle cx="{x:g}" cy="{y:g}" r="{radius:g}" fill="currentColor" stroke="none"/>'


def box(x: float, y: float, width: float, height: float, radius: float = 1.5) -> str:
    """A rectangle."""
    return f'<rect x="{x:g}" y="{y:g}" width="{width:g}" height="{height:g}" rx="{radius:g}"/>'


def solid(x: float, y: float, width: float, height: float, radius: float = 1.0) -> str:
    """A filled rectangle."""
    return (
        f'<rect x="{x:g}" y="{y:g}" width="{width:g}" height="{height:g}" rx="{radius:g}" '
        'fill="currentColor" stroke="none"/>'
    )


def letter(text: str, size: float = 13.0) -> str:
    """A letter in the middle."""
    return (
        f'<text x="12" y="{12 + size * 0.36:g}" font-size="{size:g}" font-family="sans-serif" font-weight="700" '
        f'text-anchor="middle" fill="currentColor" stroke="none">{text}</text>'
    )


def note(x: float, y: float, scale: float = 1.0) -> str:
    """An eighth note whose head is at (x, y)."""
    stem = x + 2.6 * scale
    top = y - 11 * scale
    return (
        f'<ellipse cx="{x:g}" cy="{y:g}" rx="{2.9 * scale:g}" ry="{2.2 * scale:g}" fill="currentColor" stroke="none" '
        f'transform="rotate(-18 {x:g} {y:g})"/>' + line(f"M{stem:g} {y - 0.5:g}V{top:g}")
    )


def gear() -> str:
    """A wheel with eight teeth."""
    points = []
    for tooth in range(8):
        middle = math.tau * tooth / 8
        for offset, radius in ((-0.24, 6.9), (-0.15, 9.3), (0.15, 9.3), (0.24, 6.9)):
            points.append((12 + radius * math.sin(middle + offset), 12 - radius * math.cos(middle + offset)))
    path = "M" + "L".join(f"{x:.2f} {y:.2f}" for x, y in points) + "Z"
    return line(path) + ring(12, 12, 2.9)


def sun() -> str:
    """A disc with rays."""
    rays = []
    for ray in range(8):
        x, y = math.sin(math.tau * ray / 8), -math.cos(math.tau * ray / 8)
        rays.append(f"M{12 + 7 * x:.2f} {12 + 7 * y:.2f}L{12 + 9.3 * x:.2f} {12 + 9.3 * y:.2f}")
    return ring(12, 12, 3.9) + line("".join(rays))


SPEAKER = "M4 9.5v5h3l4.5 3.8V5.7L7 9.5z"
PERSON = ring(12, 7, 3.2) + line("M5.5 20c0-4.6 2.8-7.3 6.5-7.3s6.5 2.7 6.5 7.3")
PAGE = "M6 3.5h8l4.5 4.5v12.5H6zM14 3.5V8h4.5"
BIN = "M4.5 6.5h15M9.5 6V4h5v2M6.5 6.5l.8 13.5h9.4l.8-13.5M10 10.5v5.5M14 10.5v5.5"
BELL = "M3.5 12h9c3 0 5-2 7.5-5v10c-2.5-3-4.5-5-7.5-5"

ICONS: dict[str, str] = {
    # Transport
    "play": fill("M7.5 4.8v14.4c0 .6.6.9 1.1.6l11-7.2c.5-.3.5-.9 0-1.2l-11-7.2c-.5-.3-1.1 0-1.1.6z"),
    "pause": solid(6.5, 5, 4, 14) + solid(13.5, 5, 4, 14),
    "stream": disc(12, 12, 2.2)
    + line("M8.1 15.9a5.5 5.5 0 0 1 0-7.8M15.9 8.1a5.5 5.5 0 0 1 0 7.8")
    + line("M5.3 18.7a9.5 9.5 0 0 1 0-13.4M18.7 5.3a9.5 9.5 0 0 1 0 13.4"),
    "stop": solid(6, 6, 12, 12, 1.5),
    "record": disc(12, 12, 6.2),
    "to_start": solid(5, 5.5, 2, 13, 0.8)
    + fill("M19 6.2v11.6c0 .6-.6.9-1.1.6L9 12.6c-.5-.3-.5-.9 0-1.2l8.9-5.8c.5-.3 1.1 0 1.1.6z"),
    "to_end": solid(17, 5.5, 2, 13, 0.8)
    + fill("M5 6.2v11.6c0 .6.6.9 1.1.6l8.9-5.8c.5-.3.5-.9 0-1.2L6.1 5.6C5.6 5.3 5 5.6 5 6.2z"),
    "loop": line("M7 7.5h9a4 4 0 0 1 0 8.5H8a4 4 0 0 1-3.8-5.3M13.5 4.5l3 3-3 3"),
    "previous_frame": line("M14 6l-6 6 6 6") + line("M18 6v12"),
    "next_frame": line("M10 6l6 6-6 6") + line("M6 6v12"),
    "previous_note": note(8, 17) + line("M20.5 9l-4 4 4 4"),
    "next_note": note(7, 17) + line("M16.5 9l4 4-4 4"),
    "metronome": line("M9 4h6l3.5 16.5h-13zM7 16h10M12 16l5.5-9.5"),
    "follow": line("M12 4v16M4 12h4M16 12h4") + line("M17.5 9.5l2.5 2.5-2.5 2.5"),
    "snap": line("M6 4v7.5a6 6 0 0 0 12 0V4M4.3 4h3.4M16.3 4h3.4M6 8h.01M18 8h.01"),
    "speed": line("M4.5 17.5a8.5 8.5 0 1 1 15 0") + line("M12 14l4-5") + disc(12, 14, 1.5),
    # Files and edits
    "new": line(PAGE) + line("M12.25 11.5v6M9.25 14.5h6"),
    "open": line("M3.5 18.5v-13h6l2 2.5h8v2.5M3.5 18.5l3-8h15l-3 8z"),
    "folder": line("M3.5 5.5h6l2 2.5h9v10.5h-17z"),
    "save": line("M4.5 4.5h12l3 3v12h-15zM8 4.5v5h7v-5M7.5 19.5v-6.5h9v6.5"),
    "import": line("M12 3.5v11M7.5 10.5l4.5 4.5 4.5-4.5M4.5 16v4h15v-4"),
    "export": line("M12 15V4M7.5 8l4.5-4.5L16.5 8M4.5 14v6h15v-6"),
    "film": box(3.5, 5, 17, 14) + line("M8 5v14M16 5v14M3.5 9.7H8M3.5 14.3H8M16 9.7h4.5M16 14.3h4.5"),
    "undo": line("M8.5 5L4.5 9l4 4M4.5 9h9.5a5 5 0 0 1 0 10H9"),
    "redo": line("M15.5 5l4 4-4 4M19.5 9H10a5 5 0 0 0 0 10h5"),
    "cut": ring(6.5, 17.5, 2.5) + ring(17.5, 17.5, 2.5) + line("M8 15.5L17 4M16 15.5L7 4"),
    "copy": box(8.5, 8.5, 11, 11) + line("M15.5 5.5v-1h-11v11h1"),
    "paste": line("M8.5 5h-3v15h13V5h-3") + box(8.5, 3.5, 7, 3.5, 1),
    "delete": line(BIN),
    "duplicate": box(8.5, 8.5, 11, 11) + line("M15.5 5.5v-1h-11v11h1M14 11.5v5M11.5 14h5"),
    "search": ring(10.5, 10.5, 6) + line("M15 15l5.5 5.5"),
    "close": line("M6 6l12 12M18 6L6 18"),
    "add": line("M12 5v14M5 12h14"),
    "remove": line("M5 12h14"),
    "check": line("M4.5 12.5l5 5 10-11"),
    "more": disc(5.5, 12, 1.6) + disc(12, 12, 1.6) + disc(18.5, 12, 1.6),
    "menu": line("M4 6.5h16M4 12h16M4 17.5h16"),
    "chevron_down": line("M6 9l6 6 6-6"),
    "chevron_right": line("M9 6l6 6-6 6"),
    "chevron_up": line("M6 15l6-6 6 6"),
    "chevron_left": line("M15 6l-6 6 6 6"),
    "settings": gear(),
    "help": ring(12, 12, 8.5) + line("M9.5 9.5a2.5 2.5 0 1 1 3.5 2.3c-.7.3-1 .8-1 1.7") + disc(12, 16.6, 1.1),
    "keyboard": box(2.5, 6.5, 19, 11)
    + line("M6 10h.01M9 10h.01M12 10h.01M15 10h.01M18 10h.01M6 14h.01M18 14h.01M9 14h6"),
    "language": ring(12, 12, 8.5) + line("M3.5 12h17M12 3.5c5 5 5 12 0 17c-5-5-5-12 0-17z"),
    "dark": line("M19.5 14.5A8 8 0 1 1 9.5 4.5a6.5 6.5 0 0 0 10 10z"),
    "light": sun(),
    "reset": line("M5 5v5h5M5.4 10a7.5 7.5 0 1 1-.6 4.5"),
    "refresh": line("M19.5 5v5h-5M4.5 19v-5h5M5.2 9.5A7.5 7.5 0 0 1 19 9.5M18.8 14.5A7.5 7.5 0 0 1 5 14.5"),
    "history": line("M4.5 5v4.5H9M5 9.5a7.5 7.5 0 1 1-.5 4M12 8v4.5l3 2"),
    "lock": box(5.5, 10.5, 13, 9.5) + line("M8 10.5V8a4 4 0 0 1 8 0v2.5"),
    "link": line("M10 14a4 4 0 0 0 6 .5l3-3a4 4 0 0 0-5.7-5.7l-1 1M14 10a4 4 0 0 0-6-.5l-3 3a4 4 0 0 0 5.7 5.7l1-1"),
    # Notices
    "information": ring(12, 12, 8.5) + line("M12 11.5v5") + disc(12, 8, 1.2),
    "warning": line("M12 4L2.8 19.5h18.4zM12 10v4.5") + disc(12, 17.1, 1.1),
    "error": line("M8.5 3.5h7l5 5v7l-5 5h-7l-5-5v-7zM12 7.5v5.5") + disc(12, 16.2, 1.1),
    # Players
    "player": PERSON,
    "players": ring(9, 8, 3)
    + line("M3 19.5c0-4.3 2.5-6.7 6-6.7s6 2.4 6 6.7")
    + line("M15 5.2a3 3 0 0 1 0 5.6M17 13.5c2.5.8 4 3 4 6"),
    "mute": line(SPEAKER) + line("M15.5 9.5l5 5M20.5 9.5l-5 5"),
    "sound": line(SPEAKER) + line("M15 9a4.5 4.5 0 0 1 0 6M17.7 6.3a8.2 8.2 0 0 1 0 11.4"),
    "solo": letter("S"),
    "letter_m": letter("M"),
    "crown": line("M3.5 8l4.5 4 4-7 4 7 4.5-4-1.7 10.5H5.2z"),
    "dice": box(4.5, 4.5, 15, 15, 3)
    + disc(9, 9, 1.3)
    + disc(15, 9, 1.3)
    + disc(12, 12, 1.3)
    + disc(9, 15, 1.3)
    + disc(15, 15, 1.3),
    "seated": ring(10, 5, 2.3) + line("M10 9v5.5h6l2 5.5M6.5 10v8.5h7M6.5 18.5V21M13 18.5V21"),
    "standing": ring(12, 4.8, 2.3) + line("M12 9v6M12 15l-2.5 6M12 15l2.5 6M7.5 12.5L12 9.5l4.5 3"),
    "stage": line("M3.5 18c0-5 3.8-8.5 8.5-8.5s8.5 3.5 8.5 8.5")
    + disc(6.5, 13, 1.5)
    + disc(12, 9.5, 1.5)
    + disc(17.5, 13, 1.5),
    "instrument": line(BELL) + line("M6.5 12v5h5v-5"),
    "colour": line("M12 3.5c4 5 5.8 7.5 5.8 10.5a5.8 5.8 0 0 1-11.6 0C6.2 11 8 8.5 12 3.5z"),
    "preset": line("M7 3.5h10v17l-5-4-5 4z"),
    # Timeline
    "pointer": line("M6 3.5l12.5 9-5.5 1 3 6-2.5 1.2-3-6L6.5 18.5z"),
    "pencil": line("M4.5 19.5l1-4.5L16 4.5l3.5 3.5L9 18.5zM13.5 7l3.5 3.5"),
    "eraser": line("M8 19.5L3.5 15 14 4.5l6 6-9 9zM8.5 10l6 6M8 19.5h12"),
    "split": line("M12 3.5v17") + line("M3.5 9.5H9v5H3.5M20.5 9.5H15v5h5.5"),
    "join": line("M3.5 9.5h17v5h-17z") + faint("M12 9.5v5"),
    "quantise": faint("M5 3.5v17M12 3.5v17M19 3.5v17") + solid(5, 6, 5.5, 3.5) + solid(12, 13.5, 6, 3.5),
    "transpose": note(8, 18) + line("M17 18V6M13.5 9.5L17 6l3.5 3.5"),
    "note": note(9.5, 18, 1.1) + line("M12.4 6c1 3.2 5 3.2 5 7.5"),
    "notes": note(6, 18) + note(15.5, 16.5) + line("M8.6 7l9.5-1.5"),
    "roll": solid(3.5, 5, 7, 3) + solid(8, 10.5, 8, 3) + solid(13.5, 16, 7, 3),
    "ghosts": faint("M4 6h7M14 18h6") + solid(8, 10.5, 9, 3),
    "waveform": line("M3.5 12h1.5M7.5 9v6M10.5 5.5v13M13.5 8.5v7M16.5 4v16M19.5 10v4"),
    "offset": line("M3.5 12h17M7 8.5L3.5 12 7 15.5M17 8.5l3.5 3.5-3.5 3.5") + faint("M12 4v16"),
    "curve": line("M3.5 17c4 0 4-10 8.5-10s4.5 7 8.5 7"),
    "zoom_in": ring(10.5, 10.5, 6) + line("M15 15l5.5 5.5M10.5 8v5M8 10.5h5"),
    "zoom_out": ring(10.5, 10.5, 6) + line("M15 15l5.5 5.5M8 10.5h5"),
    "fit": line("M8.5 4.5h-4v15h4M15.5 4.5h4v15h-4M7.5 12h9M10 9.5L7.5 12l2.5 2.5M14 9.5l2.5 2.5-2.5 2.5"),
    "zoom_selection": line("M4 8V4h4M16 4h4v4M20 16v4h-4M8 20H4v-4") + solid(8, 10, 8, 4),
    "generate": line("M12 3.5l2 6.5 6.5 2-6.5 2-2 6.5-2-6.5-6.5-2 6.5-2z"),
    "breath": line("M3.5 9h9.5a2.7 2.7 0 1 0-2.5-3.7M3.5 13h14a2.7 2.7 0 1 1-2.5 3.7M3.5 17h6"),
    "cue": line("M4 20L15 9M13.5 5l1-1.5M18.5 8h2M17 12.5l1.5 1M16.5 5.5l1.5-1.5"),
    "gesture": line("M12 20V10M12 10c0-3.5-2-5.5-5.5-5.5M12 10c0-3.5 2-5.5 5.5-5.5M6.5 20h11") + disc(12, 10, 1.6),
    "expression": ring(12, 12, 8.5) + disc(9, 10, 1.2) + disc(15, 10, 1.2) + line("M8 14.5c2 2.7 6 2.7 8 0"),
    "embouchure": line("M3.5 12c3-4 5.5-4.5 8.5-2.5 3-2 5.5-1.5 8.5 2.5-3 4.5-14 4.5-17 0zM3.5 12h17"),
    "fingering": "".join(box(x, 4, 4, 16, 2) for x in (3, 10, 17))
    + solid(3.9, 12, 2.2, 7, 1.1)
    + solid(17.9, 12, 2.2, 7, 1.1),
    "pin": line("M9 3.5h6l-1 6 3.5 4h-11l3.5-4zM12 13.5v7"),
    "by_hand": disc(12, 12, 4.5),
    "problem": line("M6 21V4h11.5l-2.5 4 2.5 4H6"),
    "marker": line("M7 4h10v11l-5 5-5-5z"),
    "tempo": note(8, 18) + line("M14 10h6M14 14h6"),
    "bars": line("M4 5v14M12 5v14M20 5v14") + faint("M4 9h16M4 12h16M4 15h16"),
    "clock": ring(12, 12, 8.5) + line("M12 7v5.5l3.5 2"),
    "frame": box(4, 6, 16, 12) + line("M4 9.5h16"),
    # Viewport
    "full_screen": line("M4 9V4h5M15 4h5v5M20 15v5h-5M9 20H4v-5"),
    "leave_full_screen": line("M9 4v5H4M20 9h-5V4M15 20v-5h5M4 15h5v5"),
    "camera": line("M3.5 7.5h3.5l2-3h6l2 3h3.5v12h-17z") + ring(12, 13, 3.5),
    "wireframe": line("M12 3.5l8 4.5v8l-8 4.5L4 16V8zM4 8l8 4.5L20 8M12 12.5v8"),
    "skeleton": disc(12, 4.5, 1.7)
    + line("M12 6v8M6 9.5h12M12 14l-4 6.5M12 14l4 6.5")
    + disc(6, 9.5, 1.3)
    + disc(18, 9.5, 1.3),
    "contacts": ring(12, 12, 2.5) + line("M12 3.5v5M12 15.5v5M3.5 12h5M15.5 12h5"),
    "eye": line("M2.5 12c3-5 6-7 9.5-7s6.5 2 9.5 7c-3 5-6 7-9.5 7s-6.5-2-9.5-7z") + ring(12, 12, 3),
    "hidden": line("M2.5 12c3-5 6-7 9.5-7s6.5 2 9.5 7c-3 5-6 7-9.5 7s-6.5-2-9.5-7zM4.5 20l15-16"),
    "hand": line(
        "M8 13V6.5a1.5 1.5 0 0 1 3 0V11M11 11V5a1.5 1.5 0 0 1 3 0v6M14 11V6.5a1.5 1.5 0 0 1 3 0V14c0 4-2 6.5-5.5 6.5-3 0-4.5-1.5-6-4.5l-1.8-3.2c-.5-1.5 1.2-2.3 2.1-1.3L8 13"
    ),
    "mouth": line("M3.5 12c3-4 5.5-4.5 8.5-2.5 3-2 5.5-1.5 8.5 2.5-3 4.5-14 4.5-17 0z"),
    "foot": line("M8 3.5v9c0 2-2.5 2.5-2.5 5v2h14v-1.5c0-2.5-3.5-3-5.5-5V3.5z"),
    "pose": ring(7, 7, 2.5) + ring(17, 17, 2.5) + line("M9 9l6 6M17 4v6M14 7h6"),
    "layout": box(3.5, 4.5, 17, 15) + line("M8.5 4.5v10M15.5 4.5v10M3.5 14.5h17"),
    "float": box(8.5, 4.5, 11.5, 10) + line("M15.5 17.5v2H4v-10h1.5"),
    "piece": line(PAGE) + note(10.5, 17, 0.55),
}


def main() -> None:
    """Write every drawing; one that is no longer here goes."""
    TARGET.mkdir(exist_ok=True)
    for old in TARGET.glob("*.svg"):
        if old.stem not in ICONS:
            old.unlink()
    for name, body in ICONS.items():
        (TARGET / f"{name}.svg").write_text(f"{HEAD}{body}</svg>\n", encoding="utf-8")


if __name__ == "__main__":
    main()
