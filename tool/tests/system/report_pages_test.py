#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Pages as a user sees them, from disk and without a network: charts and pictures are shown, no script fails, the
colour scheme is followed; nothing is wider than a phone, each chart has a text, ticks are at round numbers, there
is no dead link, and the keyboard works. Each page is opened in headless Chromium, in frames as wide as a phone and
a screen, with a probe added to copies of it. Skipped without Chromium.

usage: report_pages_test.py DEBURR [CLASS]
  DEBURR_KEEP_SCREENSHOTS=DIR writes a picture of each page to DIR, 1280 and 390 pixels wide."""
import array
import html
import itertools
import json
import math
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "tb/engines"))
from engine_list import trials  # noqa: E402

DEBURR = "deburr"
BROWSER = next((b for b in ("chromium", "chromium-browser", "google-chrome") if shutil.which(b)), None)
FLAGS = ["--headless", "--no-sandbox", "--disable-gpu", "--disable-background-networking", "--no-first-run",
         "--hide-scrollbars", "--host-resolver-rules=MAP * ~NOTFOUND", "--enable-logging=stderr"]
PHONE, DESKTOP = 390, 1280  # width
SCREEN = 844  # height of a phone
LIGHT, DARK = "rgb(246, 245, 242)", "rgb(19, 21, 24)"  # --page of page.css

# Runs in the page, and reports to the enclosing page.
PROBE = """
const probe_page = async () => {
  const wait = (ms) => new Promise((done) => setTimeout(done, ms));
  await wait(400);
  for (const box of document.querySelectorAll('details')) box.open = true;
  await wait(100);
  const root = document.documentElement;
  const label = (c) => c.getAttribute('aria-label') ?? '';
  const wide = [...document.querySelectorAll('body *')].filter((e) => e.getClientRects().length > 0 &&
      e.getBoundingClientRect().right > root.clientWidth + 1 && !e.closest('.scroll, .window') &&
      !e.matches('.strip img'))  // whose boxes hide what is beyond them
      .map((e) => `${e.tagName} ${e.id} ${e.className}`).slice(0, 5);
  const strips = [];  // whether the left and right edges of the picture viewer at Fit are of the pictures
  const told = {
    strips,
    width: root.clientWidth, needs: root.scrollWidth, wide,
    canvases: [...document.querySelectorAll('canvas')].map((c) => [c.id, label(c), c.getAttribute('role')]),
    page: getComputedStyle(document.body).backgroundColor,
    pictures: [...document.images].map((e) => [e.alt, e.naturalWidth]),
    // Colours of each canvas; of one that shows a file, which no script may read, -1.
    drawn: [...document.querySelectorAll('canvas')].filter((c) => c.getClientRects().length > 0 && c.width > 0).map((c) => {
      try {
        const pixels = new Uint32Array(c.getContext('2d').getImageData(0, 0, c.width, c.height).data.buffer);
        if (c.id === 'view') strips.push([1, c.width - 2].map((x) => pixels[c.width * (c.height >> 1) + x] >>> 24 === 255));
        return [c.id, new Set(pixels).size];
      } catch { return [c.id, -1]; }
    }),
    height: document.body.scrollHeight,
    contents: [...document.querySelectorAll('nav.contents a')].map((a) => a.getAttribute('href').slice(1)),
    heads: [...document.querySelectorAll('main h2')].filter((e) => e.getClientRects().length > 0).map((e) => e.id),
    links: [...document.querySelectorAll('a[href]')].map((a) => a.getAttribute('href')),
    empty: [...document.querySelectorAll('section, main h2')].filter((e) => e.innerText.trim() === '' &&
        e.getClientRects().length > 0).map((e) => e.outerHTML.slice(0, 80)),
    joined: [...document.querySelectorAll('h1 *, h2 *, h3 *')].filter((e) => e.previousSibling &&
        /\S$/.test(e.previousSibling.textContent) && /^\S/.test(e.textContent)).map((e) => e.parentElement.textContent),
    // Steps of a pixel may be as long as they like.
    cut: [...document.querySelectorAll('.scroll:not(.tall)')].filter((e) => e.scrollWidth > e.clientWidth + 1)
        .map((e) => e.innerText.slice(0, 40)),
    // Words on two lines; paths and hashes end where there is no more room.
    torn: [...document.querySelectorAll('h1, h2, h3, p, td, th, figcaption, summary, .tile *')].filter((e) => !e.closest('.anywhere, .reason'))
        .flatMap((e) => [...e.childNodes]).filter((n) => n.nodeType === 3).flatMap((n) => [...n.data.matchAll(/[A-Za-z]{2,}/g)].filter((m) => {
          const range = document.createRange();
          range.setStart(n, m.index);
          range.setEnd(n, m.index + m[0].length);
          return new Set([...range.getClientRects()].map((box) => Math.round(box.top))).size > 1;
        }).map((m) => `${m[0]} of ${n.parentElement.innerText.slice(0, 60)}`)),
    colours: typeof Chart === 'undefined' ? [] : [Chart.defaults.color, getComputedStyle(root).getPropertyValue('--muted').trim()],
    stills: [...document.querySelectorAll('.strip img')].map((e) => {
      const box = e.parentElement.getBoundingClientRect(), own = e.getBoundingClientRect();
      return [e.dataset.role, Math.min(box.width, own.width), Math.min(box.height, own.height),
              own.width / e.naturalWidth, own.height / e.naturalHeight];
    }),
    causes: typeof Chart === 'undefined' ? [] : Object.values(Chart.instances).flatMap((chart) =>
        chart.data.datasets.filter((d) => /^(stalled|busy|idle)/.test(d.label)).map((d) => [d.label, d.backgroundColor])),
    charts: typeof Chart === 'undefined' ? [] : Object.values(Chart.instances).map((chart) =>
        [chart.canvas.id, chart.chartArea.height, chart.legend?.options.display ? chart.legend.lineWidths.length : 0]),
    labels: typeof Chart === 'undefined' ? [] : Object.values(Chart.instances).map((chart) => chart.scales.y)
        .filter((y) => y && y._labelSizes?.widest?.width > y.width).map((y) => y.chart.canvas.id),
    ticks: typeof Chart === 'undefined' ? [] : Object.values(Chart.instances).map((chart) =>
        [chart.canvas.id, Object.entries(chart.scales).filter(([, s]) => s.type !== 'category' || s.ticks.some((t) => 'round' in t))
            .map(([name, s]) => [name, s.ticks.map((t) => String(t.label))])]),
  };
  told.keys = await (window.probe_keys ? window.probe_keys(wait) : null);
  parent.postMessage(JSON.stringify(told), '*');
};
addEventListener('load', probe_page);
"""
AROUND = """<!doctype html><meta charset=utf-8><body style="margin:0">%s
<pre id=told></pre><script>
const told = [], frames_of_page = [...document.querySelectorAll('iframe')];
addEventListener('message', (e) => {
  told[frames_of_page.findIndex((f) => f.contentWindow === e.source)] = JSON.parse(e.data);
  document.getElementById('told').textContent = JSON.stringify(told);
});</script>"""
FRAME = '<iframe src="%s" style="border:0;width:%dpx;height:3000px"></iframe>'


def is_number(text):
    return re.fullmatch(r"-?[\d,]*\.?\d+", text.replace("\u2212", "-")) is not None


def steps_are_round(labels):
    """Ticks at even steps, each a multiple of its step, which is 1, 2, 2.5, 4 or 5 times a power of ten (4: every
    other tick of 2, on a low chart)."""
    values = [float(text.replace(",", "").replace("\u2212", "-")) for text in labels if is_number(text)]
    if len(values) < 2:
        return True
    step = min(b - a for a, b in zip(values, values[1:]))
    mantissa = step
    while mantissa < 0.999:
        mantissa *= 10
    while mantissa >= 9.999:
        mantissa /= 10
    return (any(abs(mantissa - m) < 1e-6 for m in (1, 2, 2.5, 4, 5)) and
            all(abs(v / step - round(v / step)) < 1e-6 for v in values))


def apart(one, other):
    """Distance of two colours #rrggbb, 0 to 442."""
    return math.dist(*(bytes.fromhex(colour[1:]) for colour in (one, other)))


class PagesTest(unittest.TestCase):
    def setUp(self):
        if not BROWSER:
            self.skipTest("no Chromium here (Debian package chromium)")
        self.rows = set()  # of the legends on a phone
        scratch = tempfile.TemporaryDirectory(prefix="deburr_pages_")
        self.addCleanup(scratch.cleanup)
        self.directory = scratch.name

    def path(self, name):
        return os.path.join(self.directory, name)

    def deburr(self, *arguments, codes=(0,)):
        done = subprocess.run([DEBURR, *arguments], cwd=self.directory, text=True, capture_output=True, check=False,
                              timeout=300)
        self.assertIn(done.returncode, codes, done.stdout + done.stderr)
        return done.stdout

    def browse(self, url, *more):
        done = subprocess.run([BROWSER, *FLAGS, f"--user-data-dir={self.path('profile')}", *more, url], text=True,
                              capture_output=True, check=False, timeout=120)
        said = [line for line in done.stderr.splitlines() if "CONSOLE" in line]
        self.assertEqual(said, [])
        return done.stdout

    def all_probed(self, page, *frames, more=()):
        """The probe's report on a page below the directory, in a frame for each (width, keys, anchor)."""
        folder, name = os.path.split(self.path(page))
        around, copies, boxes = os.path.join(folder, "around_" + name), [], ""
        with open(self.path(page), encoding="utf-8") as file:
            text = file.read()
        for number, (width, keys, anchor) in enumerate(frames):
            copies.append(os.path.join(folder, f"probed{number}_{name}"))
            with open(copies[-1], "w", encoding="utf-8") as file:
                file.write(text.replace("</body>", f"<script>{keys}{PROBE}</script></body>"))
            boxes += FRAME % (os.path.basename(copies[-1]) + anchor, width)
        with open(around, "w", encoding="utf-8") as file:
            file.write(AROUND % boxes)
        try:
            dom = self.browse(f"file://{around}", "--window-size=1800,3100", "--virtual-time-budget=8000", "--dump-dom", *more)
        finally:
            for file in (*copies, around):
                os.remove(file)
        told = re.search(r'<pre id="told">(.*?)</pre>', dom, re.S)
        self.assertTrue(told and told[1], f"{page} has told nothing")
        told = json.loads(html.unescape(told[1]))
        self.assertEqual([each is not None for each in told], [True] * len(frames), f"{page} has not told all")
        for each in told:
            self.assertEqual([name for name, colours in each["drawn"] if 0 <= colours < 3], [], f"{page}: not drawn")
            self.assertEqual([name for name, wide in each["pictures"] if wide == 0], [], f"{page}: no pictures")
        return told

    def probed(self, page, width=PHONE, keys="", anchor=""):
        return self.all_probed(page, (width, keys, anchor))[0]

    def screenshots(self, page, title):
        keep = os.environ.get("DEBURR_KEEP_SCREENSHOTS")
        if not keep:
            return
        folder, name = os.path.split(self.path(page))
        for width in (DESKTOP, PHONE):
            around = os.path.join(folder, "around_" + name)
            with open(around, "w", encoding="utf-8") as file:
                file.write('<!doctype html><body style="margin:0"><iframe src="%s" style="border:0;width:%dpx;'
                           'height:7000px"></iframe>' % (name, width))
            self.browse(f"file://{around}", f"--window-size={width if width > 500 else 500},7000",
                        f"--screenshot={os.path.join(keep, f'{title}_{width}.png')}")
            os.remove(around)

    def check(self, page, title, charts, keys=""):
        """Checks the requirements on all pages; returns the probe's report."""
        told, desktop = self.all_probed(page, (PHONE, keys, ""), (DESKTOP, "", ""))
        self.assertEqual((told["width"], told["page"]), (PHONE, LIGHT))
        self.assertEqual(told["wide"], [], title)
        self.assertLessEqual(told["needs"], PHONE, title)
        self.assertGreaterEqual(len(told["canvases"]), charts)
        for name, label, role in told["canvases"]:
            self.assertGreater(len(label), 15, f"{title}: the chart {name} has no text")
            self.assertIn(role, ("img", "application"), name)
        self.assertEqual(told["empty"], [], title)
        self.assertEqual(told["joined"], [], f"{title}: headlines that run together")
        self.assertEqual(told["torn"], [], f"{title}: words that are broken")
        for edges in told["strips"] + desktop["strips"]:
            self.assertEqual(edges, [True, True], f"{title}: strips beside the pictures")
        self.assertLessEqual(len(set(told["colours"])), 1, f"{title}: words of charts in another colour than the page's")
        with open(self.path(page), encoding="utf-8") as file:
            text = file.read()
        for link in told["links"]:
            if link.startswith("#"):
                self.assertTrue(f'id="{link[1:]}"' in text or re.match("#(interval|follow)-[0-9,]+$", link), f"{title}: {link}")
            else:
                self.assertTrue(os.path.exists(os.path.join(os.path.dirname(self.path(page)), link)), f"{title}: {link}")
        # The plot area of a chart keeps its height, however many rows its legend has.
        for (name, low, rows), (_, high, _) in zip(told["charts"], desktop["charts"]):
            self.assertGreater(low, 0.75 * high, f"{title}: {name} with {rows} rows of a legend")
            self.rows.add(rows)
        self.assertEqual(desktop["cut"], [], f"{title}: tables that a screen cuts")
        self.assertEqual(told["labels"] + desktop["labels"], [], f"{title}: charts with cut names")
        with open(self.path(page), encoding="utf-8") as file:
            self.assertEqual(re.findall(r"<td[^>]*>-?[\d.]+e\+\d+<", file.read()), [], "numbers of another form")
        for width in (told, desktop):
            ticks = 0
            for chart, scales in width["ticks"]:
                for name, labels in scales:
                    self.assertTrue(steps_are_round(labels), f"{title}: {chart} {name}: {labels}")
                    ticks += len(labels)
            if charts > 1:
                self.assertGreater(ticks, 3)
        self.screenshots(page, title)
        return told


# In these tables, adjacent cells of a row must end within their box.
SEEN_TOGETHER = """
window.probe_keys = async () => [...document.querySelectorAll('%s')].map((table) => {
  const rows = [...table.rows].map((row) => [...row.cells].slice(0, %d)), end = table.closest('.scroll').getBoundingClientRect().right;
  return [table.rows[0].innerText, rows.length, Math.max(...rows.flat().map((cell) => cell.getBoundingClientRect().right)) - end,
          [...rows.flat()].filter((cell) => cell.scrollWidth > cell.clientWidth).map((cell) => cell.innerText)];
});
"""

# Selects a pixel with the keys, zooms, and returns; the first map of the page is on the right.
KEYS_OF_A_RUN = """
window.probe_keys = async (wait) => {
  const view = document.getElementById('view'), right = document.getElementById('right'), said = [];
  const press = (key, more = {}) => view.dispatchEvent(new KeyboardEvent('keydown', {key, bubbles: true, ...more}));
  const still = document.querySelector('.strip img[data-role^="map_"]');
  still.dispatchEvent(new KeyboardEvent('keydown', {key: 'Enter'}));
  said.push(still.dataset.role, right.selectedOptions[0].text, document.getElementById('scale-right').innerText);
  for (let i = 0; i < 30; ++i) { press('ArrowLeft', {shiftKey: true}); press('ArrowUp', {shiftKey: true}); }
  said.push(document.getElementById('probe').textContent);
  for (const key of ['ArrowRight', 'ArrowRight', 'ArrowDown', 'ArrowRight', 'ArrowUp', 'ArrowDown']) press(key);
  said.push(document.getElementById('probe').textContent);
  said.push(document.querySelector('#scale-right .at')?.style.left ?? '');
  const zoom = document.getElementById('zoom'), fitted = zoom.textContent;
  press('+'); said.push(zoom.textContent !== fitted); press('Home'); said.push(zoom.textContent === fitted);
  press('Enter');
  said.push(document.getElementById('pixel-command')?.textContent ?? '');
  said.push(Chart.getChart('port-time')?.options.scales.bytes.title.text ?? null);
  return said;
};
"""


class Runs(PagesTest):
    def value(self, name, x, y):
        with open(self.path(name), "rb") as file:
            file.readline()
            width, height = map(int, file.readline().split())
            file.readline()
            pixels = array.array("f")
            pixels.frombytes(file.read())
        return pixels[(height - 1 - y) * width + x]

    def check_run(self, engine, arguments):
        self.deburr("run", engine, *arguments, "--size", "96x64", "--windows=250", "--maps", "--out", engine)
        told = self.check(f"{engine}/report.html", engine, 6, KEYS_OF_A_RUN)
        role, title, scale, corner, at, mark, zoomed, fitted, command, bytes_axis = told["keys"]
        with open(self.path(f"{engine}/result.json"), encoding="utf-8") as file:
            result = json.load(file)
        figures = result["maps"][role.removeprefix("map_")]
        if result["memory"]["bytes_read"] > 0:
            self.assertEqual(bytes_axis, ["byte/clk", f"100: {result['clock_mhz'] / 10:.1f} GB/s"])
            self.axes += 1
        number = lambda v: f"{v:,.0f}" if v == int(v) else f"{float(f'{v:.6g}'):,}"
        for end in ("min", "max"):
            self.assertIn(f"{number(figures[end])} {figures['unit']}", scale)
        self.assertIn(title.removeprefix("Map: "), scale)
        self.assertIn("pixel (0, 0)", corner)
        self.assertIn("pixel (3, 1)", at)
        value = self.value(f"{engine}/{role}.pfm", 3, 1)
        words = "has no value there" if value != value else f"{number(value)} {figures['unit']}"
        self.assertIn(f"right: {title} {words}", at)
        self.assertEqual(mark == "", value != value)
        self.assertEqual((zoomed, fitted), (True, True))
        self.assertTrue(command.endswith("--pixel 3,1"), command)

    def test_pages_of_every_engine(self):
        self.axes = 0
        for engine, arguments in trials("report_page").items():
            with self.subTest(engine):
                self.check_run(engine, arguments)
        self.assertGreater(self.axes, 1, "no page with traffic of memory")
        self.assertGreater(max(self.rows), 3, "no legend of several rows: the heights say nothing")

    def test_each_cause_has_its_own_colour(self):
        """More causes than predefined colours: the same colour in every chart, and none close to another."""
        self.assertTrue(trials("causes"))
        for engine, arguments in trials("causes").items():
            self.deburr("run", engine, *arguments, "--windows", "1000", "--no-images", "--out", "causes")
            drawn = self.probed("causes/report.html", DESKTOP)["causes"]
            colours = dict(drawn)
            self.assertGreater(len(drawn), len(colours), "one chart alone draws causes")
            self.assertGreater(len(colours), 12)
            for label, colour in drawn:
                self.assertEqual(colour, colours[label], f"{label} in two colours")
            for (one, a), (other, b) in itertools.combinations(colours.items(), 2):
                self.assertGreater(apart(a, b), 20, f"{one} and {other}")

    def test_pixel_page_shows_both_sides_on_a_phone(self):
        for engine, entry in trials("followed").items():
            self.deburr("run", engine, *entry["run"], "--pixel", "{},{}".format(*entry["pixel"]), "--out", engine)
            told = self.check(f"{engine}/report.html", f"{engine}_pixel", 1, SEEN_TOGETHER % ("table.history", 5))
            (head, rows, beyond, cut), = told["keys"]
            for word in ("Golden", "Hardware", "Cycle"):
                self.assertIn(word, head)
            self.assertGreater(rows, len(entry["steps"]))
            self.assertLessEqual(beyond, 0, engine)
            self.assertEqual(cut, [], engine)

    def test_stills_show_the_frame(self):
        """All show the frame, however small or narrow it is: for a map the map itself, not its colour scale."""
        self.deburr("run", "texture", "--size", "40x32", "--maps", "--out", "small")
        for told in self.all_probed("small/report.html", (PHONE, "", ""), (DESKTOP, "", "")):
            self.assertGreater(len(told["stills"]), 5)
            (across, down), = {(round(still[1]), round(still[2])) for still in told["stills"]}
            self.assertAlmostEqual(across / down, 40 / 32, delta=0.05)
            for role, _, _, *scale in told["stills"]:
                for each, length in zip(scale, (across / 40, down / 32)):
                    self.assertAlmostEqual(each, length, delta=0.03 * length, msg=role)
        for name, size in (("flat", "2000x4"), ("tall", "4x600")):
            self.deburr("run", "texture", "--scene", "plane", "--size", size, "--maps", "--out", name)
            told = self.probed(f"{name}/report.html", DESKTOP)
            self.assertGreater(len(told["stills"]), 5)
            _, _, _, across, down = next(still for still in told["stills"] if still[0] == "after")
            for role, width, height, *scale in told["stills"]:
                self.assertGreaterEqual(min(width, height), 23, f"{name}: {role}")
                self.assertAlmostEqual(scale[0], across, delta=0.02 * across, msg=f"{name}: {role}")
                self.assertAlmostEqual(scale[1], down, delta=0.02 * down, msg=f"{name}: {role}")
            self.screenshots(f"{name}/report.html", name)

    def test_empty_columns_are_hidden(self):
        """The reference column is hidden if no figure has a reference."""
        columns = set()
        for engine in trials("report_page"):
            self.deburr("run", engine, "--size", "32x32", "--no-images", "--out", engine)
            with open(self.path(f"{engine}/result.json"), encoding="utf-8") as file:
                column = any("against" in figure for figure in json.load(file)["figures"])
            with open(self.path(f"{engine}/report.html"), encoding="utf-8") as file:
                self.assertEqual(file.read().count("<th>Against</th>"), int(column), engine)
            columns.add(column)
        self.assertEqual(columns, {False, True})

    # The page's text after its scripts have run.
    TEXT = "window.probe_keys = async () => document.body.innerHTML;"

    def test_interval_link_gives_the_wave_command(self):
        """Its link gives the command that writes its waves."""
        self.deburr("run", "texture", "--size", "128x128", "--windows", "1000", "--maps", "--trace", "colours", "--trace-to",
                    "9", "--out", "run")
        text = self.probed("run/report.html", DESKTOP, self.TEXT, "#interval-3")["keys"]
        self.assertIn("Interval 3: cycles 3,004 to 4,004.", text)
        self.assertRegex(text, r"--maps --out run --trace '\*' --trace-from 3004 --trace-to 4004</pre>")
        for part in ('data-role="map_samples"', "map_latency.pfm", "latency_fifo_entries", "<option>tag_stage</option>",
                     'href="#interval-3">3,004 to 4,004</a>'):
            self.assertIn(part, text)
        for canvas in ("rate-time", "unit-time", "port-time", "link-time", "link-histogram"):
            self.assertRegex(text, f'<canvas id="{canvas}"[^>]*style="[^"]*height: 2[0-9]+px')
        (dark,) = self.all_probed("run/report.html", (DESKTOP, "", ""), more=("--force-dark-mode",))
        self.assertEqual(dark["page"], DARK)

    def test_mismatch_link_gives_the_pixel_command(self):
        """Its link gives the command that follows the pixel."""
        self.deburr("run", "texture", "--size", "64x48", "--fault", "flip-bit", "--pixel", "36,0", "--out", "run", codes=(1,))
        text = self.probed("run/report.html", PHONE, self.TEXT, "#follow-7,9")["keys"]
        self.assertIn('<h2 id="pixel">History of pixel 36,0</h2>', text)
        self.assertIn('id="follow"><pre id="pixel-command">', text)  # not hidden
        self.assertRegex(text, "--fault flip-bit --out run --pixel 7,9</pre>")
        self.assertRegex(text, r"--pixel 36,0 --trace '\*' --trace-from [0-9]+")

    def test_checks_detect_broken_pages(self):
        """Detects a failing script, a page that is too wide, an empty chart, charts without text and dead links."""
        for body in ("<script>undefined_function();</script>", "<canvas id=c></canvas>", "<img src=none.png>"):
            with open(self.path("broken.html"), "w", encoding="utf-8") as file:
                file.write(f"<!doctype html><body>{body}</body>")
            self.assertRaises(AssertionError, self.probed, "broken.html")
        self.assertTrue(steps_are_round(["0", "50", "100"]) and steps_are_round(["2,500", "5,000", "7,500"]))
        self.assertFalse(steps_are_round(["4", "3,004", "6,004"]))
        self.assertFalse(steps_are_round(["0", "3", "6"]))
        with open(self.path("bad.html"), "w", encoding="utf-8") as file:
            file.write("<!doctype html><meta name=viewport content=width=device-width><body><canvas id=c hidden></canvas>"
                       "<h1>Alone <i>apart</i></h1><h1>Alone<i>joined</i></h1>"
                       "<div style='width:600px'>wide</div><a href=nowhere.json>x</a></body>")
        told = self.probed("bad.html")
        self.assertGreater(told["needs"], PHONE)
        self.assertTrue(told["wide"])
        self.assertEqual(told["canvases"], [["c", "", None]])
        self.assertEqual(told["links"], ["nowhere.json"])
        self.assertEqual(told["joined"], ["Alonejoined"])


SWEEP = """engine: texture
base:
  scene: {width: 48, height: 32, texture_size: 64}
  run.images: false
axes:
  scene.source: [tunnel, plane]
  texture.cache.bytes: [1024, 2048, 4096]
  texture.cache.ways: [1, 2, 4]
metrics: {cycles: cycles, bits: memory_bits.total.physical}
objectives: {minimise: [cycles, bits], for_each: [scene.source]}
"""

KEYS_OF_A_SWEEP = """
window.probe_keys = async (wait) => {
  const enter = (e) => e.dispatchEvent(new KeyboardEvent('keydown', {key: 'Enter', bubbles: true}));
  const rows = () => [...document.querySelectorAll('#table tbody tr')];
  const heads = [...document.querySelectorAll('#table th.sort')];
  const reachable = rows().every((r) => r.tabIndex === 0) && heads.every((h) => h.tabIndex === 0);
  enter(rows()[2]);
  const command = document.getElementById('chosen').innerText;
  enter(heads[heads.length - 2]);
  const cycles = rows().map((r) => Number(r.children[3].textContent.replaceAll(',', '')));
  const lines = Chart.getChart('scatter').data.datasets.filter((d) => d.showLine);
  return {reachable, command, cycles, fronts: document.getElementById('fronts').textContent,
          lines: lines.map((l) => [l.label, l.data.length, String(l.borderColor) + String(l.borderDash)])};
};
"""

LOOKS_OF_POINTS = """
window.probe_keys = async () => {
  const sets = Chart.getChart('scatter').data.datasets.filter((d) => !d.showLine);
  return [sets.flatMap((d) => d.data.map((at) => Boolean(at.point.beyond))), sets.flatMap((d) => d.pointStyle ?? d.data.map(() => 'circle'))];
};
"""


class Sweeps(PagesTest):
    def check(self, page, title, charts, keys=""):
        told = super().check(page, title, charts, keys)
        if told["height"] > 3 * SCREEN:
            self.assertEqual(set(told["heads"]) - set(told["contents"]), set(), f"{title}: what the contents lack")
        return told

    def make(self, name, text):
        with open(self.path(f"{name}.yaml"), "w", encoding="utf-8") as file:
            file.write(text)
        for action in ("run", "collect"):
            self.deburr("sweep", f"{name}.yaml", action)
        return f"out/sweeps/{name}"

    def pages(self, directory):
        return [os.path.join(directory, f) for f in os.listdir(self.path(directory)) if f.endswith(".html")]

    def test_sweep_page(self):
        directory = self.make("fronts", SWEEP)
        (page,) = self.pages(directory)
        told = self.check(page, "sweep", 3, KEYS_OF_A_SWEEP)
        keys = told["keys"]
        self.assertTrue(keys["reachable"])
        self.assertIn("deburr run texture", keys["command"])
        self.assertEqual(keys["cycles"], sorted(keys["cycles"]))
        self.assertEqual(len(keys["cycles"]), 18)
        self.assertEqual({line[0] for line in keys["lines"]},
                         {f"front of scene.source = {s}" for s in ("tunnel", "plane")})
        self.assertEqual(len({line[2] for line in keys["lines"]}), 2, "the fronts look alike")
        for source in ("tunnel", "plane"):
            self.assertIn(f"scene.source = {source}: ", keys["fronts"])
        # Without scripts there is a table of all points.
        with open(self.path(page), encoding="utf-8") as file:
            without = "".join(re.findall(r"<noscript>(.*?)</noscript>", file.read(), re.S))
        self.assertEqual(without.count("<tr"), 1 + 18)
        # Points beyond a limit have a distinct look.
        with open(self.path(f"{directory}/collected.json"), encoding="utf-8") as file:
            bits = sorted(point["values"][1] for point in json.load(file)["points"])
        (page,) = self.pages(self.make("limited", SWEEP + f"limits: [bits <= {bits[5]}]\n"))
        beyond, styles = self.probed(page, DESKTOP, LOOKS_OF_POINTS)["keys"]
        self.assertEqual(sum(beyond), sum(each > bits[5] for each in bits))
        self.assertEqual([style != "circle" for style in styles], beyond)

    def test_page_comparing_sweeps(self):
        first = self.make("before", SWEEP)
        second = self.make("after", SWEEP.replace("run.images: false", "run.images: false\n  memory.latency: 30"))
        self.deburr("compare", first, second, "--html", "page.html", codes=(0, 1))
        self.check("page.html", "comparison_of_sweeps", 1)

    def test_page_comparing_runs(self):
        for name, more in (("small", ["--set", "texture.cache.bytes=1024"]), ("large", [])):
            self.deburr("run", "texture", "--size", "64x48", "--truth", "--out", name, *more)
        self.deburr("compare", "small", "large", "--html", "page.html", codes=(0, 1))
        told = self.check("page.html", "comparison_of_runs", 0, SEEN_TOGETHER % ("#differ + .scroll table, #figures + .scroll table, "
                                                                                 "#values + details table", 3))
        self.assertGreater(len(told["pictures"]), 1)
        self.assertEqual(len(told["keys"]), 3)
        for head, rows, beyond, cut in told["keys"]:
            self.assertGreater(rows, 1)
            self.assertLessEqual(beyond, 0, f"{head}: B is cut")
            self.assertEqual(cut, [], head)


class Regressions(PagesTest):
    PLAN = """title: Pages
features:
  - id: tunnels
    title: Tunnels
    traces: [docs/unit.md#unit]
    stimuli:
      - {name: scenes, engine: texture, base: {scene: {source: tunnel, width: 24, height: 16, texture_size: 32}}, seeds: 2}
    checks: {colours: 100}
    coverage: [texture/cache/hit, texture/cache/miss]
  - id: broken
    title: A injected fault
    traces: [docs/unit.md#unit]
    stimuli:
      - {name: fault, engine: texture, base: {scene: {width: 24, height: 16, texture_size: 32}, run.fault: flip-bit}}
    checks: {colours: 1}
"""

    def test_regression_page(self):
        os.makedirs(self.path("docs"))
        for name, text in (("docs/unit.md", "# Unit\n"), ("pages.yaml", self.PLAN)):
            with open(self.path(name), "w", encoding="utf-8") as file:
                file.write(text)
        for seed in ("6", "7"):
            self.deburr("regress", "pages.yaml", "run", "--seed", seed, codes=(0, 1))
        told = self.check("out/regressions/pages-7/index.html", "regression", 1)
        self.assertEqual([c[0] for c in told["canvases"]], ["trend", "rates"])
        self.assertTrue([link for link in told["links"] if link.endswith("result.json")])


if __name__ == "__main__":
    if len(sys.argv) > 1 and not sys.argv[1].startswith("-"):
        DEBURR = os.path.abspath(sys.argv.pop(1))
    unittest.main()
