// SPDX-License-Identifier: MIT
#include "rtl_model/morphological/blend/pixel_store.h"

#include <algorithm>
#include <cstring>

namespace deburr::rtl::morphological {
namespace {

constexpr std::int32_t kLinePixels =
    spec::morphological::kFrameLineBytes / spec::morphological::kFramePixelBytes;
constexpr std::int32_t kMemoryRows = 3;
// Number of a line in the largest frame; with it go its direction and whether it has come.
constexpr std::uint32_t kTagBits = 22;
static_assert(spec::morphological::kMaxFrameSize *
                  (spec::morphological::kMaxFrameSize / kLinePixels) ==
              1 << kTagBits);
static_assert(spec::morphological::kFrameLineBytes == kLineBytes);

}  // namespace

PixelStore::PixelStore(const sc_core::sc_module_name& name, ClockDomain& clock,
                       const spec::morphological::Parameters& p, ParameterStore& store)
    : Unit(name, clock),
      store_(store),
      in_memory_(p.storage == spec::morphological::Storage::kMemory),
      rows_(in_memory_ ? kMemoryRows : store.reach_rows() + 7),
      // Whole lines of memory are loaded, whole beats stored.
      stride_(
          static_cast<std::size_t>((p.line_pixels + kLinePixels - 1) / kLinePixels * kLinePixels)),
      outstanding_(static_cast<std::uint32_t>(p.memory_outstanding)),
      memory_(declare_stall("memory", "a line of memory has not come, or cannot be sent")),
      rows_stall_(declare_stall("rows", "the place of a beat still holds a pixel to be blended")),
      pixels_("pixel_lines", p.line_pixels, static_cast<std::uint32_t>(rows_) * 32, "3R1W",
              static_cast<std::size_t>(rows_) * stride_),
      write_answered_(outstanding_),
      line_loaded_(outstanding_) {
  if (!in_memory_) return;
  constexpr std::uint32_t kLineBits = 8 * spec::morphological::kFrameLineBytes;
  buffers_.emplace_back("gather_line", 1, kLineBits);
  buffers_.emplace_back("response_lines", outstanding_, kLineBits);
  buffers_.emplace_back("lines_in_flight", 2 * outstanding_, kTagBits + 2);
}

void PixelStore::connect(Link<MemoryRequest>& requests, Link<MemoryResponse>& responses) {
  requests_ = &requests;
  responses_ = &responses;
}

Activity PixelStore::tick(Cycle cycle) {
  // Reads before writes: the rows are read-first.
  const Did fetched = fetch(cycle);
  const Did stored = store(cycle);
  bool did = fetched == Did::kWork || stored == Did::kWork;
  if (in_memory_) {
    const bool received = receive(cycle);
    const bool asked = request(cycle);
    did = did || received || asked;
  }
  if (did) return kBusy;
  if (fetched == Did::kWaitsForMemory || stored == Did::kWaitsForMemory) return memory_;
  if (fetched == Did::kWaitsDownstream) return kStalledDownstream;
  return stored == Did::kWaitsForRows ? rows_stall_ : kIdle;
}

PixelStore::Did PixelStore::fetch(Cycle cycle) {
  if (!fetches_in.can_pop(cycle)) return Did::kNothing;
  const Slot slot = fetches_in.front(cycle).slot;
  const FrameRules& rules = store_.rules();
  const std::int32_t y = slot.row - store_.reach_rows() - spec::morphological::kRowLag;
  const std::int32_t lanes = store_.lanes(), first = slot.beat * lanes;
  const std::int32_t end = std::min(first + lanes, rules.width);
  const bool last_row = y + 1 == rules.height;
  if (in_memory_) {
    const std::uint32_t needed = last_row
                                     ? frame_lines_
                                     : static_cast<std::uint32_t>(y + 1) * row_lines_ +
                                           static_cast<std::uint32_t>((end - 1) / kLinePixels) + 1;
    if (loaded_ < needed) return Did::kWaitsForMemory;
  }
  if (!pixels_out.can_push(cycle)) return Did::kWaitsDownstream;
  if (slot.beat == 0) {
    above_ = y > 0 ? row(y - 1) : nullptr;
    centre_ = row(y);
    below_ = last_row ? nullptr : row(y + 1);
  }
  PixelToken& out = pixels_out.emplace(cycle);
  for (std::int32_t x = first; x < end; ++x) {
    const auto i = static_cast<std::size_t>(x - first);
    out.centre[i] = centre_[x];
    if (above_) out.above[i] = above_[x];
    if (below_) out.below[i] = below_[x];
  }
  if (first > 0) out.before = centre_[first - 1];
  if (end < rules.width) out.after = centre_[end];
  fetched_ = slot.number + 1;
  fetches_in.pop(cycle);
  return Did::kWork;
}

PixelStore::Did PixelStore::store(Cycle cycle) {
  if (!beats_in.can_pop(cycle)) return Did::kNothing;
  const BeatToken& beat = beats_in.front(cycle);
  const Slot slot = beat.slot;
  const FrameRules& rules = store_.rules();
  if (slot.number == 0) begin_frame();
  const std::int32_t lanes = store_.lanes(), first = slot.beat * lanes;
  const std::int32_t count = std::min(lanes, rules.width - first);
  if (in_memory_) {
    if (!gather(cycle, beat, first, count)) return Did::kWaitsForMemory;
  } else {
    // The row before this one must have been asked for up to this beat.
    if (slot.row >= rows_ && fetched_ + rules.beats <= slot.number) return Did::kWaitsForRows;
    if (slot.beat == 0) in_row_ = row(slot.row);
    for (std::int32_t i = 0; i < count; ++i)
      in_row_[first + i] = beat.pixel[static_cast<std::size_t>(i)];
  }
  beats_in.pop(cycle);
  return Did::kWork;
}

void PixelStore::begin_frame() {
  const FrameRules& rules = store_.rules();
  fetched_ = 0;
  row_lines_ = static_cast<std::uint32_t>((rules.width + kLinePixels - 1) / kLinePixels);
  frame_lines_ = row_lines_ * static_cast<std::uint32_t>(rules.height);
  sent_ = answered_ = asked_ = loaded_ = 0;
  asked_row_ = 0;
  asked_line_ = 0;
  std::fill(write_answered_.begin(), write_answered_.end(), false);
  std::fill(line_loaded_.begin(), line_loaded_.end(), false);
}

// Puts a beat into the line in hand and sends the line if it is complete; false if it could not.
bool PixelStore::gather(Cycle cycle, const BeatToken& beat, std::int32_t x, std::int32_t count) {
  const FrameRules& rules = store_.rules();
  const bool completes = (x + count) % kLinePixels == 0 || x + count == rules.width;
  if (completes && (!requests_->can_push(cycle) || sent_ - answered_ == outstanding_)) return false;
  const auto at = static_cast<std::size_t>(x % kLinePixels * spec::morphological::kFramePixelBytes);
  std::memcpy(gathered_.data() + at, beat.pixel.data(),
              static_cast<std::size_t>(count * spec::morphological::kFramePixelBytes));
  if (!completes) return true;
  MemoryRequest& request = requests_->emplace(cycle);
  request.address = address_of(sent_);
  request.tag = sent_;
  request.lines = 1;
  request.write = true;
  request.byte_mask = ~std::uint64_t{0};
  request.data = gathered_;
  gathered_.fill(0);  // padding
  ++sent_;
  ++lines_written;
  return true;
}

bool PixelStore::receive(Cycle cycle) {
  if (!responses_->can_pop(cycle)) return false;
  const MemoryResponse& response = responses_->front(cycle);
  if (response.status != MemoryStatus::kOk) {
    ++memory_errors;
    store_.set_sticky(spec::morphological::reg::kStatusMemoryError);
  }
  const std::uint32_t line = response.tag;
  if (response.write) {
    write_answered_[line % outstanding_] = true;
    for (; answered_ != sent_ && write_answered_[answered_ % outstanding_]; ++answered_)
      write_answered_[answered_ % outstanding_] = false;
  } else {
    // With an error, the port gives zeros.
    const auto y = static_cast<std::int32_t>(line / row_lines_);
    const std::size_t x = line % row_lines_ * static_cast<std::size_t>(kLinePixels);
    std::memcpy(row(y) + x, response.data.data(), kLineBytes);
    line_loaded_[line % outstanding_] = true;
    for (; loaded_ != asked_ && line_loaded_[loaded_ % outstanding_]; ++loaded_)
      line_loaded_[loaded_ % outstanding_] = false;
  }
  responses_->pop(cycle);
  return true;
}

// Asks for the next line, if it has been written and there is a place for it.
bool PixelStore::request(Cycle cycle) {
  if (asked_ >= answered_ || asked_ - loaded_ == outstanding_ || !requests_->can_push(cycle))
    return false;
  const FrameRules& rules = store_.rules();
  if (asked_row_ >= rows_) {
    // The row that it replaces is asked for by the Blender for the last time in this slot.
    const std::uint32_t last_beat = std::min(
        rules.beats - 1, ((asked_line_ + 1) * static_cast<std::uint32_t>(kLinePixels) - 1) /
                             static_cast<std::uint32_t>(store_.lanes()));
    const auto slot_row = static_cast<std::uint32_t>(asked_row_ + store_.reach_rows() + 3);
    if (fetched_ <= slot_row * rules.beats + last_beat) return false;
  }
  MemoryRequest& request = requests_->emplace(cycle);
  request.address = address_of(asked_);
  request.tag = asked_;
  request.lines = 1;
  request.write = false;
  request.byte_mask = ~std::uint64_t{0};
  ++asked_;
  if (++asked_line_ == row_lines_) {
    asked_line_ = 0;
    ++asked_row_;
  }
  ++lines_read;
  return true;
}

void PixelStore::reset() {
  gathered_.fill(0);
  fetched_ = 0;
  frame_lines_ = sent_ = answered_ = asked_ = loaded_ = 0;
}

}  // namespace deburr::rtl::morphological
