"""Numbers and texts that programs stumble over."""

from __future__ import annotations

from typing import Final

INTEGERS: Final = (
    *(0, 1, -1, 2, 7, 10, 16, 63, 64, 100, 127, 128, 129, 255, 256, 1000, 4096, 32767, 32768, 65535, 65536, 100_000),
    *(2**24 - 1, 2**24, 2**28 - 1, 2**31 - 1, 2**31, -(2**31), 2**32 - 1, 2**32, 2**53 + 1, 2**62, 2**63 - 1, 2**63),
    *(-(2**63), 2**64 - 1, 2**64, 10**9, 10**12, 10**17),
)
FLOATS: Final = (0.0, -0.0, 0.1, -0.5, 1e-9, 1e-320, 1e9, 1e17, 1e300, -1e308, 1.7976931348623157e308)
NUMBER_TEXTS: Final = (
    *(str(value) for value in INTEGERS),
    *(repr(value) for value in FLOATS),
    *("nan", "-nan", "inf", "-inf", "NaN", "Infinity", "-Infinity", "1e999", "-1e999", "0x10", "1_000", "1e", "٣", ""),
    "9" * 400,
    "9" * 5000,
    "0." + "0" * 3000 + "1",
)
TEXTS: Final = (
    *("", " ", "\0", "\n", "a\nb", "\t", "'", '"', "\\", "/", ".", "..", "../../../../etc/passwd", "/dev/zero", "/"),
    *("C:\\con", "con", "nul.suisou", "\\\\host\\share\\x", "file:///dev/zero", "~", "-", "--help", "*", "?", "a|b"),
    *("<img src='file:///dev/zero'>", "<b>", "&amp;", "<html>", "<a href='http://x'>x</a>", "<!--", "&"),
    *("{file}", "{0}", "{0.__class__}", "{", "}", "%s", "%1", "%n", "${HOME}", "$(id)", "`id`"),
    *("ガッキ", "🎺", "\u202eabc", "\u200b", "\ufeff", "\x7f", "\x1b[31m", "\u2028", "é", "\U0010ffff"),
    "a" * 300,
    "a" * 20_000,
    "\u3042" * 3000,
)
