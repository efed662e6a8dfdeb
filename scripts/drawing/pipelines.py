# SPDX-License-Identifier: MIT
"""The units of the engines with the links between them. Units, links, places and latencies come from the hardware
pages and datasheets; here stands only where a unit is drawn and which way a link goes."""
from drawing.facts import Missing
from drawing.svg import Picture

WIDTH, HEIGHT, GAP_X, GAP_Y, LEFT, TOP = 148, 52, 92, 70, 84, 40


class Plan:
    """Where units stand, (column, row) each, and the ways of links that are no straight line: name of the link ->
    points, each (column + part of it, row + part of it) with 0 and 1 the sides of a box."""

    def __init__(self, units, ways=(), labels=()):
        self.units, self.ways, self.labels = units, dict(ways), dict(labels)

    @staticmethod
    def point(column, row):
        """Parts of a column beyond 1 lie in the gap: 1.5 is the middle between two boxes."""
        def place(value, size, gap):
            whole, part = int(value // 2), value % 2
            return whole * (size + gap) + (part * size if part <= 1 else size + (part - 1) * gap)
        return LEFT + place(column, WIDTH, GAP_X), TOP + place(row, HEIGHT, GAP_Y)


def at(column, row, x=.5, y=.5):
    return 2 * column + x, 2 * row + y


def straight(start, end, shift=0.):
    """From side to side of two boxes of one row or one column; `shift` moves it across, in parts of a box."""
    (c0, r0), (c1, r1) = start, end
    if r0 == r1:
        return [at(c0, r0, c1 > c0, .5 + shift), at(c1, r1, c1 < c0, .5 + shift)]
    if c0 == c1:
        return [at(c0, r0, .5 + shift, r1 > r0), at(c1, r1, .5 + shift, r1 < r0)]
    return None


def draw_link(picture, plan, name, start, end, places):
    way = plan.ways.get(name) or straight(plan.units[start], plan.units[end])
    if isinstance(way, float):
        way = straight(plan.units[start], plan.units[end], way)
    if way is None:
        raise Missing(f"scripts/drawing/pipelines.py: the link {name} from {start} to {end} needs a way")
    points = [plan.point(*point) for point in way]
    picture.path(points, arrow=True)
    middle = len(points) // 2
    (x0, y0), (x1, y1) = points[middle - 1], points[middle]
    x, y = (x0 + x1) / 2, (y0 + y1) / 2
    dx, dy, classes = plan.labels.get(name, (0, -6, "middle") if y0 == y1 else (7, 4, ""))
    label = name.rsplit(".", 1)[-1] + ("" if places == 2 else f" ({places})")
    picture.text(x + dx, y + dy, label, f"small halo {classes}")


def draw_unit(picture, facts, plan, name, inside=(), classes="box"):
    x, y = plan.point(2 * plan.units[name][0], 2 * plan.units[name][1])
    picture.rect(x, y, WIDTH, HEIGHT, classes, rx=5)
    parts = name.split(" or ")
    rows = [parts[0] + " or", parts[1]] if len(parts) == 2 else [name]
    below = ([latency] if (latency := facts.latency(name)) else []) + [f"FIFO of {places}" for places in inside]
    first = y + HEIGHT / 2 + 5 - 7 * (len(rows) + len(below) - 1)
    for i, row in enumerate(rows):
        picture.text(x + WIDTH / 2, first + 14 * i, row, "middle strong")
    for i, row in enumerate(below):
        picture.text(x + WIDTH / 2, first + 14 * (len(rows) + i), row, "middle small dim")


def draw_way_past(picture, plan, unit, start, end):
    """The link where a unit of one row with both ends is not built."""
    (c0, row), (c1, _) = plan.units[start], plan.units[end]
    if {row} != {plan.units[name][1] for name in (end, unit)}:
        raise Missing(f"scripts/drawing/pipelines.py: the way past {unit} from {start} to {end} is no row")
    points = [at(c0, row, .75 if c1 > c0 else .25, 0), at(c0, row, .75 if c1 > c0 else .25, -.3),
              at(c1, row, .25 if c1 > c0 else .75, -.3), at(c1, row, .25 if c1 > c0 else .75, 0)]
    picture.path([plan.point(*point) for point in points], "wire", arrow=True)


def draw(facts, page, plan, size, title, beside=(), optional=None):
    """The picture and its links, each with all that a test or a description needs. `optional`: as facts.optional."""
    optional = optional or {}
    links = facts.links(page)
    units = []
    for name, start, end, _ in links:
        for unit in filter(None, (start, end)):
            if unit in plan.units and unit not in units:
                units.append(unit)
            elif unit not in plan.units and not unit.startswith("each client"):
                raise Missing(f"scripts/drawing/pipelines.py: {page} has a unit {unit}, which has no place")
    columns, rows = size
    width, height = 2 * LEFT + columns * WIDTH + (columns - 1) * GAP_X, 2 * TOP + rows * HEIGHT + (rows - 1) * GAP_Y
    words = "; ".join(f"{start} to {end} by {name.rsplit('.', 1)[-1]}" for name, start, end, _ in links if end)
    past = "".join(f" Without {unit} {start} to {end}." for unit, (start, end) in optional.items())
    picture = Picture(width, height + 30, title, f"Units as boxes with their latency, links as arrows: {words}.{past}")
    for name, start, end, places in links:
        if start in plan.units and end in plan.units:
            draw_link(picture, plan, name, start, end, places)
    for unit in [*units, *beside]:
        inside = [places for _, start, end, places in links if end is None and start == unit]
        draw_unit(picture, facts, plan, unit, inside, "faint" if unit in optional else "box" if unit in units else "band")
    for unit, (start, end) in optional.items():
        draw_way_past(picture, plan, unit, start, end)
    picture.text(LEFT, height + 16, "Arrows are links, of two places if no number stands beside the name.", "small dim")
    return picture


def ports(picture, facts, plan, page, ends):
    """The streams that enter and leave, named by the table of ports: name -> way."""
    names = {row[0].strip("`") for row in facts.table(page, "port", "type")}
    for name, (way, dx, dy, classes) in ends.items():
        if name not in names:
            raise Missing(f"{page}: no port {name}")
        points = [plan.point(*point) for point in way]
        picture.path(points, arrow=True)
        x, y = points[-1] if name.endswith("_out") else points[0]
        picture.text(x + dx, y + dy, name, f"small halo {classes}")


def texture(facts):
    page = "docs/reference/texture/hardware.md"
    plan = Plan({"DerivativeUnit": (0, 0), "FootprintUnit or AxisUnit": (1, 0), "Log2Unit": (2, 0), "LevelUnit": (3, 0),
                 "SampleWalker": (3, 1), "TexelAddresser": (2, 1), "TagStage": (1, 1), "MissQueue": (0, 1),
                 "LatencyFifo": (1, 2), "DataStage": (2, 2), "FilterPipeline": (3, 2), "MemoryPort": (0, 2)},
                {"cache.memory_requests": -.2, "cache.memory_responses": .2},
                {"cache.memory_requests": (-7, 4, "end"), "cache.latency_fifo.entries": (0, -6, "middle")})
    picture = draw(facts, page, plan, (4, 3), "Units of the texture unit and the links between them")
    ports(picture, facts, plan, "docs/reference/texture/index.md", {
        "quads_in": ([(-.4, .5), (0, .5)], -16, -8, ""),
        "colours_out": ([at(3, 2, 1), at(3, 2, 1.4)], -26, -8, "")})
    return picture


def morphological(facts):
    page = "docs/reference/morphological/memories.md"
    plan = Plan({"SlotSequencer": (0, 0), "LumaUnit": (1, 0), "EdgeDetector": (2, 0), "RunExtractor": (3, 0),
                 "PixelStore": (0, 1), "MemoryPort": (1, 1), "DiagonalUnit": (2, 1), "EndpointPredictor": (3, 1),
                 "Blender": (0, 2), "AreaUnit": (2, 2), "LineUnit": (3, 2), "TextGuard": (1, 3)},
                {"guard_slots": [at(0, 0, 1, .8), at(0, 0, 1.12, .8), at(0, 3, 1.12, .5), at(1, 3, 0)],
                 "text_guard.guards": [at(1, 3, .25, 0), at(1, 3, .25, -.3), at(0, 2, .97, 1.7), at(0, 2, .97, 1)],
                 "beats": -.1, "requests": -.18, "responses": .18, "extractor.record_fifo": .1, "sums": .1,
                 "finished": [at(2, 2, 1, .05), at(2, 2, 1.2, .05), at(2, 0, 1.2, 1.2), at(3, 0, .06, 1.2), at(3, 0, .06, 1)],
                 "fetches": [at(3, 0, .15, 1), at(3, 0, .15, 1.4), at(0, 0, .75, 1.4), at(0, 1, .75, 0)],
                 "diagonal_columns": [at(3, 0, .24, 1), at(3, 0, .24, 1.64), at(2, 0, .5, 1.64), at(2, 1, .5, 0)],
                 "area_slots": [at(3, 0, .33, 1), at(3, 0, .33, 1.84), at(2, 0, 1.72, 1.84), at(2, 2, 1.72, .25),
                                at(2, 2, 1, .25)],
                 "lines": .1,
                 "frames_done": [at(0, 2, 0), (-.62, 4.5), (-.62, .8), (0, .8)]},
                {"diagonal_columns": (0, -5, "middle"), "fetches": (0, -5, "middle"), "area_slots": (-31, 93, ""),
                 "finished": (6, 52, ""), "frames_done": (6, 57, ""), "diagonals.diagonal_shares": (-7, 4, "end")})
    picture = draw(facts, page, plan, (4, 4), "Units of the morphological engine and the links between them")
    ports(picture, facts, plan, "docs/reference/morphological/index.md", {
        "pixels_in": ([(-.4, .3), (0, .3)], -16, -8, ""),
        "pixels_out": ([at(0, 2, .5, 1), at(0, 2, .5, 1.45)], 8, -6, "")})
    return picture


def geometric(facts):
    page = "docs/reference/geometric/memories.md"
    plan = Plan({"EdgeReader": (0, 0), "EdgeClassifier": (1, 0), "PairFetch": (2, 0), "VertexFetch": (3, 0),
                 "LineSetup": (4, 0), "LineWalker": (4, 1), "CoverageUnit": (3, 1), "DepthScreen": (2, 1), "DepthTest": (1, 1),
                 "WeightCombiner": (0, 1),
                 "BlockScanner": (0, 2), "BlockFetch": (1, 2), "Resolver": (2, 2), "FacingStore": (0, 3),
                 "FrameCopier": (1, 3), "ParameterStore": (2, 3), "FrameSequencer": (3, 3), "MemoryArbiter": (1, 4),
                 "MemoryPort": (2, 4)},
                {"requests": -.18, "responses": .18}, {"responses": (0, 14, "middle")})
    by_wire = {name for row in facts.table(page, "wire", "bits", "from", "to") for cell in row[2:4]
               for name in cell.replace("`", "").split(", ")}
    camel = {"".join(part.title() for part in name.split("_")) for name in by_wire}
    linked = {unit for _, start, end, _ in facts.links(page) for unit in (start, end)}
    beside = sorted(camel - linked)
    if unplaced := [unit for unit in beside if unit not in plan.units]:
        raise Missing(f"scripts/drawing/pipelines.py: {page} has units that have no place: {', '.join(unplaced)}")
    optional = facts.optional(page)
    picture = draw(facts, page, plan, (5, 5), "Units of the geometric engine and the links between them", beside, optional)
    for name, start, end, places in facts.links(page):
        if "each client" in (start, end):
            shift = 0 if end == "MemoryArbiter" else 22
            way = [plan.point(0, 8.4), plan.point(2, 8.4)][::1 if end == "MemoryArbiter" else -1]
            picture.path([(x, y + shift) for x, y in way], arrow=True)
            picture.text(LEFT + (WIDTH + GAP_X) / 2, way[0][1] + shift + (-6 if not shift else 14),
                         "each client's " + name.rsplit("_", 1)[-1], "small halo middle")
    picture.height += 32
    picture.text(LEFT, picture.height - 30, f"{' and '.join(optional)} stand only where they are built; "
                 "without one of them its link goes the way in dashes.", "small dim")
    picture.text(LEFT, picture.height - 14, "Units in dashes have no link but to memory; wires join them. "
                 "The BlockScanner reads what the WeightCombiner touched.", "small dim")
    return picture
