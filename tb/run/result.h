// SPDX-License-Identifier: MIT
// Measurements of a run and their file result.json (schema 4, docs/reference/run.md).
//
// An engine writes the file at the end of a run; `deburr report` and `deburr compare` read it. Keys
// are described in result_description.h. The file stores the unit and the meaning of each value
// under "meaning". For counters and stall causes these come from their declarations.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "tb/run/cost.h"
#include "tb/run/pixel_history.h"

namespace deburr::tb {

inline constexpr int kResultSchema = 4;
// Size limit of JSON files when read.
inline constexpr std::size_t kMaxResultBytes = std::size_t{64} << 20;

enum class Verdict { kPass, kFail, kUnchecked };

struct StallCycles {
  std::string cause, meaning;
  std::uint64_t cycles = 0;
};

// Cycles of one pipeline unit; each cycle is classified exactly once.
struct UnitCycles {
  std::string name;
  std::uint64_t busy = 0, idle = 0;
  std::vector<StallCycles> stalls;
};

// monostate: null in the file, unknown for this run.
using WorkValue = std::variant<std::monostate, std::uint64_t, double, bool>;

// A counter of one engine: "work.<name>".
struct WorkItem {
  std::string name;
  WorkValue value;
  std::string unit, meaning;
};

// The bottleneck of a run: a unit and the stall cause that took these cycles, or "busy" for a unit
// that worked in every cycle without stalls.
struct Bottleneck {
  std::string unit, cause, meaning;
  std::uint64_t cycles = 0;
};

// Finds the bottleneck of a pipeline whose units are listed from input to output; empty if there
// are no cycles. A stall caused by the next unit is attributed to that unit, except at `output`. Of
// all causes with at least half as many cycles as the largest one, the most downstream is chosen,
// since the others echo it. If the first working unit is not stalled, all stalls are ignored and
// the busiest unit is the bottleneck.
std::optional<Bottleneck> find_bottleneck(std::span<const UnitCycles> units,
                                          std::string_view output);

struct LatencyBin {
  std::uint64_t from = 0, count = 0;  // latencies in [from, start of the next bin)
};

struct Latency {
  std::uint64_t min = 0, p50 = 0, p95 = 0, p99 = 0, max = 0;
  std::vector<LatencyBin> histogram;
};

// Comparison of an image with the reference; the input image is compared in the same way. A value
// that does not exist (no edge pixels) is absent. For identical images PSNR is infinite.
struct Quality {
  std::string reference;
  std::optional<double> psnr_db, psnr_edge_db, psnr_silhouette_db;
  std::optional<double> psnr_before_db, psnr_edge_before_db, psnr_silhouette_before_db;
  std::optional<double> flip, flip_before, ssim, ssim_before;
};

// Changes relative to the input image, whether they improve it or not: the percentage of pixels
// that differ by more than a number of codes in R, G or B. It is given for all pixels and for the
// pixels that were right before.
struct Change {
  static constexpr int kSmall = 2, kLarge = 16;  // codes
  double small_percent = 0, large_percent = 0;
  std::optional<double> right_small_percent, right_large_percent;  // only with a reference
  double psnr_db = 0;                                              // relative to the input
};

// A memory of the model and its implementation. Logical bits are those that the design needs;
// physical bits include copies for more read ports and padding of the last bank.
struct MemoryFigures {
  std::string name, content;
  std::string kind;  // "flops", "sram" or "rom"
  std::uint64_t words = 0, word_bits = 0;
  std::string ports;               // "2R1W"
  std::uint64_t read_latency = 0;  // cycles
  std::string built_as;            // "2 copies of 1R1W, 4 banks"
  std::uint64_t copies = 1, banks = 1;
  std::uint64_t logical_bits = 0, physical_bits = 0;
  std::uint64_t register_bits = 0;  // flip-flops in addition to its words
  // Logical bits at the frame width of this run, if the size depends on the width.
  std::uint64_t logical_bits_at_frame_width = 0;
  // Words read and written since reset; the unit that holds it, or its own name; ports.
  std::uint64_t reads = 0, writes = 0;
  std::string owner;
  std::uint64_t read_ports = 0, write_ports = 0;
  std::optional<std::uint64_t> high_water;  // highest occupancy of a FIFO, in words
  std::string not_implementable;            // why no technology offers it; empty: implementable
};

// A link or a FIFO: number of cycles by occupancy, from 0 to its depth.
struct LinkFigures {
  std::string name, full_name;  // full_name: selects it in waveforms
  std::uint64_t beats = 0;      // total
  std::vector<std::uint64_t> cycles;
};

// Summary of a per-pixel map. The map itself is in map_NAME.png and map_NAME.pfm.
struct MapFigures {
  std::string name, title, unit, meaning;
  double min = 0, max = 0, sum = 0;
  std::uint64_t pixels = 0;  // with a value
  std::string account;       // count with which its total was compared; empty: none
};

// Links of an engine, without those inside FIFOs.
struct LinkBits {
  std::uint64_t links = 0, bits = 0;
};

// Bits of all memories of one kind.
struct MemoryBits {
  // "flops", "sram" or "rom"; "total": the sum of these; "registers": flip-flops outside memories;
  // "links".
  std::string_view kind;
  std::uint64_t memories = 0, logical = 0, physical = 0, logical_at_frame_width = 0;
};
// One entry per existing kind, and the total.
std::vector<MemoryBits> memory_bits(std::span<const MemoryFigures> memories, const LinkBits& links);

// A headline figure: the key of a value of the result ("work.frame_cycles") and the key of a value
// to compare it with. Without the second key, against_label is a remark.
struct Figure {
  std::string label, key;
  std::string against_label{}, against{};
  bool tile = false;  // shown as a tile at the top
};

// Comparisons made by one scoreboard, or by all scoreboards of the same name in a composition.
struct ScoreboardFigures {
  std::string name;
  std::uint64_t comparisons = 0, mismatches = 0;
};

// One mismatch: the check, the position in the run ("cycle 812") and the item ("pixel (3, 4)").
struct MismatchLine {
  std::string check, where, item, field, expected, got;
};

// A line of the summary that a run prints: "hits", "98.1 % of lookups".
struct TerminalLine {
  std::string name, text;
};

struct Result {
  std::string unit;
  Verdict verdict = Verdict::kUnchecked;
  std::string reason;  // why it failed or is incomplete; empty otherwise
  bool interrupted = false;
  std::vector<std::string> notes;              // decisions made about inputs
  std::vector<MismatchLine> first_mismatches;  // of each check
  std::vector<ScoreboardFigures> scoreboards;
  std::uint64_t comparisons = 0, mismatches = 0;
  std::uint64_t traffic_comparisons = 0, traffic_mismatches = 0;
  std::uint64_t cycles = 0;
  double clock_mhz = 0;
  double throughput = 0, throughput_bound = 0;
  std::string throughput_unit, throughput_bound_meaning;
  Latency latency;
  std::uint64_t bytes_read = 0, bytes_written = 0, lines_filled = 0;
  std::vector<UnitCycles> units;
  std::optional<Bottleneck> bottleneck;
  std::vector<MemoryFigures> memories;
  LinkBits link_bits;
  std::vector<UnitSheet> sheets;       // of the units built
  std::vector<LinkShape> link_shapes;  // of all links
  std::optional<Cost> cost;
  std::vector<LinkFigures> links;                                // of a run with sampling intervals
  std::vector<MapFigures> maps;                                  // of a run with maps
  std::optional<std::map<std::string, std::uint64_t>> coverage;  // hits by bin; run.coverage
  std::optional<PixelHistory> pixel;                             // of a run with run.pixel
  std::vector<WorkItem> work;
  std::vector<Figure> figures;
  std::vector<TerminalLine> terminal;  // lines of the engine; `work` in the file has their values
  std::optional<Quality> quality;
  std::optional<Change> change;
  double host_seconds = 0, host_cpu_seconds = 0;
  std::vector<std::string> faults;  // injectable faults; only in a description of a model

  double mcycles_per_s() const {
    return host_seconds > 0 ? static_cast<double>(cycles) / host_seconds / 1e6 : 0;
  }
  // Mean data rate over the run at clock_mhz, in 10^9 bytes per second.
  double gb_per_s(std::uint64_t bytes) const {
    return cycles > 0
               ? static_cast<double>(bytes) * clock_mhz / (1000 * static_cast<double>(cycles))
               : 0;
  }
};

nlohmann::ordered_json to_json(const Result& result);

// "name (why)" for each memory in a result.json that cannot be implemented.
std::vector<std::string> not_implementable_memories(const nlohmann::ordered_json& result);

// Reads DIR/result.json, or `path` itself if it is a file, and applies with_infinity(). Throws
// FileError unless it is a complete result of this schema.
nlohmann::ordered_json read_result(const std::filesystem::path& path);

// Restores infinite PSNR values, which the file stores as null for identical images.
template <class Json>
Json with_infinity(Json result) {
  for (const char* const group : {"quality", "change"}) {
    const auto found = result.find(group);
    if (found == result.end() || !found->is_object()) continue;
    const Json flags = found->value("identical", Json::object());
    if (!flags.is_object()) continue;
    for (const auto& [name, identical] : flags.items())
      if (identical == true) (*found)[name] = std::numeric_limits<double>::infinity();
  }
  return result;
}
template <class Json>
bool is_infinite(const Json& value) {
  return value.is_number_float() && std::isinf(value.template get<double>());
}

// Unit and meaning of the keys that every engine writes. "*" replaces a part of a key that depends
// on the run (units, memories).
struct Statistic {
  std::string_view name, unit, meaning;
};
std::span<const Statistic> statistics();
// Entry for a key such as "units.address.busy"; nullptr for an engine's own key.
const Statistic* find_statistic(std::string_view key);

}  // namespace deburr::tb
