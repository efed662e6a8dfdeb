// SPDX-License-Identifier: MIT
// Replaces a SystemC unit by a verilated unit of hdl/ with the same links at both ends and the same
// clock.
//
// A cycle takes two evaluations. Before the clock edge the unit sees its links' state: in_valid and
// in_data from can_pop() and front(), out_ready from can_push(). Its outputs in_pop, out_push and
// out_data become the pop and the push of this cycle. Then comes the edge. So links and surrounding
// units are unchanged, and the order in which the two sides of a link are ticked does not matter.
//
// Include this header before any SystemC header: Verilator's headers must come first.
#pragma once

#include <verilated.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <memory>
#include <string>
#include <systemc>
#include <type_traits>

#include "rtl_model/fabric/link.h"
#include "rtl_model/fabric/payload.h"
#include "rtl_model/fabric/unit.h"
#include "rtl_model/texture/tokens.h"
#include "tb/base/random.h"

namespace deburr::tb::hdl {

// The bits of a beat as 32-bit words, like the port of a verilated model.
inline constexpr std::size_t kMostWords = 20;
using Words = std::array<std::uint32_t, kMostWords>;

inline void insert(Words& words, std::uint32_t first, std::uint32_t bits, std::uint64_t value) {
  for (std::uint32_t done = 0; done < bits;) {
    const std::uint32_t at = first + done, offset = at % 32;
    words[at / 32] |= static_cast<std::uint32_t>(value >> done) << offset;
    done += 32 - offset;
  }
}
inline std::uint64_t extract(const Words& words, std::uint32_t first, std::uint32_t bits) {
  std::uint64_t value = 0;
  for (std::uint32_t done = 0; done < bits;) {
    const std::uint32_t at = first + done, offset = at % 32;
    value |= std::uint64_t{words[at / 32] >> offset} << done;
    done += 32 - offset;
  }
  return bits == 64 ? value : value & ((std::uint64_t{1} << bits) - 1);
}
// Packs word by word: packing bit by bit would cost more than the model's own evaluation.
inline Words packed(const rtl::Payload& payload, const void* beat) {
  Words words{};
  for (const rtl::Field& field : payload.fields())
    insert(words, field.first_bit, field.bits, field.get(static_cast<const std::byte*>(beat)));
  return words;
}
inline void unpack(const rtl::Payload& payload, const Words& words, void* beat) {
  for (const rtl::Field& field : payload.fields())
    field.set(static_cast<std::byte*>(beat), extract(words, field.first_bit, field.bits));
}

// Drives a port of any width; excess bits are dropped.
template <class Port>
void to_port(Port& port, const Words& words, std::uint32_t bits) {
  if constexpr (std::is_integral_v<Port>) {
    const std::uint64_t value = words[0] | std::uint64_t{words[1]} << 32;
    port = static_cast<Port>(bits == 64 ? value : value & ((std::uint64_t{1} << bits) - 1));
  } else {
    for (std::size_t i = 0; i < (bits + 31) / 32; ++i) port[i] = words[i];
    if (bits % 32 != 0) port[(bits - 1) / 32] &= (1u << bits % 32) - 1;
  }
}
template <class Port>
Words from_port(const Port& port, std::uint32_t bits) {
  Words words{};
  if constexpr (std::is_integral_v<Port>) {
    words[0] = static_cast<std::uint32_t>(port);
    words[1] = static_cast<std::uint32_t>(std::uint64_t{port} >> 32);
  } else {
    for (std::size_t i = 0; i < (bits + 31) / 32; ++i) words[i] = port[i];
  }
  return words;
}

// A model whose registers without reset start with noise (--x-initial unique).
template <class Model>
std::unique_ptr<Model> made_with_noise(VerilatedContext& context, Random& noise) {
  context.randReset(2);
  context.randSeed(
      static_cast<int>(noise.word() >> 1 | 1));  // with 0 each run would use another seed
  return std::make_unique<Model>(&context, "model");
}

// Drives the input port before the edge. An empty link drives noise as data.
template <class T, class Valid, class Port>
void show(rtl::In<T>& beats, const rtl::Payload& payload, rtl::Cycle cycle, Random& noise,
          Valid& valid, Port& port, bool admits = true) {
  valid = admits && beats.can_pop(cycle);
  if (valid) {
    to_port(port, packed(payload, &beats.front(cycle)), payload.bits());
  } else {
    Words words;
    for (std::uint32_t& word : words) word = noise.word();
    to_port(port, words, payload.bits());
  }
}
// Applies the unit's push to its output link.
template <class T, class Port>
T push(rtl::Out<T>& beats, const rtl::Payload& payload, rtl::Cycle cycle, const Port& port) {
  T beat{};
  unpack(payload, from_port(port, payload.bits()), &beat);
  beats.push(cycle, beat);
  return beat;
}

// The fields that hdl/ has: no decoders.
template <class Token>
rtl::PayloadShape built() {
  if constexpr (requires(Token token) { token.control.codec; })
    return rtl::texture::texel_quad_shape();
  else
    return {};
}

// A unit at given ports: its own, or those of the SystemC unit that it replaces.
template <class Model, class From, class To>
class VerilatedAt : public rtl::Unit {
 public:
  // `seed`: for all noise.
  VerilatedAt(const sc_core::sc_module_name& name, rtl::ClockDomain& clock, std::uint64_t seed,
              rtl::In<From>& in, rtl::Out<To>& out, const rtl::PayloadShape& to = built<To>())
      : Unit(name, clock),
        in_(in),
        out_(out),
        from_(rtl::Payload::of<From>(built<From>())),
        to_(rtl::Payload::of<To>(to)),
        noise_(seed, this->basename()),
        model_(made_with_noise<Model>(*context_, noise_)) {
    VerilatedAt::reset();
  }
  ~VerilatedAt() override { model_->final(); }

  Model& model() { return *model_; }
  // Called before each edge.
  std::function<void(Model&)> on_clock;

  rtl::Activity tick(rtl::Cycle cycle) override {
    show(in_, from_, cycle, noise_, model_->in_valid, model_->in_data, admits());
    const bool ready = out_.can_push(cycle);
    model_->out_ready = ready;
    model_->clk = 0;
    model_->eval();
    if (on_clock) on_clock(*model_);
    const bool pushes = model_->out_push, pops = model_->in_pop;
    if (pushes) pushed(cycle, push(out_, to_, cycle, model_->out_data));
    if (pops) popped(cycle, in_.take(cycle));
    model_->clk = 1;
    model_->eval();
    return pushes || pops ? rtl::kBusy : ready ? rtl::kIdle : rtl::kStalledDownstream;
  }
  // A reset takes an additional cycle.
  void reset() override {
    model_->rst_n = 0;
    edge();
    model_->rst_n = 1;
  }
  // An additional cycle between the domain's, in which the unit is empty and its links are idle:
  // used for a register write.
  void edge() {
    model_->in_valid = 0;
    model_->out_ready = 0;
    model_->clk = 0;
    model_->eval();
    model_->clk = 1;
    model_->eval();
  }

 private:
  // Hooks: admit the waiting beat; after a pop; after a push.
  virtual bool admits() const { return true; }
  virtual void popped(rtl::Cycle, const From&) {}
  virtual void pushed(rtl::Cycle, const To&) {}

  rtl::In<From>& in_;
  rtl::Out<To>& out_;
  std::unique_ptr<VerilatedContext> context_ = std::make_unique<VerilatedContext>();
  rtl::Payload from_, to_;
  Random noise_;
  std::unique_ptr<Model> model_;
};

// A unit with its own ports.
template <class Model, class From, class To>
class VerilatedUnit final : public VerilatedAt<Model, From, To> {
 public:
  VerilatedUnit(const sc_core::sc_module_name& name, rtl::ClockDomain& clock, std::uint64_t seed,
                const rtl::PayloadShape& to = built<To>())
      : VerilatedAt<Model, From, To>(name, clock, seed, beats_in, beats_out, to) {}

  rtl::In<From> beats_in{"beats_in"};
  rtl::Out<To> beats_out{"beats_out"};
};

// Writes the words of a descriptor into a verilated unit.
template <class Unit>
void write_word(Unit& unit, std::uint32_t handle, std::uint32_t word, std::uint32_t value) {
  auto& model = unit.model();
  model.write = 1;
  model.write_handle = static_cast<CData>(handle);
  model.write_word = static_cast<CData>(word);
  model.write_data = value;
  unit.edge();
  model.write = 0;
}

}  // namespace deburr::tb::hdl
