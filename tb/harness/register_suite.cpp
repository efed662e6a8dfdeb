// SPDX-License-Identifier: MIT
#include "tb/harness/register_suite.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <optional>
#include <regex>
#include <set>
#include <sstream>

#include "rtl_model/platform/register_host.h"
#include "spec/error.h"

namespace deburr::tb {
namespace {

using Response = tlm::tlm_response_status;

// ---- SystemRDL file

struct FileField {
  std::string name;
  unsigned high = 0, low = 0;
  std::set<std::string> properties;  // without text properties
  std::optional<std::uint32_t> reset;

  bool has(const std::string& property) const { return properties.contains(property); }
  std::uint32_t mask() const { return (2u << high) - (1u << low); }
  bool software_reads() const { return has("sw = r") || has("sw = rw"); }
  bool software_writes() const { return has("sw = w") || has("sw = rw"); }
  bool hardware_writes() const { return has("hw = w") || has("hw = rw"); }
  bool clears() const { return has("onwrite = woclr") && software_writes(); }
};

struct FileRegister {
  std::string name;
  std::vector<FileField> fields;

  template <class Wanted>
  std::uint32_t bits(Wanted wanted) const {
    std::uint32_t all = 0;
    for (const FileField& field : fields)
      if (wanted(field)) all |= field.mask();
    return all;
  }
  std::uint32_t readable() const {
    return bits([](auto& f) { return f.software_reads(); });
  }
  std::uint32_t writable() const {
    return bits([](auto& f) { return f.software_writes(); });
  }
  std::uint32_t commands() const {
    return bits([](auto& f) { return f.has("singlepulse"); });
  }
  std::uint32_t cleared() const {
    return bits([](auto& f) { return f.clears(); });
  }
  std::uint32_t changing() const {
    return bits([](auto& f) { return f.hardware_writes(); });
  }
  // Value read after a write of `value`, given the value read before.
  std::uint32_t after(std::uint32_t before, std::uint32_t value) const {
    const std::uint32_t kept = writable() & readable() & ~commands() & ~cleared();
    return (before & ~kept & ~(value & cleared())) | (value & kept);
  }
};

using FileMap = std::map<std::uint32_t, FileRegister>;  // by offset

std::uint32_t hex(const std::string& digits) {
  return static_cast<std::uint32_t>(std::stoul(digits, nullptr, 16));
}

FileField field_of(const std::smatch& match) {
  static const std::regex kText(R"((desc|name) = "(\\.|[^"\\])*";)");
  FileField field{match[2],
                  static_cast<unsigned>(std::stoul(match[3])),
                  static_cast<unsigned>(std::stoul(match[4])),
                  {},
                  {}};
  std::istringstream list(std::regex_replace(match[1].str(), kText, ""));
  for (std::string item; std::getline(list, item, ';');) {
    const std::size_t from = item.find_first_not_of(' ');
    if (from != std::string::npos) field.properties.insert(item.substr(from));
  }
  if (match[6].matched) field.reset = hex(match[6]);
  return field;
}

const std::regex kField(R"( *field \{ (.*) \} \\?(\w+)\[(\d+):(\d+)\]( = \d+'h([0-9A-F]+))?;)");

// Parses one address map, line by line, as it is printed.
FileMap read_file(const std::string& text) {
  static const std::regex kRegister(R"( *\} (\w+) @ 0x([0-9A-F]+);)"),
      kRepeated(R"( *\} (\w+)\[(\d+)\] @ 0x([0-9A-F]+) \+= 0x([0-9A-F]+);)");
  FileMap map, group;
  FileMap* into = &map;
  FileRegister open;
  std::istringstream lines(text);
  std::smatch match;
  for (std::string line; std::getline(lines, line);) {
    if (std::regex_match(line, match, kField)) {
      open.fields.push_back(field_of(match));
    } else if (std::regex_match(line, match, kRegister)) {
      open.name = match[1];
      into->emplace(hex(match[2]), std::exchange(open, {}));
    } else if (line == "  regfile {") {
      into = &group;
    } else if (std::regex_match(line, match, kRepeated)) {
      for (std::uint32_t i = 0; i < std::stoul(match[2]); ++i)
        for (const auto& [offset, one] : group) {
          FileRegister& copy = map[hex(match[3]) + i * hex(match[4]) + offset];
          copy = one;
          copy.name = fmt::format("{}{}_{}", match[1].str(), i, one.name);
        }
      into = &map;
    }
  }
  return map;
}

// ---- the comparison

class Comparison {
 public:
  Comparison(const FileMap& map, const RegisterHardware& hardware, int& fields)
      : map_(map), hardware_(hardware), fields_(fields) {}

  std::vector<std::string> run() {
    hardware_.reset();
    compare_resets("at first");
    find_holes();
    if (!wrong_.empty()) return wrong_;
    for (const auto& [offset, info] : map_) {
      fields_ += static_cast<int>(info.fields.size());
      if (info.writable() == 0)
        try_read_only(offset, info);
      else
        try_writes(offset, info);
      try_widths(offset, info);
      if (!wrong_.empty()) return wrong_;  // stop at the first register that differs
    }
    // A reset restores every register from another value.
    for (const auto& [offset, info] : map_)
      if (info.writable() != 0) write(offset, info, ~read(offset, info) & ~info.commands());
    hardware_.reset();
    compare_resets("after a reset");
    for (const auto& [offset, info] : map_) {
      for (const FileField& field : info.fields) {
        if (field.has("singlepulse")) try_command(offset, info, field);
        if (info.name == "STATUS") try_sticky(offset, info, field);
      }
    }
    try_while_busy();
    if (wrong_.empty()) try_provoked();
    hardware_.reset();
    return wrong_;
  }

 private:
  void say(const FileRegister& info, const std::string& text) {
    if (wrong_.size() < 20) wrong_.push_back(fmt::format("{}: {}", info.name, text));
  }
  void expect(const FileRegister& info, const std::string& when, std::uint32_t expected,
              std::uint32_t got) {
    if (expected != got)
      say(info, fmt::format("{}: {:#x} in the file, {:#x} in the hardware", when, expected, got));
  }
  // A register without readable fields rejects a read; its value counts as 0.
  std::uint32_t read(std::uint32_t offset, const FileRegister& info) {
    try {
      const std::uint32_t value = hardware_.read(offset);
      if (info.readable() == 0) say(info, "write-only in the file, but a read succeeds");
      return value;
    } catch (const spec::SimulationError& error) {
      if (info.readable() != 0) say(info, fmt::format("cannot be read: {}", error.what()));
      return 0;
    }
  }
  void write(std::uint32_t offset, const FileRegister& info, std::uint32_t value) {
    if (hardware_.write(offset, value) != tlm::TLM_OK_RESPONSE)
      say(info, fmt::format("a write of {:#x} is rejected", value));
  }

  void compare_resets(const std::string& when) {
    for (const auto& [offset, info] : map_) {
      std::uint32_t expected = 0, open = 0;
      for (const FileField& field : info.fields) {
        if (!field.reset) open |= field.mask();
        if ((field.reset.value_or(0) << field.low & ~field.mask()) != 0)
          say(info, fmt::format("the reset value of {} does not fit", field.name));
        if (field.software_reads()) expected |= field.reset.value_or(0) << field.low;
      }
      expect(info, when, expected, read(offset, info) & ~open);
    }
  }

  // Checks that no register exists at offsets that the file does not list.
  void find_holes() {
    for (std::uint32_t offset = 0; offset < map_.rbegin()->first + 64; offset += 4)
      if (!map_.contains(offset) && hardware_.write(offset, 0) != tlm::TLM_ADDRESS_ERROR_RESPONSE)
        wrong_.push_back(
            fmt::format("{:#x}: no register in the file, but a write succeeds", offset));
  }

  void try_read_only(std::uint32_t offset, const FileRegister& info) {
    const std::uint32_t before = read(offset, info);
    for (const std::uint32_t value : {~std::uint32_t{0}, std::uint32_t{0}, ~before}) {
      const Response response = hardware_.write(offset, value);
      expect(info, "after a write to a read-only register", before, read(offset, info));
      // A register of an option that is not built accepts writes and reads 0.
      if (response != tlm::TLM_COMMAND_ERROR_RESPONSE &&
          (response != tlm::TLM_OK_RESPONSE || before != 0))
        say(info, fmt::format("read-only in the file, but a write is answered with {}",
                              static_cast<int>(response)));
    }
  }

  void try_writes(std::uint32_t offset, const FileRegister& info) {
    const std::uint32_t old = read(offset, info);
    std::vector<std::uint32_t> values = {~std::uint32_t{0}, 0, 0x55555555, 0xAAAAAAAA};
    for (unsigned bit = 0; bit < 32; ++bit) values.push_back(1u << bit);
    const bool shared = (info.changing() & info.writable()) != 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
      const std::uint32_t value = values[i] & ~info.commands(), before = read(offset, info);
      // Compare the other registers in the first rounds; compare registers that hardware may change
      // in every round.
      const bool all = i < 2 || shared;
      const std::map<std::uint32_t, std::uint32_t> others = all ? read_others(offset) : kNone;
      write(offset, info, value);
      const auto changed = all ? compare_others(info, others) : kNone;
      const std::uint32_t expected = info.after(before, value);
      // Undo changes by hardware, so that the written value can be read back.
      if (read(offset, info) != expected)
        for (const auto& [other, was] : changed) write(other, map_.at(other), was);
      expect(info, fmt::format("after a write of {:#x}", value), expected, read(offset, info));
      const std::uint32_t plain =
          info.bits([](auto& f) { return f.software_writes() && !f.clears() && f.has("hw = r"); });
      const std::uint32_t held = plain & ~info.commands();
      expect(info, fmt::format("value for the hardware after a write of {:#x}", value),
             value & held, hardware_.seen(offset) & held);
    }
    write(offset, info, old & ~info.commands());
  }
  static inline const std::map<std::uint32_t, std::uint32_t> kNone{};

  std::map<std::uint32_t, std::uint32_t> read_others(std::uint32_t offset) {
    std::map<std::uint32_t, std::uint32_t> values;
    for (const auto& [other, info] : map_)
      if (other != offset) values[other] = read(other, info);
    return values;
  }
  // Checks that a write changes no other register, except fields that hardware may change. Restores
  // the registers that software can write.
  std::map<std::uint32_t, std::uint32_t> compare_others(
      const FileRegister& written, const std::map<std::uint32_t, std::uint32_t>& before) {
    std::map<std::uint32_t, std::uint32_t> changed;
    for (const auto& [other, value] : before) {
      const FileRegister& info = map_.at(other);
      const std::uint32_t now = read(other, info);
      if (((now ^ value) & ~info.changing()) != 0)
        expect(info, fmt::format("after a write to {}", written.name), value, now);
      else if (now != value && info.writable() != 0)
        changed[other] = value;
    }
    return changed;
  }

  // Only aligned words without byte enables are accepted.
  void try_widths(std::uint32_t offset, const FileRegister& info) {
    const std::uint32_t before = read(offset, info);
    const auto answered = [&](unsigned bytes, bool enables, std::uint32_t at, Response expected) {
      const Response response = hardware_.write_bytes(at, bytes, enables);
      if (response != expected)
        say(info, fmt::format("{} bytes{} at {:#x} are answered with {}", bytes,
                              enables ? " with byte enables" : "", at, static_cast<int>(response)));
      expect(info, "after a write that is rejected", before, read(offset, info));
    };
    answered(4, true, offset, tlm::TLM_BYTE_ENABLE_ERROR_RESPONSE);
    answered(2, false, offset, tlm::TLM_BURST_ERROR_RESPONSE);
    answered(4, false, offset + 2, tlm::TLM_ADDRESS_ERROR_RESPONSE);
  }

  void try_command(std::uint32_t offset, const FileRegister& info, const FileField& field) {
    hardware_.reset();
    const std::uint32_t before = read(offset, info);
    write(offset, info, before | field.mask());
    expect(info, fmt::format("after the command {}", field.name), before, read(offset, info));
    // The pulse lasts only for the write and is not stored.
    expect(info, fmt::format("value for the hardware after {}", field.name), 0,
           hardware_.seen(offset) & field.mask());
    hardware_.reset();
  }

  // A bit that hardware sets stays set until a one is written to it. The interrupt follows the bit.
  void try_sticky(std::uint32_t offset, const FileRegister& info, const FileField& field) {
    hardware_.reset();
    const std::uint32_t idle = read(offset, info);
    const bool sets = field.has("hwset");
    if (hardware_.interrupt()) say(info, "interrupt raised after a reset");
    if (!field.hardware_writes()) hardware_.set_sticky(field.mask());
    const std::uint32_t set = sets ? idle | field.mask() : idle;
    expect(info, fmt::format("with {} set by hardware", field.name), set, read(offset, info));
    if (hardware_.interrupt() != sets)
      say(info, fmt::format("wrong interrupt with {} set", field.name));
    for (const std::uint32_t value : {std::uint32_t{0}, ~field.mask()}) {
      write(offset, info, value);
      expect(info, fmt::format("{} after a write of {:#x}", field.name, value), set,
             read(offset, info));
    }
    write(offset, info, field.mask());
    expect(info, fmt::format("{} after a one written to it", field.name),
           info.after(set, field.mask()), read(offset, info));
    if (hardware_.interrupt() != (sets && !field.clears()))
      say(info, fmt::format("wrong interrupt with {} cleared", field.name));
    // Writing a one clears no other bit.
    const std::uint32_t all = info.bits([](auto& f) { return f.has("hwset"); });
    hardware_.set_sticky(all);
    write(offset, info, field.mask());
    expect(info, fmt::format("with all bits set, after a one written to {}", field.name),
           info.after(idle | all, field.mask()), read(offset, info));
  }

  void try_while_busy() {
    hardware_.reset();
    const auto status = std::find_if(map_.begin(), map_.end(),
                                     [](const auto& each) { return each.second.name == "STATUS"; });
    const auto bit = [&](const std::string& name) -> const FileField* {
      for (const FileField& field : status->second.fields)
        if (field.name == name) return &field;
      return nullptr;
    };
    const FileField *const idle = bit("idle"), *const busy_write = bit("written_while_busy");
    if (!idle || !busy_write) {
      wrong_.push_back("STATUS: the field idle or written_while_busy is missing");
      return;
    }
    hardware_.begin_job();
    hardware_.run_until([&] { return (read(status->first, status->second) & idle->mask()) == 0; });
    const std::uint32_t before = read(status->first, status->second);
    if (!idle->hardware_writes())
      say(status->second, "idle changes, but the file does not let hardware write it");
    expect(status->second, "idle during a job", 0, before & idle->mask());
    for (const auto& [offset, info] : map_) {
      const std::uint32_t kept = info.writable() & ~info.cleared() & ~info.commands();
      if (kept == 0 || (info.name == "CONTROL")) continue;
      write(status->first, status->second, busy_write->mask());
      const std::uint32_t value = read(offset, info), inverted = ~value;
      write(offset, info, inverted);
      const std::uint32_t locked = info.bits([](auto& f) { return f.has("swwe"); });
      const std::uint32_t open = ~locked & ~info.changing();
      expect(info, "after a write during a job",
             (value & locked) | (info.after(value, inverted) & open),
             read(offset, info) & (locked | open));
      expect(status->second, fmt::format("written_while_busy after a write to {}", info.name),
             busy_write->mask(), read(status->first, status->second) & busy_write->mask());
    }
  }

  // After every hardware event, read-only fields have changed only where the file allows it.
  void try_provoked() {
    hardware_.reset();
    const std::map<std::uint32_t, std::uint32_t> before = read_others(~std::uint32_t{0});
    hardware_.provoke();
    for (const auto& [offset, info] : map_) {
      const std::uint32_t sticky = info.bits([](auto& f) { return f.has("hwset"); });
      const std::uint32_t written = info.writable() & ~info.cleared();
      const std::uint32_t rest = ~(info.changing() | sticky | written);
      expect(info, "after every hardware event", before.at(offset) & rest,
             read(offset, info) & rest);
    }
  }

  const FileMap& map_;
  const RegisterHardware& hardware_;
  int& fields_;
  std::vector<std::string> wrong_;
};

}  // namespace

std::vector<std::string> register_differences(const std::string& systemrdl,
                                              const RegisterHardware& hardware, int& fields) {
  const FileMap map = read_file(systemrdl);
  if (map.empty()) return {"the file has no registers"};
  return Comparison(map, hardware, fields).run();
}

std::vector<std::pair<std::string, std::string>> wrong_files(const std::string& systemrdl) {
  std::vector<std::pair<std::string, std::string>> wrong;
  for (std::size_t at = 0, end; at < systemrdl.size(); at = end + 1) {
    end = std::min(systemrdl.find('\n', at), systemrdl.size());
    const std::string line = systemrdl.substr(at, end - at);
    std::smatch match;
    if (!std::regex_match(line, match, kField)) continue;
    const FileField field = field_of(match);
    const auto add = [&](const std::string& other) {
      wrong.emplace_back(fmt::format("{}\ninstead of\n{}", other, line),
                         std::string(systemrdl).replace(at, line.size(), other));
    };
    const auto replaced = [&](const std::string& before, const std::string& after) {
      if (const std::size_t found = line.find(before); found != std::string::npos)
        add(std::string(line).replace(found, before.size(), after));
    };
    // A command field reads as 0, like a write-only field. A read-only field whose value is 0 shows
    // no bits.
    const bool is_command = field.has("singlepulse"),
               is_zero = !field.software_writes() && !field.reset.value_or(0);
    replaced("sw = rw;", "sw = r;");
    replaced("sw = r;", "sw = rw;");
    if (!is_command) replaced("sw = w;", "sw = rw;");
    replaced("onwrite = woclr;", "");
    replaced("hwset;", "");
    replaced("singlepulse;", "");
    replaced("swwe;", "");
    if (field.name == "idle") replaced("hw = w;", "hw = r;");
    if (field.high > field.low && field.software_writes())
      replaced(fmt::format("[{}:{}]", field.high, field.low),
               fmt::format("[{}:{}]", field.high - 1, field.low));
    if (field.reset && !is_command)
      add(std::string(line).replace(static_cast<std::size_t>(match.position(6)),
                                    static_cast<std::size_t>(match.length(6)),
                                    fmt::format("{:X}", *field.reset ^ 1)));
    // In a build without memory nothing sets the memory_error bit.
    if (!is_zero && !is_command && field.name != "memory_error") add("");
  }
  return wrong;
}

std::vector<std::pair<std::string, RegisterHardware>> wrong_hardware(
    const std::string& systemrdl, const RegisterHardware& right) {
  std::vector<std::pair<std::string, RegisterHardware>> all;
  const FileMap map = read_file(systemrdl);
  std::uint32_t control = 0, status = 0, commands = 0, idle = 0;
  bool locked = false;
  for (const auto& [offset, info] : map) {
    if (info.name == "CONTROL") control = offset, commands = info.commands();
    if (info.name == "STATUS") {
      status = offset;
      idle = info.bits([](auto& f) { return f.name == "idle"; });
    }
    locked = locked || info.bits([](auto& f) { return f.has("swwe"); }) != 0;
  }
  const auto add = [&](const std::string& what, const auto& change) {
    RegisterHardware wrong = right;
    change(wrong);
    all.emplace_back(what, wrong);
  };
  add("a reset does not change registers", [](auto& h) { h.reset = [] {}; });
  add("a bit outside all fields reads as 1", [&](auto& h) {
    h.read = [right, status](std::uint32_t offset) {
      return right.read(offset) | (offset == status ? 1u << 31 : 0);
    };
  });
  add("a write to STATUS clears everything", [&](auto& h) {
    h.write = [right, status](std::uint32_t offset, std::uint32_t value) {
      return right.write(offset, offset == status ? ~std::uint32_t{0} : value);
    };
  });
  add("a write to STATUS clears nothing", [&](auto& h) {
    h.write = [right, status](std::uint32_t offset, std::uint32_t value) {
      return right.write(offset, offset == status ? 0 : value);
    };
  });
  // Makes reads of the registers that `takes` selects return the last written value.
  const auto shadowed = [&](RegisterHardware& h, const auto& takes, std::uint32_t bits) {
    const auto last = std::make_shared<std::map<std::uint32_t, std::uint32_t>>();
    h.write = [right, last, takes](std::uint32_t offset, std::uint32_t value) {
      const Response response = right.write(offset, value);
      if (!takes(offset, response)) return response;
      (*last)[offset] = value;
      return tlm::TLM_OK_RESPONSE;
    };
    h.read = [right, last, bits](std::uint32_t offset) {
      const auto found = last->find(offset);
      const std::uint32_t value = right.read(offset);
      return found == last->end() ? value : (value & ~bits) | (found->second & bits);
    };
  };
  add("software writes idle", [&](auto& h) {
    shadowed(
        h, [status](std::uint32_t offset, Response) { return offset == status; }, idle);
  });
  add("command bits read back as written", [&](auto& h) {
    shadowed(
        h, [control](std::uint32_t offset, Response) { return offset == control; }, commands);
  });
  add("a read-only register is written", [&](auto& h) {
    shadowed(
        h, [](std::uint32_t, Response r) { return r == tlm::TLM_COMMAND_ERROR_RESPONSE; },
        ~std::uint32_t{0});
  });
  add("a write to a read-only register is not rejected", [&](auto& h) {
    h.write = [right](std::uint32_t offset, std::uint32_t value) {
      const Response response = right.write(offset, value);
      return response == tlm::TLM_COMMAND_ERROR_RESPONSE ? tlm::TLM_OK_RESPONSE : response;
    };
  });
  add("byte enables are ignored", [&](auto& h) {
    h.write_bytes = [right](std::uint32_t offset, unsigned bytes, bool enables) {
      const Response response = right.write_bytes(offset, bytes, enables);
      return enables ? tlm::TLM_OK_RESPONSE : response;
    };
  });
  add("a write also reaches the next register", [&](auto& h) {
    h.write = [right](std::uint32_t offset, std::uint32_t value) {
      const Response response = right.write(offset, value);
      if (response == tlm::TLM_OK_RESPONSE) right.write(offset + 4, value & ~7u);
      return response;
    };
  });
  add("hardware does not set sticky bits", [](auto& h) { h.set_sticky = [](std::uint32_t) {}; });
  add("no interrupt", [](auto& h) { h.interrupt = [] { return false; }; });
  add(locked ? "writes during a job are accepted" : "writes during a job are ignored",
      [&](auto& h) {
        const auto busy = std::make_shared<bool>(false);
        if (locked)
          shadowed(
              h,
              [busy, status](std::uint32_t offset, Response) { return *busy && offset != status; },
              ~std::uint32_t{0});
        else
          h.write = [right, busy, status](std::uint32_t offset, std::uint32_t value) {
            if (*busy && offset != status) value = right.read(offset);
            return right.write(offset, value);
          };
        h.begin_job = [right, busy] {
          right.begin_job();
          *busy = true;
        };
        h.reset = [right, busy] {
          right.reset();
          *busy = false;
        };
      });
  return all;
}

tlm::tlm_response_status write_bytes(platform::RegisterHost& host, std::uint32_t offset,
                                     unsigned bytes, bool enables) {
  std::array<unsigned char, 4> data = {0xFF, 0xFF, 0xFF, 0xFF}, enable = {0xFF, 0, 0, 0};
  tlm::tlm_generic_payload payload;
  payload.set_command(tlm::TLM_WRITE_COMMAND);
  payload.set_address(offset);
  payload.set_data_ptr(data.data());
  payload.set_data_length(bytes);
  payload.set_streaming_width(bytes);
  if (enables) {
    payload.set_byte_enable_ptr(enable.data());
    payload.set_byte_enable_length(static_cast<unsigned>(enable.size()));
  }
  sc_core::sc_time delay = sc_core::SC_ZERO_TIME;
  host.bus->b_transport(payload, delay);
  return payload.get_response_status();
}

}  // namespace deburr::tb
