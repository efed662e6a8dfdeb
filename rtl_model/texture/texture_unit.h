// SPDX-License-Identifier: MIT
// The texture unit: filters textures for quads of fragments (docs/reference/texture/index.md).
//
//     quads_in -> AddressUnit -> TextureCache -> FilterPipeline -> colours_out
//                      ^              |
//                Descriptors       memory (TLM-2.0 initiator)
//                      |
//                  registers (TLM-2.0 target)
//
// Source: paper 2.1, figure 3.
#pragma once

#include <functional>
#include <memory>
#include <systemc>
#include <vector>

#include "rtl_model/fabric/clock_domain.h"
#include "rtl_model/fabric/datasheet.h"
#include "rtl_model/fabric/engine.h"
#include "rtl_model/fabric/histogram.h"
#include "rtl_model/fabric/latency_probe.h"
#include "rtl_model/texture/address_unit.h"
#include "rtl_model/texture/descriptors.h"
#include "rtl_model/texture/filter_pipeline.h"
#include "rtl_model/texture/texture_cache.h"
#include "spec/texture/packets.h"
#include "spec/texture/parameters.h"

namespace deburr::rtl::texture {

class TextureUnit final : public Engine {
 public:
  In<spec::texture::Quad> quads_in{"quads_in"};
  Out<spec::texture::Colour> colours_out{"colours_out"};

  // Makes what does the work of some of its units, below it and at their ports
  // (ClockDomain::replace), for example another description of them.
  using StandIns = std::function<std::vector<std::unique_ptr<sc_core::sc_module>>(
      TextureUnit& unit, LatencyProbe& probe)>;

  // ConfigError for what cannot be built (spec/texture/check_build.h). What the memory takes sizes
  // a latency FIFO whose depth is ordered as 0.
  TextureUnit(const sc_core::sc_module_name& name, ClockDomain& clock,
              const spec::texture::Parameters& parameters, const MemoryCycles& memory = {},
              const StandIns& stand_ins = {});
  ~TextureUnit() override;

  static Datasheet datasheet(const spec::texture::Parameters& parameters);

 private:
  spec::texture::Parameters parameters_;
  LatencyProbe probe_;
  Descriptors descriptors_{"descriptors", control};

 public:
  AddressUnit address;
  TextureCache cache;
  FilterPipeline filter;

  // From a fragment's quad being taken to its colour being there to be taken.
  const Histogram& fragment_latency = filter.fragment_latency;

  bool idle() const override;
  // As built: with the depth of the FIFO.
  const spec::texture::Parameters& parameters() const { return parameters_; }

 private:
  Link<TexelToken> texels_{"texels"};
  Link<TexelQuadToken> texel_quads_{"texel_quads"};
  std::vector<std::unique_ptr<sc_core::sc_module>> stand_ins_;
};

}  // namespace deburr::rtl::texture
