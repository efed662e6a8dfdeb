# SPDX-License-Identifier: MIT
"""The ways through how-tos: which engine to take, where a mismatch leads, what a night and its morning are, and what stands
around an engine in a platform and around a golden model in a testbench."""
import re
import textwrap

from drawing.facts import Missing
from drawing.svg import Picture


def plain(text):
    """A sentence of a page without its marks."""
    return re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", " ".join(text.split())).replace("`", "").replace("**", "")


def sentence(text):
    return text[:1].upper() + text[1:]


class Box:
    """Centred text in lines, the first ones strong."""

    def __init__(self, picture, x, y, width, height, text, small="", classes="box"):
        self.x, self.y, self.width, self.height = x, y, width, height
        picture.rect(x, y, width, height, classes, rx=6)
        rows = textwrap.wrap(text, max(8, int(width / 8.2)))
        more = textwrap.wrap(small, max(8, int(width / 6.2)))
        top = y + height / 2 - (len(rows) * 16 + len(more) * 14) / 2 + 12
        picture.lines(x + width / 2, top, rows, "middle strong", 16)
        picture.lines(x + width / 2, top + 16 * len(rows) - 1, more, "middle small dim", 14)

    def at(self, x, y):
        """A point of it, in parts of its sides."""
        return self.x + x * self.width, self.y + y * self.height


def way(picture, *points, label="", dx=0., dy=-6., classes="link", arrow=True):
    picture.path(points, classes, arrow=arrow)
    if label:
        (x0, y0), (x1, y1) = points[0], points[1]
        picture.text((x0 + x1) / 2 + dx, (y0 + y1) / 2 + dy, label, "small halo middle")


def which_engine(facts):
    page = "docs/howto/which_engine.md"
    rules = {plain(condition): plain(choice) for condition, choice in
             re.findall(r"^\* ([^:*]+): take (.*?)(?:\.\s|\.$)", facts.find(page, r"\n## Which engine smooths best\n(.*?)\n## ")[1], re.M | re.S)}
    conditions = list(rules)
    if list(rules.values())[:3] != ["geometric", "both", "morphological"] or len(rules) != 4:
        raise Missing(f"{page}: other rules of which engine to take: {rules}")
    mesh, more, alone, inside = conditions
    source = facts.find(page, r"`--set (morphological\.edges\.source=\w+)`")[1]
    mask = plain(facts.find(page, r"^deburr run morphological .*(--mask) \S+ +# [\w ]+ with (.*?)$")[2])
    table = {plain(row[0]): row for row in facts.table(page, "method", "needs")}

    def figures(name):
        _, _, edges, blended, clocks, *_ = table[name]
        return re.sub(r"(?<=\d) (?=\d)", "\xa0", f"edges {edges} dB, {clocks} clocks, {blended} pixels blended")

    size, latency = facts.find(page, r"Frames of (\d+ x \d+), .*?memory\s+of (\d+) clocks").groups()
    smoothing = facts.find(page, r"`(--preset \w+) --set (morphological\.edges\.source=\w+)`").groups()

    both = "geometric, then morphological"
    picture = Picture(840, 436, "From what you have to the engine that smooths it",
                      f"A way of questions. {mesh}: if not everything is a polygon, that is {more.lower()}, take {both}; else take geometric. "
                      f"Without mesh and depth take morphological: with edges of depth if {inside.lower()}, with a mask if there is {mask.replace(' in it', ' in the picture')}.")
    first = Box(picture, 20, 50, 226, 64, mesh + "?")
    second = Box(picture, 310, 50, 226, 64, more + "?")
    third = Box(picture, 20, 210, 226, 64, inside + "?")
    fourth = Box(picture, 20, 310, 226, 64, f"There is {mask.replace(' in it', ' in the picture')}?")
    answers = [Box(picture, 606, y, 214, 64, text, small, "answer") for y, text, small in
               ((50, "geometric", figures("deburr, geometric")), (130, both, ", ".join(smoothing)),
                (210, "morphological", f"--depth, {source}"), (290, "morphological", "--mask"),
                (364, "morphological", figures("deburr, morphological")))]
    picture.text(20, 30, "Pixels to be smoothed", "strong")
    picture.lines(820, 22, ["Engine; edges: mean of the nine scenes of the comparison;",
                            f"clocks and pixels: of the hardest, object, {size}, memory of {latency} clocks"], "small dim end")
    way(picture, first.at(1, .5), second.at(0, .5), label="yes")
    way(picture, second.at(1, .5), answers[0].at(0, .5), label="no")
    way(picture, second.at(.5, 1), (second.at(.5, 1)[0], answers[1].at(0, .5)[1]), answers[1].at(0, .5), label="yes", dx=16, dy=4)
    way(picture, first.at(.5, 1), third.at(.5, 0), label=f"no: {alone.lower().replace('you have ', '')}", dx=60, dy=4)
    way(picture, third.at(1, .5), answers[2].at(0, .5), label="yes, and its depth is there")
    way(picture, third.at(.5, 1), fourth.at(.5, 0), label="no", dx=14, dy=4)
    way(picture, fourth.at(1, .5), (570, fourth.at(1, .5)[1]), (570, answers[3].at(0, .5)[1]), answers[3].at(0, .5), label="yes")
    way(picture, fourth.at(.5, 1), (fourth.at(.5, 1)[0], answers[4].at(0, .5)[1]), answers[4].at(0, .5), label="no", dx=14, dy=8)
    return picture


def mismatch(facts):
    page = "docs/howto/debug_a_mismatch.md"
    steps = re.findall(r"^## (\d)\. (.*)$", facts.text(page), re.M)
    kinds = {row[0]: plain(row[1]) for row in facts.table(page, "exit code", "kind")}
    if [number for number, _ in steps] != list("123456") or sorted(kinds) != ["1", "3", "4"]:
        raise Missing(f"{page}: other steps or exit codes")
    deadlock = facts.find(page, r"^## A deadlock\n.*?\n\n([^`\n]*? before [^.]*)\.")[1]
    picture = Picture(840, 346, "From a failed run to the unit with the fault",
                      f"Six steps. {'; '.join(f'{number}: {name}' for number, name in steps)}. Exit code 1 goes through all of them, "
                      f"3 from the first to the fourth. Exit code 4: {plain(deadlock).lower()}.")
    boxes = {}
    for i, (number, name) in enumerate(steps):
        column, row = i % 3, i // 3
        boxes[int(number)] = Box(picture, 20 + 290 * column, 56 + 120 * row, 220, 62, f"{number}. {name}")
    for i in (1, 2, 4, 5):
        way(picture, boxes[i].at(1, .5), boxes[i + 1].at(0, .5), label="exit code 1" if i == 1 else "")
    way(picture, boxes[3].at(.5, 1), (boxes[3].at(.5, 1)[0], 147), (170, 147), (170, 176))
    way(picture, boxes[1].at(.25, 1), boxes[4].at(.25, 0), label="3", dx=-10, dy=4)
    dead = Box(picture, 20, 278, 510, 46, plain(deadlock), f"exit code 4: {kinds['4']}", "answer")
    way(picture, (20, 87), (10, 87), (10, 301), dead.at(0, .5))
    picture.text(30, 272, "4", "small halo middle")
    picture.lines(20, 24, [f"Exit code 1: {kinds['1']}.", f"Exit code 3: {kinds['3']}."], "small dim")
    return picture


def regression(facts):
    page = "docs/howto/nightly_regression.md"
    plan = facts.find(page, r"\n```yaml\n(.*?)```")[1]
    keys = [key for key in ("traces", "stimuli", "checks", "coverage") if re.search(rf"^ *{key}:", plan, re.M)]
    before, after = facts.find("docs/reference/regression.md", r"from (\d+) clocks before to (\d+) clocks after").groups()
    files = [row[0].strip("`") for row in facts.table("docs/reference/regression.md", "file", "")][:3]
    picture = Picture(840, 268, "What a regression does with a testplan, and what is left in the morning",
                      f"A testplan of features with {', '.join(keys)} becomes points, each a configuration with a seed. They run side by side, "
                      "each beside the golden model. Failures with one message are a bucket; its first run is made again with a wave of "
                      f"{before} clocks before and {after} after the failure. Left are {', '.join(files)}; rerun --failed runs the failures again.")
    testplan = Box(picture, 20, 40, 170, 78, "testplan", "a feature: " + ", ".join(keys))
    points = Box(picture, 250, 40, 150, 78, "points", "configuration x seed")
    runs = Box(picture, 460, 40, 150, 78, "runs", "each beside golden")
    report = Box(picture, 670, 40, 150, 78, "report", ", ".join(files), "answer")
    buckets = Box(picture, 460, 176, 150, 72, "buckets", "failures of one message")
    waves = Box(picture, 670, 176, 150, 72, "a wave a bucket", f"{before} clocks before, {after} after")
    rerun = Box(picture, 200, 176, 200, 72, "rerun --failed", "after the fix")
    way(picture, testplan.at(1, .5), points.at(0, .5), label="plan")
    way(picture, points.at(1, .5), runs.at(0, .5), label="run")
    way(picture, runs.at(1, .5), report.at(0, .5), label="pass")
    way(picture, runs.at(.5, 1), buckets.at(.5, 0), label="fail", dx=16, dy=4)
    way(picture, buckets.at(1, .5), waves.at(0, .5))
    way(picture, waves.at(.5, 0), report.at(.5, 1))
    way(picture, buckets.at(0, .5), rerun.at(1, .5))
    way(picture, rerun.at(.5, 0), (rerun.at(.5, 0)[0], 147), (490, 147), (490, 118))
    return picture


def platform(facts):
    source = "examples/platform/main.cpp"
    text = facts.text(source)
    kinds = dict(re.findall(r"^  (?:deburr::\w+::(?:\w+::)?)?(\w+) (\w+)_\{", text, re.M))
    kinds = {name: kind for kind, name in kinds.items()}
    hops = re.findall(r'hops_\.emplace_back\("\w+", \*?(\w+)_\.([\w.]+)(?:\(\))?, (\w+)_\.([\w.]+)', text)
    links = {}
    for unit, end, link in re.findall(r"^    (\w+)_\.(\w+_(?:in|out))\((\w+)_\);", text, re.M):
        links.setdefault(link, {})[end.rsplit("_", 1)[1]] = unit
    initiators = sorted(start for start, _, end, _ in hops if end == "router")
    targets = sorted(end for start, _, end, _ in hops if start == "router")
    wires = sorted(set(re.findall(r"software_\.\w+_interrupt\((\w+)_\.interrupt\)", text)))
    if (initiators, targets, wires) != (["smoother", "software", "texture"], ["memory", "painter", "smoother", "texture"], ["smoother", "texture"]):
        raise Missing(f"{source}: other sockets: {initiators}, {targets}, {wires}")
    if links != {"quads": {"out": "painter", "in": "texture"}, "colours": {"out": "texture", "in": "painter"},
                 "pixels": {"out": "painter", "in": "smoother"}, "blended": {"out": "smoother", "in": "display"}}:
        raise Missing(f"{source}: other links: {links}")

    def kind(name):
        return {"TextureUnit": "TextureUnit", "MorphologicalEngine": "MorphologicalEngine"}.get(kinds.get(name), sentence(name))

    picture = Picture(840, 366, "The example of a platform around two engines",
                      "Software writes registers through a router and waits for the interrupts of both engines. TextureUnit and "
                      "MorphologicalEngine read and write memory through the same router. Painter sends quads to the TextureUnit, gets colours, and "
                      "sends pixels to the MorphologicalEngine, whose blended pixels go to Display.")
    for x, unit in ((430, "texture"), (610, "smoother")):
        way(picture, (x + 125, 216), (x + 125, 50 if unit == "smoother" else 66), (190, 50 if unit == "smoother" else 66), classes="wire")
        picture.text(x + 119, 112, "interrupt", "small halo end dim")
    software = Box(picture, 20, 34, 170, 52, kind("software"), "a thread")
    picture.rect(20, 140, 800, 34, "box", rx=6)
    picture.text(420, 162, "Router: TLM-2.0, blocking and non-blocking", "middle strong")
    boxes = {name: Box(picture, x, 216, width, 62, kind(name), small, classes) for name, x, width, small, classes in
             (("memory", 20, 130, "a target", "box"), ("painter", 210, 150, "a unit of yours", "box"), ("texture", 430, 140, "an engine", "answer"),
              ("smoother", 610, 166, "an engine", "answer"))}
    way(picture, software.at(.5, 1), (105, 140), label="registers", dx=36, dy=4)
    for name, box in boxes.items():
        x, y = box.at(.2, 0)
        way(picture, (x, 174), (x, y), label="data" if name == "memory" else "registers", dx=0, dy=4)
    for name in ("texture", "smoother"):
        x, y = boxes[name].at(.6, 0)
        way(picture, (x, y), (x, 174), label="memory", dx=0, dy=4)
    painter, texture, smoother = (boxes[name] for name in ("painter", "texture", "smoother"))
    way(picture, painter.at(1, .3), texture.at(0, .3), label="quads")
    way(picture, texture.at(0, .7), painter.at(1, .7), label="colours", dy=14)
    way(picture, (285, 278), (285, 310), (693, 310), (693, 278), label="", arrow=True)
    picture.text(489, 304, "pixels", "small halo middle")
    display = Box(picture, 650, 322, 170, 34, kind("display"))
    way(picture, (750, 278), (750, display.y), label="blended", dx=28, dy=6)
    picture.lines(20, 336, ["Solid: sockets (software b_transport, engines nb_transport); links, a beat a clock.", "Dashed: interrupts, signals."], "small dim")
    return picture


def testbench(facts):
    page = "docs/howto/testbench.md"
    rows = {plain(row[0]): re.findall(r"`(deburr_\w+)`", row[1]) for row in facts.table(page, "component", "calls")}

    def calls(beginning):
        found = [names for name, names in rows.items() if name.startswith(beginning)]
        if len(found) != 1 or not found[0]:
            raise Missing(f"{page}: no calls of {beginning}")
        return [name.removeprefix("deburr_") for name in found[0]]

    ways = [("registers", calls("predictor, from the register monitor")), ("quads", calls("predictor, write(quad)")),
            ("pixels", calls("predictor, write(pixel)")), ("memory port", calls("predictor of the memory port"))]
    picture = Picture(840, 350, "The golden model beside a design in a testbench",
                      "Monitors give what goes into the design to a predictor, which calls the golden model: "
                      + "; ".join(f"{name}: {', '.join(names)}" for name, names in ways)
                      + ". What it returns and what comes out of the design meet in the scoreboard.")
    stimulus = Box(picture, 20, 34, 150, 70, "Stimulus")
    design = Box(picture, 330, 34, 180, 70, "Your design", "SystemVerilog")
    board = Box(picture, 670, 34, 150, 70, "Scoreboard", "compares")
    golden = Box(picture, 590, 160, 230, 150, "Golden model", "a handle a predictor, no time", "answer")
    way(picture, stimulus.at(1, .5), design.at(0, .5), label="pins")
    way(picture, design.at(1, .5), board.at(0, .5), label="what came")
    way(picture, (745, 160), board.at(.5, 1), label="what must come", dx=-48, dy=4)
    picture.path([(250, 69), (250, 140)], "link")
    picture.circle(250, 69, 3, "head")
    picture.text(258, 128, "monitors", "small halo")
    for i, (name, names) in enumerate(ways):
        y = 160 + 39 * i
        Box(picture, 190, y, 120, 32, name)
        way(picture, (310, y + 16), (590, y + 16))
        picture.text(450, y + 11, ", ".join(names) if len(", ".join(names)) < 44 else ", ".join(names[:2]) + ", ...", "small halo middle")
    picture.path([(250, 140), (250, 160)], "link", arrow=True)
    picture.rect(180, 150, 140, 166, "band", rx=6)
    picture.lines(20, 232, ["Predictor:", "a call for each", "transaction"], "small dim")
    picture.text(20, 340, "Names without deburr_, of the C interface and of deburr_golden_pkg.", "small dim")
    return picture
