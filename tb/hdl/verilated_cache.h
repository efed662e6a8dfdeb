// SPDX-License-Identifier: MIT
// The verilated texture cache of hdl/texture: a unit with two additional links to memory, which
// replace the SystemC cache's memory port (tb/hdl/adapter.h).
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <systemc>

#include "rtl_model/fabric/memory_port.h"
#include "rtl_model/texture/tokens.h"
#include "tb/hdl/adapter.h"
#include "tb/hdl/memory_shape.h"

namespace deburr::tb::hdl {

struct CachePorts {
  rtl::In<rtl::texture::TexelToken>& texels_in;
  rtl::Out<rtl::texture::TexelQuadToken>& texels_out;
  rtl::Out<rtl::MemoryRequest>& requests_out;
  rtl::In<rtl::MemoryResponse>& responses_in;
};

// A cache at given ports.
template <class Model>
class VerilatedCacheAt : public rtl::Unit {
 public:
  VerilatedCacheAt(const sc_core::sc_module_name& name, rtl::ClockDomain& clock, std::uint64_t seed,
                   const CachePorts& ports, const spec::texture::Parameters& build)
      : Unit(name, clock),
        ports_(ports),
        texel_(rtl::Payload::of<rtl::texture::TexelToken>(built<rtl::texture::TexelToken>(build))),
        quad_(rtl::Payload::of<rtl::texture::TexelQuadToken>(
            built<rtl::texture::TexelQuadToken>(build))),
        request_(rtl::Payload::of<rtl::MemoryRequest>(memory_request_shape(build))),
        response_(rtl::Payload::of<rtl::MemoryResponse>(memory_response_shape(build))),
        noise_(seed, this->basename()),
        model_(made_with_noise<Model>(*context_, noise_)) {
    model_->invalidate = 0;
    VerilatedCacheAt::reset();
  }
  ~VerilatedCacheAt() override { model_->final(); }

  // Called before each edge.
  std::function<void(Model&)> on_clock;

  rtl::Activity tick(rtl::Cycle cycle) override {
    show(ports_.texels_in, texel_, cycle, noise_, model_->in_valid, model_->in_data);
    show(ports_.responses_in, response_, cycle, noise_, model_->response_valid,
         model_->response_data);
    const bool ready = ports_.texels_out.can_push(cycle);
    model_->out_ready = ready;
    model_->request_ready = ports_.requests_out.can_push(cycle);
    model_->clk = 0;
    model_->eval();
    if (on_clock) on_clock(*model_);
    const bool pushes = model_->out_push, asks = model_->request_push, pops = model_->in_pop,
               receives = model_->response_pop;
    if (pushes) push(ports_.texels_out, quad_, cycle, model_->out_data);
    if (asks) asked(push(ports_.requests_out, request_, cycle, model_->request_data));
    if (pops) ports_.texels_in.pop(cycle);
    if (receives) received(ports_.responses_in.take(cycle));
    model_->clk = 1;
    model_->eval();
    return pushes || asks || pops || receives ? rtl::kBusy
           : ready                            ? rtl::kIdle
                                              : rtl::kStalledDownstream;
  }
  // Reset and invalidation take an additional cycle, in which the links are idle.
  void reset() override {
    model_->rst_n = 0;
    edge();
    model_->rst_n = 1;
  }
  void invalidate() {
    model_->invalidate = 1;
    edge();
    model_->invalidate = 0;
  }

 private:
  // Called for the cache's actions in the cycle.
  virtual void asked(const rtl::MemoryRequest&) {}
  virtual void received(const rtl::MemoryResponse&) {}
  void edge() {
    model_->in_valid = 0;
    model_->response_valid = 0;
    model_->out_ready = 0;
    model_->request_ready = 0;
    model_->clk = 0;
    model_->eval();
    model_->clk = 1;
    model_->eval();
  }
  CachePorts ports_;
  std::unique_ptr<VerilatedContext> context_ = std::make_unique<VerilatedContext>();
  rtl::Payload texel_, quad_, request_, response_;
  Random noise_;
  std::unique_ptr<Model> model_;
};

// A cache with its own ports.
template <class Model>
class VerilatedCache final : public VerilatedCacheAt<Model> {
 public:
  VerilatedCache(const sc_core::sc_module_name& name, rtl::ClockDomain& clock, std::uint64_t seed,
                 const spec::texture::Parameters& build)
      : VerilatedCacheAt<Model>(name, clock, seed,
                                {texels_in, texels_out, requests_out, responses_in}, build) {}

  rtl::In<rtl::texture::TexelToken> texels_in{"texels_in"};
  rtl::Out<rtl::texture::TexelQuadToken> texels_out{"texels_out"};
  rtl::Out<rtl::MemoryRequest> requests_out{"requests_out"};
  rtl::In<rtl::MemoryResponse> responses_in{"responses_in"};
};

}  // namespace deburr::tb::hdl
