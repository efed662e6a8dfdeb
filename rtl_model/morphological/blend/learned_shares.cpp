// SPDX-License-Identifier: MIT
#include "rtl_model/morphological/blend/learned_shares.h"

#include <bit>

namespace deburr::rtl::morphological {

void LearnedShares::move(Cycle cycle, BeatShares* shares) {
  pipe_.move();
  const auto for_each = [](Beat* beat, auto&& visit) {
    if (!beat) return;
    for (unsigned left = beat->asks; left != 0; left &= left - 1) {
      const auto edge = static_cast<std::size_t>(std::countr_zero(left));
      visit(edge, beat->query[edge]);
    }
  };
  // Stages 7 to 4.
  for_each(pipe_.at(5), [&](std::size_t edge, const SharesRom::Query& query) {
    const SharesRom::Shares found = rom.shares(cycle, edge, query);
    shares_of(*shares, edge) = {found.first, found.second, 0};
  });
  for_each(pipe_.at(4), [&](std::size_t edge, SharesRom::Query& query) {
    rom.address_shares(cycle, edge, query);
  });
  for_each(pipe_.at(3),
           [&](std::size_t edge, SharesRom::Query& query) { rom.add(cycle, edge, query); });
  for_each(pipe_.at(2), [&](std::size_t edge, const SharesRom::Query& query) {
    rom.address(cycle, edge, query);
  });
}

}  // namespace deburr::rtl::morphological
