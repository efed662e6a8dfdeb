// SPDX-License-Identifier: MIT
// Random stalls on any link, like MatchLib's RAND_STALL: in randomly drawn cycles the link appears
// not ready to its producer or not valid to its consumer. Stalls may change only timing, not data.
// Links without an injector have no overhead.
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
    std::uint32_t push_permille = 0;  // cycles per 1000 in which the link is not ready
    std::uint32_t pop_permille = 0;   // cycles per 1000 in which the link is not valid
    std::uint64_t seed = 1;           // each link has its own random stream derived from it
    std::string glob = "*";           // full names of links
  };
  // Applies to the links that exist now, so construct it after the design.
  StallInjector(rtl::ClockDomain& clock, const Options& options);

  rtl::Activity tick(rtl::Cycle cycle) override;
  void reset() override;  // restarts the same stalls
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
