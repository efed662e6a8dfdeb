// SPDX-License-Identifier: MIT
#include "tb/app/engine.h"
#include "tb/engines/frame/frame_engine.h"
#include "tb/engines/geometric/geometric_engine.h"
#include "tb/engines/morphological/morphological_engine.h"
#include "tb/engines/texture/texture_engine.h"

namespace deburr::tb {

std::vector<std::unique_ptr<Engine>> engines() {
  std::vector<std::unique_ptr<Engine>> all;
  all.push_back(make_texture_engine());
  all.push_back(make_morphological_engine());
  all.push_back(make_geometric_engine());
  all.push_back(make_frame_engine());
  return all;
}

}  // namespace deburr::tb
