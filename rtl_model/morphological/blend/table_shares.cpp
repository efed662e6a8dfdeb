// SPDX-License-Identifier: MIT
#include "rtl_model/morphological/blend/table_shares.h"

#include <algorithm>

namespace deburr::rtl::morphological {

TableShares::TableShares(const sc_core::sc_module_name& name,
                         spec::morphological::AreaSource layout, const ParameterStore& store)
    : sc_module(name), store_(store), table_(layout, store.lanes()) {}

void TableShares::set_ends(AreaWalk& walk) {
  constexpr std::int64_t kHalf = std::int64_t{1} << (spec::morphological::kRecipFractionBits - 1);
  // S5.12, above the line's lower end.
  const std::int64_t height = (walk.t + kHalf + 2048) >> 12;
  const auto limited = [](std::int64_t pixel) {
    return static_cast<std::int32_t>(std::clamp<std::int64_t>(pixel, -4096, 4095));
  };
  const std::int64_t inverse = walk.inverse;
  walk.set_ends(limited(-((height * inverse + kHalf) >> 24)),
                limited(((4096 - height) * inverse + kHalf) >> 24));
}

void TableShares::ask(std::size_t edge, const AreaWalk& walk, std::int32_t k, std::uint8_t near) {
  Beat* beat = pipe_.at(1);
  if (!beat) {
    beat = &pipe_.enter();
    beat->asks = 0;
  }
  beat->asks = static_cast<std::uint8_t>(beat->asks | 1u << edge);
  Search& search = beat->search[edge];
  search.left = std::max(0, k - walk.first_end());
  search.right = std::max(0, walk.last_end() - 1 - k);
  search.query.shape = walk.shape;
  search.far = walk.far;
  search.near = near;
  search.span = walk.span;
}

// Stage 4: searches end at their limit, and an end beyond it is not seen.
void TableShares::cut(Cycle cycle, Beat& beat) {
  const std::int32_t most_left = 2 * store_.rules().search_steps - 1, most_right = most_left + 1;
  for_each(beat, [&](std::size_t edge, Search& search) {
    AreaTable::Query& query = search.query;
    if (search.left > most_left) query.shape &= 0b1100;
    if (search.right > most_right) query.shape &= 0b0011;
    query.left = static_cast<std::uint8_t>(std::min(search.left, most_left));
    query.right = static_cast<std::uint8_t>(std::min(search.right, most_right));
    table_.address_roots(cycle, edge, query);
  });
}

// Stages 6 to 4, and the arithmetic of 7 to 9.
void TableShares::move_on(Cycle cycle, BeatShares* shares) {
  pipe_.move();
  if (Beat* beat = pipe_.at(4))
    for_each(*beat, [&](std::size_t edge, const Search& search) {
      const AreaTable::Shares found = table_.shares(cycle, edge, search.query);
      shares_of(*shares, edge) = at_corners(
          store_.rules(), {found.first, found.second, search.span}, search.far, search.near);
    });
  if (Beat* beat = pipe_.at(3))
    for_each(*beat, [&](std::size_t edge, Search& search) {
      table_.address_entries(cycle, edge, search.query);
    });
  if (Beat* beat = pipe_.at(2)) cut(cycle, *beat);
}

}  // namespace deburr::rtl::morphological
