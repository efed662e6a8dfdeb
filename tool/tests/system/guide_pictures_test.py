#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Pictures of how-tos equal, pixel by pixel, the output of the command on the page: parts of its pictures side by
side, enlarged.

usage: guide_pictures_test.py DEBURR ROOT [--write]     --write updates them"""
import dataclasses
import pathlib
import re
import shlex
import struct
import subprocess
import sys
import tempfile
import zlib

GAP = 6  # white pixels between pictures


@dataclasses.dataclass
class Picture:
    page: str  # page of docs/howto/; its first command with this prefix and --out makes the pictures
    command: str
    files: tuple
    part: tuple  # left, top, width, height
    scale: int


PICTURES = {
    "before_after.png": Picture("which_engine", "deburr run ", ("before", "after", "reference"), (70, 150, 44, 36), 6),
}


def read_png(path):
    """Rows of (R, G, B) of a picture of 8 bits, RGB."""
    data, at, packed = path.read_bytes(), 8, b""
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at:at + 8])
        body, at = data[at + 8:at + 8 + size], at + 12 + size
        if kind == b"IHDR":
            width, height, *form = struct.unpack(">IIBBBBB", body)
            if form != [8, 2, 0, 0, 0]:
                sys.exit(f"{path}: no picture of 8 bits, RGB")
        elif kind == b"IDAT":
            packed += body
    raw, rows, above = zlib.decompress(packed), [], bytes(3 * width)
    for y in range(height):
        filtering, *line = raw[y * (3 * width + 1):(y + 1) * (3 * width + 1)]
        for i, byte in enumerate(line):
            left, upper = (line[i - 3], above[i - 3]) if i >= 3 else (0, 0)
            near = min((left, above[i], upper), key=lambda value, to=left + above[i] - upper: abs(to - value))
            line[i] = (byte + (0, left, above[i], (left + above[i]) // 2, near)[filtering]) & 255
        above = bytes(line)
        rows.append([tuple(line[i:i + 3]) for i in range(0, 3 * width, 3)])
    return rows


def write_png(path, rows):
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    packed = zlib.compress(b"".join(b"\0" + bytes(value for pixel in row for value in pixel) for row in rows), 9)
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", len(rows[0]), len(rows), 8, 2, 0, 0, 0)) +
                     chunk(b"IDAT", packed) + chunk(b"IEND", b""))


def command_of(page, beginning):
    for block in re.findall(r"^```\n(.*?)^```", page, re.S | re.M):
        for line in block.replace("\\\n", " ").splitlines():
            if line.startswith(beginning) and " --out " in line:
                return shlex.split(line, comments=True)[1:]
    sys.exit(f"no command of the page begins with {beginning}")


def drawn(deburr, picture, page):
    left, top, width, height = picture.part
    rows = [[] for _ in range(height * picture.scale)]
    with tempfile.TemporaryDirectory() as folder:
        words = command_of(page, picture.command)
        said = subprocess.run([deburr, *words], cwd=folder, capture_output=True, text=True, check=False)
        for name in picture.files:
            file = pathlib.Path(folder, words[words.index("--out") + 1], f"{name}.png")
            if not file.is_file():
                sys.exit(f"no {name}.png:\n{said.stdout}{said.stderr}")
            part = [row[left:left + width] for row in read_png(file)[top:top + height]]
            for y, row in enumerate(rows):
                row += [(255, 255, 255)] * (GAP if row else 0)
                row += [pixel for pixel in part[y // picture.scale] for _ in range(picture.scale)]
    return rows


def main():
    if len(sys.argv) < 3:
        print(__doc__)
        return 2
    deburr, root = (pathlib.Path(word).resolve() for word in sys.argv[1:3])
    wrong = 0
    for name, picture in PICTURES.items():
        page = (root / f"docs/howto/{picture.page}.md").read_text(encoding="utf-8")
        now, file = drawn(deburr, picture, page), root / "docs/images" / name
        if "--write" in sys.argv:
            write_png(file, now)
            continue
        kept = read_png(file)
        differ = len(kept) != len(now) or sum(a != b for old, new in zip(kept, now) for a, b in zip(old, new))
        # The comparison finds a changed pixel.
        injected = [list(row) for row in now]
        injected[len(now) // 2][3] = (1, 2, 3)
        if differ or injected == kept:
            print(f"docs/images/{name}: {differ} pixels are others than after the command of howto/{picture.page}.md; "
                  f"if that is meant: {' '.join(sys.argv)} --write")
            wrong += 1
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
