// SPDX-License-Identifier: MIT
#include "rtl_model/morphological/register_section.h"

#include <array>

#include "spec/morphological/registers.h"

namespace deburr::rtl::morphological {

RegisterSection register_section(const spec::morphological::Parameters& parameters) {
  namespace reg = spec::morphological::reg;
  const auto loaded = spec::morphological::loaded_registers(parameters);
  RegisterSection section{"MorphologicalEngine", "DEBURR_MORPHOLOGICAL", {}};
  section.loaded.assign(loaded.begin(), loaded.end());
  section.busy_ignores_writes = spec::morphological::kBusyIgnoresWrites;
  // Without learned weights their registers read 0 and ignore writes.
  static constexpr std::array kNotBuilt = spec::number(spec::Access::kConstant);
  const bool learned = parameters.area == spec::morphological::AreaSource::kLearned;
  for (spec::RegisterInfo info : spec::morphological::kRegisters) {
    const bool is_built =
        learned || (info.offset != reg::kWeightsAddress && info.offset != reg::kWeightsData &&
                    info.offset != reg::kWeightsSum);
    if (!is_built) info.fields = kNotBuilt;
    section.rows.push_back(info);
  }
  return section;
}

}  // namespace deburr::rtl::morphological
