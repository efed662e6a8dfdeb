// SPDX-License-Identifier: MIT
#include "tool/engines/geometric/geometric_draws.h"

#include <string>

namespace deburr::tool {

RandomDraws geometric_draws() {
  RandomDraws all;
  all.draws = {{"geometric.line_pixels", evenly<96, 1100>},
               {"geometric.touched_words", magnitude<25, 4000>},
               {"geometric.face_limit",
                [](tb::Random& r) { return std::to_string(r.between(32, 100) * 1024); }},
               {"geometric.fills", magnitude<8, 200>},
               {"geometric.resolve_lines", magnitude<16, 300>},
               {"geometric.copy_lines", magnitude<2, 100>}};
  all.fixed = {"sequence.frames", "sequence.motion"};  // by the golden model only
  return all;
}

}  // namespace deburr::tool
