# SPDX-License-Identifier: MIT
"""Ends of runs and of diagonals with the areas that they give: shapes of the morphological engine, tiles of SMAA."""
import re

from drawing.facts import Missing
from drawing.svg import Picture

CELL, LENGTH = 19, 6


def run(picture, x, y, start, end, areas):
    """A run of LENGTH edges with pixels on both sides; start, end: code N + 2 S of the crossing edges; areas:
    (at the start, side) of each."""
    for row in range(2):
        for column in range(-1, LENGTH + 1):
            picture.rect(x + column * CELL, y + (row - 1) * CELL, CELL, CELL, "rule")
    for at_start, side in areas:
        area(picture, x, y, at_start, side)
    picture.path([(x, y), (x + LENGTH * CELL, y)], "edge")
    for at, code in ((x, start), (x + LENGTH * CELL, end)):
        if code & 1:
            picture.path([(at, y), (at, y - CELL)], "edge")
        if code & 2:
            picture.path([(at, y), (at, y + CELL)], "edge")


def area(picture, x, y, at_start, side):
    """The triangle between the edge and the line on its way from half a pixel at an end to 0 in the middle."""
    if side == "none":
        return
    end = x if at_start else x + LENGTH * CELL
    tip = (end, y + CELL / 2 * (-1 if side == "first" else 1))
    middle = (x + LENGTH * CELL / 2, y)
    picture.path([(end, y), tip, middle], f"{side} shade", closed=True)
    picture.path([tip, middle], "line")


def key(picture, x, y):
    for i, (side, words) in enumerate((("first", "share of the first (upper) pixels"), ("second", "share of the second (lower) pixels"))):
        picture.rect(x + 250 * i, y - 10, 14, 11, f"{side} shade")
        picture.text(x + 250 * i + 20, y, words, "small")
    picture.path([(x + 500, y - 4), (x + 528, y - 4)], "line")
    picture.text(x + 534, y, "line that the run stands for", "small")


CODES = ("no crossing edge", "N, on the first side", "S, on the second side", "both, a T")


def run_shapes(facts):
    shapes = facts.shapes()
    words = "; ".join(f"{start} and {end}: {shapes[start + 4 * end][0]}" for start in range(4) for end in range(4))
    picture = Picture(840, 500, "The sixteen shapes of a run by the crossing codes of its two ends",
                      "A table of runs of edges. Rows: code of the start, columns: code of the end, 0 to 3. In each run "
                      f"the area between the edge and the line. Names by codes of start and end: {words}.")
    for code, name in enumerate(CODES):
        picture.text(202 + 172 * code, 26, f"end {code}", "middle strong")
        picture.text(202 + 172 * code, 42, name, "middle small dim")
        picture.text(12, 94 + 102 * code, f"start {code}", "strong")
        picture.lines(12, 109 + 102 * code, name.split(", "), "small dim")
    for number, (name, before, after, clean) in enumerate(shapes):
        x, y = 202 - LENGTH * CELL / 2 + 172 * (number // 4), 94 + 102 * (number % 4)
        run(picture, x, y, number % 4, number // 4, [(True, before), (False, after)])
        picture.text(x + LENGTH * CELL / 2, y + CELL + 16, f"{number}: {name}" + (", clean" if clean else ""), "middle small")
    key(picture, 60, 486)
    return picture


def smaa_patterns(facts):
    formats, page = "docs/reference/morphological/formats.md", "docs/reference/morphological/smaa.md"
    bits = facts.find(formats, r"pattern p = (S_start) \+ 2 (\w+) \+ 4 (\w+) \+ 8 (\w+),").groups()
    tiles = {}
    for patterns, second, first in facts.table(formats, "p", "second", "first"):
        for pattern in patterns.split(", "):
            tiles[int(pattern)] = {"first": first, "second": second}
    merged = facts.find(page, r"^\| `table_merged`[^|]*\| ([\d, ]+) \| ([\d, ]+): zero, no read; ([^|]*) \|")
    notes = {int(pattern): "not stored: zero" for pattern in merged[2].split(", ")}
    for several, other in re.findall(r"([\d, ]+) read (\d+)", merged[3]):
        notes.update({int(pattern): f"not stored: reads {other}" for pattern in several.split(", ")})
    if sorted(tiles) != list(range(16)):
        raise Missing(f"{formats}: tiles of the published table are {sorted(tiles)}")
    parts = {"0": "", "T[i][j]": "start", "T[j][i]": "end", "U[i][j]": "start end"}
    words = "; ".join(f"{p}: second {tiles[p]['second']}, first {tiles[p]['first']}" for p in range(16))
    picture = Picture(840, 460, "The sixteen orthogonal patterns of SMAA and their tiles",
                      f"Runs of edges with crossing edges at their ends, numbered p = {bits[0]} + 2 {bits[1]} + 4 {bits[2]} "
                      f"+ 8 {bits[3]}, with the areas that the table gives. {words}. T[i][j] is the half at the start, "
                      "T[j][i] the half at the end, U both; table_merged stores eight of them.")
    for p in range(16):
        x, y = 48 + 200 * (p % 4), 56 + 102 * (p // 4)
        on = {bits[i] for i in range(4) if p >> i & 1}
        areas = [(end == "start", side) for side in ("first", "second") for end in parts[tiles[p][side]].split()]
        run(picture, x, y, ("N_start" in on) + 2 * ("S_start" in on), ("N_end" in on) + 2 * ("S_end" in on), areas)
        picture.text(x - CELL, y - CELL - 7, f"p = {p}", "strong")
        picture.text(x + LENGTH * CELL + CELL, y - CELL - 7, notes.get(p, ""), "small dim end")
        cells = [f"{side} {tiles[p][side]}" for side in ("first", "second") if tiles[p][side] != "0"]
        picture.text(x + LENGTH * CELL / 2, y + CELL + 16, ", ".join(cells) or "no area", "middle small")
    key(picture, 60, 448)
    return picture


def diagonal_ends(facts):
    formats, page = "docs/reference/morphological/formats.md", "docs/reference/morphological/smaa.md"
    pairs = {}
    for row in facts.table(formats, "e1, e2", "P, Q"):
        for codes, lines in zip(row[::2], row[1::2]):
            pairs[tuple(int(code) for code in codes.split(", "))] = [
                tuple(map(int, line)) for line in re.findall(r"\((\d),(\d)\), \((\d),(\d)\)", lines)]
    if len(pairs) != 16:
        raise Missing(f"{formats}: {len(pairs)} pairs of codes in place of 16")
    row = next(row for row in facts.table(page, "diagonal", "e1", "e2") if row[0] == "rising")
    d1 = d2 = 2
    span = d1 + d2 + 1

    def crossings(cell):
        """Edges of an expression as '2 top(x - d1 - 1, y + d1) + left(..)': weight -> (name, dx, dy)."""
        found = {}
        for weight, name, dx, dy in re.findall(r"(?:(\d) )?(top|left)\(x ?([^,]*), y ?([^)]*)\)", cell):
            value = [sum(int(sign + "1") * {"d1": d1, "d2": d2}.get(term, 0) + int(sign + (term if term.isdigit() else "0"))
                         for sign, term in re.findall(r"([+-]) (\w+)", part)) for part in (dx, dy)]
            found[int(weight or 1)] = (name, *value)
        return found

    ends = [crossings(cell) for cell in row[1:3]]
    words = "; ".join(f"{e1}, {e2}: " + " and ".join(f"({a},{b}) to ({c},{d}) + n" for a, b, c, d in pairs[e1, e2])
                      for e1 in range(4) for e2 in range(4))
    cell, pitch = 17, 178
    picture = Picture(800, 790, "The ends of a rising diagonal and the lines that they stand for",
                      "A table of staircases that rise to the right. Rows: code e1 of the lower left end, columns: code e2 of "
                      f"the upper right one. Each with the one or two lines whose areas are averaged, P to Q + (n, n): {words}.")
    for e1 in range(4):
        picture.text(12, 122 + pitch * e1, f"e1 = {e1}", "strong")
        picture.text(148 + pitch * e1, 26, f"e2 = {e1}", "middle strong")
        for e2 in range(4):
            left, base = 88 + pitch * e2, 178 + pitch * e1

            def corner(x, y, left=left, base=base):
                return left + x * cell, base - y * cell

            def edge(name, dx, dy):
                # Pixel (x, y) is cell (1 + d1, d1) of the table's axes, whose second one points up.
                x, y = 1 + d1 + dx, d1 - dy
                picture.path([corner(x, y + 1), corner(x + 1, y + 1) if name == "top" else corner(x, y)], "edge")

            for i in range(span + 3):
                picture.path([corner(-.4, i), corner(span + 2.4, i)], "rule")
                picture.path([corner(i, -.4), corner(i, span + 2.4)], "rule")
            picture.rect(*corner(1 + d1, d1 + 1), cell, cell, "second shade")
            picture.rect(*corner(1 + d1, d1 + 2), cell, cell, "first shade")
            for step in range(-d1, d2 + 1):
                edge("top", step, -step)
                if step > -d1:
                    edge("left", step, -step)
            for code, end in zip((e1, e2), ends):
                for weight, (name, dx, dy) in end.items():
                    if code & weight:
                        edge(name, dx, dy)
            for x1, y1, x2, y2 in pairs[e1, e2]:
                picture.path([corner(x1, y1), corner(x2 + span, y2 + span)], "line")
                picture.circle(*corner(x1, y1), 3, "mark")
                picture.circle(*corner(x2 + span, y2 + span), 3, "mark")
    for i, (side, words) in enumerate((("first", "first pixel, above"), ("second", "second pixel, below"))):
        picture.rect(60 + 170 * i, 766, 13, 13, f"{side} shade")
        picture.text(80 + 170 * i, 777, words, "small")
    picture.path([(400, 773), (428, 773)], "line")
    picture.text(434, 777, "lines from P to Q + (n, n)", "small")
    picture.text(600, 777, f"d1 = {d1}, d2 = {d2}, n = {span}", "small")
    return picture


def crossing_codes(facts):
    page = "docs/reference/morphological/smaa.md"
    quarters = facts.table(page, "code N + 2 S")[0][1:]
    facts.find(page, r"in one access a quarter of a pixel off the line")
    length, at, cell = 8, 3, 30
    words = "; ".join(f"code {code}, {CODES[code]}: 4e = {quarters[code]}" for code in range(4))
    picture = Picture(840, 330, "The four codes of a corner inside a row of eight edges, and where SMAA reads them",
                      "Eight edges in a row between two rows of pixels, four times, with no crossing edge, one above, one below "
                      f"and both at the corner after the third edge. {words}. With ends = crossings a corner with a code other "
                      "than 0 ends a run of three and begins one of five.")
    for code in range(4):
        x, y = 60 + 410 * (code % 2), 92 + 138 * (code // 2)
        for row in range(2):
            for column in range(-1, length + 1):
                picture.rect(x + column * cell, y + (row - 1) * cell, cell, cell, "rule")
        picture.path([(x, y), (x + length * cell, y)], "edge")
        if code & 1:
            picture.path([(x + at * cell, y), (x + at * cell, y - cell)], "edge")
        if code & 2:
            picture.path([(x + at * cell, y), (x + at * cell, y + cell)], "edge")
        picture.circle(x + (at + .5) * cell, y + cell / 4, 4, "mark")
        picture.text(x - cell, y - cell - 9, f"code {code}: {CODES[code]}", "strong")
        picture.text(x + (length + 1) * cell, y - cell - 9, f"4e = {quarters[code]}", "strong end")
        for start, end in ([(0, length)] if code == 0 else [(0, at), (at, length)]):
            picture.path([(x + start * cell + 3, y + cell + 12), (x + end * cell - 3, y + cell + 12)], "link")
            picture.text(x + (start + end) / 2 * cell, y + cell + 27, f"run of {end - start}", "middle small")
    picture.circle(70, 312, 4, "mark")
    picture.text(82, 316, "where SMAA reads both bits at once: a quarter of a pixel off the line, 1/4 of the upper and 3/4 of the "
                 "lower bit", "small")
    return picture


def far_bits(facts):
    page = "docs/reference/morphological/smaa.md"
    above, below = (int(n) for n in facts.find(
        page, r"bit 0 = left\(X, y - (\d)\) \(first side\), bit 1 = left\(X,\s+y \+ (\d)\)\s+\(second side\)").groups())
    facts.find(page, r"`far` = bits\s+of the start \+ 4 x bits of the end")
    facts.find(page, r"near the start if l < r, near the end if l > r, else in the middle")
    facts.find(page, r"f = 512 - G x \(2s near the start, 2e near the end, s \+ e in the middle\)")
    stays = int(facts.find(page, r"`corner_rounding` \| 0\.\.256, 1/256 \| (\d+) \|")[1])

    def kept(s, e, place):
        """Percent of a share that stays."""
        return (512 - (256 - stays) * {"start": 2 * s, "middle": s + e, "end": 2 * e}[place]) / 5.12

    cell = 30
    picture = Picture(840, 420, "The four far bits of a run of eight pixels, and what a sharp corner leaves of shares",
                      "Above: a run of eight edges with the four edges that its far bits look at, each the second pixel of a "
                      f"crossing: {above} rows above the line bit 0 at the start and bit 2 at the end, {below} below the "
                      "line's own row bit 1 and bit 3. Below: runs of eight and of seven pixels whose crossing on the first "
                      f"side goes on at the start: with corner_rounding = {stays} {kept(1, 0, 'start'):g} % of a share of that "
                      f"side stays in the half near the start, all of it near the end, {kept(1, 0, 'middle'):g} % in the middle "
                      "of an odd run.")

    def grid(x, y, length):
        for row in range(-above, below + 1):
            for column in range(-1, length + 1):
                picture.rect(x + column * cell, y + row * cell, cell, cell, "rule")
        picture.path([(x, y), (x + length * cell, y)], "edge")

    x, y, length = 300, 96, 8
    picture.text(12, 40, "far bits", "strong")
    picture.lines(12, 60, ("Edges that make a corner sharp:", "each the second pixel of a", "crossing. Outside the frame", "they are as `border` says; 0",
                           "of a head at its end, of a", "tail at its start."), "small")
    grid(x, y, length)
    for bit in range(4):
        at = x + (length * cell if bit & 2 else 0)
        side, first, far = ("first", y - cell, y - above * cell) if bit % 2 == 0 else ("second", y + cell, y + (below + 1) * cell)
        picture.path([(at, y), (at, first)], "candidate")
        picture.rect(at - 4, min(first, far), 8, cell, f"{side} shade")
        picture.text(at + (-10 if not bit & 2 else 10), (first + far) / 2 + 4, f"bit {bit}", "small halo" + ("" if bit & 2 else " end"))
    for x, length in ((60, 8), (470, 7)):
        y = 306
        grid(x, y, length)
        picture.path([(x, y), (x, y - above * cell)], "edge")
        picture.text(x - cell, y - above * cell - 10, f"L = {length}, far = 1: s = 1, e = 0 on the first side", "strong small")
        for k in range(length):
            place = "start" if 2 * k < length - 1 else "end" if 2 * k > length - 1 else "middle"
            picture.rect(x + k * cell, y - cell, cell, cell, "first " + ("shade" if place == "end" else "pale"))
            picture.text(x + (k + .5) * cell, y - cell / 2 + 4, f"{kept(1, 0, place):g}", "middle small")
    picture.rect(60, 394, 14, 11, "first shade")
    picture.text(80, 404, f"pixels of the first side with the percentage of their share that stays, corner_rounding = {stays}", "small")
    return picture
