// SPDX-License-Identifier: MIT
// The texture cache of hdl/texture, verilated: a unit with two links to memory besides, in which it
// stands where the SystemC cache has its memory port (tb/hdl/adapter.h).
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

template <class Model>
class VerilatedCache final : public rtl::Unit {
 public:
  rtl::In<rtl::texture::TexelToken> texels_in{"texels_in"};
  rtl::Out<rtl::texture::TexelQuadToken> texels_out{"texels_out"};
  rtl::Out<rtl::MemoryRequest> requests_out{"requests_out"};
  rtl::In<rtl::MemoryResponse> responses_in{"responses_in"};

  VerilatedCache(const sc_core::sc_module_name& name, rtl::ClockDomain& clock,
                 const spec::texture::Build& build)
      : Unit(name, clock),
        request_(rtl::Payload::of<rtl::MemoryRequest>(memory_request_shape(build))),
        response_(rtl::Payload::of<rtl::MemoryResponse>(memory_response_shape(build))) {
    context_->randReset(2);
    context_->randSeed(11);
    model_ = std::make_unique<Model>(context_.get(), "model");
    model_->invalidate = 0;
    reset();
  }
  ~VerilatedCache() override { model_->final(); }

  // What the cache says before each edge.
  std::function<void(Model&)> on_clock;

  rtl::Activity tick(rtl::Cycle cycle) override {
    show(texels_in, texel_, cycle, noise_, model_->in_valid, model_->in_data);
    show(responses_in, response_, cycle, noise_, model_->response_valid, model_->response_data);
    model_->out_ready = texels_out.can_push(cycle);
    model_->request_ready = requests_out.can_push(cycle);
    model_->clk = 0;
    model_->eval();
    if (on_clock) on_clock(*model_);
    push(texels_out, quad_, cycle, model_->out_push, model_->out_data);
    push(requests_out, request_, cycle, model_->request_push, model_->request_data);
    if (model_->in_pop) texels_in.pop(cycle);
    if (model_->response_pop) responses_in.pop(cycle);
    model_->clk = 1;
    model_->eval();
    return rtl::kBusy;
  }
  // Reset and invalidation take a clock of their own, in which the links do nothing.
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
  std::unique_ptr<VerilatedContext> context_ = std::make_unique<VerilatedContext>();
  std::unique_ptr<Model> model_;
  rtl::Payload texel_ = rtl::Payload::of<rtl::texture::TexelToken>();
  rtl::Payload quad_ = rtl::Payload::of<rtl::texture::TexelQuadToken>();
  rtl::Payload request_, response_;
  Random noise_{1};
};

}  // namespace deburr::tb::hdl
