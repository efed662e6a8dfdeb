// SPDX-License-Identifier: MIT
// Random stalls on any link, as MatchLib's RAND_STALL: in a cycle that is drawn, the link shows
// itself not ready to its producer, or not valid to its consumer. Data must not change, only time.
// A link that no injector holds pays nothing.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "rtl_model/fabric/clock_domain.h"
#include "rtl_model/fabric/link.h"
#include "tb/base/random.h"

namespace deburr::tb {

class StallInjector final : public rtl::Clocked {
 public:
  struct Options {
    std::uint32_t push_permille = 0;  // cycles of 1000 in which the link is not ready
    std::uint32_t pop_permille = 0;   // cycles of 1000 in which the link is not valid
    std::uint64_t seed = 1;           // each link draws from a stream of its own under this seed
    std::string glob = "*";           // full names of links
  };
  // On the links that exist now: construct it after the design.
  StallInjector(rtl::ClockDomain& clock, const Options& options);

  rtl::Activity tick(rtl::Cycle cycle) override;
  void reset() override;  // the same stalls again
  std::size_t links() const { return stalled_.size(); }
  std::uint64_t stalls() const { return stalls_; }

 private:
  struct Stalled {
    rtl::LinkBase* link;
    Random random;
  };
  Options options_;
  std::vector<Stalled> stalled_;
  std::uint64_t stalls_ = 0;
};

}  // namespace deburr::tb
