// SPDX-License-Identifier: MIT
#include "rtl_model/texture/latency_fifo.h"

namespace deburr::rtl::texture {

Datasheet LatencyFifo::datasheet() {
  return {.unit = "LatencyFifo",
          .does = "Holds requests between tag check and data read while lines come from memory.",
          .latency = {1, "at least 1"},
          .stages = {{"-", "requests; as deep as the memory latency in cycles",
                      "SRAM read into an output register"}}};
}

Datasheet WideLatencyFifo::datasheet() {
  Datasheet sheet = LatencyFifo::datasheet();
  sheet.unit = "WideLatencyFifo";
  sheet.does = "Holds groups between tag check and data read while lines come from memory.";
  sheet.stages = {{"-", "groups; as deep as the memory latency in cycles, and 16 more",
                   "SRAM read into an output register"}};
  return sheet;
}

}  // namespace deburr::rtl::texture
