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

// Fragments from a source other than the scene's rasteriser.
struct ForeignFragments {
  std::function<traces::QuadSource()> open;  // starts again from the first quad at each call
  std::uint64_t fragments = 0;               // total of covered lanes
};

struct TextureSetup {
  spec::texture::Parameters texture;
  MemoryParameters memory;
  ForeignFragments foreign{};
  // Called for every quad as it is sent.
  std::function<void(const traces::TracedQuad&)> observer{};
  // Precomputed golden results; null: the golden model runs with the hardware. Must be null
  // with memory errors or a recorded pixel.
  std::shared_ptr<const TextureExpectation> expectation = nullptr;
  // Connects the engine to its memory; null: directly.
  std::function<void(rtl::Engine&, platform::MemoryModel&)> connect{};
  // Replacements of the engine's units; empty: none (texture_counterparts.h).
  rtl::texture::TextureUnit::StandIns stand_ins{};
};
// Upper bound of the cycles of a memory access.
inline rtl::MemoryCycles memory_cycles(const TextureSetup& setup) {
  return memory_cycles(setup.memory, setup.texture.cache_line_bytes);
}
// Parameters with the FIFO depth and the outstanding lines that are built.
inline spec::texture::Parameters as_built(spec::texture::Parameters parameters,
                                          const rtl::MemoryCycles& memory) {
  parameters.cache_fifo_depth = rtl::texture::LatencyFifo::depth(parameters, memory);
  parameters.cache_outstanding = rtl::texture::MissQueue::entries(parameters, memory);
  return parameters;
}

}  // namespace deburr::tb
