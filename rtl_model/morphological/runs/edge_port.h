// SPDX-License-Identifier: MIT
// A read port of the memory that an axis has: columns for vertical runs, rows for horizontal ones.
#pragma once

#include <cstddef>
#include <cstdint>

#include "rtl_model/morphological/runs/edge_rows.h"
#include "rtl_model/morphological/runs/edge_window.h"

namespace deburr::rtl::morphological {

class EdgePort {
 public:
  EdgePort(EdgeWindow& window, int port)
      : window_(&window), port_(static_cast<std::size_t>(port)) {}
  EdgePort(EdgeRows& rows, int port) : rows_(&rows), port_(static_cast<std::size_t>(port)) {}

  void read(Cycle cycle, Trial& trial) {
    if (window_ != nullptr)
      window_->read(cycle, port_, trial);
    else
      rows_->read(cycle, port_, trial);
  }
  std::uint8_t hits(Cycle cycle, const Trial& trial) const {
    return window_ != nullptr ? window_->hits(cycle, port_, trial)
                              : rows_->hits(cycle, port_, trial);
  }
  std::uint8_t crossing_class(Cycle cycle, const Trial& trial) const {
    return window_ != nullptr ? window_->crossing_class(cycle, port_, trial)
                              : rows_->crossing_class(cycle, port_, trial);
  }

 private:
  EdgeWindow* window_ = nullptr;
  EdgeRows* rows_ = nullptr;
  std::size_t port_;
};

}  // namespace deburr::rtl::morphological
