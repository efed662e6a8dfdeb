// SPDX-License-Identifier: MIT
#include "rtl_model/fabric/register_section.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <iterator>
#include <utility>

namespace deburr::rtl {
namespace {

const char* access_name(spec::Access access) {
  switch (access) {
    case spec::Access::kConstant:
    case spec::Access::kReadOnly:
      return "RO";
    case spec::Access::kReadWrite:
      return "RW";
    case spec::Access::kShared:
      return "RWH";
    case spec::Access::kWriteOnly:
      return "WO";
    case spec::Access::kCommand:
      return "W1P";
    case spec::Access::kWriteOneToClear:
      return "W1C";
  }
  return "?";
}

// Each access name once, in the order of the fields.
std::string access_names(const spec::RegisterInfo& info) {
  std::vector<std::string_view> names;
  for (const spec::Field& field : info.fields)
    if (const std::string_view name = access_name(field.access);
        std::find(names.begin(), names.end(), name) == names.end())
      names.push_back(name);
  return fmt::format("{}", fmt::join(names, ", "));
}

const spec::LoadedRegister* loaded_value(const spec::RegisterInfo& info,
                                         std::span<const spec::LoadedRegister> loaded) {
  const auto found = std::find_if(loaded.begin(), loaded.end(),
                                  [&](const auto& each) { return each.offset == info.offset; });
  return found == loaded.end() ? nullptr : &*found;
}

// The register's word after a reset, and whether a reset leaves the whole word unchanged.
std::uint32_t reset_word(const spec::RegisterInfo& info,
                         std::span<const spec::LoadedRegister> loaded) {
  const spec::LoadedRegister* const value = loaded_value(info, loaded);
  return value ? value->value : info.reset();
}
bool has_reset(const spec::RegisterInfo& info) {
  return std::any_of(info.fields.begin(), info.fields.end(),
                     [](const spec::Field& field) { return field.reset.has_value(); });
}

std::string codes_of(const spec::Field& field) {
  std::string text;
  for (std::size_t code = 0; code < field.codes.size(); ++code)
    text += fmt::format("{}{} {}", code > 0 ? ", " : "", code, field.codes[code]);
  return text;
}

std::string meaning_of(const spec::Field& field) {
  if (field.meaning.empty()) return codes_of(field);
  if (field.codes.empty()) return std::string(field.meaning);
  return fmt::format("{}; {}", codes_of(field), field.meaning);
}

std::string bits_of(const spec::Field& field) {
  return field.high == field.low ? fmt::format("[{}]", field.low)
                                 : fmt::format("[{}:{}]", field.high, field.low);
}

// Registers with equal fields and reset values share a row.
std::string field_table_markdown(std::span<const spec::RegisterInfo> table,
                                 std::span<const spec::LoadedRegister> loaded) {
  struct Group {
    std::span<const spec::Field> fields;
    std::uint32_t reset;
    std::string names;
  };
  std::vector<Group> groups;
  for (const spec::RegisterInfo& r : table) {
    if (r.is_number()) continue;
    const std::uint32_t reset = reset_word(r, loaded);
    const auto same = std::find_if(groups.begin(), groups.end(), [&](const Group& group) {
      return group.fields.data() == r.fields.data() && group.reset == reset;
    });
    if (same == groups.end())
      groups.push_back({r.fields, reset, fmt::format("`{}`", r.name)});
    else
      same->names += fmt::format(", `{}`", r.name);
  }
  if (groups.empty()) return {};
  std::string text =
      "\n| register | bits | field | access | reset | meaning |\n|---|---|---|---|---|---|\n";
  for (const auto& [fields, reset, names] : groups)
    for (const spec::Field& field : fields)
      text +=
          fmt::format("| {} | {} | `{}` | {} | {} | {} |\n", names, bits_of(field), field.name,
                      access_name(field.access),
                      field.reset ? fmt::format("{}", field.of(reset)) : "none", meaning_of(field));
  return text;
}

std::string upper(std::string_view name) {
  std::string text;
  for (const char c : name)
    text += std::isalnum(static_cast<unsigned char>(c))
                ? static_cast<char>(std::toupper(static_cast<unsigned char>(c)))
                : '_';
  return text;
}

}  // namespace

std::string register_table_markdown(std::span<const spec::RegisterInfo> table,
                                    std::span<const spec::LoadedRegister> loaded) {
  std::string text = "| offset | name | access | reset | meaning |\n|---|---|---|---|---|\n";
  for (const spec::RegisterInfo& r : table)
    text += fmt::format("| 0x{:03X} | `{}` | {} | {} | {} |\n", r.offset, r.name, access_names(r),
                        has_reset(r) ? fmt::format("0x{:08X}", reset_word(r, loaded)) : "none",
                        r.meaning);
  return text + field_table_markdown(table, loaded);
}

std::string register_c_macros(std::span<const spec::RegisterInfo> table, std::string_view prefix,
                              std::span<const spec::LoadedRegister> loaded) {
  std::string text;
  for (const spec::RegisterInfo& r : table) {
    const std::string name = fmt::format("{}_{}", prefix, upper(r.name)), access = access_names(r);
    text +=
        fmt::format("\n/* {}: {} */\n#define {} 0x{:03X}u\n", access, r.meaning, name, r.offset);
    if (const std::uint32_t reset = reset_word(r, loaded); reset != 0)
      text += fmt::format("#define {}_RESET 0x{:08X}u{}\n", name, reset,
                          loaded_value(r, loaded) ? " /* with default parameters */" : "");
    if (r.is_number()) continue;
    for (const spec::Field& field : r.fields) {
      const std::string full = fmt::format("{}_{}", name, upper(field.name));
      // If accesses differ within the register, each field states its own.
      std::string remark(field.meaning);
      if (access != access_name(field.access))
        remark =
            fmt::format("{}{}{}", access_name(field.access), remark.empty() ? "" : ": ", remark);
      if (!remark.empty()) remark = fmt::format(" /* {} */", remark);
      text += fmt::format("#define {0}_MASK 0x{1:08X}u{3}\n#define {0}_SHIFT {2}u\n", full,
                          field.mask(), field.low, remark);
      for (std::size_t code = 0; code < field.codes.size(); ++code)
        text += fmt::format("#define {}_{} {}u\n", full, upper(field.codes[code]), code);
    }
  }
  return text;
}

namespace {

std::string lower(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

// Macros for the stride and count of repeated registers.
std::string repetition_macros(const RegisterSection& section) {
  if (!section.repeated) return {};
  const auto& [name, stride, count] = *section.repeated;
  return fmt::format(
      "\n/* Byte distance from a register of {1}0 to that of the next {2}, and their number. */\n"
      "#define {0}_STRIDE 0x{3:02X}u\n#define {0}_COUNT {4}u\n",
      section.macros, name, lower(name), stride, count);
}

// ---- SystemRDL ----

constexpr std::string_view kKeywords[] = {"abstract",    "accesstype", "addressingtype",
                                          "addrmap",     "alias",      "all",
                                          "bit",         "boolean",    "bothedge",
                                          "compact",     "component",  "constraint",
                                          "default",     "encode",     "enum",
                                          "external",    "false",      "field",
                                          "fullalign",   "hw",         "inside",
                                          "internal",    "level",      "longint",
                                          "mem",         "na",         "negedge",
                                          "nonsticky",   "number",     "onreadtype",
                                          "onwritetype", "posedge",    "property",
                                          "r",           "rclr",       "ref",
                                          "reg",         "regalign",   "regfile",
                                          "rset",        "ruser",      "rw",
                                          "rw1",         "signal",     "string",
                                          "struct",      "this",       "true",
                                          "type",        "unsigned",   "w",
                                          "w1",          "wclr",       "woclr",
                                          "woset",       "wot",        "wr",
                                          "wset",        "wuser",      "wzc",
                                          "wzs",         "wzt"};

std::string rdl_identifier(std::string_view name) {
  std::string text;
  for (const char c : name) text += std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
  if (std::isdigit(static_cast<unsigned char>(text[0]))) text.insert(0, 1, '_');
  return text;
}

// A name as an identifier; reserved words are escaped with a backslash.
std::string rdl_name(std::string_view name) {
  const std::string text = rdl_identifier(name);
  const bool reserved =
      std::find(std::begin(kKeywords), std::end(kKeywords), text) != std::end(kKeywords);
  return reserved ? "\\" + text : text;
}

std::string rdl_text(std::string_view text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += c;
  }
  return quoted + "\"";
}

// Hardware reads fields that software may write, and drives read-only fields. A field that both
// write needs a write enable: without one, hardware would write it in every cycle.
const char* rdl_access(spec::Access access) {
  switch (access) {
    case spec::Access::kConstant:
      return "sw = r; hw = na;";
    case spec::Access::kReadOnly:
      return "sw = r; hw = w;";
    case spec::Access::kReadWrite:
      return "sw = rw; hw = r;";
    case spec::Access::kShared:
      return "sw = rw; hw = rw; we;";
    case spec::Access::kWriteOnly:
      return "sw = w; hw = r;";
    case spec::Access::kCommand:
      return "sw = w; hw = r; singlepulse;";
    case spec::Access::kWriteOneToClear:
      return "sw = rw; hw = r; onwrite = woclr; hwset;";
  }
  return "";
}

std::string rdl_field(const spec::Field& field, std::uint32_t reset, bool waits_for_idle,
                      const std::string& indent) {
  std::string text;
  const std::string name = field.name.empty() ? "value" : rdl_name(field.name);
  const int width = field.high - field.low + 1;
  if (!field.codes.empty()) {
    text += fmt::format("{}enum {}_codes {{", indent, name);
    for (std::size_t code = 0; code < field.codes.size(); ++code)
      text += fmt::format(" {} = {}'d{};", rdl_name(field.codes[code]), width, code);
    text += " };\n";
  }
  text += fmt::format("{}field {{ {}", indent, rdl_access(field.access));
  if (waits_for_idle) text += " swwe;";  // software may write only while hardware allows it
  if (!field.codes.empty()) text += fmt::format(" encode = {}_codes;", name);
  if (!field.meaning.empty()) text += fmt::format(" desc = {};", rdl_text(field.meaning));
  text += fmt::format(" }} {}[{}:{}]", name, field.high, field.low);
  if (field.reset) text += fmt::format(" = {}'h{:X}", width, field.of(reset));
  return text + ";\n";
}

std::string rdl_register(const RegisterSection& section, const spec::RegisterInfo& info,
                         std::string_view name, std::uint32_t base, const std::string& indent) {
  std::string text = fmt::format("{0}reg {{\n{0}  desc = {1};\n", indent, rdl_text(info.meaning));
  for (const spec::Field& field : info.fields)
    text += rdl_field(field, reset_word(info, section.loaded),
                      section.busy_ignores_writes && info.name != "CONTROL" &&
                          (info.written() & field.mask()) != 0,
                      indent + "  ");
  return text + fmt::format("{}}} {} @ 0x{:03X};\n", indent, rdl_name(name), info.offset - base);
}

std::string rdl_map(const RegisterSection& section) {
  std::string text = fmt::format(
      "\naddrmap {} {{\n  name = {};\n  default regwidth = 32;\n  default accesswidth = 32;\n",
      lower(section.macros), rdl_text(section.module));
  const std::string prefix = section.repeated ? section.repeated->name + "0_" : "";
  std::string repeated;
  std::uint32_t base = 0;
  for (const spec::RegisterInfo& info : section.rows) {
    if (prefix.empty() || !info.name.starts_with(prefix)) {
      text += rdl_register(section, info, info.name, 0, "  ");
      continue;
    }
    if (repeated.empty()) base = info.offset;
    repeated += rdl_register(section, info, info.name.substr(prefix.size()), base, "    ");
  }
  if (section.repeated)
    text += fmt::format("  regfile {{\n{}  }} {}[{}] @ 0x{:03X} += 0x{:X};\n", repeated,
                        section.repeated->name, section.repeated->count, base,
                        section.repeated->stride);
  return text + "};\n";
}

// ---- UVM ----

// Fields of IEEE 1800.2. A command reads as 0, so a monitor must not expect what was written.
std::string uvm_field(const spec::Field& field, std::uint32_t reset, const std::string& name) {
  struct Kind {
    const char* access;
    bool changes;  // by hardware
  };
  const auto kind = [&]() -> Kind {
    switch (field.access) {
      case spec::Access::kConstant:
        return {"RO", false};
      case spec::Access::kReadOnly:
        return {"RO", true};
      case spec::Access::kReadWrite:
        return {"RW", false};
      case spec::Access::kShared:
        return {"RW", true};
      case spec::Access::kWriteOnly:
        return {"WO", false};
      case spec::Access::kCommand:
        return {"WO", true};
      case spec::Access::kWriteOneToClear:
        return {"W1C", true};
    }
    return {"", false};
  }();
  const int width = field.high - field.low + 1;
  return fmt::format(
      "    {0} = uvm_reg_field::type_id::create(\"{0}\");\n"
      "    {0}.configure(this, {1}, {2}, \"{3}\", {4}, {1}'h{5:X}, {6}, {7}, 0);\n",
      name, width, field.low, kind.access, kind.changes ? 1 : 0, field.of(reset),
      field.reset ? 1 : 0, field.access == spec::Access::kReadWrite ? 1 : 0);
}

// A name as an identifier of SystemVerilog that is no keyword and no member of a class of UVM.
std::string uvm_name(const spec::Field& field) {
  return field.name.empty() || field.name == "value"
             ? "value"
             : fmt::format("{}_", rdl_identifier(field.name));
}

std::string uvm_register(const RegisterSection& section, const spec::RegisterInfo& info,
                         const std::string& type) {
  const std::uint32_t reset = reset_word(info, section.loaded);
  std::string members, codes, build;
  for (const spec::Field& field : info.fields) {
    const std::string name = uvm_name(field);
    members += fmt::format("  rand uvm_reg_field {};\n", name);
    for (std::size_t code = 0; code < field.codes.size(); ++code)
      codes +=
          fmt::format("  localparam {}{} = {};\n", upper(name), upper(field.codes[code]), code);
    build += uvm_field(field, reset, name);
  }
  return fmt::format(
      "\n// {0}\nclass {1} extends uvm_reg;\n  `uvm_object_utils({1})\n{2}{3}"
      "  function new(string name = \"{1}\");\n    super.new(name, 32, UVM_NO_COVERAGE);\n"
      "  endfunction\n  virtual function void build();\n{4}  endfunction\nendclass\n",
      info.meaning, type, members, codes, build);
}

std::string uvm_block(const RegisterSection& section) {
  const std::string map = lower(section.macros), block = map + "_block";
  const std::string prefix = section.repeated ? section.repeated->name + "0_" : "";
  std::string types, members, build;
  for (const spec::RegisterInfo& info : section.rows) {
    const bool copied = !prefix.empty() && info.name.starts_with(prefix);
    const std::string name =
        copied ? fmt::format("{}_{}", section.repeated->name, info.name.substr(prefix.size()))
               : std::string(info.name);
    const std::string type = fmt::format("{}_{}", map, name);
    types += uvm_register(section, info, type);
    const bool reads = info.readable() != 0, writes = info.written() != 0;
    const char* const rights = reads && writes ? "RW" : reads ? "RO" : "WO";
    if (!copied) {
      members += fmt::format("  rand {} {};\n", type, name);
      build += fmt::format(
          "    {0} = {1}::type_id::create(\"{0}\");\n    {0}.configure(this);\n    {0}.build();\n"
          "    default_map.add_reg({0}, 'h{2:03X}, \"{3}\");\n",
          name, type, info.offset, rights);
      continue;
    }
    members += fmt::format("  rand {} {}[{}];\n", type, name, section.repeated->count);
    build += fmt::format(
        "    foreach ({0}[i]) begin\n"
        "      {0}[i] = {1}::type_id::create($sformatf(\"{0}[%0d]\", i));\n"
        "      {0}[i].configure(this);\n      {0}[i].build();\n"
        "      default_map.add_reg({0}[i], 'h{2:03X} + i * 'h{3:X}, \"{4}\");\n    end\n",
        name, type, info.offset, section.repeated->stride, rights);
  }
  const char* const note = section.busy_ignores_writes
                               ? "// While the engine is busy, writes to all registers but CONTROL "
                                 "and STATUS are ignored.\n"
                               : "";
  return fmt::format(
      "{0}\n// {1}\n{2}class {3} extends uvm_reg_block;\n  `uvm_object_utils({3})\n{4}"
      "  function new(string name = \"{3}\");\n    super.new(name, UVM_NO_COVERAGE);\n  "
      "endfunction\n"
      "  virtual function void build();\n"
      "    default_map = create_map(\"default_map\", 0, 4, UVM_LITTLE_ENDIAN);\n{5}"
      "    lock_model();\n  endfunction\nendclass\n",
      types, section.module, note, block, members, build);
}

}  // namespace

std::string register_page(const RegisterSection& section) {
  std::string page = fmt::format("\n## {}\n\n{}", section.module,
                                 register_table_markdown(section.rows, section.loaded));
  if (section.busy_ignores_writes)
    page +=
        "\nWhile the engine is busy, writes to all registers but CONTROL and STATUS are ignored.\n";
  if (!section.repeated) return page;
  const auto& [name, stride, count] = *section.repeated;
  return page + fmt::format(
                    "\n{}{}s 1..{} follow with the same registers, each 0x{:X} bytes after the "
                    "previous one.\n",
                    name.substr(0, 1), lower(name.substr(1)), count - 1, stride);
}

std::string register_systemrdl(std::span<const RegisterSection> sections) {
  std::string text =
      "// SPDX-License-Identifier: MIT\n"
      "// Registers of Deburr's engines as SystemRDL 2.0, one address map each. Bits without a "
      "field, and\n// commands (singlepulse), read as 0. Reset values are those of default "
      "parameters.\n"
      "// Generated by `deburr params --systemrdl`; do not edit.\n";
  for (const RegisterSection& section : sections) text += rdl_map(section);
  return text;
}

std::string register_uvm(std::span<const RegisterSection> sections) {
  std::string text =
      "// SPDX-License-Identifier: MIT\n"
      "// Registers of Deburr's engines as UVM register models (IEEE 1800.2), one block each, from "
      "address 0 on.\n// Fields have a trailing underscore, codes of choices are localparams. "
      "Reset "
      "values are those of default\n// parameters. Commands (WO, volatile) read as 0.\n"
      "// Generated by `deburr params --uvm`; do not edit.\n"
      "`include \"uvm_macros.svh\"\npackage deburr_registers_pkg;\nimport uvm_pkg::*;\n";
  for (const RegisterSection& section : sections) text += uvm_block(section);
  return text + "\nendpackage\n";
}

std::string register_c_header(std::span<const RegisterSection> sections) {
  std::string header =
      "/* SPDX-License-Identifier: MIT */\n"
      "/* Registers of Deburr's engines, for software that programs them: byte offsets, masks and "
      "shifts of\n"
      " * fields, codes of choices. Generated by `deburr params --c-header`; do not edit.\n"
      " * RO: read only; RW: read and write; RWH: hardware also writes it; WO: write only; W1C: "
      "hardware sets it,\n"
      " * writing a one clears it; W1P: writing a one is a command, reads as 0.\n"
      " * `name` below is the name of a field, such as DEBURR_TEXTURE_TEXTURE0_SIZE_WIDTH. */\n"
      "#ifndef DEBURR_REGISTERS_H\n#define DEBURR_REGISTERS_H\n"
      "\n/* Extracts a field from a register word. */\n"
      "#define DEBURR_FIELD(name, word) (((word) & name##_MASK) >> name##_SHIFT)\n"
      "/* Shifts a value to the position of a field and cuts it to its width. */\n"
      "#define DEBURR_IN(name, value) (((value) + 0u) << name##_SHIFT & name##_MASK)\n"
      "/* The same for a named code: DEBURR_CHOICE(DEBURR_TEXTURE_TEXTURE0_MODE_FORMAT, RGBA8). "
      "*/\n"
      "#define DEBURR_CHOICE(name, code) DEBURR_IN(name, name##_##code)\n"
      "/* Replaces a field of a register word. */\n"
      "#define DEBURR_WITH(name, word, value) (((word) & ~name##_MASK) | DEBURR_IN(name, value))\n";
  for (const RegisterSection& section : sections)
    header += register_c_macros(section.rows, section.macros, section.loaded) +
              repetition_macros(section);
  return header + "\n#endif\n";
}

}  // namespace deburr::rtl
