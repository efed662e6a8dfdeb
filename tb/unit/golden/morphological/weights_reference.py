#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Independent reference of learned weights, written from docs/reference/morphological/learned_weights.md only, for
predictor = none.

    weights_reference.py           prints the table indices of all edges of the worked examples
    weights_reference.py WIDTH HEIGHT COLUMNS ROWS IN OUT
                                   smooths raw R, G, B, A with bypass = masked and search ranges of COLUMNS and ROWS;
                                   writes R, G, B
"""

import pathlib
import re
import sys

SPEC = pathlib.Path(__file__).resolve().parents[4] / "spec" / "morphological"
C_SEARCH_RANGE, R_SEARCH_RANGE = 256, 32  # search ranges of preset deburr
LONG_Z = 16


def table(file, name):
    text = re.sub(r"//[^\n]*", "", (SPEC / file).read_text())
    body = re.search(name + r"\s*=\s*\{+([^}]*)\}", text).group(1)
    return [int(v) for v in body.replace("\n", " ").split(",") if v.strip()]


def to_linear(code):
    v = code / 255
    return int(4095 * (v / 12.92 if v <= 0.04045 else ((v + 0.055) / 1.055) ** 2.4) + 0.5)


def to_code(linear):
    v = linear / 4095
    return int(255 * (12.92 * v if v <= 0.0031308 else 1.055 * v ** (1 / 2.4) - 0.055) + 0.5)


class Edges:
    """Edges of one axis as sets of (position, line), with positions along the runs."""

    def __init__(self, along, across):
        self.along, self.across = along, across

    def code(self, position, line):
        return ((position, line - 1) in self.across) + 2 * ((position, line) in self.across)


def colour_edges(frame, threshold=13, masked=()):
    height, width = len(frame), len(frame[0])

    def step(x, y, u, v):
        for a, b in ((x, y), (u, v)):
            if not (0 <= a < width and 0 <= b < height) or (a, b) in masked:
                return 0
        return max(abs(p - q) for p, q in zip(frame[y][x], frame[v][u]))

    def find(along):  # along = (1, 0): top edges; (0, 1): left edges
        dx, dy = along
        result = set()
        for y in range(height):
            for x in range(width):
                bx, by = x - dy, y - dx  # the pixel across the edge

                def across(k):
                    return step(x + k * dy, y + k * dx, x + (k - 1) * dy, y + (k - 1) * dx)

                def parallel_steps(px, py):
                    return max(step(px, py, px - dx, py - dy), step(px, py, px + dx, py + dy))

                c = across(0)
                most = max(c, across(1), across(-1), min(parallel_steps(x, y), parallel_steps(bx, by)))
                if c >= threshold and 2 * c > most:
                    result.add((x, y))
        return result

    return find((1, 0)), find((0, 1))


def distance_class(d):
    return next((i for i, most in enumerate((0, 1, 2, 3, 5, 8, 15)) if d <= most), 7)


def length_class(length):
    return next((i for i, most in enumerate((1, 3, 7)) if length <= most), 3)


def away_class(n):
    return next(i for i, most in enumerate((1, 2, 3, 5, 9, 10), 1) if n <= most)


def crossing_class(edges, line, corner, code, towards, remaining_range):
    """Class 0..8 of a single crossing at a corner. `towards`: +1 at the start of the run, -1 at its end.
    `remaining_range`: search range minus the length of the run."""
    if code not in (1, 2):
        return 0
    far = line - 1 if code == 1 else line + 1
    beyond = line - 2 if code == 1 else line + 1
    if (corner, beyond) in edges.across:
        return 2

    def along(k):  # edge k of the far line, 0 the first one towards the run, -1 the first away
        return (corner + (k if towards > 0 else -1 - k), far) in edges.along

    if along(0):
        return 1
    n = 0
    while n < min(10, remaining_range) and along(-1 - n):
        n += 1
    return 2 + away_class(n) if n else 0


def own_end(code, end_class, side):
    """(code, E) of an end, seen from the first (side 0) or second (side 1) pixel."""
    seen = (0, 1, 2, 3)[code] if side == 0 else (0, 2, 1, 3)[code]
    return seen, (0, 2 + end_class, 11 + end_class, 1)[seen]


def indices(edges, search_range):
    """{(position, line): [(a, b, c) of the first pixel, of the second]}."""
    result = {}
    for start, line in sorted(edges.along, key=lambda e: (e[1], e[0])):
        if (start - 1, line) in edges.along:
            continue
        end = start
        while (end, line) in edges.along:
            end += 1
        length, half = end - start, search_range // 2
        codes = edges.code(start, line), edges.code(end, line)
        left = max(0, search_range - length)
        if LONG_Z <= length <= search_range and codes in ((1, 2), (2, 1)):
            raise ValueError("a long Z keeps its line, which this reference does not have")
        end_classes = (crossing_class(edges, line, start, codes[0], 1, left),
                       crossing_class(edges, line, end, codes[1], -1, left))
        for x in range(start, end):
            seen = (length <= search_range or x - start < half, length <= search_range or end - 1 - x < half)
            both = []
            for side in (0, 1):
                ends = []
                for i, d in enumerate((x - start, end - 1 - x)):
                    code, e = own_end(codes[i], end_classes[i], side) if seen[i] else (0, 0)
                    ends.append((d if seen[i] else 1 << 20, -e, code))
                (dn, en, cn), (df, ef, cf) = sorted(ends)
                lam = length_class(length) if length <= search_range else 3
                dn, df = distance_class(dn), distance_class(df)
                both.append((((cn * 4 + cf) * 8 + dn) * 8 + df, (-en * 8 + dn) * 4 + lam,
                             (-ef * 8 + df) * 4 + lam))
            result[(x, line)] = both
    return result


def planes(frame, masked=()):
    top, left = colour_edges(frame, masked=masked)
    swap = lambda plane: {(y, x) for x, y in plane}
    return Edges(top, left), Edges(swap(left), swap(top))


def smooth(frame, masked=(), search_ranges=(C_SEARCH_RANGE, R_SEARCH_RANGE)):
    """R, G, B of the frame smoothed by preset deburr with predictor = none."""
    a, b, c = (table("learned_weights.h", name)
               for name in ("kWeightsOfCodes", "kWeightsOfNear", "kWeightsOfFar"))
    of_sum = table("tables.h", "kWeightOfSum")
    horizontal, vertical = planes(frame, masked)

    def weights(edges, search_range):
        return {edge: [of_sum[min(127, max(-128, a[i] + b[j] + c[k])) + 128] for i, j, k in both]
                for edge, both in indices(edges, search_range).items()}

    h, v = weights(horizontal, search_ranges[0]), weights(vertical, search_ranges[1])
    none = [0, 0]
    result = []
    for y, row in enumerate(frame):
        result.append([])
        for x, pixel in enumerate(row):
            up, down = h.get((x, y), none)[1], h.get((x, y + 1), none)[0]
            l, r = v.get((y, x), none)[1], v.get((y, x + 1), none)[0]
            if up + down >= l + r:
                near = ((up, x, y - 1), (down, x, y + 1))
            else:
                near = ((l, x - 1, y), (r, x + 1, y))
            near = [n for n in near if n[0]]
            mixed = []
            for channel, code in enumerate(pixel):
                own = to_linear(code)
                move = sum(w * (to_linear(frame[q][p][channel]) - own) for w, p, q in near)
                by = (abs(move) + 128) >> 8
                mixed.append(to_code(own - by if move < 0 else own + by) if near else code)
            result[-1].append(tuple(mixed))
    return result


PALETTE = {".": (20, 20, 20), "#": (230, 230, 230), "r": (128, 40, 70), "g": (10, 76, 64),
           "o": (24, 24, 30)}
FRAMES = {
    "corner": """
................
................
....########....
....########....
....########....
................
................
................""",
    "stair": """
................
................
............####
........########
...#############
################
################
################""",
    "marks": """
................
..#.......##....
......#....#....
.....###........
......#......#..
..............#.
..##............
................""",
    "hues": """
rrrrrrrrrrrrrrrr
rrrrrrrrrrrrrrrr
rrrrrrrrgggggggg
rrrrrgggggggoooo
rrggggggggggoooo
gggggggggggggggg
gggggggggggggggg
gggggggggggggggg""",
}


def frame_of(name):
    return [[PALETTE[c] for c in row] for row in FRAMES[name].split()]


def smooth_file(width, height, columns, rows, source, target):
    raw = pathlib.Path(source).read_bytes()
    frame = [[tuple(raw[4 * (y * width + x):][:3]) for x in range(width)] for y in range(height)]
    masked = {(x, y) for y in range(height) for x in range(width)
              if raw[4 * (y * width + x) + 3] % 2 == 0}
    result = smooth(frame, masked, (columns, rows))
    pathlib.Path(target).write_bytes(bytes(c for row in result for pixel in row for c in pixel))


def main():
    if len(sys.argv) == 7:
        smooth_file(*map(int, sys.argv[1:5]), *sys.argv[5:])
        return
    for name in FRAMES:
        print(f"{name}")
        for axis, edges, search_range in zip("hv", planes(frame_of(name)), (C_SEARCH_RANGE, R_SEARCH_RANGE)):
            for (position, line), both in sorted(indices(edges, search_range).items(),
                                                 key=lambda e: (e[0][1], e[0][0])):
                print(f"  {axis} line {line} position {position}: first {both[0]}, second {both[1]}")


if __name__ == "__main__":
    main()
