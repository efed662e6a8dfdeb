// SPDX-License-Identifier: MIT
// Injected faults of the morphological engine: on links, in build parameters and in ROMs.
#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "rtl_model/morphological/morphological_engine.h"
#include "spec/morphological/parameters.h"
#include "tb/engines/morphological/morphological_input.h"
#include "tb/engines/morphological/morphological_setup.h"
#include "tb/env/injected_faults.h"

namespace deburr::tb {

class MorphologicalFaults : public EngineFaults {
 public:
  // `frames` and `setup` must outlive it.
  MorphologicalFaults(const FaultPlan& plan, std::string environment,
                      std::span<const MorphologicalInput> frames, const MorphologicalSetup& setup)
      : EngineFaults(plan, std::move(environment)), frames_(frames), setup_(setup) {}

  std::vector<InjectedFault> list() const;
  // Parameters of the hardware with faults; the golden model always gets the intended ones.
  spec::morphological::Parameters as_built() const;
  void inject(rtl::morphological::MorphologicalEngine& engine) const;

 private:
  std::vector<InjectedFault> smaa_faults() const;
  std::vector<InjectedFault> weights_faults() const;

  std::span<const MorphologicalInput> frames_;
  const MorphologicalSetup& setup_;
};

}  // namespace deburr::tb
