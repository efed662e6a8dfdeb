// SPDX-License-Identifier: MIT
#include "golden/morphological/smaa_coverage.h"

#include <algorithm>
#include <string>
#include <string_view>

#include "spec/morphological/shapes.h"

namespace deburr::golden::morphological {
namespace {

constexpr std::array<std::string_view, 2> kAxisNames = {"horizontal", "vertical"};
constexpr std::array<std::string_view, SmaaCoverage::kDistances> kDistanceNames = {
    "0", "1-3", "4-8", "9-24", "25+"};
constexpr std::array<std::string_view, 2> kTiles = {"half", "dip"};
constexpr std::array<std::string_view, 2> kEntries = {"first", "last"};
constexpr std::array<std::string_view, 2> kEnds = {"start", "end"};
constexpr std::array<std::string_view, 2> kLimits = {"at", "beyond"};
constexpr std::array<std::string_view, 2> kDirections = {"rising", "falling"};
constexpr std::array<std::string_view, 4> kOpen = {"closed", "open-1", "open-2", "open-both"};
constexpr std::array<std::string_view, 3> kLengths = {"3", "4-7", "8+"};
constexpr std::array<std::string_view, 4> kEndless = {"start", "end", "both", "repeated"};
constexpr std::array<std::string_view, 4> kCorners = {"start", "middle", "end", "cut"};
constexpr std::array<std::string_view, 2> kRegimes = {"floor", "alpha"};

// From this distance on the last root of a tile is read.
constexpr int kLastRoot = 14 * 14;

template <std::size_t n>
std::size_t bin_of(int value, const std::array<int, n>& up_to) {
  return static_cast<std::size_t>(std::lower_bound(up_to.begin(), up_to.end(), value) -
                                  up_to.begin());
}

}  // namespace

void SmaaCoverage::count_pixel(spec::morphological::Axis axis, const TableAddress& address) {
  const auto a = static_cast<std::size_t>(axis);
  const auto shape = static_cast<std::size_t>(address.shape);
  const int longer = std::max(address.before, address.after);
  ++table_[a][shape][bin_of<4>(longer, {0, 3, 8, 24})];
  const spec::morphological::RunShape& sides = spec::morphological::kRunShapes[shape];
  if (sides.before != spec::morphological::Side::kNone ||
      sides.after != spec::morphological::Side::kNone) {
    Pair& entries = entries_[sides.before == sides.after ? 1 : 0];
    entries[0] += longer == 0;
    entries[1] += std::min(address.before, address.after) >= kLastRoot;
  }
  const std::array<SearchEnd, 2> ends = {address.start, address.end};
  for (std::size_t end = 0; end < 2; ++end) {
    if (ends[end] == SearchEnd::kWithin) continue;
    ++searches_[a][end][ends[end] == SearchEnd::kAtLimit ? 0 : 1];
  }
}

void SmaaCoverage::count_descriptor(const spec::morphological::RunDescriptor& run, int extent) {
  auto& bins = endless_[static_cast<std::size_t>(run.axis)];
  if (run.endless != 0) ++bins[run.endless - 1u];
  const bool meets_end =
      run.part != spec::morphological::RunPart::kHead && run.start + run.length == extent;
  if (meets_end && (run.endless & 2) == 0 && run.shape >= 4) ++bins[3];
}

void SmaaCoverage::count_corner(spec::morphological::Axis axis, const TableAddress& address,
                                int far) {
  auto& bins = corners_[static_cast<std::size_t>(axis)];
  if (address.far_seen(far) == 0)
    ++bins[3];
  else
    ++bins[address.before < address.after ? 0 : address.before > address.after ? 2 : 1];
}

void SmaaCoverage::count_diagonal(bool rising, const DiagonalEnds& ends, bool beyond_frame) {
  if (!ends.counts()) return;
  const std::size_t direction = rising ? 0 : 1;
  beyond_[direction] += beyond_frame;
  const int codes = 4 * ends.e1 + ends.e2;
  ++codes_[direction][static_cast<std::size_t>(codes)];
  ++open_[direction][(ends.open1 ? 1u : 0u) + (ends.open2 ? 2u : 0u)];
  ++lengths_[direction][bin_of<2>(ends.d1 + ends.d2, {3, 7})];
}

std::vector<CoverageBin> SmaaCoverage::bins() const {
  std::vector<CoverageBin> result;
  const auto add = [&](std::uint64_t hits, std::string_view group, std::string_view first,
                       std::string_view second, std::string_view third = {}) {
    std::string name(group);
    for (const std::string_view part : {first, second, third}) {
      if (part.empty()) continue;
      name += '/';
      name += part;
    }
    result.push_back({std::move(name), hits});
  };
  for (std::size_t axis = 0; axis < 2; ++axis) {
    for (std::size_t shape = 0; shape < 16; ++shape)
      for (std::size_t d = 0; d < kDistances; ++d)
        add(table_[axis][shape][d], "table", kAxisNames[axis],
            spec::morphological::kRunShapes[shape].name, kDistanceNames[d]);
    for (std::size_t end = 0; end < 2; ++end)
      for (std::size_t limit = 0; limit < 2; ++limit)
        add(searches_[axis][end][limit], "search", kAxisNames[axis], kEnds[end], kLimits[limit]);
    for (std::size_t which = 0; which < 4; ++which)
      add(endless_[axis][which], "endless", kAxisNames[axis], kEndless[which]);
    for (std::size_t which = 0; which < 4; ++which)
      add(corners_[axis][which], "corner", kAxisNames[axis], kCorners[which]);
  }
  for (std::size_t tile = 0; tile < 2; ++tile)
    for (std::size_t entry = 0; entry < 2; ++entry)
      add(entries_[tile][entry], "table-entry", kTiles[tile], kEntries[entry]);
  for (std::size_t direction = 0; direction < 2; ++direction) {
    for (std::size_t codes = 0; codes < 16; ++codes)
      add(codes_[direction][codes], "diagonal", kDirections[direction],
          std::to_string(codes / 4) + "-" + std::to_string(codes % 4));
    for (std::size_t open = 0; open < 4; ++open)
      add(open_[direction][open], "diagonal-ends", kDirections[direction], kOpen[open]);
    for (std::size_t length = 0; length < 3; ++length)
      add(lengths_[direction][length], "diagonal-length", kDirections[direction], kLengths[length]);
    add(beyond_[direction], "diagonal-beyond", kDirections[direction], {});
  }
  add(fixed_, "threshold", "fixed", {});
  for (std::size_t luma = 0; luma < 4; ++luma)
    for (std::size_t regime = 0; regime < 2; ++regime)
      add(thresholds_[luma][regime], "threshold", spec::morphological::kDynamicLumaNames[luma],
          kRegimes[regime]);
  return result;
}

}  // namespace deburr::golden::morphological
