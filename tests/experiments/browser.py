"""A real browser for the tests: chromium without a window, over WebDriver.

Only what the tests need of the protocol, with what Python brings along.
"""

from __future__ import annotations

import base64
import io
import json
import re
import shutil
import subprocess
import tempfile
import time
import unittest
import urllib.error
import urllib.request
from pathlib import Path
from typing import Any

import matplotlib.image
import numpy as np
from numpy.typing import NDArray

DRIVER = shutil.which("chromedriver")
CHROMIUM = shutil.which("chromium")
_PATIENCE_S = 120
_FLAGS = (
    "--headless",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--disable-dev-shm-usage",
    "--force-device-scale-factor=1",
    "--hide-scrollbars",
    # WebGL without a graphics card.
    "--use-gl=angle",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    # Whatever a page might ask for, there is no network.
    "--host-resolver-rules=MAP * ~NOTFOUND",
)
_KEYS = {
    "up": "\ue013",
    "down": "\ue015",
    "left": "\ue012",
    "right": "\ue014",
    "home": "\ue011",
    "end": "\ue010",
    "escape": "\ue00c",
}

needs_browser = unittest.skipUnless(
    DRIVER and CHROMIUM,
    "needs chromium and chromedriver: install chromium and chromium-driver",
)


class Browser:
    """One browser with one window, its profile gone afterwards."""

    def __init__(self, width: int = 1280, height: int = 860) -> None:
        assert DRIVER and CHROMIUM
        self._profile = tempfile.TemporaryDirectory(
            prefix="browser-", ignore_cleanup_errors=True
        )
        self._driver = subprocess.Popen(
            [DRIVER, "--port=0"],
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
        )
        try:
            self._address = f"http://127.0.0.1:{self._port()}"
            self._session = self._ask("POST", "/session", self._wishes(width, height))[
                "sessionId"
            ]
        except BaseException:
            self._stop_driver()
            raise

    def close(self) -> None:
        """Ends the browser and its driver."""
        try:
            self._command("DELETE", "")
        finally:
            self._stop_driver()

    def open(self, page: Path, hash_: str = "") -> None:
        """Loads a page from disk and waits until it says that it is ready."""
        self._command("POST", "/url", {"url": page.resolve().as_uri() + hash_})
        self.wait_for("document.documentElement.dataset.ready === 'yes'")

    def become_a_phone(self, width: int = 390, height: int = 844) -> None:
        """Shows pages from now on as a telephone of that many points does."""
        self._command(
            "POST",
            "/goog/cdp/execute",
            {
                "cmd": "Emulation.setDeviceMetricsOverride",
                "params": {
                    "width": width,
                    "height": height,
                    "deviceScaleFactor": 1,
                    "mobile": True,
                },
            },
        )

    def run(self, script: str, *arguments: object) -> Any:
        """The value that the body of a function returns."""
        return self._command(
            "POST",
            "/execute/sync",
            {"script": script, "args": list(arguments)},
        )

    def value(self, expression: str) -> Any:
        """The value of an expression; a promise's once it is there."""
        return self.run(f"return {expression};")

    def wait_for(self, condition: str) -> None:
        """Waits until an expression is true."""
        deadline = time.monotonic() + _PATIENCE_S
        while not self.value(f"Boolean({condition})"):
            if time.monotonic() > deadline:
                raise AssertionError(
                    f"never came true: {condition}; log: {self.complaints()}"
                )
            time.sleep(0.02)

    def press(self, key: str, shift: bool = False) -> None:
        """Strikes a key where the focus is; by name or character."""
        stroke = _KEYS.get(key, key)
        actions = [
            {"type": "keyDown", "value": stroke},
            {"type": "keyUp", "value": stroke},
        ]
        if shift:
            actions.insert(0, {"type": "keyDown", "value": "\ue008"})
            actions.append({"type": "keyUp", "value": "\ue008"})
        self._command(
            "POST",
            "/actions",
            {"actions": [{"type": "key", "id": "keys", "actions": actions}]},
        )

    def drag(self, selector: str, dx: int, dy: int) -> None:
        """Drags with the left button from the middle of an element."""
        origin = self._find(selector)
        self._command(
            "POST",
            "/actions",
            {
                "actions": [
                    {
                        "type": "pointer",
                        "id": "mouse",
                        "actions": [
                            {"type": "pointerMove", "origin": origin, "x": 0, "y": 0},
                            {"type": "pointerDown", "button": 0},
                            {
                                "type": "pointerMove",
                                "origin": "pointer",
                                "x": dx,
                                "y": dy,
                                "duration": 100,
                            },
                            {"type": "pointerUp", "button": 0},
                        ],
                    }
                ]
            },
        )

    def click(self, selector: str) -> None:
        """Clicks an element as a user does."""
        element = self._find(selector)
        name = next(iter(element.values()))
        self._command("POST", f"/element/{name}/click", {})

    def picture(self, selector: str | None = None) -> NDArray[np.float32]:
        """What is seen of an element or of the window: rows of RGB(A)."""
        data = io.BytesIO(self.png(selector))
        return np.asarray(matplotlib.image.imread(data, format="png"))

    def png(self, selector: str | None = None) -> bytes:
        """The same as a file."""
        # Two frames later all that was asked for is drawn.
        self._command(
            "POST",
            "/execute/async",
            {
                "script": "const done = arguments[0];"
                "requestAnimationFrame(() => requestAnimationFrame(() => done(0)));",
                "args": [],
            },
        )
        place = ""
        if selector is not None:
            place = f"/element/{next(iter(self._find(selector).values()))}"
        return base64.b64decode(self._command("GET", f"{place}/screenshot"))

    def complaints(self) -> list[str]:
        """What the page has logged since the last call, warnings and worse."""
        entries = self._command("POST", "/se/log", {"type": "browser"})
        return [
            f"{entry['level']}: {entry['message']}"
            for entry in entries
            if entry["level"] in ("WARNING", "SEVERE")
            # What the browser says of its own software renderer.
            and not re.search(r"GL Driver Message|SwiftShader", entry["message"])
        ]

    def _find(self, selector: str) -> dict[str, str]:
        return self._command(
            "POST", "/element", {"using": "css selector", "value": selector}
        )

    def _wishes(self, width: int, height: int) -> dict[str, Any]:
        return {
            "capabilities": {
                "alwaysMatch": {
                    "browserName": "chrome",
                    "goog:chromeOptions": {
                        "binary": CHROMIUM,
                        "args": [
                            *_FLAGS,
                            f"--user-data-dir={self._profile.name}",
                            f"--window-size={width},{height}",
                        ],
                    },
                    "goog:loggingPrefs": {"browser": "ALL"},
                    "timeouts": {"script": 1000 * _PATIENCE_S},
                }
            }
        }

    def _port(self) -> int:
        assert self._driver.stdout is not None
        for line in self._driver.stdout:
            if found := re.search(r"started successfully on port (\d+)", line):
                return int(found[1])
        raise AssertionError("chromedriver does not start")

    def _command(self, method: str, path: str, body: Any = None) -> Any:
        return self._ask(method, f"/session/{self._session}{path}", body)

    def _ask(self, method: str, path: str, body: Any = None) -> Any:
        request = urllib.request.Request(
            self._address + path,
            method=method,
            data=None if body is None else json.dumps(body).encode(),
            headers={"Content-Type": "application/json"},
        )
        opener = urllib.request.build_opener(urllib.request.ProxyHandler({}))
        try:
            with opener.open(request, timeout=2 * _PATIENCE_S) as answer:
                return json.load(answer)["value"]
        except urllib.error.HTTPError as error:
            raise AssertionError(error.read().decode()[:2000]) from error

    def _stop_driver(self) -> None:
        self._driver.terminate()
        try:
            self._driver.wait(timeout=20)
        except subprocess.TimeoutExpired:
            self._driver.kill()
            self._driver.wait()
        if self._driver.stdout is not None:
            self._driver.stdout.close()
        self._profile.cleanup()
