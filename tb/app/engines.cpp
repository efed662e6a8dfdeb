// SPDX-License-Identifier: MIT
#include "tb/app/engine.h"
#include "tb/app/frame_engine.h"
#include "tb/app/geometric_engine.h"
#include "tb/app/morphological_engine.h"
#include "tb/app/texture_engine.h"

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
