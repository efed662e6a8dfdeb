// SPDX-License-Identifier: MIT
// Describes every key of result.json once, in file order, with value, unit and meaning. There are
// two visitors: the writer of the file (result.cpp) and the table of keys (statistics.cpp), from
// which docs/reference/statistics.md is made. A visitor has
//
//   bool has(bool there);           whether to visit an optional part, given whether the run has it
//   void value(std::string_view name, const T& value, std::string_view unit,
//              std::string_view meaning);
//   void group(std::string_view name, body);                 // body() visits the members
//   void each(std::string_view name, const Items& items, key, body);  // body(item); `key` is the
//                                                            // member that names an item
// and, for items that are single values:
//   void item(const T& value, std::string_view unit, std::string_view meaning);
//   void item(value, unit, meaning, own);                    // own: meaning given by the run
//   void declared_item(value, unit, meaning);                // declared by an engine, not listed
//   here
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tb/run/result.h"

namespace deburr::tb {

inline std::string_view name_of(Verdict verdict) {
  constexpr std::array<std::string_view, 3> kNames = {"pass", "fail", "unchecked"};
  return kNames[static_cast<std::size_t>(verdict)];
}

// JSON has no infinity. So the PSNR of identical images is null, and a separate flag says why.
struct PsnrFigure {
  std::string name;
  std::optional<double> db;
  std::string_view meaning;

  std::optional<double> finite() const { return db && std::isfinite(*db) ? db : std::nullopt; }
  bool identical() const { return db && std::isinf(*db); }
};

inline std::vector<PsnrFigure> psnr_figures(const Quality& q) {
  constexpr std::string_view kBefore = "The same for the input picture.";
  return {
      {"psnr_db", q.psnr_db, "PSNR over the frame; null where quality.identical.psnr_db is true."},
      {"psnr_edge_db", q.psnr_edge_db,
       "PSNR over edge pixels: reference and unfiltered input differ by more than 2/255."},
      {"psnr_silhouette_db", q.psnr_silhouette_db,
       "PSNR over edge pixels with a relative depth step of 5 % to a neighbour."},
      {"psnr_before_db", q.psnr_before_db, kBefore},
      {"psnr_edge_before_db", q.psnr_edge_before_db, kBefore},
      {"psnr_silhouette_before_db", q.psnr_silhouette_before_db, kBefore}};
}

inline std::vector<PsnrFigure> psnr_figures(const Change& change) {
  return {{"psnr_db", change.psnr_db,
           "PSNR of the frame relative to the input picture; null where change.identical.psnr_db "
           "is true."}};
}

// Figures derived from the occupancy cycles of a link.
struct LinkOccupancy {
  std::uint64_t depth = 0, occupancy = 0, most = 0;
  double mean = 0, full_percent = 0;
};

inline LinkOccupancy occupancy_of(const LinkFigures& link) {
  LinkOccupancy o;
  if (link.cycles.empty()) return o;
  std::uint64_t all = 0;
  for (std::size_t beats = 0; beats < link.cycles.size(); ++beats) {
    all += link.cycles[beats];
    o.occupancy += beats * link.cycles[beats];
    if (link.cycles[beats] > 0) o.most = beats;
  }
  const auto over_cycles = [&](std::uint64_t sum) {
    return all > 0 ? static_cast<double>(sum) / static_cast<double>(all) : 0.0;
  };
  o.depth = link.cycles.size() - 1;
  o.mean = over_cycles(o.occupancy);
  o.full_percent = 100 * over_cycles(link.cycles.back());
  return o;
}

template <class Visitor>
void describe(const MemoryFigures& m, Visitor& v) {
  v.value("content", m.content, "", "Content of the memory.");
  v.value("kind", m.kind, "", "flops, sram or rom.");
  v.value("words", m.words, "word", "Words, as built.");
  v.value("word_bits", m.word_bits, "bit", "Bits of a word.");
  v.value("ports", m.ports, "", "Read (R), write (W) and shared (RW) accesses per cycle.");
  v.value("read_latency", m.read_latency, "clk",
          "Cycles from a read to its data; 0: the same cycle.");
  v.value("built_as", m.built_as, "", "Memory macros that it is built from.");
  v.value("copies", m.copies, "", "Copies of the content, for additional read ports.");
  v.value("banks", m.banks, "", "Banks that the words are divided into.");
  v.value("logical_bits", m.logical_bits, "bit", "Words x bits of a word.");
  v.value("physical_bits", m.physical_bits, "bit",
          "Bits as built, with copies and the unused words of the last bank.");
  v.value("logical_bits_at_frame_width", m.logical_bits_at_frame_width, "bit",
          "logical_bits if built for the width of this frame.");
  // Flip-flops are seen in every cycle, so a count of reads would say nothing.
  if (v.has(m.kind != "flops")) {
    v.value("reads", m.reads, "word",
            "SRAM and ROM: words read since the last reset; for a FIFO, entries popped.");
    v.value("writes", m.writes, "word",
            "SRAM and ROM: words written since the last reset, without those loaded before the "
            "run; for a "
            "FIFO, entries pushed.");
  }
  if (v.has(m.register_bits != 0))
    v.value("register_bits", m.register_bits, "bit",
            "Additional flip-flops: output registers of a FIFO, arrived bits, and the bypass of an "
            "SRAM that returns the new word of the same cycle.");
  if (v.has(m.high_water.has_value()))
    v.value("high_water", m.high_water.value_or(0), "word",
            "For a FIFO: largest number of entries in a cycle, including the entry read in that "
            "cycle.");
}

template <class Visitor>
void describe(std::string_view name, const Ranged& figure, std::string_view unit,
              std::string_view meaning, Visitor& v) {
  v.group(name, [&] {
    v.value("low", figure.low, unit, "Lower end of its range.");
    v.value("value", figure.value, unit, meaning);
    v.value("high", figure.high, unit, "Upper end of its range.");
  });
}

template <class Visitor>
void describe(const Estimate& estimate, Visitor& v) {
  v.group("estimate", [&] {
    v.value("gates", estimate.gates, "gate",
            "By the sum of operators, also where a row is mapped.");
    v.value("flip_flops", estimate.flip_flops, "bit", "Likewise.");
    v.value("ns", estimate.ns, "ns", "Likewise.");
  });
}

template <class Visitor>
void describe(const Cost& cost, Visitor& v) {
  v.value("technology", cost.technology, "", "Standard cells of gates and nanoseconds.");
  describe("gates", cost.gates, "gate",
           "NAND gates of all units and links, without SRAM and ROM: mapped rows and estimates "
           "(docs/explanation/cost.md).",
           v);
  v.value("flip_flops", cost.flip_flops, "bit", "Flip-flops of all units and links.");
  v.value("memory_bits", cost.memory_bits, "bit", "Bits of SRAM and ROM, as built.");
  describe("ns", cost.ns, "ns", "Longest path of all units.", v);
  describe("clock_mhz", cost.clock_mhz, "MHz", "Clock that the longest path allows.", v);
  if (v.has(cost.frames_per_s.has_value())) {
    describe("frames_per_s", cost.frames_per_s.value_or(Ranged{}), "frame/s",
             "Frames like this one per second at that clock.", v);
    v.value("run_frames_per_s", cost.run_frames_per_s, "frame/s", "The same at run.clock_mhz.");
  }
  v.value("yardstick_ratio", cost.yardstick_ratio, "",
          "Longest path relative to a 24 x 24 multiply of the same technology.");
  v.value("limited_by", cost.limited_by, "", "Unit and stage with the longest path.");
  describe(cost.estimate, v);
  v.each("sram", cost.sram, &SramArea::technology, [&](const SramArea& sram) {
    v.value("mm2", sram.mm2, "mm2", "Area of all SRAM in this technology, fitted.");
  });
  v.each("units", cost.units, &UnitCost::name, [&](const UnitCost& unit) {
    v.value("basis", unit.basis, "",
            "mapped: the row of these parameters in docs/measurements/cost.json; else estimate.");
    describe("gates", unit.gates, "gate", "NAND gates of the unit, without SRAM and ROM.", v);
    v.value("flip_flops", unit.flip_flops, "bit", "Flip-flops of the unit.");
    v.value("memory_bits", unit.memory_bits, "bit", "Bits of its SRAM and ROM, as built.");
    describe("ns", unit.ns, "ns", "Longest path of the unit; 0: none is critical.", v);
    v.value("stage", unit.stage, "", "Stage with the longest path.");
    describe(unit.estimate, v);
  });
}

template <class Visitor>
void describe(const LinkFigures& link, Visitor& v) {
  const LinkOccupancy o = occupancy_of(link);
  v.value("link", link.full_name, "",
          "Full name of a link or of a FIFO's interior, for choosing waves. Present in runs with "
          "run.interval_cycles.");
  v.value("depth", o.depth, "beat", "Capacity.");
  v.value("beats", link.beats, "beat", "Beats written.");
  v.value("occupancy", o.occupancy, "beat x clk",
          "Sum of the number of beats at the end of each cycle.");
  v.value("mean", o.mean, "beat", "Mean occupancy: occupancy / cycles.");
  v.value("most", o.most, "beat", "Largest number of beats at the end of a cycle.");
  v.value("full_percent", o.full_percent, "%", "Cycles that ended with a full link.");
  v.value("histogram", link.cycles, "clk", "Cycles by number of beats, from 0 to depth.");
}

template <class Visitor>
void describe(const MapFigures& m, Visitor& v) {
  constexpr std::string_view kUnit = "see maps.*.unit";
  v.value("title", m.title, "", "Title of a map of the picture, in runs with run.maps.");
  v.value("meaning", m.meaning, "", "Meaning of its values.");
  v.value("unit", m.unit, "", "Unit of its values.");
  v.value("picture", "map_" + m.name + ".png", "", "File in false colours, with the scale.");
  v.value("values", "map_" + m.name + ".pfm", "",
          "File of the values: portable float map, one 32-bit float per pixel, rows from the "
          "bottom; NaN: no value.");
  v.value("pixels", m.pixels, "pixel", "Pixels with a value.");
  v.value("min", m.min, kUnit, "Smallest value.");
  v.value("max", m.max, kUnit, "Largest value.");
  v.value("mean", m.pixels > 0 ? m.sum / static_cast<double>(m.pixels) : 0.0, kUnit,
          "Mean of the pixels with a value.");
  v.value("sum", m.sum, kUnit, "Sum of all values.");
  v.value("checked_against", m.account, "",
          "Counter of the model that the map must add up to; empty: none.");
}

template <class Visitor>
void describe(const PixelHistory& p, Visitor& v) {
  v.value("x", p.pixel.x, "pixel", "Column of the pixel of run.pixel, from the left.");
  v.value("y", p.pixel.y, "pixel", "Its row, from the top.");
  v.value("note", p.note, "", "Why its history is empty or incomplete; empty: it is complete.");
  v.value("differences", p.differences(), "", "Steps in which hardware and golden model differ.");
  v.value("steps", p.steps, "",
          "History of the pixel, in order: part (which engine), step, item, value of the golden "
          "model and of the hardware (empty: unknown there), cycle of the simulation (clock; null: "
          "none), and whether they differ.");
}

template <class Visitor>
void describe(const Quality& q, Visitor& v) {
  const std::vector<PsnrFigure> figures = psnr_figures(q);
  v.value("reference", q.reference, "", "Reference that the picture is compared with.");
  for (const PsnrFigure& psnr : figures) v.value(psnr.name, psnr.finite(), "dB", psnr.meaning);
  v.each("identical", figures, &PsnrFigure::name, [&](const PsnrFigure& psnr) {
    v.item(psnr.identical(), "",
           "Whether the pictures are equal in every pixel that this PSNR counts; the infinite PSNR "
           "is then null. If the PSNR is null without this flag, no pixel counts.");
  });
  constexpr std::string_view kBefore = "The same for the input picture.";
  v.value("flip", q.flip, "",
          "FLIP over the frame, 0 (equal) to 1: Andersson et al. 2020, for 67 pixels per degree.");
  v.value("flip_before", q.flip_before, "", kBefore);
  v.value("ssim", q.ssim, "",
          "SSIM of luma over the frame, at most 1 (equal): Wang et al. 2004, full size; null if a "
          "side is shorter than its window of 11 pixels.");
  v.value("ssim_before", q.ssim_before, "", kBefore);
}

template <class Visitor>
void describe(const Change& c, Visitor& v) {
  v.value("over_2_percent", c.small_percent, "%",
          "Pixels that differ from the input by more than 2 codes in R, G or B.");
  v.value("over_16_percent", c.large_percent, "%", "The same for more than 16 codes.");
  v.value("right_over_2_percent", c.right_small_percent, "%",
          "Pixels that the engine changes by more than 2 codes although the input is within 2 "
          "codes of the reference; null without a reference.");
  v.value("right_over_16_percent", c.right_large_percent, "%", "The same for more than 16 codes.");
  const std::vector<PsnrFigure> figures = psnr_figures(c);
  for (const PsnrFigure& psnr : figures) v.value(psnr.name, psnr.finite(), "dB", psnr.meaning);
  v.each("identical", figures, &PsnrFigure::name, [&](const PsnrFigure& psnr) {
    v.item(psnr.identical(), "",
           "Whether no pixel was changed; the infinite PSNR of this name is then null.");
  });
}

template <class Visitor>
void describe(const Result& r, Visitor& v) {
  v.value("schema", kResultSchema, "", "Version of this file's layout.");
  v.value("unit", r.unit, "", "The engine that ran.");
  v.value("verdict", name_of(r.verdict), "",
          "pass, fail, or unchecked (run without golden model).");
  if (v.has(!r.reason.empty()))
    v.value("reason", r.reason, "", "Why the run failed or is incomplete.");
  if (v.has(r.interrupted))
    v.value("interrupted", true, "",
            "The run was ended by a signal; counters cover the cycles until then.");
  v.group("checks", [&] {
    v.value("comparisons", r.comparisons, "value", "Outputs compared with the golden model.");
    v.value("mismatches", r.mismatches, "value", "Outputs that differ from the golden model.");
    v.value("traffic_comparisons", r.traffic_comparisons, "line",
            "Memory accesses compared with the golden model's prediction, in order.");
    v.value("traffic_mismatches", r.traffic_mismatches, "line",
            "Memory accesses that differ from the prediction.");
  });
  v.each("scoreboards", r.scoreboards, &ScoreboardFigures::name,
         [&](const ScoreboardFigures& board) {
           v.value("comparisons", board.comparisons, "value",
                   "Outputs that one scoreboard compared with the golden model.");
           v.value("mismatches", board.mismatches, "value",
                   "Outputs of this scoreboard that differ or are missing.");
         });
  v.value("cycles", r.cycles, "clk", "From the end of reset to the last output.");
  v.value("clock_mhz", r.clock_mhz, "MHz", "Clock frequency for which rates and times are given.");
  v.group("throughput", [&] {
    v.value("value", r.throughput, "see throughput.unit", "Work per cycle, over the whole run.");
    v.value("unit", r.throughput_unit, "", "Unit of the rate.");
    v.value("bound", r.throughput_bound, "see throughput.unit", "Upper bound of the throughput.");
    v.value("bound_meaning", r.throughput_bound_meaning, "", "Origin of the bound.");
  });
  v.group("latency", [&] {
    v.value("unit", "clk", "", "Unit of the latencies.");
    v.value("min", r.latency.min, "clk",
            "Shortest latency of a transaction, input taken to output.");
    v.value("p50", r.latency.p50, "clk", "Half of all transactions are at most this slow.");
    v.value("p95", r.latency.p95, "clk", "95 % of all transactions are at most this slow.");
    v.value("p99", r.latency.p99, "clk", "99 % of all transactions are at most this slow.");
    v.value("max", r.latency.max, "clk", "Longest latency of a transaction.");
    v.value("histogram", r.latency.histogram, "clk, transactions",
            "Bins: transactions with a latency of at least `from` and below the next bin's.");
  });
  v.group("memory", [&] {
    v.value("bytes_read", r.bytes_read, "byte", "Bytes read from memory.");
    v.value("bytes_written", r.bytes_written, "byte", "Bytes written to memory.");
    v.value("read_gb_per_s", r.gb_per_s(r.bytes_read), "GB/s",
            "Mean read rate at clock_mhz, over the whole run; 10^9 bytes per second.");
    v.value("written_gb_per_s", r.gb_per_s(r.bytes_written), "GB/s",
            "Mean write rate at clock_mhz, over the whole run; 10^9 bytes per second.");
    v.value("lines_filled", r.lines_filled, "line",
            "Lines read from memory: cache lines, or lines of a frame stored there.");
  });
  v.each("units", r.units, &UnitCycles::name, [&](const UnitCycles& unit) {
    v.value("busy", unit.busy, "clk",
            "Cycles in which the unit did work, on at least one lane, or had work in progress.");
    v.value("idle", unit.idle, "clk",
            "Cycles without work, or with nothing to do but wait for memory responses.");
    v.each("stalls", unit.stalls, &StallCycles::cause, [&](const StallCycles& stall) {
      v.item(stall.cycles, "clk", "Cycles in which the unit had work but could do none of it.",
             stall.meaning);
    });
  });
  if (v.has(r.bottleneck.has_value()))
    v.group("bottleneck", [&] {
      const Bottleneck b = r.bottleneck.value_or(Bottleneck{});
      v.value("unit", b.unit, "", "Unit that limits the run.");
      v.value("cause", b.cause, "",
              "Its stall cause, or busy if it is limited by its own throughput.");
      v.value("cycles", b.cycles, "clk", "Cycles of that unit with this cause.");
      v.value("meaning", b.meaning, "", "Meaning of the cause.");
    });
  v.each("memories", r.memories, &MemoryFigures::name,
         [&](const MemoryFigures& m) { describe(m, v); });
  const std::vector<MemoryBits> sums = memory_bits(r.memories, r.link_bits);
  v.each("memory_bits", sums, &MemoryBits::kind, [&](const MemoryBits& bits) {
    v.value("memories", bits.memories, "",
            "Number of memories of a kind (flops, sram, rom) and of all (total). Separately: "
            "memories with additional flip-flops (registers), and links (links).");
    v.value("logical", bits.logical, "bit", "Logical bits of the memories.");
    v.value("physical", bits.physical, "bit", "Physical bits of the memories.");
    v.value("logical_at_frame_width", bits.logical_at_frame_width, "bit",
            "Logical bits of the memories for the width of this frame.");
  });
  if (v.has(r.cost.has_value())) v.group("cost", [&] { describe(r.cost.value_or(Cost{}), v); });
  std::vector<MemoryFigures> not_implementable = r.memories;
  std::erase_if(not_implementable,
                [](const MemoryFigures& m) { return m.not_implementable.empty(); });
  if (v.has(!not_implementable.empty()))
    v.each(
        "not_implementable", not_implementable, &MemoryFigures::name, [&](const MemoryFigures& m) {
          v.item(m.not_implementable, "",
                 "Why this memory is not implementable. The result then belongs to hardware that "
                 "cannot be built.");
        });
  if (v.has(!r.links.empty()))
    v.each("links", r.links, &LinkFigures::name,
           [&](const LinkFigures& link) { describe(link, v); });
  if (v.has(!r.maps.empty()))
    v.each("maps", r.maps, &MapFigures::name, [&](const MapFigures& m) { describe(m, v); });
  if (v.has(r.pixel.has_value()))
    v.group("pixel", [&] { describe(r.pixel.value_or(PixelHistory{}), v); });
  v.each("work", r.work, &WorkItem::name,
         [&](const WorkItem& item) { v.declared_item(item.value, item.unit, item.meaning); });
  if (v.has(!r.notes.empty()))
    v.value("notes", r.notes, "", "Conversions of inputs, such as 16 to 8 bits.");
  if (v.has(!r.first_mismatches.empty()))
    v.value("first_mismatches", r.first_mismatches, "",
            "First mismatches of each check: place, item and field, expected and actual value.");
  v.value("figures", r.figures, "", "Most important keys of this file.");
  if (v.has(r.quality.has_value()))
    v.group("quality", [&] { describe(r.quality.value_or(Quality{}), v); });
  if (v.has(r.change.has_value()))
    v.group("change", [&] { describe(r.change.value_or(Change{}), v); });
  v.group("host", [&] {
    v.value("seconds", r.host_seconds, "s", "Wall-clock time of the simulation, without set-up.");
    v.value("mcycles_per_s", r.mcycles_per_s(), "Mcycle/s",
            "Simulated cycles per second of wall-clock time.");
    v.value("cpu_seconds", r.host_cpu_seconds, "s", "CPU time of the simulation.");
  });
  if (v.has(r.coverage.has_value()))
    v.group("coverage", [&] {
      v.value("bins", r.coverage.value_or(std::map<std::string, std::uint64_t>{}), "hit",
              "Functional coverage, in runs with run.coverage: every bin of the run's engines "
              "(docs/reference/coverage.md) with its hits; 0: a hole. Runs are merged by adding "
              "their hits.");
    });
}

}  // namespace deburr::tb
