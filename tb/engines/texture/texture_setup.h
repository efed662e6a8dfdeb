// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <memory>

#include "rtl_model/fabric/engine.h"
#include "rtl_model/platform/memory_model.h"
#include "rtl_model/texture/latency_fifo.h"
#include "rtl_model/texture/texture_unit.h"
#include "spec/texture/parameters.h"
#include "tb/engines/texture/texture_expectation.h"
#include "tb/env/memory_parameters.h"
#include "tb/traces/fragment_trace.h"

namespace deburr::tb {

// Where fragments come from, if not from the scene's rasteriser.
struct ForeignFragments {
  std::function<traces::QuadSource()> open;  // from the first quad on, each time
  std::uint64_t fragments = 0;               // covered lanes in all
};

struct TextureSetup {
  spec::texture::Parameters texture;
  MemoryParameters memory;
  ForeignFragments foreign{};
  // Sees every quad as it is sent.
  std::function<void(const traces::TracedQuad&)> observer{};
  // What the golden model found already; null: it works beside the hardware. Never with errors of
  // memory, nor with a pixel that is followed.
  std::shared_ptr<const TextureExpectation> expectation = nullptr;
  // Connects the engine with its memory; null: directly.
  std::function<void(rtl::Engine&, platform::MemoryModel&)> connect{};
  // What does the work of units of the engine; null: nothing (texture_counterparts.h).
  rtl::texture::TextureUnit::StandIns stand_ins{};
};
// What this memory takes at most.
inline rtl::MemoryCycles memory_cycles(const TextureSetup& setup) {
  return memory_cycles(setup.memory, setup.texture.cache_line_bytes);
}
// With the depth of the FIFO that is built.
inline spec::texture::Parameters as_built(spec::texture::Parameters parameters,
                                          const rtl::MemoryCycles& memory) {
  parameters.cache_fifo_depth = rtl::texture::LatencyFifo::depth(parameters, memory);
  return parameters;
}

}  // namespace deburr::tb
