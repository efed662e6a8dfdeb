// SPDX-License-Identifier: MIT
// What a run measured, and its file result.json (schema 4, docs/reference/run.md).
//
// Written by an engine at the end of a run, read by `deburr report` and `deburr compare`. Its keys
// are described in result_description.h. Unit and meaning of each travel with the file, under
// "meaning"; those of an engine's counters and stall causes come from their declaration.
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

#include "tb/run/pixel_history.h"

namespace deburr::tb {

inline constexpr int kResultSchema = 4;
// No reader takes more of one of our JSON files.
inline constexpr std::size_t kMaxResultBytes = std::size_t{64} << 20;

enum class Verdict { kPass, kFail, kUnchecked };

struct StallCycles {
  std::string cause, meaning;
  std::uint64_t cycles = 0;
};

// One pipeline unit's cycles, each classified exactly once.
struct UnitCycles {
  std::string name;
  std::uint64_t busy = 0, idle = 0;
  std::vector<StallCycles> stalls;
};

// null in the file: not known of this run.
using WorkValue = std::variant<std::monostate, std::uint64_t, double, bool>;

// A counter of one engine: "work.<name>".
struct WorkItem {
  std::string name;
  WorkValue value;
  std::string unit, meaning;
};

// What held the run back: the unit, and the stall cause that took these cycles, or "busy" where
// nothing stalled it and it did a clock's work in each of them.
struct Bottleneck {
  std::string unit, cause, meaning;
  std::uint64_t cycles = 0;
};

// The bottleneck among a pipeline's units, given from its input to its output; nothing for no
// cycles. Waiting for the next unit is that unit's matter, except at `output`. Of the causes that
// took at least half as much as the largest one the deepest counts: those before it are its echo.
// Where the first working unit is not held back, no stall matters and the busiest unit counts.
std::optional<Bottleneck> find_bottleneck(std::span<const UnitCycles> units,
                                          std::string_view output);

struct LatencyBin {
  std::uint64_t from = 0, count = 0;  // cycles >= from, below the next bin's
};

struct Latency {
  std::uint64_t min = 0, p50 = 0, p95 = 0, p99 = 0, max = 0;
  std::vector<LatencyBin> histogram;
};

// Against a picture taken as reference, with the picture that went in beside it; a value that does
// not exist (no edge pixels) is absent, and one of identical pictures is infinite.
struct Quality {
  std::string reference;
  std::optional<double> psnr_db, psnr_edge_db, psnr_silhouette_db;
  std::optional<double> psnr_before_db, psnr_edge_before_db, psnr_silhouette_before_db;
  std::optional<double> flip, flip_before, ssim, ssim_before;
};

// What was made of the picture that went in, right or wrong: shares of pixels that differ from it
// by more than so many codes in R, G or B, of all and of those that were right before.
struct Change {
  static constexpr int kSmall = 2, kLarge = 16;  // codes
  double small_percent = 0, large_percent = 0;
  std::optional<double> right_small_percent, right_large_percent;  // there was a reference
  double psnr_db = 0;                                              // to what went in
};

// A memory of the model and what it is built from. Logical bits are what the design asks for;
// physical ones include copies for more read ports and the words that fill up the last bank.
struct MemoryFigures {
  std::string name, content;
  std::string kind;  // "flops", "sram" or "rom"
  std::uint64_t words = 0, word_bits = 0;
  std::string ports;               // "2R1W"
  std::uint64_t read_latency = 0;  // cycles
  std::string built_as;            // "2 copies of 1R1W, 4 banks"
  std::uint64_t copies = 1, banks = 1;
  std::uint64_t logical_bits = 0, physical_bits = 0;
  std::uint64_t register_bits = 0;  // flip-flops beside its words
  // Logical bits for frames of the width that this run had, where the size goes with the width.
  std::uint64_t logical_bits_at_frame_width = 0;
  std::optional<std::uint64_t> high_water;  // most words in a clock, of a FIFO
  std::string not_implementable;            // why no technology offers it; empty: it can be built
};

// A link or a FIFO: cycles by the number of beats inside, from 0 to its depth.
struct LinkFigures {
  std::string name, full_name;  // full_name: what waves are chosen by
  std::uint64_t beats = 0;      // in all
  std::vector<std::uint64_t> cycles;
};

// A map over the picture: its files are map_NAME.png and map_NAME.pfm.
struct MapFigures {
  std::string name, title, unit, meaning;
  double min = 0, max = 0, sum = 0;
  std::uint64_t pixels = 0;  // with a value
  std::string account;       // what the values were checked against; empty: nothing
};

// The links of an engine, those inside of FIFOs left out.
struct LinkBits {
  std::uint64_t links = 0, bits = 0;
};

// Bits of all memories of a kind.
struct MemoryBits {
  // "total": of flops, sram and rom. Beside it "registers": flip-flops beside memories; "links".
  std::string_view kind;
  std::uint64_t memories = 0, logical = 0, physical = 0, logical_at_frame_width = 0;
};
// Of every kind that there is, and the total.
std::vector<MemoryBits> memory_bits(std::span<const MemoryFigures> memories, const LinkBits& links);

// What a reader looks for first: a value of the result by its key ("work.frame_cycles"), beside
// one that it should be compared with; without such a key, against_label is a remark.
struct Figure {
  std::string label, key;
  std::string against_label{}, against{};
  bool tile = false;  // among the large numbers at the top
};

// What one scoreboard compared, or all of that name in a composition.
struct ScoreboardFigures {
  std::string name;
  std::uint64_t comparisons = 0, mismatches = 0;
};

// One mismatch: which check, where in the run ("cycle 812"), which item ("pixel (3, 4)").
struct MismatchLine {
  std::string check, where, item, field, expected, got;
};

// A line of what a run says at its end: "hits", "98.1 % of look-ups".
struct TerminalLine {
  std::string name, text;
};

struct Result {
  std::string unit;
  Verdict verdict = Verdict::kUnchecked;
  std::string reason;  // why it failed or is not complete; empty otherwise
  bool interrupted = false;
  std::vector<std::string> notes;              // what had to be decided about an input
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
  std::vector<LinkFigures> links;                                // of a run with windows
  std::vector<MapFigures> maps;                                  // of a run with maps
  std::optional<std::map<std::string, std::uint64_t>> coverage;  // hits by bin; run.coverage
  std::optional<PixelHistory> pixel;                             // of a run with run.pixel
  std::vector<WorkItem> work;
  std::vector<Figure> figures;
  std::vector<TerminalLine> terminal;  // the engine's own; the file has their figures in `work`
  std::optional<Quality> quality;
  std::optional<Change> change;
  double host_seconds = 0, host_cpu_seconds = 0;
  std::vector<std::string> faults;  // that can be injected; of a model that is described, not run

  double mcycles_per_s() const {
    return host_seconds > 0 ? static_cast<double>(cycles) / host_seconds / 1e6 : 0;
  }
  // Mean rate over the run, at clock_mhz; 10^9 bytes a second.
  double gb_per_s(std::uint64_t bytes) const {
    return cycles > 0
               ? static_cast<double>(bytes) * clock_mhz / (1000 * static_cast<double>(cycles))
               : 0;
  }
};

nlohmann::ordered_json to_json(const Result& result);

// "name (why)" of each idealised memory of a result.json.
std::vector<std::string> not_implementable_memories(const nlohmann::ordered_json& result);

// Reads DIR/result.json (or the file itself) and checks that it is a complete result of this
// schema: FileError otherwise.
// What is said of with_infinity() has been done.
nlohmann::ordered_json read_result(const std::filesystem::path& path);

// A result as readers work with it: a PSNR that is null in the file since the pictures are
// identical is infinite.
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

// Unit and meaning of the keys that every engine writes. "*" stands for one part of a key that a
// run makes (units, memories).
struct Statistic {
  std::string_view name, unit, meaning;
};
std::span<const Statistic> statistics();
// The entry for a key such as "units.address.busy"; nullptr when it is an engine's own.
const Statistic* find_statistic(std::string_view key);

}  // namespace deburr::tb
