#!/usr/bin/env python3
"""Opens pages of `gyrolog report` in a real headless Chromium, over its DevTools pipe: no request leaves, the console
stays silent, each picture is decoded, the text stands there, nothing is wider than the window, and the page prints.
Exit 77: Chromium is absent.

    browser_test.py PROGRAM [FOLDER]     FOLDER keeps the page, screenshots (light, grey, narrow) and the printed PDF
"""

import base64
import json
import os
import pathlib
import select
import shutil
import subprocess
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2]))

from schemas import KeptFolder  # noqa: E402

SOON_S = 120
MODEL = {"schema": "gyrolog-model/1", "rate_hz": 100, "axes": {axis: {"N": 0.01, "B": 0.001} for axis in "xyz"}}
WIDE, NARROW = 1100, 420  # of a window of a screen and of a telephone
LONG_NAME = "recordings_of_the_second_turntable_" * 5
A4_TEXT = 680  # 180 mm at 96 pixels an inch
HIGH = 700  # of 1000 of a page: with a heading and its text above, a higher picture leaves most of two pages empty


class Browser:
    """One page of a headless Chromium. Messages are JSON with a 0 behind, on descriptors 3 and 4."""

    def __init__(self, chromium, folder):
        to_browser, self.commands = os.pipe()
        self.answers, from_browser = os.pipe()

        def at_3_and_4():
            # Copies first: either may be 3 or 4 itself.
            read_end, write_end = os.dup(to_browser), os.dup(from_browser)
            os.dup2(read_end, 3)
            os.dup2(write_end, 4)

        self.process = subprocess.Popen(
            [chromium, "--headless", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--no-first-run",
             "--remote-debugging-pipe", f"--user-data-dir={folder / 'profile'}"],
            preexec_fn=at_3_and_4, close_fds=False, env={**os.environ, "HOME": str(folder)},
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(to_browser)
        os.close(from_browser)
        self.buffer = b""
        self.number = 0
        self.events = []
        self.session = None
        target = self.call("Target.createTarget", url="about:blank")["targetId"]
        self.session = self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]

    def end(self):
        self.process.kill()
        self.process.wait()
        os.close(self.commands)
        os.close(self.answers)

    def message(self):
        end = time.monotonic() + SOON_S
        while b"\0" not in self.buffer:
            ready = select.select([self.answers], [], [], max(0.0, end - time.monotonic()))[0]
            piece = os.read(self.answers, 1 << 20) if ready else b""
            assert piece, "Chromium does not answer"
            self.buffer += piece
        text, self.buffer = self.buffer.split(b"\0", 1)
        return json.loads(text)

    def call(self, method, **parameters):
        self.number += 1
        command = {"id": self.number, "method": method, "params": parameters}
        if self.session:
            command["sessionId"] = self.session
        os.write(self.commands, json.dumps(command).encode() + b"\0")
        while True:
            came = self.message()
            if came.get("id") == self.number:
                assert "result" in came, (method, came)
                return came["result"]
            self.events.append(came)

    def wait_for(self, method):
        while not any(event.get("method") == method for event in self.events):
            self.events.append(self.message())

    def told(self, method):
        return [event["params"] for event in self.events if event.get("method") == method]

    def value(self, expression):
        result = self.call("Runtime.evaluate", expression=expression, awaitPromise=True, returnByValue=True)
        assert "exceptionDetails" not in result, result
        return result["result"]["value"]

    def open(self, path):
        for domain in ("Network", "Log", "Runtime", "Page"):
            self.call(f"{domain}.enable")
        self.call("Network.emulateNetworkConditions", offline=True, latency=0, downloadThroughput=0, uploadThroughput=0)
        self.events.clear()
        self.call("Page.navigate", url=path.as_uri())
        self.wait_for("Page.loadEventFired")

    def resize(self, width):
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=900, deviceScaleFactor=1, mobile=False)

    def screen(self, grey=False):
        """A picture of the whole page, for which Chromium makes the window as large as all that could be scrolled to."""
        self.call("Emulation.setEmulatedVisionDeficiency", type="achromatopsia" if grey else "none")
        return base64.b64decode(self.call("Page.captureScreenshot", captureBeyondViewport=True)["data"])


def run(*command, returns=0):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True)
    assert done.returncode == returns, f"{command}: {done.returncode}\n{done.stdout}{done.stderr}"


def complaints_about(browser, path):
    requested = [request["request"]["url"] for request in browser.told("Network.requestWillBeSent")]
    found = [f"asks for {url[:80]}" for url in requested if url != path.as_uri() and not url.startswith("data:")]
    found += [f"console: {told}" for told in browser.told("Runtime.consoleAPICalled") + browser.told("Log.entryAdded")]
    found += [f"script: {told}" for told in browser.told("Runtime.exceptionThrown")]
    return found


def look_at(browser, path, titles, keep, pictures_least=3):
    browser.open(path)
    found = complaints_about(browser, path)
    pictures = browser.value("""Promise.all([...document.images].map(image => image.decode().then(
        () => [image.naturalWidth, image.clientWidth, image.alt], problem => [0, 0, image.alt + problem])))""")
    found += [f"picture not decoded: {alt}" for natural, shown, alt in pictures if natural == 0 or shown == 0]
    found += [f"picture without words for those who do not see it: {index}"
              for index, picture in enumerate(pictures) if not picture[2]]
    if len(pictures) < pictures_least:
        found.append(f"{len(pictures)} pictures only")
    text = browser.value("document.body.innerText")
    found += [f"no '{title}'" for title in titles if title not in text]
    for width in (WIDE, NARROW):
        browser.resize(width)
        needed = browser.value("document.documentElement.scrollWidth")
        if needed > width:
            found.append(f"is {needed} wide in a window of {width}")
    # A cell or a picture that the page's edge cuts is lost on paper.
    browser.call("Emulation.setEmulatedMedia", media="print")
    browser.resize(A4_TEXT)
    wide = browser.value("""[...document.querySelectorAll('table, img')].filter(
        one => one.getBoundingClientRect().right > document.documentElement.clientWidth + 1).map(
        one => one.tagName + ' ' + one.innerText.slice(0, 60))""")
    found += [f"cut on A4: {one}" for one in wide]
    high = browser.value(f"""[...document.images].filter(
        one => one.getBoundingClientRect().height > {HIGH}).map(one => one.alt)""")
    found += [f"leaves pages half empty: {one}" for one in high]
    browser.call("Emulation.setEmulatedMedia", media="")
    # Last, for the pictures leave the window as large as they are.
    for width in (WIDE, NARROW):
        browser.resize(width)
        (keep / f"{path.stem}.{width}.png").write_bytes(browser.screen())
    browser.resize(WIDE)
    (keep / f"{path.stem}.grey.png").write_bytes(browser.screen(grey=True))
    pdf = base64.b64decode(browser.call("Page.printToPDF", preferCSSPageSize=True, paperWidth=8.27,
                                        paperHeight=11.69)["data"])
    (keep / f"{path.stem}.pdf").write_bytes(pdf)
    if not pdf.startswith(b"%PDF-") or len(pdf) < 20000:
        found.append("does not print")
    return found


def notices_what_is_wrong(browser, folder, keep):
    """The test itself: a page that does all that a report must not."""
    bad = folder / "bad.html"
    bad.write_text('<body><img alt="x" src="data:image/png;base64,AAAA"><img src="http://gyrolog.invalid/a.png">'
                   '<script>console.error("no")</script><div style="width:3000px">wide</div>'
                   f'<img alt="high" src="data:," style="height:{HIGH + 1}px">')
    found = "\n".join(look_at(browser, bad, ["Bias"], keep))
    for expected in ("asks for http://gyrolog.invalid", "console:", "not decoded", "no 'Bias'", "wide in a window of 1100",
                     "does not print", "half empty: high"):
        assert expected in found, f"not noticed: {expected}\n{found}"


def main():
    program = pathlib.Path(sys.argv[1]).resolve()
    chromium = shutil.which("chromium")
    if chromium is None:
        print("skipped: needs chromium")
        sys.exit(77)
    with KeptFolder() as name:
        folder = pathlib.Path(name)
        keep = pathlib.Path(sys.argv[2]) if len(sys.argv) > 2 else folder / "kept"
        keep.mkdir(exist_ok=True)
        (folder / "model.json").write_text(json.dumps(MODEL))
        run(program, "capture", "--device", "sim:rate=100,seed=7", "--duration", "15m", "-o", folder / "board.pcapng")
        run(program, "report", folder / "board.pcapng", "-o", folder / "plain.html")
        run(program, "report", folder / "board.pcapng", "--model", folder / "model.json", "--simulations", "20", "-o",
            folder / "diagnosed.html")
        texts = [folder / f"text{seed}.csv" for seed in range(4)]
        for seed, text in enumerate(texts):
            run(program, "simulate", folder / "model.json", "-o", text, "--duration", "2m", "--seed", seed)
        # A page is as wide as it is wherever its recordings lie: a path is one word to a browser.
        far = folder / LONG_NAME
        far.mkdir()
        shutil.copy(folder / "board.pcapng", far / "board.pcapng")
        (far / "text.csv").write_text("no table\n")
        run(program, "analyze", far / "board.pcapng", *texts, "--jsonl", folder / "lines.jsonl")
        run(program, "analyze", far / "text.csv", "--jsonl", folder / "bad.jsonl", returns=1)
        with open(folder / "lines.jsonl", "a") as lines:
            lines.write((folder / "bad.jsonl").read_text())
        run(program, "report", folder / "lines.jsonl", "-o", folder / "many.html")
        titles = ["What was recorded", "Allan deviation and spectrum", "Noise coefficients", "Bias",
                  "What to record next"]
        problems = []
        browser = Browser(chromium, folder)
        try:
            notices_what_is_wrong(browser, folder, folder)
            for page, more in (("plain", []), ("diagnosed", ["Against the model"])):
                shutil.copy(folder / f"{page}.html", keep / f"{page}.html")
                problems += [f"{page}: {one}" for one in look_at(browser, keep / f"{page}.html", titles + more, keep)]
            shutil.copy(folder / "many.html", keep / "many.html")
            problems += [f"many: {one}" for one in look_at(
                browser, keep / "many.html", ["What stands out", "How far the units lie apart", "Recordings"], keep, 1)]
        finally:
            browser.end()
    assert not problems, "\n".join(problems)
    print("all pages: as they should be")


if __name__ == "__main__":
    main()
