// SPDX-License-Identifier: MIT
// What can be wrong with a geometric engine on purpose: on its links, in how it is built, in its
// tables and in what it finds in memory.
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
  // Frames and setup must outlive it.
  GeometricFaults(const FaultPlan& plan, std::string environment,
                  std::span<const geometric::Frame> frames, const GeometricSetup& setup)
      : EngineFaults(plan, std::move(environment)), frames_(frames), setup_(setup) {}

  std::vector<InjectedFault> list() const;
  // What the engine is built with; the golden model always gets what was ordered.
  spec::geometric::Parameters as_built() const;
  void inject(rtl::geometric::GeometricEngine& engine) const;
  // The facing bits that go to memory.
  std::vector<std::uint8_t> facing(const geometric::Frame& frame) const;

 private:
  std::optional<std::uint32_t> face_of_a_fault() const;
  std::optional<std::size_t> block_that_takes_from_above() const;

  std::span<const geometric::Frame> frames_;
  const GeometricSetup& setup_;
};

}  // namespace deburr::tb
