"""Chromium without a window, asked through its own pipe (Chrome DevTools Protocol)."""

import json
import os
import select
import shutil
import subprocess
import time

_NAMES = ("chromium", "chromium-browser", "google-chrome")
_FLAGS = (
    "--headless",
    "--no-sandbox",
    "--disable-gpu",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--hide-scrollbars",
    "--disable-dev-shm-usage",
    "--remote-debugging-pipe",
)


def find_chromium():
    """Its path; a test that needs it fails where there is none."""
    found = next((path for path in map(shutil.which, _NAMES) if path), None)
    if found is None:
        raise RuntimeError("no Chromium: install Debian's package 'chromium' (scripts/setup --for-tests does)")
    return found


class HeadlessBrowser:
    """One page; for use in ``with``. ``events`` holds everything the browser said unasked."""

    def __init__(self, profile, timeout=60.0):
        self._timeout, self._number, self._rest, self.events = timeout, 0, b"", []
        theirs_in, self._to = os.pipe()
        self._from, theirs_out = os.pipe()
        # The browser reads its orders from descriptor 3 and answers on 4.
        order = f"exec {find_chromium()} {' '.join(_FLAGS)} --user-data-dir='{profile}' 3<&{theirs_in} 4>&{theirs_out}"
        self._process = subprocess.Popen(
            ["bash", "-c", order],
            pass_fds=(theirs_in, theirs_out),
            stderr=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
        )
        os.close(theirs_in)
        os.close(theirs_out)
        self._session = None

    def __enter__(self):
        target = self.ask("Target.createTarget", url="about:blank")["targetId"]
        self._session = self.ask("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ("Page", "Network", "Runtime", "Log"):
            self.ask(f"{domain}.enable")
        return self

    def __exit__(self, *_):
        self._process.terminate()
        try:
            self._process.wait(10.0)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait(10.0)
        os.close(self._to)
        os.close(self._from)

    def open(self, url, width, height=800, mobile=False):
        """Load a page in a window of this size [CSS pixels]."""
        self.ask("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=mobile)
        self.events.clear()
        self.ask("Page.navigate", url=url)
        while not any(event["method"] == "Page.loadEventFired" for event in self.events):
            self.events.append(self._read("the page to load"))

    def value(self, expression):
        """Value of a JavaScript expression in the page."""
        answer = self.ask("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)
        assert "exceptionDetails" not in answer, answer
        return answer["result"].get("value")

    def ask(self, method, **parameters):
        """Answer to an order."""
        self._number += 1
        order = {"id": self._number, "method": method, "params": parameters}
        if self._session is not None:
            order["sessionId"] = self._session
        os.write(self._to, json.dumps(order).encode() + b"\0")
        while (message := self._read(method)).get("id") != self._number:
            self.events.append(message)
        assert "error" not in message, message
        return message["result"]

    def _read(self, what):
        deadline = time.monotonic() + self._timeout
        while b"\0" not in self._rest:
            ready, _, _ = select.select([self._from], [], [], max(0.0, deadline - time.monotonic()))
            part = os.read(self._from, 1 << 16) if ready else b""
            if not part:
                raise RuntimeError(f"Chromium ended or was silent for {self._timeout} s while waiting for {what}")
            self._rest += part
        message, self._rest = self._rest.split(b"\0", 1)
        return json.loads(message)
