# SPDX-License-Identifier: MIT
"""What the pictures show, read from the pages and headers that the tests hold against the models."""
import re


class Missing(Exception):
    """A page no longer says what a picture needs; the text names page and place."""


class Facts:
    """The pages and headers of a checkout."""

    def __init__(self, root):
        self.root = root

    def text(self, file):
        return (self.root / file).read_text(encoding="utf-8")

    def find(self, file, pattern):
        """The match of a pattern in a file."""
        found = re.search(pattern, self.text(file), re.M | re.S)
        if not found:
            raise Missing(f"{file}: nothing matches {pattern}")
        return found

    def table(self, file, *head):
        """Rows of the first table of a page whose head begins with these cells."""
        rows, inside = [], False
        for line in self.text(file).splitlines():
            cells = [cell.strip() for cell in re.split(r"(?<!\\)\|", line.strip().strip("|"))]
            if inside and not line.startswith("|"):
                break
            if inside and not re.fullmatch(r"[\s|:-]+", line):
                rows.append(cells)
            inside = inside or (line.startswith("|") and cells[:len(head)] == list(head))
        if not rows:
            raise Missing(f"{file}: no table with the head {' | '.join(head)}")
        return rows

    def links(self, page):
        """(name, from, to, places) of each link of a hardware page; `to` is None for a FIFO inside of a unit."""
        found = []
        for name, ends, places, *_ in self.table(page, "link", "from, to", "places"):
            ends = ends.split(":")[0].split(";")[0]
            inside = re.fullmatch(r"inside the (\w+)", ends)
            start, _, end = (inside[1], "", None) if inside else ends.partition(", ")
            found.append((re.sub(r"_entries$|_\?\?", "", name.strip("`")), start, end, int(places)))
        return found

    def optional(self, page):
        """Unit that not every build has -> (from, to): what its link joins without it."""
        found = {}
        for _, ends, *_ in self.table(page, "link", "from, to", "places"):
            if without := re.fullmatch(r"(\w+), (\w+); without that one (\w+)", ends):
                found[without[2]] = without[1], without[3]
        return found

    def latency(self, name):
        """Words for the latency of a unit (or of 'A or B'), from its datasheet; none if it has none."""
        cells = []
        for unit in name.split(" or "):
            cells += re.findall(rf"^\| {unit}(?:, [^|]*)? \| ([^|]*) \|", self.text("docs/reference/datasheets.md"), re.M)
        if not cells:
            return None
        clocks = sorted({int(found[1]) for cell in cells if (found := re.match(r"(\d+)\b", cell))})
        more = any(not re.match(r"\d", cell) or "and" in cell for cell in cells)
        if not clocks:
            least = re.match(r"at least (\d+)", cells[0])
            clocks, more = ([int(least[1])], True) if least else (clocks, more)
        if not clocks:
            return None
        words = f"{clocks[0]} to {clocks[-1]} clocks" if len(clocks) > 1 else "1 clock" if clocks == [1] else f"{clocks[0]} clocks"
        return words + (" or more" if more else "")

    def stages(self, unit):
        """(stage, work) of each stage of a unit's first datasheet."""
        text = self.find("docs/reference/datasheets.md", rf"^### {unit}\n(.*?)\nCost")[1]
        return re.findall(r"^\| ([\d, -]+?) \| ([^|]*?) \|", text, re.M)

    def shapes(self):
        """(name, before, after, clean) of the sixteen shapes of runs; sides are first, second or none."""
        found = re.findall(r'\{"([\w-]+)", Side::k(\w+), Side::k(\w+), (true|false)\}',
                           self.text("spec/morphological/shapes.h"))
        if len(found) != 16:
            raise Missing(f"spec/morphological/shapes.h: {len(found)} shapes in place of 16")
        return [(name, before.lower(), after.lower(), clean == "true") for name, before, after, clean in found]
