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
#include <memory>
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
  // All that a clock looks at, in one cache line.
  struct alignas(64) Watched {
    const rtl::LinkBase* link;
    std::uint64_t pushes = 0, pops = 0;  // as of the end of the last cycle
    // The link's slots, and what the beats in them were when they were pushed, at the same places:
    // bytes from the first slot on, counted along for the next push and pop.
    const std::byte* slots;
    std::unique_ptr<std::byte[]> copies;
    // What a link does that does not rest.
    void (*follow)(Watched& watched, rtl::Cycle cycle);
    std::uint32_t slot_bytes, ring_bytes, tail = 0, head = 0;

    std::uint32_t after(std::uint32_t place) const {
      return place + slot_bytes == ring_bytes ? 0 : place + slot_bytes;
    }
    const std::byte* oldest() const { return slots + head; }
    const std::byte* newest() const { return slots + tail; }
    // The copies of the same beats.
    const std::byte* expected() const { return copies.get() + head; }
    std::byte* kept() const { return copies.get() + tail; }
  };
  static std::uint32_t place_of(const Watched& watched, std::uint64_t beat);
  void adopt(Watched& watched);
  // Throws if anything is wrong.
  template <bool kWidths>
  static void follow(Watched& watched, rtl::Cycle cycle);
  // The same for beats of this size, and for a link through which a stream of them goes: without
  // the first, which would cost the second registers, in it.
  template <std::size_t kBytes>
  [[gnu::noinline]] static void follow_beats(Watched& watched, rtl::Cycle cycle);
  template <std::size_t kBytes>
  static void follow_stream(Watched& watched, rtl::Cycle cycle);
  static void (*follower_of(std::size_t payload_bytes))(Watched& watched, rtl::Cycle cycle);
  [[noreturn, gnu::cold]] static void reject_counts(const Watched& watched, rtl::Cycle cycle);
  // These only if a field is concerned, and not only bits that belong to none.
  static void reject_change(const Watched& watched, rtl::Cycle cycle);
  static void reject_width(const Watched& watched, rtl::Cycle cycle);

  std::vector<Watched> watched_;
  // Beats that were compared, less the pops of all links since their resets.
  std::uint64_t beats_ = 0;
};

}  // namespace deburr::tb
