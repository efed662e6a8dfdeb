// SPDX-License-Identifier: MIT
#include "rtl_model/fabric/trace.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <utility>

#include "rtl_model/fabric/counters.h"
#include "rtl_model/fabric/glob.h"
#include "rtl_model/fabric/ownership.h"
#include "rtl_model/fabric/register_block.h"
#include "rtl_model/fabric/unit.h"
#include "rtl_model/fabric/wire.h"
#include "spec/error.h"

namespace deburr::rtl {
namespace {

// VCD identifiers: numbers in base 94, as printable characters.
std::string short_name(std::size_t number) {
  std::string text;
  do {
    text += static_cast<char>('!' + number % 94);
    number /= 94;
  } while (number);
  return text;
}

std::string binary(std::uint64_t value, int bits) {
  std::string text(static_cast<std::size_t>(bits), '0');
  for (int i = 0; i < bits; ++i)
    if (value >> i & 1) text[static_cast<std::size_t>(bits - 1 - i)] = '1';
  return text;
}

// Splits a hierarchical name into the path of modules and the leaf name.
std::pair<std::vector<std::string>, std::string> split(const std::string& name) {
  std::vector<std::string> path;
  std::size_t begin = 0;
  for (std::size_t dot; (dot = name.find('.', begin)) != std::string::npos; begin = dot + 1)
    path.push_back(name.substr(begin, dot - begin));
  return {path, name.substr(begin)};
}

}  // namespace

Trace::Trace(ClockDomain& clock, const TraceOptions& options) : clock_(clock), options_(options) {
  file_.open(options_.file, std::ios::out | std::ios::trunc);
  check_file();
  clock_.require_cycle_by_cycle();
  clock_.add_after(*this);
  for_each_of<Unit>(clock, [&](Unit& unit) { initial_[&unit] = unit.counts(); });
}

Trace::~Trace() {
  file_.close();
  std::error_code ignored;  // a device is not removed
  if (!file_ && std::filesystem::is_regular_file(options_.file, ignored))
    std::filesystem::remove(options_.file, ignored);
}

void Trace::check_file() const {
  if (file_) return;
  const int reason = errno;
  throw spec::FileError(
      fmt::format("cannot write the waves to '{}': {}; the partial file was removed: trace fewer "
                  "units or cycles, or "
                  "choose another folder",
                  options_.file, std::strerror(reason)));
}

void Trace::flush() {
  file_.flush();
  check_file();
}

bool Trace::wanted(const std::string& name) const {
  return std::any_of(options_.scopes.begin(), options_.scopes.end(),
                     [&](const std::string& scope) { return glob_match(scope, name); });
}

std::vector<std::string> Trace::names(const ClockDomain& clock) {
  std::vector<std::string> names;
  const auto add = [&](const sc_core::sc_object& object) { names.emplace_back(object.name()); };
  for_each_of<LinkBase>(clock, add);
  for_each_of<WireBase>(clock, add);
  for_each_of<Unit>(clock, add);
  for_each_of<Counter>(clock, add);
  const Ownership ownership;  // a user's registers may not belong to a domain
  for_each<RegisterBlock>([&](const RegisterBlock& block) {
    if (ownership.find(block) != &clock) return;
    for (const spec::RegisterInfo& r : block.table())
      names.push_back(fmt::format("{}.{}", block.name(), r.name));
  });
  return names;
}

void Trace::add(const std::string& name, int bits, std::function<std::uint64_t()> sample) {
  if (!wanted(name)) return;
  signals_.push_back({name,
                      bits,
                      [bits, sample = std::move(sample)](Cycle) { return binary(sample(), bits); },
                      {},
                      {}});
}

void Trace::collect(Cycle cycle) {
  for_each_of<LinkBase>(clock_, [&](LinkBase& link) {
    const std::string name = link.name();
    if (!wanted(name)) return;
    const auto number = [&](const char* what, int bits, auto sample) {
      signals_.push_back({name + "." + what,
                          bits,
                          [bits, sample](Cycle c) { return binary(sample(c), bits); },
                          {},
                          {}});
    };
    number("occupancy", static_cast<int>(std::bit_width(link.depth())),
           [&link](Cycle) -> std::uint64_t { return link.occupancy(); });
    number("push", 1, [&link](Cycle c) -> std::uint64_t { return link.last_push() == c; });
    number("pop", 1, [&link](Cycle c) -> std::uint64_t { return link.last_pop() == c; });
    if (!options_.payloads) return;
    for (const Field& field : link.payload().fields()) {
      std::string flat = field.name;
      std::replace(flat.begin(), flat.end(), '.', '_');
      signals_.push_back({fmt::format("{}.{}", name, flat),
                          static_cast<int>(field.bits),
                          [&link, &field](Cycle) {
                            return link.empty() ? std::string("x")
                                                : binary(field.get(link.head()),
                                                         static_cast<int>(field.bits));
                          },
                          {},
                          {}});
    }
  });
  for_each_of<WireBase>(clock_, [&](const WireBase& wire) {
    const std::string name = wire.name();
    if (!wanted(name)) return;
    const std::vector<Field>& fields = wire.payload().fields();
    for (const Field& field : fields) {
      std::string flat = field.name;
      std::replace(flat.begin(), flat.end(), '.', '_');
      signals_.push_back({fields.size() == 1 ? name : fmt::format("{}.{}", name, flat),
                          static_cast<int>(field.bits),
                          [&wire, &field](Cycle c) {
                            const std::byte* const value = wire.seen(c);
                            return value ? binary(field.get(value), static_cast<int>(field.bits))
                                         : std::string("x");
                          },
                          {},
                          {}});
    }
  });
  for_each_of<Unit>(clock_, [&](Unit& unit) {
    if (!wanted(unit.name())) return;
    // The counter that increased since the last sample gives the unit's activity.
    const bool early = cycle < options_.from;
    auto before = early ? unit.counts() : initial_[&unit];
    signals_.push_back({std::string(unit.name()) + ".activity",
                        0,
                        [&unit, before](Cycle) mutable {
                          const auto now = unit.counts();
                          std::string text = "reset";
                          for (int i = 0; i < unit.activities(); ++i)
                            if (now[static_cast<std::size_t>(i)] >
                                before[static_cast<std::size_t>(i)])
                              text = unit.activity_name({static_cast<std::uint8_t>(i)});
                          before = now;
                          return text;
                        },
                        {},
                        {}});
  });
  for_each_of<Counter>(clock_, [&](Counter& counter) {
    add(counter.name(), 64, [&counter] { return counter.value(); });
  });
  const Ownership ownership;
  for_each<RegisterBlock>([&](RegisterBlock& block) {
    if (ownership.find(block) != &clock_) return;
    for (std::size_t i = 0; i < block.table().size(); ++i)
      add(fmt::format("{}.{}", block.name(), block.table()[i].name), 32,
          [&block, i]() -> std::uint64_t { return block.get(i); });
  });
}

void Trace::write_header() {
  // Signals of one scope must be contiguous in the file.
  std::multimap<std::vector<std::string>, Signal> by_path;
  for (Signal& signal : signals_) by_path.emplace(split(signal.name).first, std::move(signal));
  signals_.clear();
  for (auto& [path, signal] : by_path) signals_.push_back(std::move(signal));
  file_ << "$comment deburr $end\n$timescale " << sc_core::sc_get_time_resolution().to_string()
        << " $end\n";
  clock_id_ = short_name(signals_.size());
  cycle_id_ = short_name(signals_.size() + 1);
  file_ << "$scope module " << options_.top << " $end\n$var wire 1 " << clock_id_
        << " clk $end\n$var wire 64 " << cycle_id_ << " cycle [63:0] $end\n";
  std::vector<std::string> open;
  for (std::size_t i = 0; i < signals_.size(); ++i) {
    Signal& signal = signals_[i];
    signal.id = short_name(i);
    const auto [path, leaf] = split(signal.name);
    std::size_t common = 0;
    while (common < open.size() && common < path.size() && open[common] == path[common]) ++common;
    for (; open.size() > common; open.pop_back()) file_ << "$upscope $end\n";
    for (; open.size() < path.size(); open.push_back(path[open.size()]))
      file_ << "$scope module " << path[open.size()] << " $end\n";
    if (signal.bits == 0)
      file_ << "$var string 1 " << signal.id << ' ' << leaf << " $end\n";
    else
      file_ << "$var wire " << signal.bits << ' ' << signal.id << ' ' << leaf
            << (signal.bits > 1 ? fmt::format(" [{}:0]", signal.bits - 1) : std::string())
            << " $end\n";
  }
  for (; !open.empty(); open.pop_back()) file_ << "$upscope $end\n";
  file_ << "$upscope $end\n$enddefinitions $end\n";
}

void Trace::write(const std::string& value, int bits, const std::string& id) {
  if (bits == 1)
    file_ << value << id << '\n';
  else
    file_ << (bits == 0 ? 's' : 'b') << value << ' ' << id << '\n';
}

Activity Trace::tick(Cycle cycle) {
  if (!started_) {
    // Starts one cycle early, to have a previous sample of the activity counters.
    if (cycle + 1 < options_.from) return kIdle;
    started_ = true;
    collect(cycle);
    write_header();
  }
  if (cycle < options_.from || cycle > options_.to) return kIdle;
  if (cycle == options_.to) {
    flush();
    return kIdle;
  }
  const std::uint64_t edge = clock_.time_of(cycle).value();
  file_ << '#' << edge << '\n';
  write("1", 1, clock_id_);
  write(binary(cycle, 64), 64, cycle_id_);
  for (Signal& signal : signals_) {
    std::string value = signal.sample(cycle);
    if (value == signal.last) continue;
    write(value, signal.bits, signal.id);
    signal.last = std::move(value);
  }
  // A period of one time unit has no half.
  if (const std::uint64_t half = clock_.period().value() / 2; half != 0) {
    file_ << '#' << edge + half << '\n';
    write("0", 1, clock_id_);
  }
  check_file();
  return kBusy;
}

}  // namespace deburr::rtl
