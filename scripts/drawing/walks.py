# SPDX-License-Identifier: MIT
"""How single things go through the hardware: a request through the texture cache, a line over pixels, a footprint over texels."""
import math
import re
import textwrap

from drawing.facts import Missing
from drawing.svg import Picture


def texture_cache(facts):
    links = {name: (start, end, places) for name, start, end, places in facts.links("docs/reference/texture/hardware.md")}
    depth = links["cache.latency_fifo.entries"][2]
    picture = Picture(840, 404, "The two halves of the texture cache with a FIFO between them",
                      f"A request goes through the TagStage, waits in the LatencyFifo of {depth} places, and goes through the "
                      "DataStage, always in order. Lines that the TagStage misses go through the MissQueue to memory and come "
                      "back into the FillBuffer, where the DataStage finds them when their request has come to the head.")
    boxes = {"TagStage": (20, 60, 220), "LatencyFifo": (300, 60, 240), "DataStage": (600, 60, 220),
             "MissQueue": (20, 270, 220), "MemoryPort": (350, 270, 140), "FillBuffer": (600, 270, 220)}
    halves = {"TagStage": "tag half", "DataStage": "data half"}
    for unit, (x, y, width) in boxes.items():
        height = 84 if y > 200 else 124
        picture.rect(x, y, width, height, "box", rx=5)
        picture.text(x + width / 2, y + 20, unit + (f", the {halves[unit]}" if unit in halves else ""), "middle strong")
        rows = []
        if unit != "LatencyFifo" and unit != "MemoryPort":
            for stage, work in facts.stages(unit):
                text = work if stage == "-" else f"{stage}: {work}"
                rows += textwrap.wrap(text, 40)
        if unit == "MemoryPort":
            rows = [facts.latency(unit) + ",", "and those of memory"]
        picture.lines(x + 10, y + 38, rows, "small dim", 13)
    x, y, width = boxes["LatencyFifo"]
    for i in range(10):
        kind = "second shade" if i in (2, 7) else "first shade" if i < 9 else "rule"
        picture.rect(x + width - 26 - 22 * i, y + 40, 18, 30, kind, rx=3)
    picture.text(x + width / 2, y + 86, f"{depth} places, in order", "middle small dim")
    for i, (side, word) in enumerate((("first", "hit"), ("second", "missed a line"))):
        picture.rect(x + 40 + 60 * i, y + 97, 11, 11, f"{side} shade", rx=2)
        picture.text(x + 56 + 60 * i, y + 107, word, "small")

    def way(name, points, dx=0., dy=-6., classes="middle"):
        if name not in links:
            raise Missing(f"docs/reference/texture/hardware.md: no link {name}")
        picture.path(points, arrow=True)
        (x0, y0), (x1, y1) = points[0], points[1]
        picture.text((x0 + x1) / 2 + dx, (y0 + y1) / 2 + dy, name.split(".")[-1], f"small halo {classes}")

    way("texels", [(130, 22), (130, 60)], 8, 0, "")
    way("cache.requests", [(240, 118), (300, 118)])
    picture.path([(540, 118), (600, 118)], arrow=True)
    way("texel_quads", [(710, 60), (710, 22)], 8, 0, "")
    way("cache.misses", [(130, 184), (130, 270)], 8, 4, "")
    way("cache.memory_requests", [(240, 300), (350, 300)])
    picture.path([(490, 330), (600, 330)], arrow=True)
    picture.text(545, 324, links["cache.memory_responses"][0] and "memory_responses", "small halo middle")
    picture.path([(710, 270), (710, 184)], arrow=True)
    picture.lines(700, 222, ["lines, in the order", "in which they were missed"], "small dim end")
    hit = facts.find("docs/reference/datasheets.md", r"^\| TextureCache \| (\d+) \|")[1]
    miss = facts.find("docs/reference/texture/cache.md", r"One that misses a line takes (\d+) clocks")[1]
    picture.text(20, 388, f"A request that hits takes {hit} clocks; one that misses a line {miss} more than the latency of memory.",
                 "small dim")
    return picture


def line_walk(facts):
    vectors = facts.table("docs/reference/geometric/formats.md", "M0, m0, d0", "M1, m1, d1")
    ends, other, horizontal, columns, position, slope = vectors[0][:6]
    major0, minor0, _ = map(int, ends.split(", "))
    major1, minor1, _ = map(int, other.split(", "))
    first, count = map(int, columns.split(", "))
    rule = facts.find("docs/reference/geometric/formats.md", r"^distance\(dis\) = ([^.]*)\.")[1]
    if horizontal != "yes" or not re.fullmatch(r"[\d\s()+>|dis-]+", rule):
        raise Missing("docs/reference/geometric/formats.md: the first line of the vectors, or distance(dis), is another")
    left, right, bottom, cell = first - 2, first + count + 2, 7, 54

    def at(x, y):
        return 20 + (x - left) * cell, 20 + y * cell

    walked = []
    for i in range(count):
        place = (int(position) + i * int(slope)) >> 8
        row, dis = place >> 16, (place & 65535) - 32768
        # The rule is the page's, of digits, brackets, dis and operators alone.
        coverage = eval(rule.replace("|dis|", "abs(dis)"), {"__builtins__": {}}, {"abs": abs, "dis": dis})
        walked.append((first + i, row, place / 65536, row + (1 if dis > 0 else -1), coverage))
    groups = []
    for column, row, *_ in walked:
        block = (column // 4, row // 4)
        if groups and groups[-1][0] == block and len(groups[-1][1]) < 4:
            groups[-1][1].append((column, row))
        else:
            groups.append((block, [(column, row)]))
    words = "; ".join(f"column {column}: pixel {row}, neighbour {other}, coverage {coverage}"
                      for column, row, _, other, coverage in walked)
    picture = Picture(40 + (right - left) * cell, 104 + bottom * cell, "A line's walk over pixels in the geometric engine",
                      f"The first line of the contract's vectors over pixels. In each column the pixel that holds the line is "
                      f"blended with the neighbour nearer to the line. {words}. Groups of four walkers: "
                      + ", ".join(str(len(pixels)) for _, pixels in groups) + " columns, a clock each.")
    for column, row, _, _, coverage in walked:
        x, y = at(column, row)
        picture.rect(x, y, cell, cell, "first", fill_opacity=number_of(coverage / 200))
    for x in range(left, right):
        for y in range(bottom):
            picture.rect(*at(x, y), cell, cell, "rule")
    for x in range(left + -left % 4, right + 1, 4):
        picture.path([at(x, 0), at(x, bottom)], "wire")
    for y in range(0, bottom + 1, 4):
        picture.path([at(left, y), at(right, y)], "wire")
    picture.path([at(major0 / 256, minor0 / 256), at(major1 / 256, minor1 / 256)], "line")
    for end in ((major0, minor0), (major1, minor1)):
        picture.circle(*at(end[0] / 256, end[1] / 256), 4, "mark")
    for column, row, place, other, coverage in walked:
        x, y = at(column + .5, row + .5)
        px, py = at(column + .5, place)
        picture.circle(px, py, 4, "second")
        up = other < row
        picture.path([(x + 14, y + (-16 if up else 16)), (x + 14, y + (-34 if up else 34))], arrow=True)
        picture.text(x - 22, y + (22 if up else -14), str(coverage), "strong halo")
    for _, pixels in groups:
        x0, y = at(pixels[0][0], bottom)
        x1, _ = at(pixels[-1][0] + 1, bottom)
        picture.path([(x0 + 4, y + 10), (x0 + 4, y + 16), (x1 - 4, y + 16), (x1 - 4, y + 10)], "group")
        picture.text((x0 + x1) / 2, y + 32, "1 clock", "small middle")
    y = 20 + bottom * cell
    picture.text(20, y + 30, "groups of 4 walkers", "small")
    picture.lines(20, y + 58, ["Dots: where the line crosses the middle of a column. Number: coverage in 1/256. Arrow: to the neighbour "
                                "that is blended in.", "Dashed: blocks of 4 x 4 pixels; a group is of one block."], "small dim")
    return picture


def number_of(value):
    return round(value, 3)


def footprint(facts):
    page = "docs/reference/texture/formats.md"
    table = facts.table(page, "direction", "0", "1")
    rows = {row[0]: [int(cell) for cell in row[1:]] for row in table}
    if sorted(rows) != ["C", "S"] or len(rows["C"]) != 8:
        raise Missing(f"{page}: the table of directions has other rows")
    along, across = (5.6, 3.2), (2.2, -.2)  # a pixel's row and column, in texels
    axes = [tuple((c * a + s * b) / 128 for a, b in zip(along, across)) for c, s in zip(rows["C"], rows["S"])]
    major = max(range(8), key=lambda k: (math.hypot(*axes[k]), -k))
    longest = math.hypot(*axes[major])
    shortest = abs(along[0] * across[1] - along[1] * across[0]) / longest
    beyond = int(facts.find(page, r"`kLog2Count\[n\]`, which is round\(4096 lb n\) \+ (\d+)")[1])
    taken = 4096 * math.log2(longest / shortest)
    count = 1 + sum(taken > round(4096 * math.log2(n)) + beyond for n in range(1, 16))
    side = 2 ** max(0, math.log2(longest) - taken / 4096)
    cell, width, height = 70, 11, 6
    picture = Picture(40 + width * cell, 112 + height * cell, "An anisotropic footprint with its samples",
                      f"A pixel as a parallelogram over texels. Of the eight candidate directions number {major} is the longest, "
                      f"{longest:.2f} texels; the minor axis is {shortest:.2f} texels by the area. So the rule any takes {count} "
                      f"samples along the major axis, each {side:.2f} texels wide, the size of a texel at its level of detail.")

    def at(x, y):
        return 20 + (x + width / 2) * cell, 20 + (y + height / 2) * cell

    corners = [at((a * along[0] + b * across[0]) / 2, (a * along[1] + b * across[1]) / 2)
               for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    picture.path(corners, "second pale", closed=True)
    for x in range(width):
        for y in range(height):
            picture.rect(20 + x * cell, 20 + y * cell, cell, cell, "rule")
    for i in range(count):
        part = (2 * i + 1 - count) / (2 * count)
        x, y = at(axes[major][0] * part - side / 2, axes[major][1] * part - side / 2)
        picture.rect(x, y, side * cell, side * cell, "faint")
    for k, (u, v) in enumerate(axes):
        picture.path([at(-u / 2, -v / 2), at(u / 2, v / 2)], "line" if k == major else "candidate")
        length = math.hypot(u, v)
        scale = .5 + .3 / length
        x, y = at(u * scale, v * scale)
        picture.text(x, y + 5, str(k), "middle halo" + (" strong" if k == major else " small"))
    for i in range(count):
        part = (2 * i + 1 - count) / (2 * count)
        picture.circle(*at(axes[major][0] * part, axes[major][1] * part), 5, "mark")
    y = 20 + height * cell
    picture.rect(20, y + 16, 14, 11, "second pale")
    picture.text(40, y + 26, "the pixel, over texels of level 0", "small")
    picture.path([(260, y + 22), (288, y + 22)], "candidate")
    picture.text(294, y + 26, "candidates 0 to 7", "small")
    picture.path([(430, y + 22), (458, y + 22)], "line")
    picture.text(464, y + 26, f"the longest of them, {major}: the major axis", "small")
    picture.circle(27, y + 46, 5, "mark")
    picture.text(40, y + 50, f"{count} samples along it", "small")
    picture.rect(260, y + 40, 14, 12, "faint")
    picture.text(294, y + 50, "a texel of the level of detail that a sample is taken from", "small")
    return picture
