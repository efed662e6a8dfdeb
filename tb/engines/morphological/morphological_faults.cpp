// SPDX-License-Identifier: MIT
#include "tb/engines/morphological/morphological_faults.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <utility>

#include "rtl_model/platform/morphological_records.h"
#include "spec/error.h"

namespace deburr::tb {
namespace {

// Largest threshold T and largest floor, U8.16.
constexpr std::int32_t kMostThreshold = (1 << spec::morphological::kThresholdBits) - 1;

}  // namespace

std::vector<InjectedFault> MorphologicalFaults::list() const {
  const int width = frames_.empty() ? 1 : frames_.front().image.width;
  const std::uint64_t row = platform::beats_a_row(width, platform::lanes_of(setup_.morphological));
  const std::string memory = setup_.morphological.storage == spec::morphological::Storage::kMemory
                                 ? ""
                                 : "morphological.storage = memory";
  const std::string guard =
      setup_.morphological.text_guard ? "" : "morphological.text_guard = true";
  std::vector<InjectedFault> list = {
      {"flip-bit", "Flips a bit of the red channel of output beat 100.",
       "flip:blended:100:pixel.0.r.4"},
      {"drop-pixel", "Drops output beat 100.", "drop:blended:100"},
      {"duplicate-pixel", "Delivers output beat 100 twice.", "duplicate:blended:100"},
      {"drop-input", "Drops input beat 50 on its way into the engine.", "drop:pixels:50"},
      {"wrong-edge", "Flips the left edge of a pixel in row 1, after the edge detector.",
       fmt::format("flip:morphological.edge_bits:{}:left", 2 * row + row / 2)},
      {"wrong-rule", "The engine tries one step less than was ordered.", "",
       setup_.morphological.steps > 0 ? "" : "morphological.steps of at least 1"},
      {"wrong-guard", "The text guard is off.", "", guard},
      {"flip-guard", "Flips the text guard's bit of a pixel in row 10.",
       fmt::format("flip:morphological.text_guard.guards_entries:{}:guarded.0", 10 * row + row / 2),
       guard},
      {"stuck-ready", "Holds back the slots of the luma unit from cycle 500 on.",
       "stuck_ready:morphological.slots:500"},
      {"duplicate-fetch", "Sends memory request 20 twice.",
       fmt::format("duplicate:morphological.requests:{}", kFaultyRequest), memory}};
  for (InjectedFault& fault : memory_faults(memory)) list.push_back(std::move(fault));
  for (InjectedFault& fault : smaa_faults()) list.push_back(std::move(fault));
  for (InjectedFault& fault : weights_faults()) list.push_back(std::move(fault));
  return list;
}

// Faults of colour edges and of learned weights.
std::vector<InjectedFault> MorphologicalFaults::weights_faults() const {
  const spec::morphological::Parameters& p = setup_.morphological;
  const std::string needs =
      p.area == spec::morphological::AreaSource::kLearned ? "" : "morphological.area = learned";
  return {
      {"wrong-colour", "Edges come from luma.", "",
       p.edge_source == spec::morphological::EdgeSource::kColour
           ? ""
           : "morphological.edges.source = colour"},
      {"wrong-weight",
       "Flips a bit of the word of weights_a for a single pixel between crossings on its side.", "",
       needs},
      {"wrong-near", "Flips a bit of the words of weights_b for crossings that go on.", "", needs},
      {"wrong-far", "Flips a bit of the words of weights_c for crossings that go on.", "", needs},
      {"wrong-sum", "Flips a bit of the word of weight_rom for a sum of -2.0.", "", needs},
      {"wrong-class", "Flips a bit of the class of the crossing at the end of a vertical run.",
       "flip:morphological.lines_v0:20:line.end_class.1", needs},
      {"wrong-code", "Flips a bit of the codes of the ends of a horizontal run.",
       "flip:morphological.lines_h0:20:line.run.shape.0", needs},
      {"wrong-axis", "The line of a weight from above counts as the longest one.",
       "flip:morphological.weights:500:weights.0.span_up.11", needs},
      {"drop-line", "Drops a record after the dividers of horizontal runs.",
       "drop:morphological.lines_h0:20", needs}};
}

// Faults of SMAA's blocks. Those without a link fault are injected by as_built() and plant().
std::vector<InjectedFault> MorphologicalFaults::smaa_faults() const {
  const spec::morphological::Parameters& p = setup_.morphological;
  const auto unless = [](bool built, std::string needs) {
    return built ? std::string() : "morphological." + std::move(needs);
  };
  const bool luma = p.edge_source == spec::morphological::EdgeSource::kLuma;
  const bool dynamic = p.threshold_mode == spec::morphological::ThresholdMode::kDynamic;
  const bool contrast = p.local_contrast == spec::morphological::LocalContrast::kSmaa ||
                        p.local_contrast == spec::morphological::LocalContrast::kPaper;
  const bool table = p.area != spec::morphological::AreaSource::kAnalytic &&
                     p.area != spec::morphological::AreaSource::kLearned;
  const bool clamp = p.border == spec::morphological::Border::kClamp;
  const std::string for_table = unless(table, "area = table_full, table_merged or table_minimal"),
                    for_diagonals = unless(p.diagonals, "diagonals = true");
  return {
      {"wrong-threshold",
       "The threshold errs where it is just reached: T a unit higher, or alpha a unit lower.", "",
       unless(luma && (dynamic ? p.alpha > 0 : p.threshold < kMostThreshold),
              "edges.source = luma, alpha of at least 1, T of at most 16777214")},
      {"wrong-floor", "The floor of a dynamic threshold is a unit higher.", "",
       unless(luma && dynamic && p.floor < kMostThreshold,
              "edges.threshold_mode = dynamic, floor of at most 16777214")},
      {"wrong-contrast",
       "An edge of exactly half the contrast beside it is dropped for kept, kept for dropped.", "",
       unless(luma && contrast, "edges.local_contrast = smaa or paper")},
      {"wrong-area", "Flips a bit of the word of area_rom0 that runs of one pixel read.", "",
       for_table},
      {"wrong-root", "Flips a bit of the word of sqrt_rom for two pixels.", "", for_table},
      {"wrong-decode", "Patterns 6, 7 and 14 of the merged table read the tile of 9.", "",
       unless(p.area == spec::morphological::AreaSource::kTableMerged, "area = table_merged")},
      {"wrong-search", "Searches along runs end a step early.", "",
       unless(table && p.search_steps > 1, "area = table_*, search_steps of at least 2")},
      {"wrong-border", "Edges end at the frame's border.", "", unless(clamp, "border = clamp")},
      {"wrong-endless", "The end of a horizontal run that lies in the frame counts as endless.",
       "flip:morphological.lines_h0:20:line.run.endless.1", unless(clamp, "border = clamp")},
      {"wrong-values", "Tables hold exact areas for the published ones, or the published ones.", "",
       table || p.diagonals ? ""
                            : "morphological.area = table_* or morphological.diagonals = true"},
      {"wrong-entry", "A vertical record is stored in the other entry of its column.",
       "flip:morphological.lines_v0:20:entry",
       unless(p.ends == spec::morphological::Ends::kCrossings, "ends = crossings")},
      {"wrong-diagonal", "Searches along diagonals end a step early.", "",
       unless(p.diagonals && p.diagonal_steps > 1,
              "diagonals = true, diagonal_steps of at least 2")},
      {"wrong-diagonal-area",
       "Flips a bit of the words of diagonal_rom for two pixels to either end.", "", for_diagonals},
      {"drop-diagonals", "Drops the weights of the diagonals of beat 200.",
       "drop:morphological.diagonal_unit.diagonal_weights_entries:200", for_diagonals},
      {"wrong-corner", "Sharp corners keep 1/256 less of a weight.", "",
       unless(p.round_corners && p.corner_rounding > 0,
              "round_corners = true, corner_rounding of at least 1")},
      {"wrong-mix", "Flips a bit of the word of mix_rom for weights that sum up to 64.", "",
       unless(p.blend == spec::morphological::BlendRule::kStrongest, "blend = strongest")}};
}

spec::morphological::Parameters MorphologicalFaults::as_built() const {
  spec::morphological::Parameters p = setup_.morphological;
  // A fault without effect in this configuration is rejected by its `needs`.
  if (injected("wrong-rule")) p.steps = std::max(0, p.steps - 1);
  if (injected("wrong-guard")) p.text_guard = false;
  if (injected("wrong-threshold")) {
    if (p.threshold_mode == spec::morphological::ThresholdMode::kDynamic)
      p.alpha = std::max(0, p.alpha - 1);
    else
      p.threshold = std::min(kMostThreshold, p.threshold + 1);
  }
  if (injected("wrong-floor")) p.floor = std::min(kMostThreshold, p.floor + 1);
  if (injected("wrong-contrast"))
    p.local_contrast = p.local_contrast == spec::morphological::LocalContrast::kSmaa
                           ? spec::morphological::LocalContrast::kPaper
                           : spec::morphological::LocalContrast::kSmaa;
  if (injected("wrong-search")) p.search_steps = std::max(1, p.search_steps - 1);
  if (injected("wrong-diagonal")) p.diagonal_steps = std::max(1, p.diagonal_steps - 1);
  if (injected("wrong-border")) p.border = spec::morphological::Border::kEnd;
  if (injected("wrong-values"))
    p.area_values = p.area_values == spec::morphological::AreaValues::kExact
                        ? spec::morphological::AreaValues::kPublished
                        : spec::morphological::AreaValues::kExact;
  if (injected("wrong-colour")) p.edge_source = spec::morphological::EdgeSource::kLuma;
  if (injected("wrong-corner")) p.corner_rounding = std::max(0, p.corner_rounding - 1);
  return p;
}

void MorphologicalFaults::inject(rtl::morphological::MorphologicalEngine& engine) const {
  const auto in_rom = [&]<class Word>(const char* name, Word, auto&& change) {
    rtl::for_each<rtl::MemoryBase>(engine, [&](rtl::MemoryBase& memory) {
      if (memory.basename() != std::string_view(name)) return;
      auto* const rom = dynamic_cast<rtl::Memory<Word>*>(&memory);
      DEBURR_CHECK(rom != nullptr, std::string(name) + " has other words");
      change(*rom);
    });
  };
  constexpr std::uint16_t kHalf = 0;
  constexpr std::uint32_t kWord = 0;
  // Tile index in the ROM's layout; each parity of a tile has 64 words.
  using spec::morphological::AreaSource;
  const AreaSource layout = setup_.morphological.area;
  const std::uint64_t tile_of_6 = layout == AreaSource::kTableFull     ? 6
                                  : layout == AreaSource::kTableMerged ? 4
                                                                       : 0;
  constexpr std::uint64_t kTileWords = 64, kMergedTileOf9 = 6;
  if (injected("wrong-area"))
    in_rom("area_rom0", kHalf, [&](auto& rom) { rom.backdoor(tile_of_6 * kTileWords) ^= 1u << 5; });
  if (injected("wrong-root"))
    in_rom("sqrt_rom", kHalf, [](auto& rom) { rom.backdoor(2) ^= 1u << 6; });
  if (injected("wrong-decode"))
    for (const char* const name : {"area_rom0", "area_rom1", "area_rom2", "area_rom3"})
      in_rom(name, kHalf, [&](auto& rom) {
        for (std::uint64_t i = 0; i < kTileWords; ++i)
          rom.backdoor(tile_of_6 * kTileWords + i) = rom.backdoor(kMergedTileOf9 * kTileWords + i);
      });
  if (injected("wrong-diagonal-area"))
    in_rom("diagonal_rom", kHalf, [](auto& rom) {
      constexpr std::uint64_t kDistances = spec::morphological::kDiagonalDistances;
      for (std::uint64_t codes = 0; codes < 16; ++codes)
        rom.backdoor((codes * kDistances + 2) * kDistances + 2) ^= 1u << 4;
    });
  constexpr std::int8_t kEntry = 0;
  constexpr std::uint8_t kWeight = 0;
  if (injected("wrong-weight"))
    in_rom("weights_a", kEntry, [](auto& rom) {
      // Crossing codes 1 and 1, distances 0 and 0.
      rom.backdoor(5 * 64) = static_cast<std::int8_t>(rom.backdoor(5 * 64) ^ 1 << 4);
    });
  for (const auto& [fault, name] :
       {std::pair{"wrong-near", "weights_b"}, std::pair{"wrong-far", "weights_c"}})
    if (injected(fault))
      in_rom(name, kEntry, [](auto& rom) {
        constexpr std::uint64_t kContinues = 4, kWords = 32;  // class 2 of code 1
        for (std::uint64_t i = kContinues * kWords; i < (kContinues + 1) * kWords; ++i)
          rom.backdoor(i) = static_cast<std::int8_t>(rom.backdoor(i) ^ 1 << 4);
      });
  if (injected("wrong-sum"))
    in_rom("weight_rom", kWeight, [](auto& rom) { rom.backdoor(128 - 32) ^= 1u << 2; });
  if (injected("wrong-mix"))
    in_rom("mix_rom", kWord, [](auto& rom) { rom.backdoor(64) ^= 1u << 13; });
}

}  // namespace deburr::tb
