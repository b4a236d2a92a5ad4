"""A real browser without a window, driven as by a user: by its keyboard, at the width of a screen.

It is Chromium's headless shell (Debian: ``chromium-headless-shell``); it speaks the DevTools protocol over two pipes.
"""

from __future__ import annotations

import base64
import json
import os
import shutil
import subprocess
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Final

COMMANDS: Final = ("chromium-headless-shell", "chromium", "chromium-browser", "google-chrome")
_KEYS: Final = {"Enter": ("Enter", 13, "\r"), "Tab": ("Tab", 9, ""), " ": ("Space", 32, " ")}
_ANSWER_S: Final = 180.0


def browser_command() -> str | None:
    """Command of the installed browser."""
    return next((found for name in COMMANDS if (found := shutil.which(name))), None)


class Page:
    """A page in the browser; see `opened`."""

    def __init__(self, process: subprocess.Popen[bytes], to_browser: int, from_browser: int) -> None:
        self._process, self._to, self._from = process, to_browser, from_browser
        self._buffer, self._number, self._session = b"", 0, ""
        self.events: list[dict[str, Any]] = []

    def ask(self, method: str, **parameters: Any) -> dict[str, Any]:
        """Call a method of the DevTools protocol and return its result."""
        self._number += 1
        message = {"id": self._number, "method": method, "params": parameters}
        if self._session:
            message["sessionId"] = self._session
        os.write(self._to, json.dumps(message).encode() + b"\0")
        while True:
            answer = self._receive()
            if answer.get("id") == self._number:
                assert "error" not in answer, answer
                result: dict[str, Any] = answer["result"]
                return result
            self.events.append(answer)

    def _receive(self) -> dict[str, Any]:
        while b"\0" not in self._buffer:
            data = os.read(self._from, 1 << 20)
            assert data, "the browser has ended"
            self._buffer += data
        line, self._buffer = self._buffer.split(b"\0", 1)
        answer: dict[str, Any] = json.loads(line)
        return answer

    def attach(self) -> None:
        """Send further commands to the page instead of the browser."""
        target = self.ask("Target.createTarget", url="about:blank")["targetId"]
        self._session = self.ask("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Log"):
            self.ask(f"{domain}.enable")

    def value(self, expression: str) -> Any:
        """Return the value of a JavaScript expression on the page."""
        answer = self.ask("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)
        assert "exceptionDetails" not in answer, answer
        return answer["result"].get("value")

    def wait_for(self, expression: str) -> Any:
        """Wait until an expression has a true value and return it."""
        return wait_until(lambda: self.value(expression), expression)

    def load(self, address: str) -> None:
        """Open a page, or open the same one again."""
        self.value("globalThis.leaving = true")
        self.ask("Page.navigate", url=address)
        self.wait_for("!globalThis.leaving && document.readyState === 'complete'")

    def reload(self) -> None:
        """Load the page again."""
        self.value("globalThis.leaving = true")
        self.ask("Page.reload")
        self.wait_for("!globalThis.leaving && document.readyState === 'complete'")

    def press(self, key: str) -> None:
        """Press and release a key: a digit, ``"Enter"``, ``"Tab"`` or a space."""
        code, number, text = _KEYS.get(key) or (f"Digit{key}", ord(key), key)
        said = {"key": key, "code": code, "windowsVirtualKeyCode": number}
        self.ask("Input.dispatchKeyEvent", type="keyDown", **said, **({"text": text} if text else {}))
        self.ask("Input.dispatchKeyEvent", type="keyUp", **said)

    def resize(self, width: int, height: int) -> None:
        """Set the size of the page in pixels; one narrower than 600 has the layout for phones."""
        phone = width < 600
        self.ask("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=phone)

    def picture(self, path: Path) -> None:
        """Write a screenshot of the whole page to a PNG file."""
        size = self.ask("Page.getLayoutMetrics")["cssContentSize"]
        clip = {"x": 0, "y": 0, "width": size["width"], "height": size["height"], "scale": 1}
        data = self.ask("Page.captureScreenshot", clip=clip, captureBeyondViewport=True)["data"]
        path.write_bytes(base64.b64decode(data))

    def troubles(self) -> list[str]:
        """Return the errors of the page: its exceptions and the errors that the browser logged."""
        found = []
        for event in self.events:
            if event.get("method") == "Runtime.exceptionThrown":
                found.append(json.dumps(event["params"]["exceptionDetails"]))
            elif event.get("method") == "Log.entryAdded" and event["params"]["entry"]["level"] == "error":
                found.append(event["params"]["entry"]["text"])
        return found


def wait_until(check: Callable[[], Any], what: str) -> Any:
    """Wait for the first true value of a check and return it; fail after the time limit."""
    end_s = time.monotonic() + _ANSWER_S
    while time.monotonic() < end_s:
        found = check()
        if found:
            return found
        time.sleep(0.05)
    raise AssertionError(f"not within {_ANSWER_S:g} s: {what}")


@contextmanager
def opened(folder: Path, language: str) -> Iterator[Page]:
    """Open a browser with a language, a folder for downloads and a profile folder."""
    command = browser_command()
    assert command is not None
    theirs, to_browser = os.pipe()
    from_browser, ours = os.pipe()
    options = ["--no-sandbox", "--disable-gpu", "--mute-audio", "--remote-debugging-pipe", "--no-first-run"]
    if "headless-shell" not in command:
        options.append("--headless=new")
    profile = folder / "profile"
    process = subprocess.Popen(
        [
            *("bash", "-c", f'exec "$0" "$@" 3<&{theirs} 4>&{ours}'),
            *(command, *options, f"--user-data-dir={profile}", f"--accept-lang={language}", f"--lang={language}"),
        ],
        pass_fds=(theirs, ours),
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )
    os.close(theirs)
    os.close(ours)
    try:
        page = Page(process, to_browser, from_browser)
        page.ask("Browser.setDownloadBehavior", behavior="allow", downloadPath=str(folder))
        page.attach()
        yield page
    finally:
        process.terminate()
        process.wait()
        os.close(to_browser)
        os.close(from_browser)
