#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Checks the site that scripts/docs makes: without a warning; every page of docs/ and of the root is in it; every
link, anchor and picture leads to something in it; nothing is loaded from a network, and no plain script imports, which
a browser rejects as a whole; it can be searched, and has dark, light and narrow screens.

usage: site_test.py SOURCE"""
import html.parser
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import urllib.parse

SPHINX = "/usr/bin/python3"  # Debian's, which scripts/docs takes
REMOTE = re.compile(r"(?:https?:)?//")


class Page(html.parser.HTMLParser):
    """What a page has: places to link to, links, what a browser loads for it, and which of it are plain scripts."""

    def __init__(self, text):
        super().__init__()
        self.places, self.links, self.loads, self.plain_scripts, self.phone = set(), [], [], [], False
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        values = dict(attrs)
        self.places.update(value for key in ("id", "name") if (value := values.get(key)))
        self.phone |= tag == "meta" and values.get("name") == "viewport"
        if tag == "a" and "href" in values:
            self.links.append(values["href"])
        elif tag == "link" and "href" in values:
            # The others (rel = search, next, index) are opened when somebody asks for them.
            (self.loads if set(values.get("rel", "").split()) & {"stylesheet", "icon", "preload"} else self.links).append(values["href"])
        if tag == "script" and "src" in values and values.get("type") != "module":
            self.plain_scripts.append(values["src"])
        if tag in ("script", "img", "iframe", "source", "object", "embed"):
            self.loads += [values[key] for key in ("src", "data") if key in values]


def problems(site):
    """What is wrong with the files of a site."""
    pages = {file: Page(file.read_text(encoding="utf-8")) for file in sorted(site.rglob("*.html"))}
    for file, page in pages.items():
        name = file.relative_to(site)
        if not page.phone and not name.as_posix().startswith("_static/"):
            yield f"{name}: is not made for narrow screens"
        for target in page.loads:
            if REMOTE.match(target):
                yield f"{name}: loads {target}"
        for target in page.links + page.loads:
            if REMOTE.match(target) or re.match(r"(?:mailto|data|javascript):", target):
                continue
            path, _, anchor = urllib.parse.unquote(target).partition("#")
            other = pathlib.Path(os.path.normpath(file.parent / path.partition("?")[0])) if path else file
            if not other.exists():
                yield f"{name}: {target} does not exist"
            elif anchor and other in pages and anchor not in pages[other].places:
                yield f"{name}: {target} has no such anchor"
    scripts = {file.parent / urllib.parse.unquote(target).partition("?")[0] for file, page in pages.items()
               for target in page.plain_scripts if not REMOTE.match(target)}
    for file in sorted({pathlib.Path(os.path.normpath(file)) for file in scripts}):
        if file.is_file() and re.search(r"^\s*(?:import|export)\b", file.read_text(encoding="utf-8"), re.M):
            yield f"{file.relative_to(site)}: imports or exports, and is no module"
    for file in sorted(site.rglob("*.css")):
        for target in re.findall(r"(?:url\(|@import\s+)['\"]?([^'\")\s]+)", file.read_text(encoding="utf-8")):
            if target.startswith("/") or REMOTE.match(target):
                yield f"{file.relative_to(site)}: loads {target}"


def completeness(root, site):
    files = [(page.relative_to(root / "docs").with_suffix(".html"), page) for page in (root / "docs").rglob("*.md")]
    files += [(pathlib.Path("project") / (page.stem + ".html"), page) for page in root.glob("*.md")]
    for name, page in sorted(files):
        if not (site / name).is_file():
            yield f"{page.relative_to(root)}: is not in the site"
    index = site / "searchindex.js"
    words = index.read_text(encoding="utf-8") if index.is_file() else ""
    if "anisotrop" not in words or not (site / "search.html").is_file():
        yield "the site cannot be searched"
    if not all("--color-background-primary: #14181f" in file.read_text(encoding="utf-8") for file in site.glob("*.html")):
        yield "a page of the site has no colours for dark"


def beside(site):
    """Sections and pages at the side of the index, in order."""
    tree = (site / "index.html").read_text(encoding="utf-8").partition('class="sidebar-tree"')[2].partition("</aside>")[0]
    return [section or page for section, page in re.findall(r'caption-text">([^<]*)<|href="([^"#]+)"', tree)]


def make(root, out, source):
    return subprocess.run([root / "scripts/docs", "--out", out, "--root", source], capture_output=True, text=True, check=False,
                          env={**os.environ, "DEBURR_NO_INSTALL": "1"})


def faults_that_are_not_found(root, folder):
    """A site of two pages without a fault, and one with faults that are named, each with its page."""
    faults = ("[b](none.md)", "![p](images/none.svg)", "[b](b.md#nothing)")
    for i, text in enumerate(("[b](b.md#a-heading) ![p](images/p.svg)", "\n\n".join(faults))):
        source, out = folder / f"source{i}", folder / f"site{i}"
        for part in ("docs/images", "scripts/site"):
            (source / part).mkdir(parents=True)
        for file in (root / "scripts/site").iterdir():
            if file.is_file():
                (source / "scripts/site" / file.name).write_bytes(file.read_bytes())
        (source / "docs/images/p.svg").write_text('<svg xmlns="http://www.w3.org/2000/svg"/>', encoding="utf-8")
        (source / "README.md").write_text("# Read me\n\n[A](docs/a.md) [S](scripts/site)\n", encoding="utf-8")
        (source / "docs/a.md").write_text(f"# A\n\n{text}\n", encoding="utf-8")
        (source / "docs/b.md").write_text("# B\n\n## A heading\n\nanisotropy\n", encoding="utf-8")
        (source / "docs/index.md").write_text("# I\n\n## Questions\n\n1. [q](b.md#a-heading)\n\n## How-to\n\n* [over two\n  lines](b.md)\n",
                                              encoding="utf-8")
        done = make(root, out, source)
        if (done.returncode == 0) != (i == 0):
            yield f"scripts/docs ends with {done.returncode} for {text}\n{done.stdout}{done.stderr}"
        elif i > 0:
            warnings = [line for line in (done.stdout + done.stderr).splitlines() if "a.md:" in line]
            for fault in ("none.md", "none.svg", "nothing"):
                if not any(fault in line for line in warnings):
                    yield f"planted fault not found: {fault}\n{done.stdout}{done.stderr}"
        elif found := [*problems(out), *completeness(source, out)]:
            yield f"a page without a fault has: {found}"
        elif (side := beside(out)) != ["How-to", "b.html", "Reference", "a.html", "Project", "project/README.html"]:
            yield f"at the side stands: {side}"
        else:
            page = out / "a.html"
            text = page.read_text(encoding="utf-8")
            for bad in ('<script src="https://example.org/a.js"></script>', '<a href="none.html">n</a>', '<a href="b.html#no">n</a>',
                        '<img src="//example.org/a.png">', '<link rel="stylesheet" href="http://example.org/a.css">'):
                page.write_text(text.replace("</body>", bad + "</body>"), encoding="utf-8")
                if not any("example.org" in line or "none.html" in line or "#no" in line for line in problems(out)):
                    yield f"planted fault not found: {bad}"
            page.write_text(text, encoding="utf-8")
            script = out / "_static/scripts/furo.js"
            kept = script.read_text(encoding="utf-8")
            if "theme-toggle" not in kept or "root.Gumshoe" not in kept:
                yield "the theme's script lacks the button of dark and light, or the marks of the sections"
            script.write_text('import Gumshoe from "./gumshoe-patched.js";\n' + kept, encoding="utf-8")
            if not any("furo.js: imports" in line for line in problems(out)):
                yield "planted fault not found: a plain script that imports"
            script.write_text(kept, encoding="utf-8")
            page.unlink()
            if not list(completeness(source, out)):
                yield "planted fault not found: a page that is not there"


def main():
    if len(sys.argv) != 2:
        print(__doc__)
        return 2
    if subprocess.run([SPHINX, "-c", "import sphinx, myst_parser, furo"], capture_output=True, check=False).returncode:
        print("skipped: no Sphinx with myst_parser and furo (scripts/install docs)")
        return 0
    root = pathlib.Path(sys.argv[1]).resolve()
    with tempfile.TemporaryDirectory(prefix="deburr_site_") as temporary:
        folder = pathlib.Path(temporary)
        done = make(root, folder / "site", root)
        if done.returncode or done.stderr.strip():
            print(done.stdout + done.stderr)
            return 1
        found = [*problems(folder / "site"), *completeness(root, folder / "site"), *faults_that_are_not_found(root, folder)]
    print("\n".join(found))
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
