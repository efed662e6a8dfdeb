// SPDX-License-Identifier: MIT
#include "tb/base/renamed.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <utility>

namespace deburr::tb {
namespace {

using Pair = std::pair<std::string_view, std::string_view>;

// Instance names: match at the start of a dotted part, optionally after an engine's name.
constexpr std::array kInstances{Pair{"derivative", "derivative_unit"},
                                Pair{"footprint", "footprint_unit"},
                                Pair{"axis", "axis_unit"},
                                Pair{"log2", "log2_unit"},
                                Pair{"level", "level_unit"},
                                Pair{"walker", "sample_walker"},
                                Pair{"addresser", "texel_addresser"},
                                Pair{"filter", "filter_pipeline"},
                                Pair{"address", "address_unit"},
                                Pair{"cache", "texture_cache"},
                                Pair{"sequencer", "slot_sequencer"},
                                Pair{"luma", "luma_unit"},
                                Pair{"edges", "edge_detector"},
                                Pair{"extractor", "run_extractor"},
                                Pair{"predictor_h", "endpoint_predictor_h"},
                                Pair{"predictor_v", "endpoint_predictor_v"},
                                Pair{"divider_h", "line_unit_h"},
                                Pair{"divider_v", "line_unit_v"},
                                Pair{"area", "area_unit"},
                                Pair{"diagonals", "diagonal_unit"}};

// Words: match anywhere in a name, between dots, underscores and slashes.
constexpr std::array kWords{Pair{"clocks", "cycles"},
                            Pair{"bytes_per_clock", "bytes_per_cycle"},
                            Pair{"pixels_per_clock", "pixels_per_cycle"},
                            Pair{"columns_a_clock", "columns_per_cycle"},
                            Pair{"bytes_a_blended_pixel", "bytes_per_blended_pixel"},
                            Pair{"look_up", "lookup"},
                            Pair{"look_ups", "lookups"},
                            Pair{"look-up", "lookup"},
                            Pair{"most_outstanding", "max_outstanding"},
                            Pair{"most_waiting", "max_waiting"},
                            Pair{"record", "descriptor"},
                            Pair{"records", "descriptors"},
                            Pair{"shares", "weights"},
                            Pair{"share", "weight"},
                            Pair{"left_pixels", "bypassed_pixels"},
                            Pair{"leave", "bypass"},
                            Pair{"reach_columns", "search_columns"},
                            Pair{"truth", "reference"},
                            Pair{"taps", "probes"},
                            Pair{"tap", "probe"},
                            Pair{"idealised", "not_implementable"},
                            Pair{"window_cycles", "interval_cycles"},
                            Pair{"windows", "intervals"},
                            Pair{"buckets", "signatures"},
                            Pair{"refusal", "rejection"},
                            Pair{"left/beside", "bypass/beside"},
                            Pair{"left/half", "bypass/half"},
                            Pair{"left/marked", "bypass/marked"},
                            Pair{"left/*", "bypass/*"},
                            Pair{"bottom/left", "bottom/bypassed"},
                            Pair{"left/left", "left/bypassed"},
                            Pair{"right/left", "right/bypassed"},
                            Pair{"top/left", "top/bypassed"}};

bool is_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0; }

// Whether `now` is `before` with renamed instances, compared part by part.
bool is_renamed(std::string_view before, std::string_view now) {
  for (;;) {
    const std::size_t b = before.find('.'), n = now.find('.');
    const std::string_view was = before.substr(0, b), is = now.substr(0, n);
    // After nothing, or after the name of a part of a composition.
    const auto same = [&](const Pair& instance) {
      const std::size_t at = was.find(instance.first);
      return at != std::string_view::npos && (at == 0 || was[at - 1] == '_') &&
             is.starts_with(was.substr(0, at)) && is.substr(at).starts_with(instance.second) &&
             was.substr(at + instance.first.size()) == is.substr(at + instance.second.size());
    };
    if (was != is && std::none_of(kInstances.begin(), kInstances.end(), same)) return false;
    if ((b == std::string_view::npos) != (n == std::string_view::npos)) return false;
    if (b == std::string_view::npos) return true;
    before.remove_prefix(b + 1), now.remove_prefix(n + 1);
  }
}

}  // namespace

std::string with_current_words(std::string name) {
  for (const auto& [before, now] : kWords) {
    for (std::size_t at = name.find(before); at != std::string::npos;
         at = name.find(before, at + now.size())) {
      const std::size_t end = at + before.size();
      if ((at > 0 && is_word(name[at - 1])) || (end < name.size() && is_word(name[end]))) continue;
      name.replace(at, before.size(), now);
    }
  }
  return name;
}

std::optional<std::string> renamed(std::string_view name, const std::vector<std::string>& known) {
  const std::string today = with_current_words(std::string(name));
  const auto found = std::find_if(known.begin(), known.end(),
                                  [&](const std::string& k) { return is_renamed(today, k); });
  return found == known.end() || *found == name ? std::nullopt : std::optional(*found);
}

}  // namespace deburr::tb
