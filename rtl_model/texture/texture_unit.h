// SPDX-License-Identifier: MIT
// Texture unit: filters textures for quads of fragments. Contract: docs/reference/texture/index.md.
//
//     quads_in -> AddressUnit -> TextureCache -> FilterPipeline -> colours_out
//                      ^              |
//                Descriptors       memory (TLM-2.0 initiator)
//                      |
//                  registers (TLM-2.0 target)
//
// Source    Paper 2.1, figure 3.
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
  Out<spec::texture::ColourGroup> colours_out{"colours_out"};

  // Creates modules that replace some units at their ports (ClockDomain::replace), for example
  // their RTL counterpart.
  using StandIns = std::function<std::vector<std::unique_ptr<sc_core::sc_module>>(
      TextureUnit& unit, LatencyProbe& probe)>;

  // Throws ConfigError if the parameters cannot be built (spec/texture/check_build.h). `memory`
  // sizes the latency FIFO if its depth is set to 0.
  TextureUnit(const sc_core::sc_module_name& name, ClockDomain& clock,
              const spec::texture::Parameters& parameters, const MemoryCycles& memory = {},
              const StandIns& stand_ins = {});
  ~TextureUnit() override;

  static Datasheet datasheet(const spec::texture::Parameters& parameters);

 private:
  spec::texture::Parameters parameters_;
  LatencyProbe probe_;
  Descriptors descriptors_;

 public:
  // Exactly one of each pair is built: with width 1, or above.
  const std::unique_ptr<AddressUnit> narrow_address;
  const std::unique_ptr<wide::AddressUnit> wide_address;
  TextureCache cache;
  const std::unique_ptr<FilterPipeline> narrow_filter;
  const std::unique_ptr<wide::FilterPipeline> wide_filter;

  // Its units with counters of either width.
  struct Address {
    DerivativeUnitBase& derivative;
    LevelUnitBase& level;
    SampleWalkerBase& walker;
    TexelAddresserBase& addresser;
  };
  const Address address;
  FilterPipelineBase& filter;

  // Cycles from taking a fragment's quad until its colour is available.
  const Histogram& fragment_latency = filter.fragment_latency;

  bool idle() const override;
  std::vector<Datasheet> datasheets() const override;
  // As built, with the actual depth of the FIFO.
  const spec::texture::Parameters& parameters() const { return parameters_; }

 private:
  // To the cache and from it, of the width that is built.
  std::unique_ptr<Link<TexelToken>> texels_;
  std::unique_ptr<Link<TexelQuadToken>> texel_quads_;
  std::unique_ptr<Link<TexelGroup>> texel_groups_;
  std::unique_ptr<Link<TexelQuadGroup>> texel_quad_groups_;
  std::vector<std::unique_ptr<sc_core::sc_module>> stand_ins_;
};

}  // namespace deburr::rtl::texture
