// SPDX-License-Identifier: MIT
// The texture unit: filters textures for quads of fragments (docs/texture_unit.md).
//
//   quads_in -> AddressUnit -> TextureCache -> FilterPipeline -> colours_out
//                    ^              |
//              ParameterStore    memory (TLM-2.0 initiator)
//                    |
//                registers (TLM-2.0 target)
//
// Latency 17 clocks from a quad taken to its first colour (one sample, nearest, warm cache; 32 with
// `footprint = exact`); one bilinear request a clock with a warm cache, so N x (1 or 2) clocks a
// fragment. Source: paper 2.1, figure 3.
#pragma once

#include <systemc>
#include <vector>

#include "rtl_model/fabric/clock_domain.h"
#include "rtl_model/fabric/histogram.h"
#include "rtl_model/fabric/memory_port.h"
#include "rtl_model/fabric/register_block.h"
#include "rtl_model/fabric/storage.h"
#include "rtl_model/texture/address_unit.h"
#include "rtl_model/texture/filter_pipeline.h"
#include "rtl_model/texture/fragment_probe.h"
#include "rtl_model/texture/parameter_store.h"
#include "rtl_model/texture/texture_cache.h"
#include "spec/texture/packets.h"
#include "spec/texture/parameters.h"

namespace deburr::rtl::texture {

class TextureUnit final : public sc_core::sc_module {
 public:
  In<spec::texture::Quad> quads_in{"quads_in"};
  Out<spec::texture::Colour> colours_out{"colours_out"};

  // ConfigError if a parameter is out of range, or a cache size that must be a power of two is not.
  TextureUnit(const sc_core::sc_module_name& name, ClockDomain& clock,
              const spec::texture::Parameters& parameters);
  const char* kind() const override { return "deburr_texture_unit"; }

 private:
  spec::texture::Parameters parameters_;
  FragmentProbe probe_;

 public:
  ParameterStore store;
  AddressUnit address;
  TextureCache cache;
  FilterPipeline filter;

  // Sockets, to be bound from outside.
  decltype(MemoryPort::memory)& memory = cache.memory_port.memory;
  decltype(RegisterBlock::bus)& registers = store.registers.bus;

  // From a fragment's quad being taken to its colour being there to be taken.
  const Histogram& fragment_latency = filter.fragment_latency;

  // Nothing is inside and nothing waits in front. Between edges.
  bool idle() const;

  // For reports: everything below this module, in the order of declaration.
  std::vector<const Unit*> units();
  std::vector<const Counter*> counters();
  std::vector<const Storage*> memories();

  const spec::texture::Parameters& parameters() const { return parameters_; }

 private:
  Link<TexelToken> texels_{"texels"};
  Link<TexelQuadToken> texel_quads_{"texel_quads"};
};

}  // namespace deburr::rtl::texture
