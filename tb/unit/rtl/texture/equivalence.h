// SPDX-License-Identifier: MIT
// Block by block: the output of each unit of the texture pipeline equals the golden model's
// function of its input. Values only; each unit's own test checks cycles.
//
// Where two implementations of one rule can be compared without a clock, the inputs are exhaustive
// or cover every combination of leading one, mantissa and kind of low bits. Units are fed through
// links that stall now and then, corner values first, then random ones. Every block also runs with
// one wrong bit in one token: the comparison must notice.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <functional>

#include "spec/texture/descriptor.h"
#include "tb/base/random.h"
#include "tb/harness/driver.h"
#include "tb/stimuli/texture_quads.h"
#include "tb/unit/rtl/texture/support.h"

namespace deburr::tb {

namespace hw = rtl::texture;
using texture_rtl::period;
using texture_rtl::Store;
using texture_rtl::write_descriptor;

struct Verdict {
  std::uint64_t compared = 0, mismatches = 0, first = 0;  // first: index of the first wrong answer
};

inline void expect_equal(const Verdict& v, std::uint64_t at_least) {
  EXPECT_EQ(v.mismatches, 0u) << "the first at answer " << v.first;
  EXPECT_GE(v.compared, at_least);
}
// The injected fault changes one token, so it may spoil at most the answers of that token.
inline void expect_noticed(const Verdict& v, std::uint64_t answers_a_token = 1) {
  EXPECT_GE(v.mismatches, 1u);
  EXPECT_LE(v.mismatches, answers_a_token);
}

// One unit between a driver and a sink; its ports are bound to `in` and `out`.
template <class From, class To>
class Pair {
 public:
  rtl::ClockDomain clock{"clock", period()};
  rtl::Link<From> in{"in"};
  rtl::Link<To> out{"out"};

  Pair() {
    driver_.beats_out(in);
    sink_.beats_in(out);
    sink_.keep(false);
  }
  // Resets everything, including descriptors.
  void reset() {
    clock.set_reset_n(false);
    clock.run(2);
    clock.set_reset_n(true);
  }
  // Sends `tokens` tokens after a reset and checks `answers` answers.
  void run(std::uint64_t tokens, const std::function<From(std::uint64_t)>& token,
           std::uint64_t answers, const std::function<bool(std::uint64_t, const To&)>& right) {
    std::uint64_t answer = 0;
    driver_.send([&](std::uint64_t i, From& beat) {
      if (i == tokens) return false;
      beat = token(i);
      return true;
    });
    sink_.on_beat = [&](rtl::Cycle, const To& got) {
      if (!right(answer, got) && verdict.mismatches++ == 0) verdict.first = answer;
      ++answer;
      ++verdict.compared;
    };
    const bool finished =
        clock.run_until([&] { return answer >= answers; }, 100 * (tokens + answers) + 1000);
    EXPECT_TRUE(finished) << answer << " of " << answers << " answers came";
    clock.run(50);  // detects extra answers
    EXPECT_EQ(answer, answers);
  }
  Verdict verdict;

 private:
  Driver<From> driver_{"driver", clock, {.stall_permille = 50}};
  Sink<To> sink_{"sink", clock, {.stall_permille = 50}};
};

inline constexpr hw::Ticket kTicket = {7, 1, true, true, 0};
inline constexpr std::uint64_t kFaultyToken = 1000;

inline constexpr std::uint32_t kMemoryBytes = 1u << 20;

// Writes 16 descriptors; the golden functions get the same.
using Descriptors = std::array<spec::texture::Descriptor, spec::texture::kMaxTextures>;
inline void write(Store& store, const Descriptors& descriptors) {
  for (std::uint32_t h = 0; h < descriptors.size(); ++h)
    write_descriptor(store.bus, h, descriptors[h]);
}

}  // namespace deburr::tb
