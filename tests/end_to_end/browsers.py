"""Chromium and Firefox without a window, a network or a library: by their own remote protocols."""

import base64
import json
import os
import shutil
import socket
import subprocess
import tempfile
import time
from importlib.util import find_spec
from pathlib import Path
from typing import Any, Self

import pytest

from ..workflow.running import free_port

KEYS = {
    "Tab": (9, "", "\ue004"),
    "Enter": (13, "\r", "\ue007"),
    "Space": (32, " ", " "),
}
"""Keys by name: their number and text in Chromium, and their letter in WebDriver."""


class Driven:
    """A browser that is told by messages in JSON what to do, in a folder of its own that goes with it."""

    name: str

    def __init__(self) -> None:
        self.console: list[str] = []
        self._number, self._buffer = 0, b""
        self._folder = tempfile.TemporaryDirectory(
            prefix=self.name, ignore_cleanup_errors=True
        )

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._process.terminate()
        self._process.communicate(timeout=20)
        self._folder.cleanup()

    def _start(self, *command: str, **pipes: int) -> None:
        quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL} | pipes
        self._process: subprocess.Popen[bytes] = subprocess.Popen(command, **quiet)  # type: ignore[call-overload]

    def _before(self, mark: bytes) -> bytes:
        """What comes until a mark."""
        while mark not in self._buffer:
            self._receive()
        text, _, self._buffer = self._buffer.partition(mark)
        return text

    def _receive(self) -> None:
        part = self._more()
        assert part, f"{self.name} ended"
        self._buffer += part

    def _more(self) -> bytes:
        raise NotImplementedError


class Chromium(Driven):
    """Chromium by its DevTools protocol, over two pipes."""

    name = "chromium"

    def __init__(self) -> None:
        super().__init__()
        # the browser reads from descriptor 3 and writes to 4
        self._start(
            *("sh", "-c", 'exec "$@" 3<&0 4>&1 >/dev/null', "sh", CHROMIUM or ""),
            *("--headless=new", "--no-sandbox", "--disable-gpu", "--no-first-run"),
            *(
                "--remote-debugging-pipe",
                "--hide-scrollbars",
                "--proxy-server=127.0.0.1:9",
            ),
            f"--user-data-dir={self._folder.name}",
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
        )
        self._session: dict[str, str] = {}
        target = self._ask("Target.createTarget", url="about:blank")["targetId"]
        about = self._ask("Target.attachToTarget", targetId=target, flatten=True)
        self._session = {"sessionId": about["sessionId"]}
        for domain in ("Page", "Runtime", "Log"):
            self._ask(f"{domain}.enable")

    def open(
        self, page: Path, width: int = 1400, height: int = 1000, *, dark: bool = False
    ) -> None:
        self.console.clear()
        size = {
            "width": width,
            "height": height,
            "deviceScaleFactor": 1,
            "mobile": False,
        }
        self._ask("Emulation.setDeviceMetricsOverride", **size)
        scheme = {"name": "prefers-color-scheme", "value": "dark" if dark else "light"}
        self._ask("Emulation.setEmulatedMedia", media="", features=[scheme])
        self._ask("Page.navigate", url=page.resolve().as_uri())
        self.run(
            "new Promise(done => document.readyState === 'complete' ? done() : addEventListener('load', done))"
        )

    def run(self, script: str) -> Any:
        how = {"awaitPromise": True, "returnByValue": True}
        found = self._ask("Runtime.evaluate", expression=script, **how)
        assert "exceptionDetails" not in found, str(found["exceptionDetails"])
        return found["result"].get("value")

    def press(self, *keys: str) -> None:
        for key in keys:
            if key not in KEYS:
                self._ask("Input.insertText", text=key)
                continue
            number, text, _ = KEYS[key]
            about = {"key": text or key, "code": key, "windowsVirtualKeyCode": number}
            self._ask("Input.dispatchKeyEvent", type="keyDown", text=text, **about)
            self._ask("Input.dispatchKeyEvent", type="keyUp", **about)

    def printed(self) -> bytes:
        """Return the page as it is printed, as PDF."""
        return base64.b64decode(
            self._ask("Page.printToPDF", preferCSSPageSize=True)["data"]
        )

    def _ask(self, method: str, **params: Any) -> Any:
        self._number += 1
        message = {
            "id": self._number,
            "method": method,
            "params": params,
        } | self._session
        pipe = self._process.stdin
        assert pipe is not None
        pipe.write(json.dumps(message).encode() + b"\0")
        pipe.flush()
        while (answer := json.loads(self._before(b"\0"))).get("id") != self._number:
            self._note(answer.get("method"), answer.get("params", {}))
        assert "error" not in answer, f"{method}: {answer['error']}"
        return answer["result"]

    def _more(self) -> bytes:
        assert self._process.stdout is not None
        return os.read(self._process.stdout.fileno(), 1 << 20)

    def _note(self, method: str | None, params: Any) -> None:
        if method == "Runtime.exceptionThrown":
            thrown = params["exceptionDetails"]
            self.console.append(
                str(thrown.get("exception", {}).get("description", thrown["text"]))
            )
        elif method == "Runtime.consoleAPICalled":
            self.console.append(
                str([argument.get("value") for argument in params["args"]])
            )
        elif method == "Log.entryAdded":
            self.console.append(params["entry"]["text"])


class Firefox(Driven):
    """Firefox by Marionette, over a socket."""

    name = "firefox"

    def __init__(self) -> None:
        super().__init__()
        port = free_port()
        preferences = Path(__file__).with_name("firefox.js").read_text()
        (Path(self._folder.name) / "user.js").write_text(
            preferences.replace("PORT", str(port))
        )
        self._start(
            *(
                FIREFOX or "",
                "--headless",
                "--marionette",
                "--remote-allow-system-access",
            ),
            *("--profile", self._folder.name, "--no-remote"),
        )
        self._socket = _connected(port)
        self._next()
        capabilities = {"alwaysMatch": {"acceptInsecureCerts": True}}
        self._ask("WebDriver:NewSession", capabilities=capabilities)
        self._ask("WebDriver:SetTimeouts", script=120000)

    def __exit__(self, *_: object) -> None:
        super().__exit__()
        self._socket.close()

    def open(
        self, page: Path, width: int = 1400, height: int = 1000, *, dark: bool = False
    ) -> None:
        self._in_chrome(
            "Services.prefs.setIntPref('layout.css.prefers-color-scheme.content-override', arguments[0]);"
            "Services.console.reset();",
            0 if dark else 1,
        )
        self._ask("WebDriver:SetWindowRect", width=width, height=height + 85)
        self._ask("WebDriver:Navigate", url=page.resolve().as_uri())

    def run(self, script: str) -> Any:
        found = self._execute(f"return ({script})", newSandbox=False)
        self.console = self._in_chrome(
            "return Services.console.getMessageArray().map(m => m.message || '').filter(m => m.includes('file://'));"
        )
        return found

    def press(self, *keys: str) -> None:
        letters = [
            letter for key in keys for letter in (KEYS[key][2] if key in KEYS else key)
        ]
        both = [
            {"type": kind, "value": a} for a in letters for kind in ("keyDown", "keyUp")
        ]
        keyboard = {"type": "key", "id": "keyboard", "actions": both}
        self._ask("WebDriver:PerformActions", actions=[keyboard])

    def _in_chrome(self, script: str, *arguments: Any) -> Any:
        self._ask("Marionette:SetContext", value="chrome")
        try:
            return self._execute(script, *arguments)
        finally:
            self._ask("Marionette:SetContext", value="content")

    def _execute(self, script: str, *arguments: Any, **how: bool) -> Any:
        about = {"script": script, "args": list(arguments)} | how
        return self._ask("WebDriver:ExecuteScript", **about)["value"]

    def _ask(self, method: str, **params: Any) -> Any:
        self._number += 1
        text = json.dumps([0, self._number, method, params]).encode()
        self._socket.sendall(str(len(text)).encode() + b":" + text)
        _, _, error, result = self._next()
        assert not error, f"{method}: {error['message']}"
        return result

    def _next(self) -> Any:
        length = int(self._before(b":"))
        while len(self._buffer) < length:
            self._receive()
        text, self._buffer = self._buffer[:length], self._buffer[length:]
        return json.loads(text)

    def _more(self) -> bytes:
        return self._socket.recv(1 << 20)


Browser = Chromium | Firefox
"""A browser opens a page in a window of so many pixels, runs expressions or promises in it, and presses keys."""


def _connected(port: int) -> socket.socket:
    """Connect to a browser that is still starting."""
    for _ in range(300):
        try:
            return socket.create_connection(("127.0.0.1", port), timeout=180)
        except OSError:
            time.sleep(0.1)
    raise AssertionError("Firefox does not answer")


def _program(*names: str) -> str | None:
    return next((path for name in names if (path := shutil.which(name))), None)


CHROMIUM = _program("chromium", "chromium-browser", "google-chrome")
FIREFOX = _program("firefox-esr", "firefox")
BROWSERS = {"chromium": (Chromium, CHROMIUM), "firefox": (Firefox, FIREFOX)}
"""Each with the path of its program, or None where there is none."""

QUICK_IN_ONE = pytest.mark.parametrize(
    "browser",
    ["chromium", pytest.param("firefox", marks=pytest.mark.slow)],
    indirect=True,
)
"""Marks long tests whose figures and words are seen in both browsers by quick ones."""


def expression(name: str) -> str:
    """Return the expression that a script beside this file holds, without its last semicolon."""
    text = Path(__file__).with_name(name).read_text(encoding="utf-8")
    return text.rstrip().removesuffix(";")


def put(browser: Browser, place: str, value: object, event: str = "input") -> None:
    """Give the element at a selector a value, as a person does."""
    browser.run(
        f"(() => {{ const field = document.querySelector({json.dumps(place)}); field.focus();"
        f"field.value = {json.dumps(value)}; field.dispatchEvent(new Event('{event}', {{bubbles: true}})); }})()"
    )


def put_file(browser: Browser, name: str, text: str) -> None:
    """Open a file in the page of ``rockfrag app``."""
    browser.run(
        f"(() => {{ const data = new DataTransfer(); data.items.add(new File([{json.dumps(text)}], '{name}'));"
        "const file = document.getElementById('file'); file.files = data.files;"
        "file.dispatchEvent(new Event('change')); })()"
    )


def waited(browser: Browser, script: str) -> None:
    """Wait until something is so in the page."""
    until = time.monotonic() + 60
    while not browser.run(script):
        if time.monotonic() > until:
            raise AssertionError(
                f"{script}: {browser.run('document.body.innerText')[:2000]}"
            )
        time.sleep(0.02)


def barriers(browser: Browser) -> list[list[str]]:
    """What axe finds in the page that keeps readers from it; skips where it is not installed."""
    axe = find_spec("axe_core_python")
    if axe is None or axe.origin is None:
        pytest.skip("axe-core-python is not installed")
    script = (Path(axe.origin).parent / "axe.min.js").read_text(encoding="utf-8")
    browser.run(f"(() => {{ {script} }})() || 1")
    return browser.run(
        "axe.run().then(found => found.violations.map(one => [one.id, one.nodes[0].html]))"
    )


READY = "document.getElementById('live').dataset.ready"
ANSWERED = (
    "document.body.dataset.stage === 'complete' && !document.querySelector('.stale')"
)
"""When a page with a simulation, and the page of ``rockfrag app``, have done what they were asked."""

# nothing is wider than the window
FITS = "document.documentElement.scrollWidth <= innerWidth"


def opened(
    browser: Browser, page: Path, *size: int, ready: str = READY, dark: bool = False
) -> None:
    """Open a page in a window of a size, and wait until it is ready."""
    browser.open(page, *size, dark=dark)
    waited(browser, ready)
