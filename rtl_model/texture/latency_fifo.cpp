// SPDX-License-Identifier: MIT
#include "rtl_model/texture/latency_fifo.h"

namespace deburr::rtl::texture {

Datasheet LatencyFifo::datasheet() {
  return {.unit = "LatencyFifo",
          .does = "Holds requests between tag check and data read while lines come from memory.",
          .latency = {1, "at least 1"},
          .stages = {{"-", "requests; as deep as the memory latency in cycles",
                      "SRAM read into an output register"}},
          .cost =
              "the FIFO: depth x request bits, flip-flops up to 32 requests and 16 kbit, else "
              "SRAM 1R1W."};
}

Datasheet WideLatencyFifo::datasheet() {
  Datasheet sheet = LatencyFifo::datasheet();
  sheet.unit = "WideLatencyFifo";
  sheet.does = "Holds groups between tag check and data read while lines come from memory.";
  sheet.stages = {{"-", "groups; as deep as the memory latency in cycles, and 16 more",
                   "SRAM read into an output register"}};
  sheet.cost = "depth x group bits, flip-flops up to 32 groups and 16 kbit, else SRAM 1R1W.";
  return sheet;
}

}  // namespace deburr::rtl::texture
