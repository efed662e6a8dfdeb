// SPDX-License-Identifier: MIT
#include "rtl_model/morphological/blend/pixel_store.h"

#include <algorithm>
#include <cstring>

namespace deburr::rtl::morphological {
namespace {

constexpr std::int32_t kLinePixels =
    spec::morphological::kFrameLineBytes / spec::morphological::kFramePixelBytes;
static_assert(spec::morphological::kFrameLineBytes == kLineBytes);

constexpr std::size_t kStoreWords = 8;  // words of an arriving line stored per cycle

// Words per row, rounded up to whole memory lines.
std::size_t stride_of(std::int32_t line_pixels, std::int32_t lanes) {
  const std::int32_t lines = (line_pixels + kLinePixels - 1) / kLinePixels;
  return static_cast<std::size_t>(lines) * static_cast<std::size_t>(kLinePixels / lanes);
}

// Request tag: index among the lines in flight, line within its row, row on the chip.
constexpr std::uint32_t kFlightBits = 8, kLineBits = 9;
std::uint32_t tag_of(std::uint32_t flight, std::uint32_t line, std::int32_t row) {
  return flight | line << kFlightBits |
         static_cast<std::uint32_t>(row) << (kFlightBits + kLineBits);
}
static_assert(kFlightBits + kLineBits + 2 == PixelStore::kTagBits);

}  // namespace

PixelStore::PixelStore(const sc_core::sc_module_name& name, ClockDomain& clock,
                       const spec::morphological::Parameters& p)
    : Unit(name, clock),
      lanes_(built_lanes(p)),
      lag_(search_range_rows_of(p) + spec::morphological::kRowLag),
      rows_(p.storage == spec::morphological::Storage::kMemory
                ? kLines
                : (search_range_rows_of(p) + 7 + kLines - 1) / kLines * kLines),
      stride_(stride_of(p.line_pixels, lanes_)),
      memory_stall_(declare_stall("memory", "waits for a line from memory, or to send one")),
      rows_stall_(declare_stall("rows", "the entry for a beat still holds a pixel to be blended")) {
  const bool in_memory = p.storage == spec::morphological::Storage::kMemory;
  const std::uint32_t banks = in_memory ? kStoreWords : 2;
  for (std::int32_t i = 0; i < kLines; ++i)
    lines_.push_back(std::make_unique<Lines>(
        "pixel_lines" + std::to_string(i),
        MemoryShape{.words = static_cast<std::size_t>(rows_ / kLines) * stride_,
                    .word_bits = static_cast<std::uint32_t>(32 * lanes_),
                    // A row overwrites the row that is read for the last time.
                    .read_during_write = ReadDuringWrite::kOldWord,
                    .banks = banks,
                    .span = banks,
                    .content = "every fourth row of pixels to be blended",
                    .columns = static_cast<std::uint64_t>(p.line_pixels)}));
  if (!in_memory) return;
  memory_.emplace(static_cast<std::uint32_t>(p.memory_outstanding));
  memory_error_out.emplace("memory_error_out");
}

void PixelStore::connect(Link<MemoryRequest>& requests, Link<MemoryResponse>& responses) {
  if (!memory_) return;
  memory_->requests = &requests;
  memory_->responses = &responses;
}

// ---- Output side ------------------------------------------------------------------------------

// storage = memory: have all lines arrived that the slot needs?
bool PixelStore::is_loaded(const FrameConfiguration& configuration, const Slot& slot) const {
  const std::int32_t y = slot.row - lag_;
  if (y + 1 == configuration.height) return memory_->loaded.row >= configuration.height;
  const std::int32_t end = std::min<std::int32_t>((slot.beat + 1) * lanes_, configuration.width);
  const LinePlace needed = {y + 1, static_cast<std::uint32_t>((end - 1) / kLinePixels)};
  return needed.before(memory_->loaded);
}

void PixelStore::look_around(const FrameConfiguration& configuration, std::int32_t slot_row) {
  const std::int32_t y = slot_row - lag_;
  above_ = y > 0 ? row(y - 1) : Row{};
  centre_ = row(y);
  below_ = y + 1 == configuration.height ? Row{} : row(y + 1);
  around_row_ = slot_row;
}

// Stage 1.
void PixelStore::address(Cycle cycle, const FrameConfiguration& configuration) {
  words_.before = words_.centre[static_cast<std::size_t>(lanes_) - 1];
  if (above_.lines) {
    above_.lines->read.read(cycle, above_.from + beat_);
    words_.above = above_.lines->words[above_.from + beat_];
  }
  const bool goes_on = beat_ + 1 < configuration.beats;
  centre_.lines->read.read(cycle, centre_.from + beat_, goes_on ? 2 : 1);
  const Word* const centre = &centre_.lines->words[centre_.from + beat_];
  words_.centre = centre[0];
  if (goes_on) words_.after = centre[1][0];
  if (below_.lines) {
    below_.lines->read.read(cycle, below_.from + beat_);
    words_.below = below_.lines->words[below_.from + beat_];
  }
}

// Stage 2. The rows still belong to this slot: the next slot enters stage 1 after this call.
void PixelStore::send(Cycle cycle, const FrameConfiguration& configuration) {
  const std::uint32_t beat = beat_;
  PixelToken& out = pixels_out.emplace(cycle);
  centre_.lines->read.check(cycle, centre_.from + beat);
  out.before = words_.before;
  out.centre = words_.centre;
  if (beat + 1 < configuration.beats) out.after = words_.after;
  if (above_.lines) {
    above_.lines->read.check(cycle, above_.from + beat);
    out.above = words_.above;
  }
  if (below_.lines) {
    below_.lines->read.check(cycle, below_.from + beat);
    out.below = words_.below;
  }
  fetched_ = false;
}

PixelStore::Did PixelStore::fetch(Cycle cycle, const FrameConfiguration& configuration) {
  Did did = Did::kNothing;
  if (fetched_) {
    if (!pixels_out.can_push(cycle)) return Did::kWaitsDownstream;
    send(cycle, configuration);
    did = Did::kWork;
  }
  if (!fetches_in.can_pop(cycle)) return did;
  if (memory_ && !is_loaded(configuration, fetches_in.front(cycle).slot))
    return did == Did::kWork ? did : Did::kWaitsForMemory;
  const Slot slot = fetches_in.take(cycle).slot;
  if (slot.row != around_row_) look_around(configuration, slot.row);
  beat_ = slot.beat;
  address(cycle, configuration);
  fetched_ = true;
  asked_row_ = slot.row;
  asked_beat_ = slot.beat + 1u;
  return Did::kWork;
}

// ---- Input side -------------------------------------------------------------------------------

PixelStore::Did PixelStore::store(Cycle cycle, const FrameConfiguration& configuration) {
  if (!beats_in.can_pop(cycle)) return Did::kNothing;
  const BeatToken& beat = beats_in.front(cycle);
  const Slot slot = beat.slot;
  if (slot.number == 0) begin_frame(configuration);
  if (memory_) {
    const std::int32_t first = slot.beat * lanes_;
    if (!gather(cycle, configuration, beat, first, std::min(lanes_, configuration.width - first)))
      return Did::kWaitsForMemory;
  } else {
    if (!is_free(slot.row, slot.beat)) return Did::kWaitsForRows;
    if (slot.beat == 0) in_ = row(slot.row);
    in_.lines->write.write(cycle, in_.from + slot.beat);
    in_.lines->words[in_.from + slot.beat] = beat.pixel;
  }
  beats_in.pop(cycle);
  return Did::kWork;
}

Activity PixelStore::tick(Cycle cycle) {
  const FrameConfiguration& configuration = configuration_in.read(cycle);
  const Did fetched = fetch(cycle, configuration);
  const Did stored = store(cycle, configuration);
  bool did = fetched == Did::kWork || stored == Did::kWork;
  if (memory_) {
    did |= receive(cycle);
    did |= settle(cycle);
    did |= request(cycle, configuration);
  }
  if (did) return kBusy;
  if (fetched == Did::kWaitsForMemory || stored == Did::kWaitsForMemory) return memory_stall_;
  if (fetched == Did::kWaitsDownstream) return kStalledDownstream;
  return stored == Did::kWaitsForRows ? rows_stall_ : kIdle;
}

void PixelStore::begin_frame(const FrameConfiguration& configuration) {
  around_row_ = -1;
  asked_row_ = 0;
  if (!memory_) return;
  memory_->row_lines =
      static_cast<std::uint32_t>((configuration.width + kLinePixels - 1) / kLinePixels);
  memory_->sent = memory_->answered = memory_->asked = memory_->loaded = {};
  memory_->writes.reset();
  memory_->reads.reset();
}

// Adds a beat to the gathered line and sends the line when complete; false if it cannot be sent.
bool PixelStore::gather(Cycle cycle, const FrameConfiguration& configuration, const BeatToken& beat,
                        std::int32_t x, std::int32_t count) {
  InMemory& m = *memory_;
  const bool completes = (x + count) % kLinePixels == 0 || x + count == configuration.width;
  if (completes && (!m.requests->can_push(cycle) || m.writes.full())) return false;
  constexpr std::size_t kPixelBytes = spec::morphological::kFramePixelBytes;
  const std::size_t at = static_cast<std::size_t>(x % kLinePixels) * kPixelBytes;
  m.gather.write(cycle, 0);
  std::memcpy(m.gathered.data() + at, beat.pixel.data(),
              static_cast<std::size_t>(count) * kPixelBytes);
  if (!completes) return true;
  m.send.read(cycle, 0);
  MemoryRequest& request = m.requests->emplace(cycle);
  // 32 bits: the address wraps at 4 GiB.
  request.address = configuration.pixel_base + m.sent.address;
  request.tag = tag_of(m.writes.send(), m.sent.line, 0);
  request.lines = 1;
  request.write = true;
  request.byte_mask = ~std::uint64_t{0};
  request.data = m.gathered;
  m.gathered.fill(0);  // padding
  m.sent.step(m.row_lines);
  ++lines_written;
  return true;
}

bool PixelStore::receive(Cycle cycle) {
  InMemory& m = *memory_;
  if (!m.responses->can_pop(cycle)) return false;
  const MemoryResponse& response = m.responses->front(cycle);
  if (!response.write && !load(cycle, response)) return true;
  if (response.status != MemoryStatus::kOk) {
    ++memory_errors;
    memory_error_out->raise(cycle);
  }
  const std::uint32_t flight = response.tag & ((1u << kFlightBits) - 1);
  (response.write ? m.writes : m.reads).arrives(cycle, flight);
  m.responses->pop(cycle);
  return true;
}

// Stores a line or half of it. After an error the port delivers zeros. False: half is left.
bool PixelStore::load(Cycle cycle, const MemoryResponse& response) {
  InMemory& m = *memory_;
  const auto lanes = static_cast<std::size_t>(lanes_);
  const std::size_t words = kLinePixels / lanes, part = std::min(words, kStoreWords);
  const std::size_t from = m.half ? part : 0;
  const std::uint32_t line = response.tag >> kFlightBits & ((1u << kLineBits) - 1);
  const Row to = row(static_cast<std::int32_t>(response.tag >> (kFlightBits + kLineBits)));
  const std::size_t at = to.from + line * words + from;
  to.lines->write.write(cycle, at, part);
  const std::size_t bytes = lanes * std::size_t{spec::morphological::kFramePixelBytes};
  for (std::size_t i = 0; i < part; ++i)
    std::memcpy(to.lines->words[at + i].data(), response.data.data() + (from + i) * bytes, bytes);
  m.half = !m.half && part < words;
  return !m.half;
}

// Retires lines in order, one per direction and cycle.
bool PixelStore::settle(Cycle cycle) {
  InMemory& m = *memory_;
  const bool answered = m.writes.settle(cycle), loaded = m.reads.settle(cycle);
  if (answered) m.answered.step(m.row_lines);
  if (loaded) m.loaded.step(m.row_lines);
  return answered || loaded;
}

// Requests the next line if it has been written and its entry is free.
bool PixelStore::request(Cycle cycle, const FrameConfiguration& configuration) {
  InMemory& m = *memory_;
  if (!m.asked.before(m.answered) || m.reads.full() || !m.requests->can_push(cycle)) return false;
  const std::uint32_t last_beat = std::min(
      configuration.beats - 1, ((m.asked.line + 1) * static_cast<std::uint32_t>(kLinePixels) - 1) /
                                   static_cast<std::uint32_t>(lanes_));
  if (!is_free(m.asked.row, last_beat)) return false;
  MemoryRequest& request = m.requests->emplace(cycle);
  request.address = configuration.pixel_base + m.asked.address;
  request.tag = tag_of(m.reads.send(), m.asked.line, m.asked.row % rows_);
  request.lines = 1;
  request.write = false;
  request.byte_mask = ~std::uint64_t{0};
  m.asked.step(m.row_lines);
  ++lines_read;
  return true;
}

void PixelStore::reset() {
  fetched_ = false;
  around_row_ = -1;
  asked_row_ = 0;
  if (!memory_) return;
  memory_->gathered.fill(0);
  memory_->half = false;
  memory_->sent = memory_->answered = memory_->asked = memory_->loaded = {};
  memory_->writes.reset();
  memory_->reads.reset();
}

Datasheet PixelStore::datasheet(const spec::morphological::Parameters& p) {
  const std::uint32_t lanes = lane_copies(p), word = 32 * lanes;
  const std::uint32_t memory = p.storage == spec::morphological::Storage::kMemory ? 1 : 0;
  const auto outstanding = static_cast<std::uint32_t>(p.memory_outstanding);
  constexpr auto kMemories = static_cast<std::uint32_t>(kLines);
  // Position of a line in its row, its row, and for the next write and read its address.
  constexpr std::uint32_t kPlace = 9 + 14, kAddress = 26;
  return {
      .unit = "PixelStore",
      .does = "Stores the pixels of a frame until they are blended, R + 5 rows later.",
      .latency = {2},
      // Bases of the incoming row and of the three rows around the blended one. In memory: four
      // positions, numbers of lines in flight, address and data of a request, half of a line.
      .stages = {{.clock = "1",
                  .work = "address",
                  .operators = {4 * op::add(16), 4 * op::add(17), kMemories * op::mux(17, 4),
                                2 * op::compare(14), op::compare(13), op::equal(14), op::logic(60),
                                memory * 4 * op::add(9), memory * 4 * op::equal(9),
                                memory * 4 * op::add(14), memory * 2 * op::add(kAddress),
                                memory * op::add(32), memory * op::mux(32 + kTagBits, 2),
                                memory * 3 * op::compare(kPlace), memory * 6 * op::add(8),
                                memory * 4 * op::equal(8), memory * op::mux(8 * word, 2),
                                memory * op::logic(100)},
                  .longest = memory != 0 ? std::vector{op::mux(1, outstanding), op::logic(8)}
                                         : std::vector{op::add(17), op::mux(17, 4)},
                  .registers =
                      4 * 16 + 2 * 14 + 13 + 8 + memory * (4 * kPlace + 2 * kAddress + 6 * 8 + 4)},
                 {.clock = "2",
                  .work = "words",
                  .path = "SRAM read",
                  .operators = {2 * op::mux(word, kMemories), op::mux(word + 32, kMemories),
                                op::mux(word + 32, 2)},
                  .longest = {op::mux(word, kMemories), op::mux(word, 2)},
                  .registers = 32}},
      .megahertz = 300};
}

}  // namespace deburr::rtl::morphological
