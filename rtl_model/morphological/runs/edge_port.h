// SPDX-License-Identifier: MIT
// Read port of a predictor for the edges of its axis: columns for vertical runs (EdgeWindow), rows
// for horizontal runs (EdgeRows).
#pragma once

#include <cstddef>
#include <cstdint>

#include "rtl_model/fabric/clocked.h"
#include "rtl_model/morphological/common/frame_configuration.h"
#include "rtl_model/morphological/runs/trial.h"

namespace deburr::rtl::morphological {

class EdgeMemory {
 public:
  EdgeMemory() = default;
  EdgeMemory(const EdgeMemory&) = delete;
  EdgeMemory& operator=(const EdgeMemory&) = delete;
  virtual ~EdgeMemory() = default;

  // Reads the edges that the trial needs, and stores in the trial which columns they are.
  virtual void read(Cycle cycle, const FrameConfiguration& configuration, std::size_t port,
                    Trial& trial) = 0;
  // Results are valid in the cycle after read().
  virtual std::uint8_t hits(Cycle cycle, const FrameConfiguration& configuration, std::size_t port,
                            const Trial& trial) const = 0;
  virtual std::uint8_t crossing_class(Cycle cycle, const FrameConfiguration& configuration,
                                      std::size_t port, const Trial& trial) const = 0;
};

class EdgePort {
 public:
  EdgePort(EdgeMemory& memory, int port) : memory_(memory), port_(static_cast<std::size_t>(port)) {}

  void read(Cycle cycle, const FrameConfiguration& configuration, Trial& trial) {
    memory_.read(cycle, configuration, port_, trial);
  }
  std::uint8_t hits(Cycle cycle, const FrameConfiguration& configuration,
                    const Trial& trial) const {
    return memory_.hits(cycle, configuration, port_, trial);
  }
  std::uint8_t crossing_class(Cycle cycle, const FrameConfiguration& configuration,
                              const Trial& trial) const {
    return memory_.crossing_class(cycle, configuration, port_, trial);
  }

 private:
  EdgeMemory& memory_;
  std::size_t port_;
};

}  // namespace deburr::rtl::morphological
