// SPDX-License-Identifier: MIT
// What the hardware of a run is built of, and the estimate of its cost. The first is collected from
// the engines (Meter::add_parts); tool/cost/estimate.h makes the second from it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "rtl_model/fabric/datasheet.h"

namespace deburr::tb {

// A unit of an engine, named as in `units` of the result ("texture_axis_unit" in a composition).
struct UnitSheet {
  std::string name;
  rtl::Datasheet sheet;
};

struct LinkShape {
  std::string name, consumer;  // the unit that pops it
  std::uint64_t bits = 0, depth = 0;
};

// A figure with the range in which it lies by the calibration of its kind.
struct Ranged {
  double low = 0, value = 0, high = 0;
};

// By the sum of operators alone. Ratios of two builds hold better between such figures.
struct Estimate {
  double gates = 0, ns = 0;
  std::uint64_t flip_flops = 0;
};

struct UnitCost {
  std::string name;
  std::string basis;  // "estimate", or "mapped": the row of these very parameters
  Ranged gates;       // NAND2 of two inputs
  std::uint64_t flip_flops = 0, memory_bits = 0;
  Ranged ns;          // longest path; 0: none is critical
  std::string stage;  // with it; of a mapped row, "to" the register or port at its end
  Estimate estimate;
};

// All SRAM of the run in one technology; never converted to another.
struct SramArea {
  std::string technology;
  double mm2 = 0;
};

struct Cost {
  std::string technology;
  Ranged gates;
  std::uint64_t flip_flops = 0, memory_bits = 0;
  Ranged ns, clock_mhz;
  // Of a complete run, which is one frame: at clock_mhz above, and at that of the run.
  std::optional<Ranged> frames_per_s;
  double run_frames_per_s = 0;
  double yardstick_ratio = 0;  // ns over those of a 24 x 24 multiply
  std::string limited_by;      // "axis_unit stage 8", "axis_unit to out_data"
  Estimate estimate;
  std::vector<SramArea> sram;
  std::vector<UnitCost> units;
};

}  // namespace deburr::tb
