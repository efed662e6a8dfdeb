# SPDX-License-Identifier: MIT
"""Gates and ns of primitives by width, for estimates of units (tool/cost/osu018.json).

A kind has up to two sizes, a and b. A fit is a sum of terms, each a product of 1, a, b, log2(a), log2(b), min(a,b)."""
import concurrent.futures
import json
import math
import random
import statistics

from . import flows
from .designs import bare, sha

FILE, MEMORIES = "tool/cost/osu018.json", "tool/cost/sram.json"
ONE, TWO, CLOCK = "input [A-1:0] p, ", "input [A-1:0] p, q, ", "input clk, rst_n, en, "
LINK = CLOCK + "input push, pop, input [A-1:0] p, output can_push, can_pop, output [A-1:0] y"
CELL = ("NAME #(.BITS(A), .ENTRIES(B)) channel (.clk, .rst_n, .push, .push_data(p), .can_push, .pop, .front(y), "
        ".can_pop);")
WIDTHS = [(a, 0) for a in (4, 8, 16, 24, 32, 48, 64)]
FEW = [(a, 0) for a in (2, 4, 8, 16, 32)]
REGISTERS = [(a, 0) for a in (1, 8, 64, 512)]
SELECTS = [(8, 2), (64, 2), (512, 2), (12, 4), (128, 4), (12, 8), (32, 8), (32, 16), (8, 32), (32, 32)]
FACTORS = [(8, 8), (16, 8), (8, 16), (32, 8), (8, 32), (16, 16), (48, 16), (16, 48), (24, 24), (32, 32)]
STORED = [(1, 64), (8, 16), (32, 16), (8, 64), (32, 64), (16, 128)]
LINEAR, TREE, CARRY, BOTH = "1 + a", "1 + log2(a)", "1 + a + a*log2(a)", "1 + log2(a) + log2(b)"


def loop(body):
    return f"integer i; always @* begin y = 0; for (i = 0; i < A; i = i + 1) {body} end"


def cases(words):
    return f"always @* case (s) {' '.join(f'{i}: y = {word};' for i, word in enumerate(words))} default: y = 0; endcase"


def mux(a, b):
    return "input [A*B-1:0] p, input [L-1:0] s, output reg [A-1:0] y", cases(f"p[{i}*A +: A]" for i in range(b))


def crossbar(a, b):
    """As many outputs as inputs; a row is one output."""
    one = mux(a, b)[1]
    return "input [A*B-1:0] p, input [B*L-1:0] s, output reg [A*B-1:0] y", " ".join(
        one.replace("(s)", f"(s[{i}*L +: L])").replace("y =", f"y[{i}*A +: A] =") for i in range(b))


def rom(a, b):
    words = random.Random(a * b)
    return "input [L-1:0] s, output reg [A-1:0] y", cases(f"{a}'d{words.getrandbits(a)}" for _ in range(b))


def square(a, _):
    """Each product of two different bits once, so half as many rows as a multiply has."""
    columns = [[f"p[{i // 2}]"] if i % 2 == 0 else [] for i in range(2 * a)]
    for low in range(a):
        for high in range(low + 1, a):
            columns[low + high + 1].append(f"p[{low}] & p[{high}]")
    rows = [", ".join((column[row:] or ["1'b0"])[0] for column in reversed(columns)) for row in range(a // 2 + 1)]
    return ONE + "output [2*A-1:0] y", "assign y = " + " + ".join("{" + row + "}" for row in rows) + ";"


def memory(writes, reads):
    write = " ".join(f"if (we[{i}]) m[wa[{i}*L +: L]] <= wd[{i}*A +: A];" for i in range(writes))
    read = " ".join(f"assign y[{i}*A +: A] = m[ra[{i}*L +: L]];" for i in range(reads))
    return (CLOCK + f"input [{writes}-1:0] we, input [{writes}*L-1:0] wa, input [{writes}*A-1:0] wd, "
            f"input [{reads}*L-1:0] ra, output [{reads}*A-1:0] y",
            f"reg [A-1:0] m[0:B-1]; always @(posedge clk) begin {write} end {read}")


def register(condition):
    return CLOCK + ONE + "output reg [A-1:0] y", f"always @(posedge clk) {condition} y <= p;"


# Kind: rows (a, b), terms of gates, terms of ns, and (ports, body) or {(ports, body): how often} by a and b.
KINDS = {
    "logic": (FEW, "a", "1", (TWO + "output [A-1:0] y", "assign y = ~(p & q);")),
    "add": (WIDTHS, CARRY, TREE, (TWO + "output [A:0] y", "assign y = p + q;")),
    "subtract": (WIDTHS, CARRY, TREE, (TWO + "output [A:0] y", "assign y = {1'b0, p} - {1'b0, q};")),
    "increment": (WIDTHS, CARRY, TREE, (ONE + "input i, output [A-1:0] y", "assign y = p + i;")),
    "compare": (WIDTHS, LINEAR + " + log2(a)", TREE + " + a", (TWO + "output y", "assign y = p < q;")),
    "equal": (WIDTHS, LINEAR, TREE, (TWO + "output y", "assign y = p == q;")),
    "magnitude": (WIDTHS, CARRY, TREE + " + a", (ONE + "output [A-1:0] y", "assign y = p[A-1] ? -p : p;")),
    "maximum": (WIDTHS, LINEAR, TREE, (TWO + "output [A-1:0] y", "assign y = p < q ? q : p;")),
    "mux": (SELECTS, "a + a*b + a*log2(b)", BOTH, mux),
    "crossbar": ([(8, 4), (32, 4), (8, 8), (32, 8), (16, 16)], "a + a*b + b", BOTH,
                 lambda a, b: {crossbar(a, b): 1 / b}),
    "multiply": (FACTORS, "a*b + a*b*min(a,b)", BOTH + " + min(a,b)",
                 (ONE + "input [B-1:0] q, output [A+B-1:0] y", "assign y = p * q;")),
    "square": ([(a, 0) for a in (8, 12, 16, 24, 31)], "a + a*a", TREE, square),
    "multiply_constant": ([(12, 1), (32, 1), (12, 2), (32, 2), (24, 3), (24, 5)], "a + b + a*b", BOTH, (
        ONE + "output [A+2*B:0] y", "localparam [2*B:0] K = {B+1{2'b01}}; assign y = p * K;")),
    "shift": ([(8, 8), (16, 16), (32, 8), (32, 32), (64, 16), (64, 64)], "a + a*log2(b) + b", BOTH,
              (ONE + "input [L-1:0] s, output [A-1:0] y", "assign y = p >> s;")),
    "leading_one": (WIDTHS, LINEAR + " + log2(a)", LINEAR, (
        ONE + "output reg [$clog2(A)-1:0] y", loop("if (p[i]) y = i;"))),
    "root_stage": ([(a, 0) for a in (10, 16, 24, 34, 48)], LINEAR, TREE, (
        ONE + "input [A-3:0] q, input [3:0] d, output [1:0] r, output [A-1:0] y",
        "wire [A+1:0] s = {p, d[3:2]}, t = {q, 2'b01}, u = r[1] ? s - t : s, v = {u[A-1:0], d[1:0]}, "
        "w = {q, r[1], 2'b01}, x = r[0] ? v - w : v; assign r[1] = s >= t, r[0] = v >= w, y = x[A-1:0];")),
    "count_ones": (WIDTHS, LINEAR, TREE, (ONE + "output reg [$clog2(A):0] y", loop("y = y + p[i];"))),
    "priority": (FEW, LINEAR, LINEAR, (ONE + "output [A-1:0] y", "assign y = p & ~(p - 1'b1);")),
    "rom_read": ([(8, 16), (16, 16), (9, 64), (16, 64), (13, 65), (12, 256), (8, 1024)], "a + a*b", "1 + log2(b)", rom),
    "register": (REGISTERS, "a", "1", register("")),
    "register_enable": (REGISTERS, LINEAR, TREE, register("if (en)")),
    "register_reset": (REGISTERS, LINEAR, TREE, register("if (!rst_n) y <= 0; else if (en)")),
    "memory": (STORED, "a*b + b", BOTH, lambda a, b: {memory(1, 1): 2, memory(1, 2): -1}),
    "memory_write": (STORED, "a*b + b", BOTH, lambda a, b: {memory(2, 1): 1, memory(1, 1): -1}),
    "memory_read": (STORED, "a*b + b", BOTH, lambda a, b: {memory(1, 2): 1, memory(1, 1): -1}),
    "link": ([(8, 2), (32, 2), (128, 2), (360, 2), (32, 4), (32, 8)], "1 + a + a*b", BOTH,
             (LINK, CELL.replace("NAME", "link"))),
    "fifo": ([(8, 32), (32, 32), (128, 32), (32, 128), (185, 107), (32, 1024)], "1 + a + log2(b)", "1 + log2(b)",
             (LINK, CELL.replace("NAME", "fifo"))),
}


def listed(root):
    """{kind: {(a, b): {SystemVerilog: how often}}}, and a hash of them and of the mapping flow."""
    fabric = {name: bare((root / f"hdl/fabric/{name}.sv").read_text(encoding="utf-8")).replace(
        "logic [BITS-1:0] memory[", "(* deburr_memory *) logic [BITS-1:0] memory[") + "\n" for name in ("link", "fifo")}

    def texts(kind, a, b):
        made = KINDS[kind][3]
        made = made(a, b) if callable(made) else made
        sizes = f"A = {a}, B = {b}, L = {max(1, (b - 1).bit_length())}"
        return {f"{fabric.get(kind, '')}module primitive #(parameter {sizes}) ({ports});\n{body}\nendmodule\n": count
                for (ports, body), count in (made if isinstance(made, dict) else {made: 1}).items()}

    rows = {kind: {(a, b): texts(kind, a, b) for a, b in KINDS[kind][0]} for kind in KINDS}
    return rows, sha(flows.FLOWS["osu018"], flows.CONSTRAINTS, *(
        f"{count} {text}" for by in rows.values() for of in by.values() for text, count in of.items()))


def fit(form, rows):
    """Coefficients with the least sum of squared relative errors, and the median and the largest relative error."""
    known = {"min(a,b)": min, "log2(a)": lambda a, b: math.log2(a), "log2(b)": lambda a, b: math.log2(b),
             "a": lambda a, b: a, "b": lambda a, b: b, "1": lambda a, b: 1}
    terms = [term.split("*") for term in form.split(" + ")]
    rows = [([math.prod(known[name](a, b) for name in term) for term in terms], value) for a, b, value in rows]
    if not any(value for _, value in rows):
        return {"form": form, "coefficients": [0] * len(terms)}, {"median": 0, "largest": 0}
    # Normal equations, solved by elimination.
    lines = [[sum(x[i] * x[j] / y ** 2 for x, y in rows) for j in range(len(terms))] + [sum(x[i] / y for x, y in rows)]
             for i in range(len(terms))]
    for i, line in enumerate(lines):
        line[:] = [value / line[i] for value in line]
        for other in lines:
            if other is not line:
                other[:] = [value - other[i] * own for value, own in zip(other, line)]
    found = [float(f"{line[-1]:.5g}") for line in lines]
    errors = [abs(sum(c * x for c, x in zip(found, row)) / value - 1) for row, value in rows]
    return ({"form": form, "coefficients": found},
            {"median": round(statistics.median(errors), 3), "largest": round(max(errors), 3)})


def fitted(kind, rows):
    gates, error = fit(KINDS[kind][1], [(a, b, gates) for a, b, gates, _ in rows])
    ns, ns_error = fit(KINDS[kind][2], [(a, b, ns) for a, b, _, ns in rows])
    return {"gates": gates, "ns": ns, "error": error, "ns_error": ns_error, "rows": rows}


def map_all(root, work, mapper, jobs):
    """What osu018.json contains."""
    rows, made_of = listed(root)

    def mapped(text):
        design = work / f"{sha(text)[:16]}.sv"
        design.write_text(text, encoding="utf-8")
        return mapper.map(sha(text), "osu018", design, "primitive", "a primitive")

    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        every = sorted({text for by in rows.values() for of in by.values() for text in of})
        found = dict(zip(every, pool.map(mapped, every)))
    gate = flows.unit_area()
    kinds = {kind: fitted(kind, [[a, b, round(sum(count * found[text]["area"] for text, count in of.items()) / gate, 1),
                                  found[next(iter(of))]["ns"] or 0] for (a, b), of in by.items()])
             for kind, by in rows.items()}
    return {"technology": "osu018", "made_by": "scripts/synthesise --primitives", "tools": flows.tool_versions(),
            "flow": made_of, "yardstick_ns": flows.yardstick(mapper, work), "kinds": kinds}


def text_of(cost):
    """The JSON, a kind per line."""
    head = [f" {json.dumps(name)}: {json.dumps(value)}," for name, value in cost.items() if name != "kinds"]
    return "{\n" + "\n".join(head) + '\n "kinds": {\n' + ",\n".join(
        f'  "{kind}": {json.dumps(one)}' for kind, one in cost["kinds"].items()) + "\n }\n}\n"


def check(root):
    """The differences of osu018.json from the flow and the list of primitives, and of fits from their rows."""
    text = (root / FILE).read_text(encoding="utf-8")
    cost = json.loads(text)
    if cost["flow"] != listed(root)[1]:
        yield f"{FILE}: the mapping flow or the list of primitives has changed (scripts/synthesise --primitives)"
    elif text != text_of({**cost, "kinds": {kind: fitted(kind, one["rows"]) for kind, one in cost["kinds"].items()}}):
        yield f"{FILE}: its fits are not those of its rows (scripts/synthesise --primitives)"
    for name, one in json.loads((root / MEMORIES).read_text(encoding="utf-8"))["technologies"].items():
        for at, (figure, error) in enumerate((("um2", "error"), ("ns", "ns_error")), 2):
            made = fit(one[figure]["form"], [(*row[:2], row[at]) for row in one["rows"]]) if figure in one else None
            if made and made != (one[figure], one[error]):
                yield f"{MEMORIES}: {name}: {figure} should be {made}"
