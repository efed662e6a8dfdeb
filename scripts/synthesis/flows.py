# SPDX-License-Identifier: MIT
"""Maps a unit to a technology with yosys, within a time limit, and caches the result."""
import json
import os
import pathlib
import re
import resource
import shutil
import signal
import subprocess
import tempfile
import threading
import time

from .designs import Problem, sha

LIBERTY = pathlib.Path("/usr/share/qflow/tech/osu018/osu018_stdcells.lib")
TECHNOLOGIES = ("osu018", "xc7", "ecp5")
# Stand-ins for a row: it took too long, or it has not been mapped yet.
NOT_MAPPED, NOT_RUN = "not mapped", "not run"
TOOLS = ("yosys", "yosys-abc")
YARDSTICK = "24 x 24 multiply"
YARDSTICK_TEXT = """module yardstick(input [23:0] a, input [23:0] b, output [47:0] p);
  assign p = a * b;
endmodule
"""
# A buffer drives each input, and each output drives one XOR2X1 (fF).
CONSTRAINTS = "set_driving_cell BUFX4\nset_load 32 [all_outputs]\n"
# The default script of yosys for a library without its `dc2`, which turns the prefix adders of `techmap` into ripple
# adders: 62 bits take 1.94 ns instead of 7.28 with 598 gates instead of 501.
ABC = ("strash;&get,-n;&fraig,-x;&put;scorr;dretime;strash;&get,-n;&dch,-f;&nf;&put;"
       "buffer;upsize;dnsize;stime,-p")

KEEP = "select -set kept t:$mem_v2 a:deburr_memory=1 %i"
FLOWS = {
    "osu018": f"""synth -flatten -noabc -run coarse:fine
{KEEP}
opt -fast -full
memory_map t:$mem_v2 @kept %d
opt -undriven -fine
techmap
opt -fast
dfflibmap -liberty LIBERTY
opt_clean
write_json OUT.before
abc -liberty LIBERTY -constr CONSTRAINTS -script +{ABC}
opt_clean
tee -q -o OUT.stat stat -liberty LIBERTY
""",
    "xc7": """synth_xilinx -flatten -noiopad -noclkbuf
tee -q -o OUT.stat stat
""",
    "ecp5": """synth_ecp5 -abc9 -nowidelut
tee -q -o OUT.stat stat
""",
}
# Lookup tables per cell; a half block RAM counts as half.
LUTS = {"xc7": {"LUT1": 1, "LUT2": 1, "LUT3": 1, "LUT4": 1, "LUT5": 1, "LUT6": 1, "INV": 1, "SRL16E": 1, "SRLC32E": 1,
                "RAM32M": 4, "RAM64M": 4, "RAM32X1D": 2, "RAM64X1D": 2, "RAM128X1D": 4, "RAM32X1S": 1,
                "RAM64X1S": 1, "RAM128X1S": 2, "RAM256X1S": 4, "RAM32M16": 8, "RAM64M8": 8},
        "ecp5": {"LUT4": 1, "CCU2C": 2, "TRELLIS_DPR16X4": 6}}
FLIP_FLOPS = {"xc7": r"FD[RSCP]E.*|LD[CP]E", "ecp5": r"TRELLIS_FF", "osu018": r"DFF.*|LATCH"}
MULTIPLIERS = {"xc7": {"DSP48E1": 1}, "ecp5": {"MULT18X18D": 1, "MULT9X9D": 1}}
BLOCKS = {"xc7": {"RAMB18E1": 0.5, "RAMB36E1": 1}, "ecp5": {"DP16KD": 1, "PDPW16KD": 1}}
OTHERS = {"xc7": r"CARRY4|MUXF[78]", "ecp5": r"PFUMX|L6MUX21|GND|VCC"}


def said_by(*command):
    return subprocess.run(command, capture_output=True, text=True, check=False).stdout.strip()


def package_version(package):
    try:
        return said_by("dpkg-query", "-W", "-f", "${Version}", package)
    except OSError:
        return ""


def tool_versions():
    """Versions of all tools; a Problem names the package of a missing tool."""
    for tool in TOOLS:
        if shutil.which(tool) is None:
            raise Problem(f"{tool} is not installed: scripts/install synthesis (package yosys)")
    if not LIBERTY.exists():
        raise Problem(f"{LIBERTY} is not there: scripts/install synthesis (package qflow-tech-osu018)")
    return {"yosys": re.sub(r" \(.*", "", said_by("yosys", "-V")).removeprefix("Yosys "),
            "abc": package_version("berkeley-abc"), "osu018": package_version("qflow-tech-osu018")}


class Limit(Exception):
    """The processor time of a row was used up."""


class Yosys:
    """Runs yosys with limited processor time; running processes are ended with the program."""

    def __init__(self):
        self._running, self._lock, self._stopped = set(), threading.Lock(), False

    def stop(self):
        with self._lock:
            self._stopped = True
            for process in self._running:
                try:
                    os.killpg(process.pid, signal.SIGKILL)
                except ProcessLookupError:
                    pass

    def __call__(self, script, failed, seconds=None):
        """Its output. Raises Limit above this processor time in seconds, Problem if it failed."""
        def limited():
            if seconds is not None:
                whole = max(1, int(seconds + 0.999))
                resource.setrlimit(resource.RLIMIT_CPU, (whole, whole + 1))

        with tempfile.TemporaryDirectory(prefix="deburr_synthesis_") as folder:
            file, log = pathlib.Path(folder) / "script.ys", pathlib.Path(folder) / "log"
            file.write_text(script, encoding="utf-8")
            with open(log, "wb") as stream:
                with self._lock:
                    if self._stopped:
                        raise KeyboardInterrupt
                    process = subprocess.Popen(["yosys", "-s", str(file)], stdout=stream, stderr=subprocess.STDOUT,
                                               stdin=subprocess.DEVNULL, cwd=folder, preexec_fn=limited,
                                               start_new_session=True)
                    self._running.add(process)
                try:
                    _, status, used = os.wait4(process.pid, 0)
                    process.returncode = os.waitstatus_to_exitcode(status)
                finally:
                    with self._lock:
                        self._running.discard(process)
                    # An abc process that outlives its yosys.
                    try:
                        os.killpg(process.pid, signal.SIGKILL)
                    except ProcessLookupError:
                        pass
            if self._stopped:
                raise KeyboardInterrupt
            said = log.read_text(encoding="utf-8", errors="replace")
            # The kernel may end it shortly before its own count reaches the limit.
            if seconds is not None and (used.ru_utime + used.ru_stime >= seconds or
                                        process.returncode == -signal.SIGXCPU):
                raise Limit
            if process.returncode:
                errors = [line for line in said.splitlines() if "ERROR" in line] or said.splitlines()[-3:]
                raise Problem(f"{failed}: " + " ".join(errors))
            return said


def counted(text):
    """{cell: count} of the last design that `stat` printed."""
    part = text[text.rfind("Number of cells:"):]
    return {name: int(count) for name, count in re.findall(r"^ +([\w$]+) +(\d+)$", part, re.M)}


def memory_bits(before):
    """Bits of the memories that were kept."""
    def number(cell, name):
        value = cell["parameters"][name]
        return int(value, 2) if isinstance(value, str) else value
    return sum(number(cell, "SIZE") * number(cell, "WIDTH") for cell in before["cells"].values()
               if cell["type"] == "$mem_v2")


class Names:
    """Register names for the ends of a path, which the tools name by nets."""

    def __init__(self, module):
        self._bits, self._shown = {}, {}
        # Prefers a register's name that was not given inside a cell, and of those the longest: `high_y_1`, not `d_y`.
        for name, net in sorted(module["netnames"].items(),
                                key=lambda item: (item[1]["hide_name"], item[0].count("."), -len(item[0]))):
            for at, bit in enumerate(net["bits"]):
                self._bits[name, at] = bit
                if not net["hide_name"] and isinstance(bit, int):
                    self._shown.setdefault(bit, name)
        self._written = {}
        for cell in module["cells"].values():
            if "D" in cell["connections"] and "Q" in cell["connections"]:
                self._written.setdefault(cell["connections"]["D"][0], cell["connections"]["Q"][0])
            elif cell["type"] == "$mem_v2":
                for port in ("RD_ADDR", "WR_ADDR", "WR_DATA", "RD_EN", "WR_EN"):
                    for bit in cell["connections"][port]:
                        self._written.setdefault(bit, "memory")
        self._inputs = {bit: name for name, port in module["ports"].items() if port["direction"] == "input"
                        for bit in port["bits"]}
        self._outputs = {bit: name for name, port in module["ports"].items() if port["direction"] == "output"
                         for bit in port["bits"]}

    def of(self, text, end):
        """`text` as abc prints it: NAME or NAME [BIT]. At the end of a path it names the register that is written."""
        found = re.fullmatch(r"\\?(\S+?)(?: \[(\d+)\])?", text.strip())
        bit = self._bits.get((found[1], int(found[2] or 0))) if found else None
        if end and bit in self._written and bit not in self._outputs:
            bit = self._written[bit]
            if bit == "memory":
                return "a memory"
        ports = self._outputs if end else self._inputs
        return ports.get(bit) or self._shown.get(bit)


def measured(technology, said, out):
    """The figures of a row."""
    stat = pathlib.Path(f"{out}.stat").read_text(encoding="utf-8")
    cells = counted(stat)
    flip_flops = sum(count for name, count in cells.items() if re.fullmatch(FLIP_FLOPS[technology], name))
    if technology != "osu018":
        known = {**LUTS[technology], **MULTIPLIERS[technology], **BLOCKS[technology]}
        strange = [name for name in cells if name not in known and not re.fullmatch(
            FLIP_FLOPS[technology] + "|" + OTHERS[technology], name)]
        if strange:
            raise Problem(f"{technology} has cells of unknown kind: {', '.join(strange)} (scripts/synthesis/flows.py)")
        return {"luts": sum(count * LUTS[technology].get(name, 0) for name, count in cells.items()),
                "flip_flops": flip_flops,
                "multipliers": sum(count * MULTIPLIERS[technology].get(name, 0) for name, count in cells.items()),
                "block_rams": sum(count * BLOCKS[technology].get(name, 0) for name, count in cells.items())}
    module = next(iter(json.loads(pathlib.Path(f"{out}.before").read_text(encoding="utf-8"))["modules"].values()))
    area = re.search(r"Chip area for (?:top )?module .*: ([\d.]+)", stat)
    delay = re.findall(r"Delay = *([\d.]+) ps", said)
    path = re.findall(r"Start-point = pi\d+ \((.*)\)\.\s+End-point = po\d+ \((.*)\)\.", said)
    names = Names(module) if path else None
    return {"area": float(area[1]) if area else 0.0, "flip_flops": flip_flops, "memory_bits": memory_bits(module),
            "ns": round(float(delay[-1]) / 1000, 3) if delay and path else None,
            "from": names.of(path[-1][0], False) if path else None, "to": names.of(path[-1][1], True) if path else None}


class Mapper:
    """Rows from the cache, or mapped again; a row over the time limit is `not mapped`."""

    def __init__(self, yosys, folder, versions, seconds):
        self._yosys, self._folder, self._versions, self._seconds = yosys, folder, versions, seconds
        folder.mkdir(parents=True, exist_ok=True)
        self._constraints = folder / "constraints"
        self._constraints.write_text(CONSTRAINTS, encoding="utf-8")

    def _file(self, key, technology):
        return self._folder / (sha(key, technology, FLOWS[technology], CONSTRAINTS, json.dumps(self._versions))[:32] +
                               ".json")

    def known(self, key, technology):
        """(True, row) if the row is in the cache."""
        try:
            kept = json.loads(self._file(key, technology).read_text(encoding="utf-8"))
        except (OSError, ValueError):
            return False, None
        if "over" in kept and kept["over"] < self._seconds:
            return False, None
        return True, kept.get("row", NOT_MAPPED)

    def map(self, key, technology, design, name, what):
        there, row = self.known(key, technology)
        if there:
            return row
        with tempfile.TemporaryDirectory(prefix="deburr_synthesis_") as folder:
            out = pathlib.Path(folder) / "out"
            read = f"read_ilang {design}" if pathlib.Path(design).suffix == ".il" else f"read_verilog -sv {design}"
            script = f"{read}\nhierarchy -top {name}\n" + (
                FLOWS[technology].replace("LIBERTY", str(LIBERTY)).replace("CONSTRAINTS", str(self._constraints))
                .replace("OUT", str(out)))
            try:
                kept = {"row": measured(technology, self._yosys(script, f"{what}, {technology}", self._seconds), out)}
            except Limit:
                kept = {"over": self._seconds}
        part = self._file(key, technology).with_suffix(f".{os.getpid()}.{threading.get_ident()}")
        part.write_text(json.dumps(kept), encoding="utf-8")
        part.rename(self._file(key, technology))
        return kept.get("row", NOT_MAPPED)


def yardstick(mapper, folder):
    """Delay in ns of the multiplier to which delays are relative."""
    file = folder / "yardstick.sv"
    file.write_text(YARDSTICK_TEXT, encoding="utf-8")
    row = mapper.map(sha(YARDSTICK_TEXT), "osu018", file, "yardstick", YARDSTICK)
    if row == NOT_MAPPED:
        raise Problem(f"the yardstick, a {YARDSTICK}, exceeds the time limit: increase --seconds")
    return row["ns"]


def unit_area():
    """Area of the NAND gate to which areas are relative."""
    text = LIBERTY.read_text(encoding="utf-8")
    return float(re.search(r"cell \(NAND2X1\) \{\s*area : ([\d.]+);", text)[1])


def now():
    return time.strftime("%Y-%m-%d", time.gmtime())
