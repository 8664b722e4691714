"""Debian's Chromium without a window, for tests of pages and of the site."""

from __future__ import annotations

import pathlib
import shutil
import time
import unittest

try:
    from selenium import webdriver
    from selenium.webdriver.chrome.service import Service
except ImportError:
    webdriver = None

_IS_THERE = webdriver is not None and all(shutil.which(name) for name in ("chromium", "chromedriver"))
_PATIENCE = 20.0  # s, for a page to be ready


class _Browser:
    """One window; `open` loads a page and waits until its script is ready."""

    def __init__(self):
        self.driver = None

    def start(self):
        options = webdriver.ChromeOptions()
        options.binary_location = shutil.which("chromium")
        # root, as in containers, has no sandbox
        for word in ("--headless=new", "--no-sandbox", "--disable-gpu", "--hide-scrollbars",
                     "--enable-unsafe-swiftshader"):  # WebGL by the processor, without a warning
            options.add_argument(word)
        options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
        self.driver = webdriver.Chrome(service=Service(shutil.which("chromedriver")), options=options)

    def open(self, page: pathlib.Path, width: int = 1280, height: int = 900, scheme: str = "light") -> None:
        self.driver.execute_cdp_cmd("Emulation.setEmulatedMedia",
                                    {"features": [{"name": "prefers-color-scheme", "value": scheme}]})
        self.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride",
                                    {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": False})
        self.driver.get(page.resolve().as_uri())
        self.wait("return window.pyroclast !== undefined || document.getElementById('data') === null")

    def wait(self, script: str) -> None:
        end = time.monotonic() + _PATIENCE
        while not self.run(script):
            if time.monotonic() > end:
                raise AssertionError(f"not so within {_PATIENCE:g} s: {script}; console: {self.console()}")
            time.sleep(0.02)

    def run(self, script: str, *arguments):
        return self.driver.execute_script(script, *arguments)

    def console(self) -> list[str]:
        """What the page has said since it was last asked."""
        return [entry["message"] for entry in self.driver.get_log("browser")]

    def press(self, key: str, **more) -> None:
        """A key, as the page hears it. more: shiftKey."""
        self.run("document.body.dispatchEvent(new KeyboardEvent('keydown', Object.assign({key: arguments[0], "
                 "bubbles: true, cancelable: true}, arguments[1])))", key, more)

    def mouse(self, kind: str, x: float, y: float) -> None:
        """A real event of the mouse in the window: "mousePressed", "mouseReleased" or "mouseMoved"."""
        held = {"button": "left", "buttons": 1, "clickCount": 1} if kind != "mouseMoved" else {"buttons": 1}
        self.driver.execute_cdp_cmd("Input.dispatchMouseEvent", {"type": kind, "x": x, "y": y, **held})

    def place(self, selector: str) -> dict[str, float]:
        """Where an element lies in the window, once it is scrolled into view."""
        return self.run("const e = document.querySelector(arguments[0]); e.scrollIntoView({block: 'center'}); "
                        "const {x, y, width, height} = e.getBoundingClientRect(); return {x, y, width, height}",
                        selector)

    def close(self) -> None:
        self.driver.quit()


browser = _Browser()


def begin() -> None:
    """Starts the browser for a module of tests."""
    if not _IS_THERE:
        raise unittest.SkipTest("chromium, chromium-driver or python3-selenium is not installed")
    browser.start()
    unittest.addModuleCleanup(browser.close)
