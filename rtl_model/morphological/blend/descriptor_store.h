// SPDX-License-Identifier: MIT
// Keeps the records of both axes where the raster finds them.
//
// Where: at the entrance of the AreaUnit, read by its DescriptorWalk. A line that arrives is popped
// behind its slot (stage 2 of the walk), multiplied in that clock and stored in the next, which
// finishes the record; with a table a clock later, since its ends a and b are two more multiplies.
// A record is written once: the mark of its place says where it starts and how long it is, so pixel
// k of it is known without a counter, and t = t(0) + k x scale x slope. So a bank needs one read
// and one write port; a line whose bank a lower lane takes in its clock waits, which
// `bank_conflicts` counts. A horizontal record has a pair of columns, a vertical one a column. With
// crossings there is a horizontal record a column, and each column has two vertical ones, used in
// turn (the token's `entry`): a run may begin in the row after its predecessor's end. Slot rows 0
// and 1 clear the marks. Source: Reshetov 2009; paper 000, section 2.
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

// The records of an axis: marks, which the walk reads for each beat, and words, in banks by place.
class AxisDescriptors {
 public:
  // Where a record lies. Horizontal: its place is its pair of columns; vertical: its column.
  struct alignas(8) Mark {
    std::uint16_t start = 0;   // U13
    std::uint16_t length = 0;  // U12, 0: none
    std::uint16_t row = 0;     // U13, horizontal only
  };

  AxisDescriptors(const std::string& axis, const MemoryShape& shape, std::uint32_t mark_bits,
                  std::uint32_t descriptor_bits);

  std::size_t banks() const { return banks_; }
  // A power of two.
  std::size_t bank_of(std::size_t place) const { return place & (banks_ - 1); }

  // --- The walk, a clock each: marks from `place` on, then a record of a bank ---
  void read_marks(Cycle cycle, std::size_t place, std::size_t count) {
    read_marks_.read(cycle, place, count);
  }
  void check_marks(Cycle cycle, std::size_t place) const { read_marks_.check(cycle, place); }
  // The output registers of the marks take these, a beat of most lanes, in the clock of the
  // address.
  const Mark* marks_from(std::size_t place) const { return &mark_[place]; }
  void read(Cycle cycle, std::size_t place) { read_[bank_of(place)].read(cycle, place); }
  const StoredDescriptor& descriptor(Cycle cycle, std::size_t place) const {
    return read_[bank_of(place)].at(cycle, place);
  }

  // --- Lines and the first slot rows: a write a bank and clock ---
  void write(Cycle cycle, std::size_t place, const Mark& mark, const StoredDescriptor& descriptor);
  // The marks of a beat.
  void clear_marks(Cycle cycle, std::size_t place);

 private:
  const std::size_t banks_;
  Memory<void> marks_;
  ReadPort<void> read_marks_{marks_, "raster"};
  Memory<StoredDescriptor> descriptors_;
  std::vector<ReadPort<StoredDescriptor>> read_;  // a bank each, as the others
  std::vector<WritePort<void>> write_marks_;
  std::vector<WritePort<StoredDescriptor>> write_;
  // The words of `marks_`, and as many more as make a beat of most lanes.
  std::vector<Mark> mark_;
};

class DescriptorStore final : public sc_core::sc_module {
 public:
  // The AreaUnit's, of its lines.
  struct Counters {
    Counter &descriptors, &bank_conflicts;
  };

  // `columns`: of the longest row, in whole beats, of a pair at least.
  DescriptorStore(const sc_core::sc_module_name& name,
                  const spec::morphological::Parameters& parameters, std::size_t columns,
                  Counters counters);

  // --- Lines: what their stages do in a clock. False: nothing, or `finished` has no room ---
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
  // A slot passes stage 2 of the walk, so that lines of it may enter.
  void pass(Cycle cycle, const Slot& slot) {
    if (slot.beat == 0) {
      row_begin_ = slot.number & kSlotMask;
      odd_row_ = slot.row & 1;
    }
    passed_ = (slot.number + 1) & kSlotMask;
    if (slot.row < 2) clear_marks(cycle, slot);
  }

  // --- Places, for the walk ---
  AxisDescriptors& row() { return row_; }
  AxisDescriptors& column() { return column_; }
  // Of a row's columns: of the pair that column x lies in, or of the column. kPairs: built without
  // crossings.
  template <bool kPairs>
  std::size_t row_place(std::int32_t row, std::size_t x) const {
    return static_cast<std::size_t>(row & 1) * pairs_ + (x >> (kPairs ? 1 : pair_bits_));
  }
  std::uint32_t pair_bits() const { return pair_bits_; }
  std::uint32_t entry_bits() const { return entry_bits_; }

  void reset();

  // Of every line as it is stored.
  std::function<void(const spec::morphological::LineDescriptor&)> observer;

  static Datasheet datasheet(const spec::morphological::Parameters& parameters);

 private:
  // Lines between their pop and their store.
  struct Lines {
    std::array<LineToken, spec::morphological::kMaxLanes> entered;
    std::size_t entered_count = 0;
    // With a table: t(0) is known, the ends follow.
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
  const bool ends_;    // with a table, which needs those of the line
  const bool shapes_;  // with a table or corners
  // Columns that weight a horizontal record, records of a column: both a power of two.
  const std::uint32_t pair_bits_, entry_bits_;
  const std::size_t pairs_;  // of a row
  AxisDescriptors row_, column_;
  Lines row_lines_, column_lines_;
  Counters counters_;
  // U15, low bits: the slot that comes next into stage 3; the first one of the row of the last one.
  std::uint32_t passed_ = 0, row_begin_ = 0;
  bool odd_row_ = false;  // that row
};

}  // namespace deburr::rtl::morphological
