// SPDX-License-Identifier: MIT
// A FIFO between two clock domains, with a unit in each: the writer takes beats of a link of one
// domain, the reader passes them on in the other.
//
//   link -> Crossing::writer | entries | Crossing::reader -> link
//
// A beat is seen at the second edge of the reader after it was written, and its entry is free at
// the second edge of the writer after it was read, as behind two flip-flops. A reset of the
// reader's domain drops all beats; a reset of the writer's domain keeps those that it wrote.
#pragma once

#include <cstddef>
#include <deque>
#include <string>
#include <systemc>

#include "rtl_model/fabric/link.h"
#include "rtl_model/fabric/unit.h"

namespace platform {

template <class Beat>
class Crossing {
  // Something that one domain did at a time, and the edges of the other one since then.
  struct Seen {
    sc_core::sc_time time;
    int edges = 0;
    void at(const sc_core::sc_time& edge) { edges += time < edge ? 1 : 0; }
    bool by_both() const { return edges >= 2; }
  };
  struct Entry : Seen {
    Beat beat;
  };
  static constexpr std::size_t kEntries = 8;

 public:
  class Writer final : public deburr::rtl::Unit {
   public:
    deburr::rtl::In<Beat> beats_in{"beats_in"};
    Writer(const sc_core::sc_module_name& name, deburr::rtl::ClockDomain& clock, Crossing& crossing)
        : Unit(name, clock), crossing_(crossing) {}
    deburr::rtl::Activity tick(deburr::rtl::Cycle cycle) override {
      const sc_core::sc_time now = clock().time_of(cycle);
      std::deque<Seen>& read = crossing_.read_;
      for (Seen& each : read) each.at(now);
      while (!read.empty() && read.front().by_both()) read.pop_front();
      if (!beats_in.can_pop(cycle)) return deburr::rtl::kIdle;
      if (crossing_.written_.size() + read.size() == kEntries)
        return deburr::rtl::kStalledDownstream;
      crossing_.written_.push_back({{now}, beats_in.take(cycle)});
      return deburr::rtl::kBusy;
    }
    void reset() override {}

   private:
    Crossing& crossing_;
  };

  class Reader final : public deburr::rtl::Unit {
   public:
    deburr::rtl::Out<Beat> beats_out{"beats_out"};
    Reader(const sc_core::sc_module_name& name, deburr::rtl::ClockDomain& clock, Crossing& crossing)
        : Unit(name, clock), crossing_(crossing) {}
    deburr::rtl::Activity tick(deburr::rtl::Cycle cycle) override {
      const sc_core::sc_time now = clock().time_of(cycle);
      std::deque<Entry>& written = crossing_.written_;
      for (Entry& each : written) each.at(now);
      if (written.empty() || !written.front().by_both()) return deburr::rtl::kIdle;
      if (!beats_out.can_push(cycle)) return deburr::rtl::kStalledDownstream;
      beats_out.push(cycle, written.front().beat);
      written.pop_front();
      crossing_.read_.push_back({now});
      return deburr::rtl::kBusy;
    }
    void reset() override { crossing_.written_.clear(); }

   private:
    Crossing& crossing_;
  };

  Crossing(const std::string& name, deburr::rtl::ClockDomain& from, deburr::rtl::ClockDomain& to)
      : writer((name + "_writer").c_str(), from, *this),
        reader((name + "_reader").c_str(), to, *this) {}

 private:
  std::deque<Entry> written_;
  std::deque<Seen> read_;  // entries that the writer does not know to be free

 public:
  Writer writer;
  Reader reader;
};

}  // namespace platform
