// SPDX-License-Identifier: MIT
// What result.json holds, described once: every key in the order of the file, with its value, unit
// and meaning. Consumers are visitors: the writer of the file (result.cpp) and the table of its
// keys (statistics.cpp), from which docs/reference/statistics.md is made. A visitor has
//
//   bool has(bool there);           whether to visit what a run has or has not
//   void value(std::string_view name, const T& value, std::string_view unit,
//              std::string_view meaning);
//   void group(std::string_view name, body);                 // body() visits what is inside
//   void each(std::string_view name, const Items& items, key, body);  // body(item); `key` is the
//                                                            // member that names an item
// and, for an item that is one value:
//   void item(const T& value, std::string_view unit, std::string_view meaning);
//   void item(value, unit, meaning, own);                    // own: what the run says it means
//   void declared_item(value, unit, meaning);                // an engine's own, in no table here
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

// JSON has no infinity: a PSNR of identical pictures is null, and a flag of its name says why.
struct PsnrFigure {
  std::string name;
  std::optional<double> db;
  std::string_view meaning;

  std::optional<double> finite() const { return db && std::isfinite(*db) ? db : std::nullopt; }
  bool identical() const { return db && std::isinf(*db); }
};

inline std::vector<PsnrFigure> psnr_figures(const Quality& q) {
  constexpr std::string_view kBefore = "The same of the picture that went in.";
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
           "PSNR over the frame to the picture that went in; null where "
           "change.identical.psnr_db is true."}};
}

// What follows from the cycles of a link.
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
  v.value("content", m.content, "", "What a memory of the model holds.");
  v.value("kind", m.kind, "", "flops, sram or rom.");
  v.value("words", m.words, "word", "Words, as built.");
  v.value("word_bits", m.word_bits, "bit", "Bits of a word.");
  v.value("ports", m.ports, "", "Reads (R), writes (W) and either (RW) in a clock.");
  v.value("read_latency", m.read_latency, "clk", "From a read to its word; 0: the same clock.");
  v.value("built_as", m.built_as, "", "The memories that can be bought, from which it is made.");
  v.value("copies", m.copies, "", "Copies with the same words, for more read ports.");
  v.value("banks", m.banks, "", "Banks that share the words.");
  v.value("logical_bits", m.logical_bits, "bit", "Words x bits of a word.");
  v.value("physical_bits", m.physical_bits, "bit",
          "Bits that are built: with copies, and with the words that fill up the last bank.");
  v.value("logical_bits_at_frame_width", m.logical_bits_at_frame_width, "bit",
          "logical_bits if it were built for the width of this frame.");
  if (v.has(m.register_bits != 0))
    v.value("register_bits", m.register_bits, "bit",
            "Flip-flops beside its words: output registers of a FIFO, arrived bits, and of SRAM "
            "that gives the word of the same clock the bypass.");
  if (v.has(m.high_water.has_value()))
    v.value("high_water", m.high_water.value_or(0), "word",
            "Most entries in a clock, with what leaves in it; of a FIFO.");
}

template <class Visitor>
void describe(const LinkFigures& link, Visitor& v) {
  const LinkOccupancy o = occupancy_of(link);
  v.value("link", link.full_name, "",
          "Full name of a link or of what is inside a FIFO, to choose waves by. Links are there in "
          "runs with run.interval_cycles.");
  v.value("depth", o.depth, "beat", "Beats that it holds.");
  v.value("beats", link.beats, "beat", "Beats that went in.");
  v.value("occupancy", o.occupancy, "beat x clk", "Beats inside at the end of each clock, summed.");
  v.value("mean", o.mean, "beat", "Occupancy over cycles.");
  v.value("most", o.most, "beat", "Most beats inside at the end of a clock.");
  v.value("full_percent", o.full_percent, "%", "Cycles at whose end it was full.");
  v.value("histogram", link.cycles, "clk",
          "Cycles by the number of beats inside, from 0 to depth.");
}

template <class Visitor>
void describe(const MapFigures& m, Visitor& v) {
  constexpr std::string_view kUnit = "see maps.*.unit";
  v.value("title", m.title, "", "Of a map over the picture, in runs with run.maps.");
  v.value("meaning", m.meaning, "", "What its values are.");
  v.value("unit", m.unit, "", "Unit of its values.");
  v.value("picture", "map_" + m.name + ".png", "", "File in false colours, with the scale.");
  v.value("values", "map_" + m.name + ".pfm", "",
          "File of the values: portable float map, a 32-bit float a pixel, rows from the bottom; "
          "NaN where there is nothing.");
  v.value("pixels", m.pixels, "pixel", "Pixels with a value.");
  v.value("min", m.min, kUnit, "Smallest value.");
  v.value("max", m.max, kUnit, "Largest value.");
  v.value("mean", m.pixels > 0 ? m.sum / static_cast<double>(m.pixels) : 0.0, kUnit,
          "Mean of the pixels with a value.");
  v.value("sum", m.sum, kUnit, "Sum of all values.");
  v.value("checked_against", m.account, "",
          "What the model counted by itself, and the map had to come to; empty: nothing.");
}

template <class Visitor>
void describe(const PixelHistory& p, Visitor& v) {
  v.value("x", p.pixel.x, "pixel", "Column of the pixel of run.pixel, from the left.");
  v.value("y", p.pixel.y, "pixel", "Its row, from the top.");
  v.value("note", p.note, "", "Why its history is empty or not whole; empty: it is whole.");
  v.value("differences", p.differences(), "", "Steps in which the hardware is not as golden.");
  v.value("steps", p.steps, "",
          "What happened to the pixel, in order: part (which of several), step, item, what golden "
          "and the hardware have (empty: it is not known there), clock (of the simulation, null: "
          "none), and whether they differ.");
}

template <class Visitor>
void describe(const Quality& q, Visitor& v) {
  const std::vector<PsnrFigure> figures = psnr_figures(q);
  v.value("reference", q.reference, "", "What the picture is compared with.");
  for (const PsnrFigure& psnr : figures) v.value(psnr.name, psnr.finite(), "dB", psnr.meaning);
  v.each("identical", figures, &PsnrFigure::name, [&](const PsnrFigure& psnr) {
    v.item(psnr.identical(), "",
           "Whether both pictures agree in each pixel that counts for the PSNR of this name, which "
           "would be infinite and is null. Null without it: there is no such pixel.");
  });
  constexpr std::string_view kBefore = "The same of the picture that went in.";
  v.value("flip", q.flip, "",
          "FLIP over the frame, 0 (equal) to 1: Andersson et al. 2020, its screen of 67 pixels a "
          "degree.");
  v.value("flip_before", q.flip_before, "", kBefore);
  v.value("ssim", q.ssim, "",
          "SSIM of luma over the frame, at most 1 (equal): Wang et al. 2004, full size; null where "
          "a side is below its window of 11 pixels.");
  v.value("ssim_before", q.ssim_before, "", kBefore);
}

template <class Visitor>
void describe(const Change& c, Visitor& v) {
  v.value("over_2_percent", c.small_percent, "%",
          "Pixels that differ from what went in by more than 2 codes in R, G or B.");
  v.value("over_16_percent", c.large_percent, "%", "The same by more than 16 codes.");
  v.value(
      "right_over_2_percent", c.right_small_percent, "%",
      "Of the pixels that were right before, within 2 codes of the reference: those that differ "
      "from what went in by more than 2 codes; null without a reference.");
  v.value("right_over_16_percent", c.right_large_percent, "%", "The same by more than 16 codes.");
  const std::vector<PsnrFigure> figures = psnr_figures(c);
  for (const PsnrFigure& psnr : figures) v.value(psnr.name, psnr.finite(), "dB", psnr.meaning);
  v.each("identical", figures, &PsnrFigure::name, [&](const PsnrFigure& psnr) {
    v.item(psnr.identical(), "",
           "Whether nothing was changed, so that the PSNR of this name would be infinite and is "
           "null.");
  });
}

template <class Visitor>
void describe(const Result& r, Visitor& v) {
  v.value("schema", kResultSchema, "", "Version of this file's layout.");
  v.value("unit", r.unit, "", "The engine that ran.");
  v.value("verdict", name_of(r.verdict), "",
          "pass, fail, or unchecked when no golden model ran beside it.");
  if (v.has(!r.reason.empty()))
    v.value("reason", r.reason, "", "Why the run failed or is not complete.");
  if (v.has(r.interrupted))
    v.value("interrupted", true, "",
            "The run was ended by a signal; counters cover what was done.");
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
                   "What one scoreboard compared with golden.");
           v.value("mismatches", board.mismatches, "value", "What of it differs, or never came.");
         });
  v.value("cycles", r.cycles, "clk", "From the end of reset to the last output.");
  v.value("clock_mhz", r.clock_mhz, "MHz", "Clock that rates and times are quoted for.");
  v.group("throughput", [&] {
    v.value("value", r.throughput, "see throughput.unit", "Work over cycles of the whole run.");
    v.value("unit", r.throughput_unit, "", "Unit of the rate.");
    v.value("bound", r.throughput_bound, "see throughput.unit",
            "What the hardware could do at best.");
    v.value("bound_meaning", r.throughput_bound_meaning, "", "Where the bound comes from.");
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
            "Mean rate of reads at clock_mhz, over the whole run; 10^9 bytes a second.");
    v.value("written_gb_per_s", r.gb_per_s(r.bytes_written), "GB/s",
            "Mean rate of writes at clock_mhz, over the whole run; 10^9 bytes a second.");
    v.value("lines_filled", r.lines_filled, "line",
            "Reads of memory: lines of the cache, or of the frame where it waits in memory.");
  });
  v.each("units", r.units, &UnitCycles::name, [&](const UnitCycles& unit) {
    v.value("busy", unit.busy, "clk",
            "Cycles in which the unit did work, on one lane at least, or had some under way.");
    v.value("idle", unit.idle, "clk",
            "Cycles in which the unit had nothing to do, or only waited for answers of memory.");
    v.each("stalls", unit.stalls, &StallCycles::cause, [&](const StallCycles& stall) {
      v.item(stall.cycles, "clk", "Cycles in which the unit had work and could do none of it.",
             stall.meaning);
    });
  });
  if (v.has(r.bottleneck.has_value()))
    v.group("bottleneck", [&] {
      const Bottleneck b = r.bottleneck.value_or(Bottleneck{});
      v.value("unit", b.unit, "", "The unit that held the run back most.");
      v.value("cause", b.cause, "", "Its stall cause, or busy where it worked all the time.");
      v.value("cycles", b.cycles, "clk", "Cycles of that unit that went there.");
      v.value("meaning", b.meaning, "", "What the cause means.");
    });
  v.each("memories", r.memories, &MemoryFigures::name,
         [&](const MemoryFigures& m) { describe(m, v); });
  const std::vector<MemoryBits> sums = memory_bits(r.memories, r.link_bits);
  v.each("memory_bits", sums, &MemoryBits::kind, [&](const MemoryBits& bits) {
    v.value("memories", bits.memories, "",
            "Memories of a kind (flops, sram, rom), and of all of these (total); beside the total "
            "memories with registers beside their words (registers), and links (links).");
    v.value("logical", bits.logical, "bit", "Their logical bits.");
    v.value("physical", bits.physical, "bit", "Their physical bits.");
    v.value("logical_at_frame_width", bits.logical_at_frame_width, "bit",
            "Their logical bits for the width of this frame.");
  });
  std::vector<MemoryFigures> not_implementable = r.memories;
  std::erase_if(not_implementable,
                [](const MemoryFigures& m) { return m.not_implementable.empty(); });
  if (v.has(!not_implementable.empty()))
    v.each("idealised", not_implementable, &MemoryFigures::name, [&](const MemoryFigures& m) {
      v.item(m.not_implementable, "",
             "Why no technology offers this memory. Such a result is of no hardware that can be "
             "built.");
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
    v.value("notes", r.notes, "", "What had to be decided about an input, such as 16 bits made 8.");
  if (v.has(!r.first_mismatches.empty()))
    v.value("first_mismatches", r.first_mismatches, "",
            "The first mismatches of each check: where, which item and field, expected and got.");
  v.value("figures", r.figures, "", "Keys of this file that a reader looks for first.");
  if (v.has(r.quality.has_value()))
    v.group("quality", [&] { describe(r.quality.value_or(Quality{}), v); });
  if (v.has(r.change.has_value()))
    v.group("change", [&] { describe(r.change.value_or(Change{}), v); });
  v.group("host", [&] {
    v.value("seconds", r.host_seconds, "s",
            "Time of the simulation on this host, set-up not included.");
    v.value("mcycles_per_s", r.mcycles_per_s(), "Mcycle/s",
            "Simulated cycles a second of host time.");
    v.value("cpu_seconds", r.host_cpu_seconds, "s",
            "The same as time of the processor: not that of other programs.");
  });
  if (v.has(r.coverage.has_value()))
    v.group("coverage", [&] {
      v.value("bins", r.coverage.value_or(std::map<std::string, std::uint64_t>{}), "hit",
              "Functional coverage, in runs with run.coverage: every bin of the run's engines "
              "(docs/reference/coverage.md) with how often it was met; 0: a hole. A merge of runs "
              "is a sum.");
    });
}

}  // namespace deburr::tb
