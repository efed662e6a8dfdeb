// SPDX-License-Identifier: MIT
// Injected faults of the geometric engine: on links, in build parameters, in tables and in memory
// contents.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "rtl_model/geometric/geometric_engine.h"
#include "spec/geometric/parameters.h"
#include "tb/engines/geometric/geometric_setup.h"
#include "tb/engines/geometric/geometric_stimuli.h"
#include "tb/env/injected_faults.h"

namespace deburr::tb {

class GeometricFaults : public EngineFaults {
 public:
  // `frames` and `setup` must outlive it.
  GeometricFaults(const FaultPlan& plan, std::string environment,
                  std::span<const geometric::Frame> frames, const GeometricSetup& setup)
      : EngineFaults(plan, std::move(environment)), frames_(frames), setup_(setup) {}

  std::vector<InjectedFault> list() const;
  // Parameters of the hardware with faults; the golden model always gets the intended ones.
  spec::geometric::Parameters as_built() const;
  void inject(rtl::geometric::GeometricEngine& engine) const;
  // Facing bits that are written to memory.
  std::vector<std::uint8_t> facing(const geometric::Frame& frame) const;

 private:
  std::optional<std::uint32_t> face_for_facing_fault() const;
  std::optional<std::size_t> block_blending_from_above() const;

  std::span<const geometric::Frame> frames_;
  const GeometricSetup& setup_;
};

}  // namespace deburr::tb
