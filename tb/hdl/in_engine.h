// SPDX-License-Identifier: MIT
// Verilated units of hdl/texture that replace SystemC units inside a texture unit: at their ports,
// with its registers and counters (docs/explanation/hdl.md, "In the engine").
#pragma once

#include <bit>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "rtl_model/texture/texture_unit.h"
#include "spec/texture/registers.h"
#include "tb/engines/texture/texture_counterparts.h"
#include "tb/engines/texture/texture_setup.h"
#include "tb/hdl/adapter.h"
#include "tb/hdl/settings.h"
#include "tb/hdl/verilated_cache.h"

namespace deburr::tb::hdl {

template <class Model>
class AddressInEngine final
    : public VerilatedAt<Model, spec::texture::Quad, rtl::texture::TexelToken> {
  using Base = VerilatedAt<Model, spec::texture::Quad, rtl::texture::TexelToken>;

 public:
  AddressInEngine(rtl::texture::TextureUnit& unit, rtl::LatencyProbe& probe, std::uint64_t seed)
      : Base("address_hdl", unit.address.derivative.clock(), seed, unit.address.derivative.quads_in,
             unit.narrow_address->texels_out, unit.parameters()),
        unit_(unit),
        probe_(probe) {
    rtl::texture::AddressUnit& address = *unit.narrow_address;
    rtl::ClockDomain& clock = this->clock();
    rtl::texture::DerivativeUnit& d = address.derivative;
    clock.replace(d, {&d.quads, &d.fragments, &d.clamped, &d.saturated, &d.invalid});
    if (address.footprint) clock.replace(*address.footprint);
    if (address.axis) clock.replace(*address.axis);
    clock.replace(address.log2);
    clock.replace(address.level);
    clock.replace(address.walker);
    clock.replace(address.addresser, {&address.addresser.bilinears});
    this->on_clock = [&d](Model& says) {
      if (says.saturated) ++d.saturated;
    };
    namespace reg = spec::texture::reg;
    for (const spec::RegisterInfo& info : rtl::texture::register_table()) {
      if (info.offset < reg::kTextureBase) continue;
      const std::uint32_t at = info.offset - reg::kTextureBase;
      unit.control.on_taken(info.offset, [this, at](std::uint32_t value) {
        write_word(*this, at / reg::kTextureStride, at % reg::kTextureStride / 4, value);
      });
    }
  }
  void reset() override {
    Base::reset();
    probe_.reset();
  }

 private:
  bool admits() const override { return unit_.control.enabled(); }
  void popped(rtl::Cycle cycle, const spec::texture::Quad& quad) override {
    rtl::texture::DerivativeUnitBase& d = unit_.address.derivative;
    const unsigned lanes = quad.coverage & 0xFu;
    const auto covered = static_cast<std::uint64_t>(std::popcount(lanes));
    ++d.quads;
    d.fragments += covered;
    d.clamped += static_cast<std::uint64_t>(std::popcount(lanes & quad.clamped));
    for (std::uint64_t i = 0; i < covered; ++i) probe_.enters(cycle);
  }
  void pushed(rtl::Cycle, const rtl::texture::TexelToken& request) override {
    if (request.ticket.valid) {
      ++unit_.address.addresser.bilinears;
    } else {
      ++unit_.address.derivative.invalid;
      unit_.control.set_sticky(spec::texture::reg::kStatusInvalidTexture);
    }
  }

  rtl::texture::TextureUnit& unit_;
  rtl::LatencyProbe& probe_;
};

template <class Model>
class CacheInEngine final : public VerilatedCacheAt<Model> {
 public:
  CacheInEngine(rtl::texture::TextureUnit& unit, rtl::LatencyProbe&, std::uint64_t seed)
      : VerilatedCacheAt<Model>(
            "cache_hdl", unit.cache.tag_stage.clock(), seed,
            {unit.cache.narrow->tag_stage.texels_in, *unit.cache.narrow->data_stage.texels_out,
             unit.cache.miss_queue.requests_out, unit.cache.miss_queue.responses_in},
            unit.parameters()),
        unit_(unit),
        failed_(static_cast<std::size_t>(unit.parameters().cache_outstanding)) {
    rtl::texture::TextureCache& cache = unit.cache;
    rtl::texture::MissQueue& m = cache.miss_queue;
    rtl::ClockDomain& clock = this->clock();
    clock.replace(m, {&m.line_fills, &m.fill_bytes, &m.memory_errors});
    clock.replace(cache.tag_stage);
    clock.replace(cache.narrow->latency_fifo);
    clock.replace(cache.data_stage);
    unit.control.on_command(spec::texture::reg::kControlInvalidate, [this] { this->invalidate(); });
  }
  void reset() override {
    VerilatedCacheAt<Model>::reset();
    failed_.assign(failed_.size(), false);
  }

 private:
  void asked(const rtl::MemoryRequest&) override {
    ++unit_.cache.miss_queue.line_fills;
    unit_.cache.miss_queue.fill_bytes +=
        static_cast<std::uint64_t>(unit_.parameters().cache_line_bytes);
  }
  // Counts a line once, however many of its beats had an error.
  void received(const rtl::MemoryResponse& beat) override {
    const bool failed = failed_[beat.tag] || beat.status != rtl::MemoryStatus::kOk;
    failed_[beat.tag] = failed && !beat.last;
    if (!failed || !beat.last) return;
    ++unit_.cache.miss_queue.memory_errors;
    unit_.control.set_sticky(spec::texture::reg::kStatusMemoryError);
  }

  rtl::texture::TextureUnit& unit_;
  std::vector<bool> failed_;  // of lines in flight, by tag
};

template <class Model>
class FilterInEngine final
    : public VerilatedAt<Model, rtl::texture::TexelQuadToken, spec::texture::ColourGroup> {
 public:
  FilterInEngine(rtl::texture::TextureUnit& unit, rtl::LatencyProbe& probe, std::uint64_t seed)
      : VerilatedAt<Model, rtl::texture::TexelQuadToken, spec::texture::ColourGroup>(
            "filter_hdl", unit.filter.clock(), seed, unit.narrow_filter->texels_in,
            unit.filter.colours_out, unit.parameters()),
        filter_(unit.filter),
        probe_(probe) {
    this->clock().replace(filter_, {&filter_.fragments});
  }

 private:
  void pushed(rtl::Cycle cycle, const spec::texture::ColourGroup&) override {
    ++filter_.fragments;
    filter_.fragment_latency.record(probe_.leaves(cycle + 1));
  }

  rtl::texture::FilterPipelineBase& filter_;
  rtl::LatencyProbe& probe_;
};

// Registers one counterpart; called from the list that cmake/Hdl.cmake generates. `settings` holds
// the model's settings.
template <class InEngine>
void add_counterpart(const char* unit, const char* settings) {
  add_texture_counterpart({unit, as_built(parameters_of(settings), {}),
                           [](rtl::texture::TextureUnit& around, rtl::LatencyProbe& probe,
                              std::uint64_t seed) -> std::unique_ptr<sc_core::sc_module> {
                             return std::make_unique<InEngine>(around, probe, seed);
                           }});
}
template <class Model>
void add_address_unit(const char* settings) {
  add_counterpart<AddressInEngine<Model>>("address", settings);
}
template <class Model>
void add_texture_cache(const char* settings) {
  add_counterpart<CacheInEngine<Model>>("cache", settings);
}
template <class Model>
void add_filter_pipeline(const char* settings) {
  add_counterpart<FilterInEngine<Model>>("filter", settings);
}

}  // namespace deburr::tb::hdl
