# SPDX-License-Identifier: MIT
"""A picture as SVG that is readable in dark and in light, has a title and a description, and is the same bytes
whenever it is drawn."""
import html

STYLE = """
svg { --ground: #ffffff; --ink: #1b1f24; --dim: #57606a; --box: #eef1f5; --rule: #d0d7de; --first: #0969da;
      --second: #bc4c00; --third: #1a7f37; }
@media (prefers-color-scheme: dark) {
  svg { --ground: #14181f; --ink: #e6edf3; --dim: #a5afba; --box: #232b36; --rule: #3a444f; --first: #58a6ff;
        --second: #f0883e; --third: #3fb950; }
}
text { fill: var(--ink); font: 13px sans-serif; }
.small { font-size: 11px; } .dim { fill: var(--dim); } .strong { font-weight: 600; }
.middle { text-anchor: middle; } .end { text-anchor: end; }
.halo { stroke: var(--ground); stroke-width: 4px; paint-order: stroke; stroke-linejoin: round; }
.ground { fill: var(--ground); }
.answer { fill: var(--box); stroke: var(--third); stroke-width: 1.8; }
.box { fill: var(--box); stroke: var(--dim); } .band { fill: none; stroke: var(--dim); stroke-dasharray: 5 4; }
.rule { stroke: var(--rule); fill: none; } .link { stroke: var(--dim); stroke-width: 1.4; fill: none; }
.wire { stroke: var(--dim); stroke-dasharray: 4 3; fill: none; } .head { fill: var(--dim); }
.edge { stroke: var(--ink); stroke-width: 2.6; stroke-linecap: round; fill: none; }
.line { stroke: var(--third); stroke-width: 2; fill: none; } .mark { fill: var(--third); }
.first { fill: var(--first); } .second { fill: var(--second); } .shade { fill-opacity: .55; } .pale { fill-opacity: .3; }
.faint { stroke: var(--first); stroke-opacity: .6; fill: var(--first); fill-opacity: .12; }
.candidate { stroke: var(--dim); stroke-dasharray: 3 3; fill: none; }
.group { stroke: var(--second); stroke-width: 2.4; fill: none; }
"""


def number(value):
    """A coordinate, short."""
    return f"{round(value, 2):g}"


class Picture:
    """Elements on a ground of its own, so that it does not matter what the page's ground is."""

    def __init__(self, width, height, title, description):
        self.width, self.height, self.title, self.description = width, height, title, description
        self.elements = []

    def _add(self, name, classes, text=None, **attributes):
        values = "".join(f' {key.replace("_", "-")}="{number(value) if isinstance(value, (int, float)) else value}"'
                         for key, value in attributes.items())
        kind = f' class="{classes}"' if classes else ""
        self.elements.append(f"<{name}{kind}{values}/>" if text is None else
                             f"<{name}{kind}{values}>{html.escape(text, quote=False)}</{name}>")

    def rect(self, x, y, width, height, classes="box", **attributes):
        self._add("rect", classes, x=x, y=y, width=width, height=height, **attributes)

    def text(self, x, y, text, classes=""):
        self._add("text", classes, text, x=x, y=y)

    def lines(self, x, y, rows, classes="", pitch=14):
        for i, row in enumerate(rows):
            self.text(x, y + i * pitch, row, classes)

    def path(self, points, classes="link", arrow=False, closed=False):
        steps = " ".join(("M" if i == 0 else "L") + number(x) + " " + number(y) for i, (x, y) in enumerate(points))
        extra = {"marker_end": "url(#head)"} if arrow else {}
        self._add("path", classes, d=steps + (" Z" if closed else ""), **extra)

    def circle(self, x, y, radius, classes):
        self._add("circle", classes, cx=x, cy=y, r=radius)

    def __str__(self):
        return "\n".join((
            "<!-- SPDX-License-Identifier: MIT. Made by scripts/figures: change that, or what it reads. -->",
            f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {number(self.width)} {number(self.height)}"'
            f' width="{number(self.width)}" height="{number(self.height)}" role="img" aria-labelledby="title desc">',
            f'<title id="title">{html.escape(self.title, quote=False)}</title>',
            f'<desc id="desc">{html.escape(self.description, quote=False)}</desc>',
            f"<style>{STYLE}</style>",
            '<defs><marker id="head" viewBox="0 0 8 8" refX="7" refY="4" markerWidth="8" markerHeight="8"'
            ' orient="auto" markerUnits="userSpaceOnUse"><path class="head" d="M0 0L8 4L0 8Z"/></marker></defs>',
            f'<rect class="ground" width="{number(self.width)}" height="{number(self.height)}" rx="6"/>',
            *self.elements, "</svg>", ""))
