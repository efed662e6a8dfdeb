// SPDX-License-Identifier: MIT
// Stores the descriptors of both axes, addressed by raster position.
//
// Position  First part of the AreaUnit; read by its DescriptorWalk.
// Latency   A line is popped after its slot has passed stage 2 of the walk, multiplied in that
//           cycle and stored in the next, which finishes the descriptor. With a table one cycle
//           later: the ends a and b take two more multiplies.
// Memory    A descriptor is written once. Its mark holds start and length, so pixel k needs no
//           counter: t = t(0) + k x scale x slope. A bank therefore has one read and one write
//           port. A line whose bank is taken by a lower lane waits (counter `bank_conflicts`).
//           There is one horizontal descriptor per pair of columns and one vertical descriptor per
//           column. With crossings there is one horizontal descriptor per column, and two vertical
//           ones used in turn (`entry`), since a run may begin in the row after its predecessor's
//           end. Slot rows 0 and 1 clear the marks.
// Source    Reshetov 2009; paper 000, section 2.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <systemc>
#include <vector>

#include "rtl_model/fabric/counters.h"
#include "rtl_model/fabric/datasheet.h"
#include "rtl_model/fabric/link.h"
#include "rtl_model/fabric/memory.h"
#include "rtl_model/morphological/blend/stored_descriptor.h"
#include "rtl_model/morphological/common/frame_configuration.h"
#include "rtl_model/morphological/common/tokens.h"
#include "spec/morphological/packets.h"
#include "spec/morphological/parameters.h"

namespace deburr::rtl::morphological {

// Descriptors of one axis: marks, which the walk reads for each beat, and words; banked by address.
class AxisDescriptors {
 public:
  // Position of a descriptor. Horizontal: addressed by pair of columns; vertical: by column.
  struct alignas(8) Mark {
    std::uint16_t start = 0;   // U13
    std::uint16_t length = 0;  // U12, 0: no descriptor
    std::uint16_t row = 0;     // U13, horizontal only
  };

  AxisDescriptors(const std::string& axis, const MemoryShape& shape, std::uint32_t mark_bits,
                  std::uint32_t descriptor_bits);

  std::size_t banks() const { return banks_; }
  // The number of banks is a power of two.
  std::size_t bank_of(std::size_t place) const { return place & (banks_ - 1); }

  // --- Port of the walk: marks from `place` on, one cycle later a descriptor of a bank ---
  void read_marks(Cycle cycle, std::size_t place, std::size_t count) {
    read_marks_.read(cycle, place, count);
  }
  void check_marks(Cycle cycle, std::size_t place) const { read_marks_.check(cycle, place); }
  // Marks that the read returns. Call in the cycle of the address; valid for kMaxLanes columns.
  const Mark* marks_from(std::size_t place) const { return &mark_[place]; }
  void read(Cycle cycle, std::size_t place) { read_[bank_of(place)].read(cycle, place); }
  const StoredDescriptor& descriptor(Cycle cycle, std::size_t place) const {
    return read_[bank_of(place)].at(cycle, place);
  }

  // --- Write port of lines and of the first slot rows: one write per bank and cycle ---
  void write(Cycle cycle, std::size_t place, const Mark& mark, const StoredDescriptor& descriptor);
  // Clears the marks of a beat.
  void clear_marks(Cycle cycle, std::size_t place);

 private:
  const std::size_t banks_;
  Memory<void> marks_;
  ReadPort<void> read_marks_{marks_, "raster"};
  Memory<StoredDescriptor> descriptors_;
  std::vector<ReadPort<StoredDescriptor>> read_;  // per bank, as the write ports
  std::vector<WritePort<void>> write_marks_;
  std::vector<WritePort<StoredDescriptor>> write_;
  // Content of `marks_`, padded to a beat with the maximum number of lanes.
  std::vector<Mark> mark_;
};

class DescriptorStore final : public sc_core::sc_module {
 public:
  // Counters of the AreaUnit.
  struct Counters {
    Counter &descriptors, &bank_conflicts;
  };

  // `columns`: of the longest row, rounded up to whole beats and pairs.
  DescriptorStore(const sc_core::sc_module_name& name,
                  const spec::morphological::Parameters& parameters, std::size_t columns,
                  Counters counters);

  // --- Lines: advances their stages by a cycle. False: nothing done, or `finished` is full ---
  bool take_lines(Cycle cycle, const FrameConfiguration& configuration,
                  LanePorts<In<LineToken>>& horizontal, LanePorts<In<LineToken>>& vertical,
                  Out<FinishToken>& finished) {
    bool did = false;
    if ((ends_ ? row_lines_.measured_count + column_lines_.measured_count
               : row_lines_.entered_count + column_lines_.entered_count) != 0) {
      if (!store_lines(cycle, configuration, finished)) return false;
      did = true;
    }
    if (ends_ && row_lines_.entered_count + column_lines_.entered_count != 0) {
      measure_lines();
      did = true;
    }
    if (horizontal.any_arrives(cycle, lanes_)) did |= enter(cycle, horizontal, row_, row_lines_);
    if (vertical.any_arrives(cycle, lanes_)) did |= enter(cycle, vertical, column_, column_lines_);
    return did;
  }
  // A slot passes stage 2 of the walk; its lines may enter from now on.
  void pass(Cycle cycle, const Slot& slot) {
    if (slot.beat == 0) {
      row_begin_ = slot.number & kSlotMask;
      odd_row_ = slot.row & 1;
    }
    passed_ = (slot.number + 1) & kSlotMask;
    if (slot.row < 2) clear_marks(cycle, slot);
  }

  // --- Addresses, for the walk ---
  AxisDescriptors& row() { return row_; }
  AxisDescriptors& column() { return column_; }
  // Address of the entry for column x of a row (with crossings per column, else per pair). kPairs:
  // built without crossings.
  template <bool kPairs>
  std::size_t row_place(std::int32_t row, std::size_t x) const {
    return static_cast<std::size_t>(row & 1) * pairs_ + (x >> (kPairs ? 1 : pair_bits_));
  }
  std::uint32_t pair_bits() const { return pair_bits_; }
  std::uint32_t entry_bits() const { return entry_bits_; }

  void reset();

  // Called with every line when it is stored.
  std::function<void(const spec::morphological::LineDescriptor&)> observer;

  static Datasheet datasheet(const spec::morphological::Parameters& parameters);
  static std::uint32_t word_bits(const spec::morphological::Parameters& parameters);

 private:
  // Lines between pop and store.
  struct Lines {
    std::array<LineToken, spec::morphological::kMaxLanes> entered;
    std::size_t entered_count = 0;
    // With a table: t(0) is known, the ends are computed next.
    std::array<LineToken, spec::morphological::kMaxLanes> measured;
    std::size_t measured_count = 0;
  };

  bool enter(Cycle cycle, LanePorts<In<LineToken>>& lines, AxisDescriptors& axis, Lines& under_way);
  void measure_lines();
  bool store_lines(Cycle cycle, const FrameConfiguration& configuration,
                   Out<FinishToken>& finished);
  void store(Cycle cycle, const FrameConfiguration& configuration, AxisDescriptors& axis,
             const LineToken& token);
  std::size_t place(const AxisDescriptors& axis, const LineToken& token) const;
  void clear_marks(Cycle cycle, const Slot& slot);

  const std::size_t lanes_;
  const bool ends_;    // with a table, which needs the line's ends
  const bool shapes_;  // with a table or corners
  // Columns per horizontal descriptor, descriptors per column: log2 of both.
  const std::uint32_t pair_bits_, entry_bits_;
  const std::size_t pairs_;  // pairs per row
  AxisDescriptors row_, column_;
  Lines row_lines_, column_lines_;
  Counters counters_;
  // U15, low bits: next slot for stage 3; first slot of the row of the last slot.
  std::uint32_t passed_ = 0, row_begin_ = 0;
  bool odd_row_ = false;  // parity of that row
};

}  // namespace deburr::rtl::morphological
