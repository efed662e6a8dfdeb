// SPDX-License-Identifier: MIT
// Protocol checker for links. A link registers pushed beats, so "valid holds until taken" means
// that a beat stays in its slot, unchanged, until it is popped. At the end of every cycle, for
// every link:
//   * at most one push and one pop, each through its port (conservation),
//   * a pop takes a beat that was pushed in an earlier cycle; a push takes a slot that was free
//     before this cycle,
//   * the payload at the pop equals the payload at the push, bit for bit,
//   * with `widths`, every field of a pushed beat fits its declared width.
// At the end of the run no beat may be left in a link. A violation throws SimulationError.
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
  // Checks all links that exist and whose full name matches the glob. So construct it after the
  // design.
  explicit LinkChecker(rtl::ClockDomain& clock, const std::string& glob = "*", bool widths = false);

  rtl::Activity tick(rtl::Cycle cycle) override;
  void reset() override;

  std::size_t links() const { return watched_.size(); }
  std::uint64_t beats() const;  // popped and compared so far
  // Throws if a link still holds beats.
  void check_empty() const;

 private:
  // Everything that is read per cycle, in one cache line.
  struct alignas(64) Watched {
    const rtl::LinkBase* link;
    std::uint64_t pushes = 0, pops = 0;  // at the end of the previous cycle
    // The link's slots and, at the same offsets, copies of the beats as pushed. Offsets are in
    // bytes from the first slot and advance with each push and pop.
    const std::byte* slots;
    std::unique_ptr<std::byte[]> copies;
    // Called in cycles in which the link is not idle.
    void (*follow)(Watched& watched, rtl::Cycle cycle);
    std::uint32_t slot_bytes, ring_bytes, tail = 0, head = 0;

    std::uint32_t after(std::uint32_t place) const {
      return place + slot_bytes == ring_bytes ? 0 : place + slot_bytes;
    }
    const std::byte* oldest() const { return slots + head; }
    const std::byte* newest() const { return slots + tail; }
    // Copy of the oldest beat.
    const std::byte* expected() const { return copies.get() + head; }
    std::byte* kept() const { return copies.get() + tail; }
  };
  static std::uint32_t place_of(const Watched& watched, std::uint64_t beat);
  void adopt(Watched& watched);
  // Throws on any violation.
  template <bool kWidths>
  static void follow(Watched& watched, rtl::Cycle cycle);
  // Instances for this payload size. The second handles a link that streams; keeping the first out
  // of line leaves it more registers.
  template <std::size_t kBytes>
  [[gnu::noinline]] static void follow_beats(Watched& watched, rtl::Cycle cycle);
  template <std::size_t kBytes>
  static void follow_stream(Watched& watched, rtl::Cycle cycle);
  static void (*follower_of(std::size_t payload_bytes))(Watched& watched, rtl::Cycle cycle);
  [[noreturn, gnu::cold]] static void reject_counts(const Watched& watched, rtl::Cycle cycle);
  // Throws only if a field changed; padding bits are ignored.
  static void reject_change(const Watched& watched, rtl::Cycle cycle);
  static void reject_width(const Watched& watched, rtl::Cycle cycle);

  std::vector<Watched> watched_;
  // Number of compared beats, minus the number of pops of all links since their resets.
  std::uint64_t beats_ = 0;
};

}  // namespace deburr::tb
