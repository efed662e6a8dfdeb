// SPDX-License-Identifier: MIT
// Random register accesses: reads and writes of any register, with any value, in any cycle. The
// results of the engine are not checked, but the engine must not crash or violate a protocol, and a
// reset must restore it.
#pragma once

#include <unistd.h>

#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <span>
#include <stdexcept>
#include <string>

#include "rtl_model/fabric/clock_domain.h"
#include "rtl_model/platform/register_host.h"
#include "spec/error.h"
#include "spec/registers.h"
#include "tb/base/forked.h"
#include "tb/base/random.h"
#include "tb/harness/engine_kit.h"

namespace deburr::tb {

class RegisterNoise {
 public:
  RegisterNoise(std::uint64_t seed, std::span<const spec::RegisterInfo> table,
                std::uint32_t most_offset)
      : random_(seed), table_(table), most_offset_(most_offset) {}

  // One access, mostly to a register that exists.
  void access(platform::RegisterHost& host) {
    const std::uint32_t at = offset();
    if (random_.chance(150)) {
      try {
        host.read(at);
      } catch (const spec::SimulationError&) {  // no such register: rejected as expected
      }
      return;
    }
    host.try_write(at, value());
  }

  Random& random() { return random_; }

 private:
  std::uint32_t offset() {
    if (random_.chance(700))
      return table_[random_.below(static_cast<std::uint32_t>(table_.size()))].offset;
    if (random_.chance(900)) return random_.below(most_offset_) & ~3u;
    return random_.word();
  }
  std::uint32_t value() {
    switch (random_.below(6)) {
      case 0:
        return random_.below(4);
      case 1:
        return ~0u;
      case 2:
        return random_.below(40) | random_.below(40) << 16;  // a small frame
      case 3:
        return 1u << random_.below(32);
      case 4:
        return random_.below(1u << 20) & ~63u;  // an address
      default:
        return random_.word();
    }
  }

  Random random_;
  std::span<const spec::RegisterInfo> table_;
  std::uint32_t most_offset_;
};

// Requirements for every engine under register noise: no crash, no hang, and after a reset the same
// results as a new engine. The Kit (engine_kit.h) is constructed from a Random.
template <class Kit>
std::string left_by_noise(std::uint64_t seed) {
  Random random(seed);
  Kit kit(random);
  const auto job = [&] {
    std::string text = text_of(run_job(kit, Job::kWhole), Compared::kAll);
    for (const std::string& line : state_of(kit)) text += line + "\n";
    return text;
  };
  kit.reset(Kit::kNoiseReset);
  const std::string fresh = job();
  RegisterNoise noise(random.next(), kit.engine().control.registers.table(), Kit::kMostOffset);
  kit.noise_begins();
  for (int i = 0; i < Kit::kAccesses; ++i) {
    noise.access(kit.bus());
    kit.disturb(random);
    kit.clock().run(random.below(Kit::kCycles));
  }
  if (std::string wrong = kit.noise_ends(); !wrong.empty()) return wrong;
  kit.reset(Kit::kNoiseReset);
  kit.restore();
  const std::string again = job();
  return again == fresh ? "" : "expected\n" + fresh + "got\n" + again;
}

// Runs `work` for consecutive seeds, each in its own process, until one returns a complaint: at
// least `seeds` of them, or for DEBURR_FUZZ_SECONDS if that is set. If DEBURR_FUZZ_SEED is set,
// only this seed is run. Returns the first complaint with its seed; a crash or a hang counts as a
// complaint.
inline std::string first_complaint(std::uint64_t seeds,
                                   const std::function<std::string(std::uint64_t)>& work) {
  using Clock = std::chrono::steady_clock;
  const char* const wanted = std::getenv("DEBURR_FUZZ_SECONDS");
  const Clock::time_point end = Clock::now() + std::chrono::seconds(wanted ? std::atoi(wanted) : 0);
  const char* const alone = std::getenv("DEBURR_FUZZ_SEED");
  const std::uint64_t first = alone ? std::strtoull(alone, nullptr, 10) : 1;
  constexpr unsigned kHangSeconds = 100;
  for (std::uint64_t seed = first; alone ? seed == first : seed <= seeds || Clock::now() < end;
       ++seed) {
    std::string said;
    try {
      said = forked_text([&] {
        ::alarm(kHangSeconds);
        return work(seed);
      });
    } catch (const std::runtime_error& error) {
      said = error.what();
    }
    if (!said.empty()) return "seed " + std::to_string(seed) + ": " + said;
  }
  return "";
}

}  // namespace deburr::tb
