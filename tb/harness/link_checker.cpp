// SPDX-License-Identifier: MIT
#include "tb/harness/link_checker.h"

#include <fmt/format.h>

#include <cstring>

#include "rtl_model/fabric/counters.h"
#include "rtl_model/fabric/trace.h"
#include "spec/error.h"

namespace deburr::tb {

LinkChecker::LinkChecker(rtl::ClockDomain& clock, const std::string& glob, bool widths)
    : widths_(widths) {
  rtl::for_each<rtl::LinkBase>([&](rtl::LinkBase& link) {
    if (!rtl::glob_match(glob, link.name())) return;
    watched_.push_back({&link, link.pushes(), link.pops(),
                        std::vector<std::byte>(link.depth() * link.payload_bytes()), 0});
    // A beat that is there already is taken as it is.
    Watched& watched = watched_.back();
    for (std::uint64_t n = link.pops(); n < link.pushes(); ++n)
      std::memcpy(watched.copies.data() + n % link.depth() * link.payload_bytes(), link.beat(n),
                  link.payload_bytes());
  });
  clock.add_after(*this);
}

void LinkChecker::follow(Watched& w, rtl::Cycle cycle) {
  const rtl::LinkBase& link = *w.link;
  const auto violation = [&](const std::string& what) {
    throw spec::SimulationError(fmt::format("{}: cycle {}: {} (producer {}, consumer {})",
                                            link.name(), cycle, what, link.producer(),
                                            link.consumer()));
  };
  const std::uint64_t pushed = link.last_push() == cycle, popped = link.last_pop() == cycle;
  const std::uint64_t before = w.pushes - w.pops;
  if (link.pushes() != w.pushes + pushed)
    violation(fmt::format("{} beats have gone in, {} were pushed: a beat vanished or appeared",
                          link.pushes(), w.pushes + pushed));
  if (link.pops() != w.pops + popped)
    violation(fmt::format("{} beats have gone out, {} were popped: a beat vanished", link.pops(),
                          w.pops + popped));
  if (pushed && before == link.depth()) violation("a push into a link that was full");
  if (popped && before == 0) violation("a pop of a beat that was pushed in the same cycle");

  const std::size_t bytes = link.payload_bytes();
  const auto copy = [&](std::uint64_t number) {
    return w.copies.data() + number % link.depth() * bytes;
  };
  if (popped) {
    // All bytes first: the list of fields is needed for the text only.
    const std::byte* beat = link.beat(w.pops);
    if (std::memcmp(beat, copy(w.pops), bytes) != 0)
      if (const std::string fields = link.payload().difference(copy(w.pops), beat); !fields.empty())
        violation(fmt::format("beat {} changed while it waited (was/is): {}", w.pops, fields));
    ++w.compared;
  }
  if (pushed) {
    std::memcpy(copy(w.pushes), link.beat(w.pushes), bytes);
    const rtl::Field* wide = widths_ ? link.payload().misfit(link.beat(w.pushes)) : nullptr;
    if (wide)
      violation(fmt::format("beat {}: the value of {} needs more than its {} bits", w.pushes,
                            wide->name, wide->bits));
  }
  w.pushes = link.pushes();
  w.pops = link.pops();
}

rtl::Activity LinkChecker::tick(rtl::Cycle cycle) {
  for (Watched& watched : watched_) follow(watched, cycle);
  return rtl::kIdle;
}

void LinkChecker::reset() {
  for (Watched& watched : watched_) {
    watched.pushes = watched.link->pushes();
    watched.pops = watched.link->pops();
  }
}

std::uint64_t LinkChecker::beats() const {
  std::uint64_t sum = 0;
  for (const Watched& watched : watched_) sum += watched.compared;
  return sum;
}

void LinkChecker::check_empty() const {
  std::string text;
  for (const Watched& watched : watched_)
    if (!watched.link->empty())
      text += fmt::format("\n  {}: {} beats left, {} in, {} out", watched.link->name(),
                          watched.link->occupancy(), watched.link->pushes(), watched.link->pops());
  if (!text.empty()) throw spec::SimulationError("links are not empty at the end:" + text);
}

}  // namespace deburr::tb
