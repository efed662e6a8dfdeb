#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Reads back the output of `deburr params --systemrdl` with a parser for the part of SystemRDL 2.0 that it uses. The
output obeys the standard's rules for properties, bits and addresses. Some fields are checked against the contract,
fields loaded by parameters against the defaults, and all against the C header (whose values c_header_test.py
checks against the contract). tb/harness/register_suite.h compares it with the hardware. The UVM register models of
`deburr params --uvm` have the same registers and fields.

usage: systemrdl_test.py DEBURR"""
import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

TOKEN = re.compile(r'\s+|//[^\n]*|("(?:\\.|[^"\\])*"|\\?\w+(?:\'[hd]\w+)?|@|\+=|[{}\[\];:=])')
# The resulting properties of a field.
ACCESS = {("rw", "r"): "RW", ("r", "w"): "RO", ("r", "na"): "RO", ("rw", "rw", "we"): "RWH", ("w", "r"): "WO",
          ("w", "r", "singlepulse"): "W1P", ("rw", "r", "hwset", "woclr"): "W1C"}
# By hand, from the contract's pages: access, properties and reset value of fields.
CONTRACT = {
    "deburr_geometric.STATUS.idle": ({"sw": "r", "hw": "w"}, 1),
    "deburr_geometric.STATUS.frame_done": ({"sw": "rw", "hw": "r", "onwrite": "woclr", "hwset": "true"}, 0),
    "deburr_geometric.CONTROL.enable": ({"sw": "rw", "hw": "r"}, 1),
    "deburr_geometric.CONTROL.start": ({"sw": "w", "hw": "r", "singlepulse": "true"}, 0),
    "deburr_geometric.SIZE.width": ({"sw": "rw", "hw": "r", "swwe": "true"}, 0),
    "deburr_geometric.EDGES.value": ({"sw": "r", "hw": "w"}, 0),
    "deburr_geometric.ID.value": ({"sw": "r", "hw": "na"}, 0xDEB00005),
    "deburr_morphological.STATUS.framing": ({"sw": "rw", "hw": "r", "onwrite": "woclr", "hwset": "true"}, 0),
    "deburr_morphological.CONTROL.clear_counters": ({"sw": "w", "hw": "r", "singlepulse": "true"}, 0),
    "deburr_morphological.WEIGHTS_ADDRESS.entry": ({"sw": "rw", "hw": "rw", "we": "true", "swwe": "true"}, 0),
    "deburr_morphological.WEIGHTS_DATA.weight": ({"sw": "rw", "hw": "rw", "we": "true", "swwe": "true"}, None),
    "deburr_morphological.WEIGHTS_SUM.value": ({"sw": "r", "hw": "w"}, None),
    "deburr_morphological.THRESHOLD_ON.value": ({"sw": "rw", "hw": "r", "swwe": "true"}, 167025),
    "deburr_morphological.THRESHOLD_OFF.value": ({"sw": "rw", "hw": "r", "swwe": "true"}, 835635),
    "deburr_texture.STATUS.invalid_texture": ({"sw": "rw", "hw": "r", "onwrite": "woclr", "hwset": "true"}, 0),
    "deburr_texture.CONTROL.invalidate": ({"sw": "w", "hw": "r", "singlepulse": "true"}, 0),
    "deburr_texture.CONFIG.spread": ({"sw": "r", "hw": "na"}, 64),
    "deburr_texture.TEXTURE0_MODE.levels": ({"sw": "rw", "hw": "r"}, 0),
}


def tokens(text):
    at, found = 0, []
    while at < len(text):
        match = TOKEN.match(text, at)
        if not match:
            raise ValueError(f"not SystemRDL: {text[at:at + 40]!r}")
        if match[1]:
            found.append(match[1])
        at = match.end()
    return found


def number(word):
    size, base, digits = re.fullmatch(r"(?:(\d+)'([hd]))?(\w+)", word).groups()
    value = int(digits, {"h": 16, "d": 10, None: 0}[base])
    if size and value >> int(size):
        raise ValueError(f"{word} does not fit")
    return value


class Reader:
    """address map -> register -> offset, access, reset value, fields: name -> high, low, codes."""

    def __init__(self, text):
        self.words = tokens(text)
        self.at = 0

    def take(self, *wanted):
        word = self.words[self.at]
        self.at += 1
        if wanted and word not in wanted:
            raise ValueError(f"{word} instead of {wanted}")
        return word

    def name(self):
        return self.take().removeprefix("\\")

    def property(self):
        if self.words[self.at] == "default":
            self.take()
        key, value = self.take(), "true"  # the standard's value of a property given without one
        if self.take("=", ";") == "=":
            value = self.name()
            self.take(";")
        return key, value

    def file(self):
        maps = {}
        while self.at < len(self.words):
            self.take("addrmap")
            name = self.name()
            maps[name] = self.registers()
            self.take(";")
        return maps

    def registers(self):
        """The body of a map or of a repeated group, whose registers get names with the number 0."""
        found = {}
        self.take("{")
        while self.words[self.at] != "}":
            if self.words[self.at] == "reg":
                self.take()
                register = self.register()
                name = self.name()
                self.take("@")
                found[name] = register | {"offset": number(self.take())}
                self.take(";")
            elif self.words[self.at] == "regfile":
                self.take()
                inner = self.registers()
                name = self.name()
                self.take("[")
                count = number(self.take())
                self.take("]")
                self.take("@")
                base = number(self.take())
                self.take("+=")
                found["repeated"] = {"count": count, "base": base, "stride": number(self.take())}
                self.take(";")
                found |= {f"{name}0_{key}": value | {"offset": base + value["offset"]} for key, value in inner.items()}
            else:
                self.property()
        self.take("}")
        return found

    def register(self):
        register = {"reset": 0, "fields": {}, "access": []}
        codes = {}
        self.take("{")
        while self.words[self.at] != "}":
            kind = self.words[self.at]
            if kind == "enum":
                self.take()
                name = self.name()
                codes[name] = self.enumeration()
            elif kind == "field":
                self.take()
                self.field(register, codes)
            else:
                self.property()
        self.take("}")
        return register

    def enumeration(self):
        values = {}
        self.take("{")
        while self.words[self.at] != "}":
            name = self.name()
            self.take("=")
            values[name] = number(self.take())
            self.take(";")
        self.take("}")
        self.take(";")
        return values

    def field(self, register, codes):
        self.take("{")
        properties = []
        while self.words[self.at] != "}":
            properties.append(self.property())
        self.take("}")
        name = self.name()
        self.take("[")
        high = number(self.take())
        self.take(":")
        low = number(self.take())
        self.take("]")
        reset = None
        if self.take("=", ";") == "=":
            reset = number(self.take())
            self.take(";")
        register["reset"] |= (reset or 0) << low
        given = dict(properties)
        if len(given) < len(properties) or name in register["fields"]:
            raise ValueError(f"{name} has something twice")
        named = given.get("encode")
        effects = sorted(value if key == "onwrite" else key
                         for key, value in properties if key in ("singlepulse", "onwrite", "hwset", "we"))
        access = ACCESS[given["sw"], given["hw"], *effects]
        if access not in register["access"]:
            register["access"].append(access)
        register["fields"][name] = {
            "mask": (2 << high) - (1 << low), "shift": low, "width": high - low + 1, "reset": reset,
            "codes": codes[named] if named else {},
            "properties": {key: value for key, value in properties if key not in ("desc", "name", "encode")}}


def broken_rules(maps):
    """Rules of the standard, SystemRDL 2.0 (its sections in brackets)."""
    for register, info in ((f"{prefix}.{name}", info) for prefix, registers in maps.items()
                           for name, info in registers.items() if name != "repeated"):
        taken = 0
        if info["offset"] % 4:
            yield f"{register}: not at a multiple of its width (10.1)"
        if not info["fields"]:
            yield f"{register}: without a field (10.1)"
        for name, field in info["fields"].items():
            sw, hw = field["properties"]["sw"], field["properties"]["hw"]
            has = field["properties"]
            full = f"{register}.{name}"
            if taken & field["mask"]:
                yield f"{full}: shares bits (10.1)"
            taken |= field["mask"]
            if field["mask"] >> 32:
                yield f"{full}: beyond the register (10.1)"
            if sw not in ("r", "w", "rw") or hw not in ("r", "w", "rw", "na") or (sw == "w" and hw in ("w", "na")):
                yield f"{full}: no such field as sw = {sw}, hw = {hw} (9.4)"
            if "onwrite" in has and "w" not in sw:
                yield f"{full}: onwrite, and software does not write it (9.6)"
            if "swwe" in has and "w" not in sw:
                yield f"{full}: swwe, and software does not write it (9.6)"
            bit = field["width"] == 1 and field["reset"] == 0 and "w" in sw and "onwrite" not in has
            if "singlepulse" in has and not bit:
                yield f"{full}: singlepulse wants one bit that is reset to 0 and that software writes (9.6)"
            if "we" in has and "w" not in hw:
                yield f"{full}: we, and hardware does not write it"
            if hw == "na" and field["reset"] is None:
                yield f"{full}: a constant without a value (9.4)"
            if any(value >> field["width"] for value in field["codes"].values()):
                yield f"{full}: a code that does not fit (9.10)"
            if len(set(field["codes"].values())) < len(field["codes"]):
                yield f"{full}: a code twice (9.10)"
    for prefix, registers in maps.items():
        offsets = [info["offset"] for name, info in registers.items() if name != "repeated"]
        if len(set(offsets)) < len(offsets):
            yield f"{prefix}: two registers in one place (10.1)"
        group = registers.get("repeated")
        if group and max(offsets) + 4 - group["base"] > group["stride"]:
            yield f"{prefix}: repeated registers overlap"


def broken_contract(maps):
    for full, (properties, reset) in CONTRACT.items():
        prefix, register, name = full.split(".")
        field = maps.get(prefix, {}).get(register, {}).get("fields", {}).get(name, {"properties": None, "reset": None})
        if (field["properties"], field["reset"]) != (properties, reset):
            yield f"{full}: {field['properties']}, reset {field['reset']}, but the contract says {properties}, {reset}"


def broken_resets(maps, defaults):
    """Fields that parameters load: their defaults, as `deburr params --json` lists them."""
    tried = 0
    for prefix, registers in maps.items():
        for register in ("CONFIG", "SMAA", "THRESHOLD", "ALPHA", "FLOOR", "DEPTH_THRESHOLD"):
            for name, field in registers.get(register, {"fields": {}})["fields"].items():
                stem = register.lower() if name == "value" else name
                keys = [(prefix, stem), (prefix, f"edges_{stem}")]
                default = next((defaults[key] for key in keys if key in defaults), None)
                if default is None:
                    continue  # made of several parameters: area_table, area_learned
                tried += 1
                if field["reset"] != field["codes"].get(default, default):
                    yield f"{prefix}.{register}.{name}: reset {field['reset']}, the parameter's default is {default}"
    if tried < 40:
        yield f"only {tried} fields hold a parameter"


def macros(maps):
    """The entries that the C header defines, and the access in its comments."""
    values, accesses = {}, {}
    for prefix, registers in maps.items():
        prefix = prefix.upper()
        for name, register in registers.items():
            if name == "repeated":
                values |= {f"{prefix}_COUNT": register["count"], f"{prefix}_STRIDE": register["stride"]}
                continue
            full = f"{prefix}_{name}"
            values[full] = register["offset"]
            accesses[full] = ", ".join(register["access"])
            if register["reset"]:
                values[f"{full}_RESET"] = register["reset"]
            for field, bits in register["fields"].items():
                if field == "value" and bits["mask"] == 0xFFFFFFFF:
                    continue  # a register with one number, which has no field in the header
                stem = f"{full}_{field.upper()}"
                values |= {f"{stem}_MASK": bits["mask"], f"{stem}_SHIFT": bits["shift"]}
                values |= {f"{stem}_{code.upper()}": value for code, value in bits["codes"].items()}
    return values, accesses


def header_macros(header):
    values = {name: int(value, 0) for name, value in re.findall(r"^#define (\w+) (\w+)u", header, re.M)}
    accesses = {name: access for access, name in re.findall(r"^/\* ([RWOHP1C, ]+): .*\n#define (\w+) ", header, re.M)}
    return values, accesses


# UVM's access and "volatile" of a field.
UVM_ACCESS = {"RW": ("RW", 0), "RWH": ("RW", 1), "WO": ("WO", 0), "W1P": ("WO", 1), "W1C": ("W1C", 1)}


def uvm_model(text):
    """block -> register -> offset, distance, number, fields: name -> access, volatile, width, lowest bit, reset, codes."""
    classes = {name: body for name, body in re.findall(r"^class (\w+) extends uvm_reg;\n(.*?)^endclass$", text, re.M | re.S)}
    blocks = {}
    for block, body in re.findall(r"^class (\w+)_block extends uvm_reg_block;\n(.*?)^endclass$", text, re.M | re.S):
        blocks[block] = {}
        for kind, name, count in re.findall(r"^  rand (\w+) (\w+)(?:\[(\d+)\])?;$", body, re.M):
            at, stride = re.search(rf"default_map\.add_reg\({name}(?:\[i\])?, 'h(\w+)(?: \+ i \* 'h(\w+))?,", body).groups()
            members = re.findall(r"^  rand uvm_reg_field (\w+);$", classes[kind], re.M)
            codes = {code: int(value) for code, value in re.findall(r"^  localparam (\w+) = (\d+);$", classes[kind], re.M)}
            fields = {}
            for field in members:
                size, low, access, volatile, bits, reset, has_reset = re.search(
                    rf"^    {field}\.configure\(this, (\d+), (\d+), \"(\w+)\", ([01]), (\d+)'h(\w+), ([01]), [01], 0\);$",
                    classes[kind], re.M).groups()
                assert size == bits, field
                fields[field] = (access, int(volatile), int(size), int(low), int(reset, 16) if has_reset == "1" else None,
                                 {code: value for code, value in codes.items()
                                  if field == max((one for one in members if code.startswith(one.upper())), key=len)})
            blocks[block][name] = (int(at, 16), int(stride or "0", 16), int(count or 1), fields)
    return blocks


def as_uvm(maps):
    """The same of SystemRDL."""
    blocks = {}
    for prefix, registers in maps.items():
        group = registers.get("repeated")
        blocks[prefix] = {}
        for name, register in registers.items():
            if name == "repeated":
                continue
            copied = bool(group) and register["offset"] >= group["base"]
            fields = {}
            for field, bits in register["fields"].items():
                full = field if field == "value" else field + "_"
                has = bits["properties"]
                effects = sorted(value if key == "onwrite" else key for key, value in has.items()
                                 if key in ("singlepulse", "onwrite", "hwset", "we"))
                access = ACCESS[has["sw"], has["hw"], *effects]
                access, volatile = UVM_ACCESS.get(access) or ("RO", 0 if has["hw"] == "na" else 1)
                fields[full] = (access, volatile, bits["width"], bits["shift"], bits["reset"],
                                {full.upper() + code.upper(): value for code, value in bits["codes"].items()})
            shown = re.sub(r"^([A-Z]+)0_", r"\1_", name) if copied else name
            blocks[prefix][shown] = (register["offset"], *((group["stride"], group["count"]) if copied else (0, 1)), fields)
    return blocks


def uvm_differences(uvm, maps):
    try:
        mine, theirs = uvm_model(uvm), as_uvm(maps)
    except (AttributeError, KeyError, AssertionError) as error:
        return [f"the UVM model cannot be read: {error!r}"]
    return [f"{block}.{name}: {mine.get(block, {}).get(name)} in the UVM model, {theirs.get(block, {}).get(name)} in SystemRDL"
            for block in sorted(set(mine) | set(theirs))
            for name in sorted(set(mine.get(block, {})) | set(theirs.get(block, {})))
            if mine.get(block, {}).get(name) != theirs.get(block, {}).get(name)]


# The part of UVM that the model uses, for its syntax.
UVM_STUB = """
`define uvm_object_utils(T) typedef T type_id; \\
  static function T create(string name); T made; made = new(name); return made; endfunction
package uvm_pkg;
typedef enum {UVM_NO_COVERAGE} uvm_coverage_e;
typedef enum {UVM_LITTLE_ENDIAN} uvm_endianness_e;
typedef class uvm_reg;
class uvm_reg_field;
  `uvm_object_utils(uvm_reg_field)
  function new(string name = ""); endfunction
  function void configure(uvm_reg parent, int unsigned size, int unsigned lsb_pos, string access, bit volatile_,
    bit [63:0] reset, bit has_reset, bit is_rand, bit individually_accessible); endfunction
endclass
typedef class uvm_reg_block;
class uvm_reg;
  function new(string name, int unsigned n_bits, int has_coverage); endfunction
  function void configure(uvm_reg_block parent); endfunction
endclass
class uvm_reg_map;
  function void add_reg(uvm_reg rg, bit [63:0] offset, string rights); endfunction
endclass
class uvm_reg_block;
  uvm_reg_map default_map;
  function new(string name, int has_coverage); endfunction
  function uvm_reg_map create_map(string name, bit [63:0] base_addr, int unsigned n_bytes, uvm_endianness_e endian);
    uvm_reg_map made = new; return made;
  endfunction
  function void lock_model(); endfunction
endclass
endpackage
"""


def broken_syntax(uvm):
    """What Verilator finds, where it is installed."""
    if not shutil.which("verilator"):
        return []
    with tempfile.TemporaryDirectory() as folder:
        pathlib.Path(folder, "uvm_macros.svh").write_text("", encoding="utf-8")
        pathlib.Path(folder, "all.sv").write_text(UVM_STUB + uvm + "\nmodule top; endmodule\n", encoding="utf-8")
        done = subprocess.run(["verilator", "--lint-only", "-Wno-fatal", "-Wno-lint", "-Wno-style", "--top-module", "top", "-I" + folder,
                               str(pathlib.Path(folder, "all.sv"))], capture_output=True, text=True, check=False)
        return [done.stderr] if done.returncode else []


def differences(text, header, defaults):
    try:
        maps = Reader(text).file()
        read = macros(maps)
    except (ValueError, IndexError, KeyError) as error:
        return [f"cannot be read: {error!r}"]
    return [*broken_rules(maps), *broken_contract(maps), *broken_resets(maps, defaults),
            *(f"{name}: {mine.get(name)} here, {theirs.get(name)} in the header"
              for mine, theirs in zip(read, header_macros(header)) for name in sorted(set(mine) | set(theirs))
              if mine.get(name) != theirs.get(name))]


def main():
    if len(sys.argv) != 2:
        print(__doc__)
        return 2
    text, header, uvm = (subprocess.run([sys.argv[1], "params", option], check=True, capture_output=True, text=True).stdout
                    for option in ("--systemrdl", "--c-header", "--uvm"))
    listed = json.loads(subprocess.run([sys.argv[1], "params", "--json"], check=True, capture_output=True).stdout)
    defaults = {(f"deburr_{one['engine']}", one["name"].partition(".")[2].replace(".", "_")): one["default"]
                for one in listed["parameters"]}
    wrong = differences(text, header, defaults)
    if len(header_macros(header)[0]) < 300:
        wrong.append("the header is not all there")
    # Faults that must be detected: an offset, a bit, a reset value, a code, an access, side effects, a lost register,
    # a stride, and constructs that the standard forbids.
    for before, after in ((" ID @ 0x000;", " ID @ 0x0FC;"), ("crease[3:2]", "crease[4:3]"),
                          ("32'hDEB00005", "32'hDEB00002"), (" paper = 2'd1;", " paper = 2'd2;"),
                          ("onwrite = woclr;", ""), (" hwset;", ""), ("steps[13:9] = 5'h8", "steps[13:9] = 5'h0"),
                          ("value[15:0] = 16'hCCD", "value[15:0] = 16'h0"),
                          (" singlepulse;", ""), ("sw = r; hw = w;", "sw = rw; hw = r;"), (" swwe;", ""), (" we;", ""),
                          ("hw = r; singlepulse;", "hw = r; singlepulse; onwrite = woclr;"),
                          ("sw = r; hw = w;", "sw = r; hw = r; we;"), ("enable[0:0] = 1'h1", "enable[0:0] = 1'h0"),
                          ("start[2:2]", "start[3:2]"), ("idle[0:0] = 1'h1", "idle[0:0]"), ("} SIZE @", "} SIZES @"),
                          ("+= 0x80", "+= 0x40"), ("enable[0:0]", "enable[0:0")):
        if before not in text:
            wrong.append(f"nothing is {before!r}")
        elif not differences(text.replace(before, after, 1), header, defaults):
            wrong.append(f"{before!r} as {after!r} was not noticed")
    maps = Reader(text).file()
    wrong += [*uvm_differences(uvm, maps), *broken_syntax(uvm)]
    for before, after in (("'h008, ", "'h00C, "), ('"W1C", 1', '"RW", 1'), ('"RO", 1', '"RO", 0'), ("32'hDEB00005", "32'hDEB00002"),
                          ("(this, 1, 1,", "(this, 1, 2,"), ("localparam LAYOUT_TILED = 1", "localparam LAYOUT_TILED = 0"),
                          ("i * 'h80", "i * 'h40"), ("TEXTURE_MODE[16]", "TEXTURE_MODE[15]"), ("  rand uvm_reg_field idle_;\n", "")):
        if before not in uvm:
            wrong.append(f"nothing is {before!r} in the UVM model")
        elif not uvm_differences(uvm.replace(before, after, 1), maps):
            wrong.append(f"{before!r} as {after!r} was not noticed in the UVM model")
    print("\n".join(wrong))
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
