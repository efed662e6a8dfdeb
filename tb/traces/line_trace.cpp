// SPDX-License-Identifier: MIT
#include "tb/traces/line_trace.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <iterator>

#include "rtl_model/fabric/lookups.h"
#include "rtl_model/fabric/memory_port.h"
#include "spec/error.h"

namespace deburr::tb::traces {
namespace {

// Bytes of the line that starts `from` bytes after the transaction's address.
std::uint32_t bytes_of_line(const tlm::tlm_generic_payload& payload, std::uint32_t from,
                            std::uint32_t line_bytes) {
  const unsigned char* enables = payload.get_byte_enable_ptr();
  if (enables == nullptr) return line_bytes;
  return static_cast<std::uint32_t>(
      std::count(enables + from, enables + from + line_bytes, TLM_BYTE_ENABLED));
}

std::string padded(std::string text, std::size_t bytes) {
  text.resize(bytes, '\0');
  return text;
}

}  // namespace

LineTrace::LineTrace(const std::filesystem::path& file, const LineTraceOptions& options)
    : options_(options), output_(file) {
  attach_ports();
  if (options.lookups) attach_caches();
  begin();
}

LineTrace::~LineTrace() { detach(); }

void LineTrace::attach_ports() {
  const rtl::ClockDomain* clock = nullptr;
  rtl::for_each<rtl::MemoryPort>([&](rtl::MemoryPort& port) {
    if (clock && clock != &port.clock())
      throw spec::ConfigError(
          fmt::format("run.line_trace: a trace covers one clock domain, but {} belongs to {} and "
                      "{} to {}: trace engines of one domain",
                      ports_.front().name, clock->name(), port.name(), port.clock().name()));
    clock = &port.clock();
    const std::uint32_t line_bytes = port.parameters().line_bytes;
    const auto number = static_cast<std::uint8_t>(ports_.size());
    ports_.push_back({port.name(), line_bytes, false});
    port.observer = [this, number, line_bytes](rtl::Cycle cycle,
                                               const tlm::tlm_generic_payload& payload) {
      const LineEvent event = payload.is_write() ? LineEvent::kWrite : LineEvent::kRead;
      for (std::uint32_t from = 0; from < payload.get_data_length(); from += line_bytes)
        add({cycle, payload.get_address() + from, bytes_of_line(payload, from, line_bytes), event,
             number});
    };
  });
  if (ports_.empty())
    throw spec::ConfigError(
        "run.line_trace: no unit of this build accesses memory: build one that does, or omit the "
        "option");
}

void LineTrace::attach_caches() {
  bool any = false;
  rtl::for_each<rtl::Lookups>([&](rtl::Lookups& cache) {
    const std::uint32_t line_bytes = cache.watched_line_bytes();
    const auto number = static_cast<std::uint8_t>(ports_.size());
    ports_.push_back({dynamic_cast<sc_core::sc_object&>(cache).name(), line_bytes, true});
    any = true;
    // An observer that is already attached is still called.
    cache.observer = [this, number, line_bytes, other = cache.observer](
                         rtl::Cycle cycle, std::uint32_t line, rtl::LookUp outcome) {
      if (other) other(cycle, line, outcome);
      constexpr std::array kEvents = {LineEvent::kHit, LineEvent::kMerged, LineEvent::kMiss};
      add({cycle, std::uint64_t{line} * line_bytes, line_bytes,
           kEvents[static_cast<std::size_t>(outcome)], number});
    };
  });
  if (!any)
    throw spec::ConfigError(
        "run.line_trace_lookups: no cache of this build reports lookups: build one that does, or "
        "omit the option");
}

void LineTrace::detach() {
  rtl::for_each<rtl::MemoryPort>([](rtl::MemoryPort& port) { port.observer = nullptr; });
  rtl::for_each<rtl::Lookups>([](rtl::Lookups& cache) { cache.observer = nullptr; });
}

void LineTrace::begin() {
  std::string& out = output_.buffer();
  if (options_.format == TraceFormat::kBinary) {
    out += binary_header();
    return;
  }
  out += fmt::format("# deburr-lines {}\n# engine {}\n# clock_mhz {}\n", kVersion, options_.engine,
                     options_.clock_mhz);
  for (std::size_t i = 0; i < ports_.size(); ++i)
    out += fmt::format("# port {} {} {} {}\n", i, ports_[i].cache ? "lookups" : "memory",
                       ports_[i].line_bytes, ports_[i].name);
  out += "# clock event address bytes port\n";
}

std::string LineTrace::binary_header() const {
  std::string out(kMagic);
  put_little_endian(out, kVersion);
  put_little_endian(out, static_cast<std::uint32_t>(kHeaderBytes + kPortBytes * ports_.size()));
  put_little_endian(out, static_cast<std::uint32_t>(kRecordBytes));
  put_little_endian(out, static_cast<std::uint32_t>(ports_.size()));
  put_little_endian(out, records_);
  put_double(out, options_.clock_mhz);
  out += padded(options_.engine, 24);
  for (const Port& port : ports_) {
    put_little_endian(out, port.line_bytes);
    put_little_endian(out, static_cast<std::uint32_t>(port.cache ? 1 : 0));
    out += padded(port.name, kPortBytes - 8);
  }
  return out;
}

void LineTrace::add(const Record& record) {
  if (!clock_.empty() && clock_.front().cycle != record.cycle) write_clock();
  clock_.push_back(record);
}

// Sorted by port, so independent of the evaluation order of units.
void LineTrace::write_clock() {
  std::stable_sort(clock_.begin(), clock_.end(),
                   [](const Record& a, const Record& b) { return a.port < b.port; });
  std::string& out = output_.buffer();
  for (const Record& r : clock_) {
    if (options_.format == TraceFormat::kBinary) {
      put_little_endian(out, std::uint64_t{r.cycle});
      put_little_endian(out, r.address);
      put_little_endian(out, r.bytes);
      put_little_endian(out, static_cast<std::uint8_t>(r.event));
      put_little_endian(out, r.port);
      put_little_endian(out, std::uint16_t{0});
    } else {
      fmt::format_to(std::back_inserter(out), "{} {} {:#010x} {} {}\n", r.cycle,
                     kLineEventNames[static_cast<std::size_t>(r.event)], r.address, r.bytes,
                     r.port);
    }
    output_.written();
  }
  records_ += clock_.size();
  clock_.clear();
}

void LineTrace::finish() {
  write_clock();
  detach();
  if (options_.format == TraceFormat::kBinary) {
    output_.finish(binary_header());
    return;
  }
  output_.buffer() += fmt::format("# end {}\n", records_);
  output_.finish();
}

}  // namespace deburr::tb::traces
