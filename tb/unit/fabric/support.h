// SPDX-License-Identifier: MIT
// A small pipeline with random stalls, and helpers for rejections.
#pragma once

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <systemc>
#include <vector>

#include "rtl_model/fabric/clock_domain.h"
#include "rtl_model/fabric/link.h"
#include "rtl_model/fabric/unit.h"
#include "tb/base/random.h"
#include "tb/harness/driver.h"
#include "tb/harness/in_child.h"
#include "tb/harness/statistics.h"

namespace deburr::tb {

// Returns the message of the error that an action ends with.
template <class Error, class F>
std::string text_of(F&& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  ADD_FAILURE() << "no error";
  return {};
}

struct Token {
  std::uint32_t number = 0;
  std::uint32_t value = 0;
  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit("number", self.number, 32, "U32");
    visit("value", self.value, 32, "U32");
  }
  friend bool operator==(const Token&, const Token&) = default;
};

// Adds its key to each token; stalls at random. `raise` is called at each token, for tests of the
// SystemC calls that units may make.
class Adder final : public rtl::Unit {
 public:
  rtl::In<Token> tokens_in{"tokens_in"};
  rtl::Out<Token> tokens_out{"tokens_out"};
  Adder(const sc_core::sc_module_name& name, rtl::ClockDomain& clock, std::uint32_t key,
        std::uint32_t stall_permille)
      : Unit(name, clock),
        key_(key),
        stall_permille_(stall_permille),
        stalled_(declare_stall("random", "stalled on purpose")) {}
  rtl::Activity tick(rtl::Cycle cycle) override {
    if (random_.chance(stall_permille_)) return stalled_;
    if (!tokens_in.can_pop(cycle)) return rtl::kIdle;
    if (!tokens_out.can_push(cycle)) return rtl::kStalledDownstream;
    Token token = tokens_in.take(cycle);
    token.value += key_;
    tokens_out.push(cycle, token);
    if (raise) raise(cycle, token);
    return rtl::kBusy;
  }
  void reset() override { random_ = Random(7, name()); }
  void set_key(std::uint32_t key) { key_ = key; }

  std::function<void(rtl::Cycle, const Token&)> raise;

 private:
  std::uint32_t key_, stall_permille_;
  Random random_{7, name()};
  rtl::Activity stalled_;
};

// driver -> adder_0 -> ... -> adder_3 -> sink
struct Pipeline {
  static constexpr int kAdders = 4;
  rtl::ClockDomain clock;
  Driver<Token> driver;
  std::vector<std::unique_ptr<Adder>> adders;
  Sink<Token> sink;
  std::vector<std::unique_ptr<rtl::Link<Token>>> links;

  explicit Pipeline(std::uint32_t tokens, std::uint32_t stall_permille = 200,
                    const sc_core::sc_time& period = sc_core::sc_time(10, sc_core::SC_NS),
                    const std::string& prefix = "")
      : clock((prefix + "clock").c_str(), period),
        driver((prefix + "driver").c_str(), clock, {stall_permille, 3}),
        sink((prefix + "sink").c_str(), clock, {stall_permille, 5}) {
    for (int i = 0; i <= kAdders; ++i)
      links.push_back(
          std::make_unique<rtl::Link<Token>>(fmt::format("{}link_{}", prefix, i).c_str()));
    driver.beats_out(*links[0]);
    for (int i = 0; i < kAdders; ++i) {
      const auto n = static_cast<std::size_t>(i);
      adders.push_back(std::make_unique<Adder>(fmt::format("{}adder_{}", prefix, i).c_str(), clock,
                                               static_cast<std::uint32_t>(i + 1), stall_permille));
      adders[n]->tokens_in(*links[n]);
      adders[n]->tokens_out(*links[n + 1]);
    }
    sink.beats_in(*links[kAdders]);
    driver.send([tokens](std::uint64_t index, Token& token) {
      if (index >= tokens) return false;
      const auto number = static_cast<std::uint32_t>(index);
      token = {number, number * 1000};
      return true;
    });
  }
  // Every beat with its cycle (relative to the last reset), and every counter of the simulation.
  std::string fingerprint() const {
    const rtl::Cycle zero = clock.cycle() - clock.cycles_since_reset();
    std::string text;
    for (std::size_t i = 0; i < sink.beats().size(); ++i)
      text += fmt::format("{}:{}={} ", sink.cycles()[i] - zero, sink.beats()[i].number,
                          sink.beats()[i].value);
    return text + statistics(clock).dump();
  }
};

}  // namespace deburr::tb
