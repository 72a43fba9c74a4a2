"""A real browser (chromium, by chromedriver), for the tests of pages."""

import base64
import json
import os
import shutil
import signal
import socket
import subprocess
import time
import urllib.error
import urllib.request


class Browser:
    """W3C WebDriver, as much as these need."""

    def __init__(self, profile, *more_flags):
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            port = free.getsockname()[1]
        self.driver = subprocess.Popen([shutil.which("chromedriver"), f"--port={port}"], stdout=subprocess.DEVNULL,
                                       stderr=subprocess.DEVNULL, start_new_session=True)
        self.address = f"http://127.0.0.1:{port}"
        flags = ["--headless=new", "--disable-gpu", "--enable-unsafe-swiftshader", "--no-first-run", "--disable-sync",
                 "--disable-background-networking", "--disable-component-update", f"--user-data-dir={profile}",
                 "--window-size=1300,1500", *more_flags]
        if os.geteuid() == 0:
            flags.append("--no-sandbox")
        wanted = {"capabilities": {"alwaysMatch": {"goog:chromeOptions": {"args": flags},
                                                   "goog:loggingPrefs": {"browser": "ALL"}}}}
        end = time.monotonic() + 60
        while True:
            try:
                self.session = "/session/" + self.call("/session", wanted)["sessionId"]
                return
            except (urllib.error.URLError, ConnectionError):
                if time.monotonic() > end:
                    raise
                time.sleep(0.2)

    def call(self, path, body=None):
        request = urllib.request.Request(self.address + path, method="GET" if body is None else "POST",
                                         data=None if body is None else json.dumps(body).encode(),
                                         headers={"Content-Type": "application/json"})
        with urllib.request.urlopen(request, timeout=120) as answer:
            return json.load(answer)["value"]

    def open(self, address):
        self.call(self.session + "/url", {"url": address})

    def run(self, script):
        return self.call(self.session + "/execute/sync", {"script": script, "args": []})

    def new_window(self):
        """Opens one more, and goes on in it."""
        made = self.call(self.session + "/window/new", {"type": "window"})
        self.go_to(made["handle"])
        return made["handle"]

    def window(self):
        return self.call(self.session + "/window")

    def go_to(self, handle):
        self.call(self.session + "/window", {"handle": handle})

    def console(self):
        return self.call(self.session + "/se/log", {"type": "browser"})

    def click(self, selector):
        found = self.call(self.session + "/element", {"using": "css selector", "value": selector})
        self.call(self.session + f"/element/{next(iter(found.values()))}/click", {})

    def screenshot(self):
        return base64.b64decode(self.call(self.session + "/screenshot"))

    def close(self):
        os.killpg(self.driver.pid, signal.SIGKILL)
        self.driver.wait()
