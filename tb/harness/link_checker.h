// SPDX-License-Identifier: MIT
// Protocol checker of links. A link registers what is pushed, so "valid stays until taken" means: a
// beat that is in the link stays there, unchanged and in its place, until it is popped. Checked at
// the end of every cycle, for every link:
//   * at most one push and one pop, each by its side and not behind its back (conservation),
//   * a pop takes a beat of an earlier cycle, a push a slot that was free before this cycle,
//   * the payload at the pop is, bit for bit, the payload at the push,
//   * and, if `widths` are asked for, no field of a pushed beat needs more bits than it has.
// At the end: nothing is left in a link. A violation throws SimulationError.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "rtl_model/fabric/clock_domain.h"
#include "rtl_model/fabric/link.h"

namespace deburr::tb {

class LinkChecker final : public rtl::Clocked {
 public:
  // All links whose full name matches the glob and that exist now: construct it after the design.
  explicit LinkChecker(rtl::ClockDomain& clock, const std::string& glob = "*", bool widths = false);

  rtl::Activity tick(rtl::Cycle cycle) override;
  void reset() override;

  std::size_t links() const { return watched_.size(); }
  std::uint64_t beats() const;  // popped and compared so far
  // Throws if a link still holds beats.
  void check_empty() const;

 private:
  struct Watched {
    const rtl::LinkBase* link;
    std::uint64_t pushes = 0, pops = 0;  // as of the end of the last cycle
    std::uint64_t compared = 0;
    // The link's slots and, packed, what the beats in them were when they were pushed; the slots of
    // the next push and pop are counted along, for a division by the depth costs more than a beat.
    const std::byte* slots;
    std::size_t slot_bytes, payload_bytes;
    std::uint32_t depth, tail = 0, head = 0;
    std::vector<std::byte> copies;

    const std::byte* slot(std::uint32_t number) const { return slots + number * slot_bytes; }
    const std::byte* copy(std::uint32_t number) const {
      return copies.data() + number * payload_bytes;
    }
    std::byte* copy(std::uint32_t number) { return copies.data() + number * payload_bytes; }
    std::uint32_t after(std::uint32_t number) const { return number + 1 == depth ? 0 : number + 1; }
  };
  void adopt(Watched& watched);
  void follow(Watched& watched, rtl::Cycle cycle);
  // What follow() does not look at closer unless it must, out of its way. The first throws always,
  // the others if a field is concerned, and not only bits that belong to none.
  [[noreturn, gnu::cold]] static void reject_counts(const Watched& watched, rtl::Cycle cycle);
  [[gnu::noinline]] static void reject_change(const Watched& watched, rtl::Cycle cycle);
  [[gnu::noinline]] static void reject_width(const Watched& watched, rtl::Cycle cycle);
  std::vector<Watched> watched_;
  bool widths_;
};

}  // namespace deburr::tb
