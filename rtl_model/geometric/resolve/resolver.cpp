// SPDX-License-Identifier: MIT
#include "rtl_model/geometric/resolve/resolver.h"

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <string>

#include "rtl_model/geometric/common/hardware_lists.h"
#include "spec/geometric/records.h"
#include "spec/geometric/tables.h"

namespace deburr::rtl::geometric {
namespace {

std::uint32_t resolve_lanes_of(const spec::geometric::Parameters& p) {
  return spec::geometric::kLaneCount[static_cast<std::size_t>(p.resolve_lanes)];
}

spec::geometric::Rgba8 pixel_of(const Line& line, std::size_t pixel) {
  spec::geometric::Rgba8 rgba;
  std::copy_n(line.begin() + static_cast<std::ptrdiff_t>(4 * pixel), 4, rgba.begin());
  return rgba;
}

}  // namespace

Resolver::Resolver(const sc_core::sc_module_name& name, ClockDomain& clock,
                   const spec::geometric::Parameters& p, const ColourStore::Reader& colours)
    : Unit(name, clock),
      colours_(colours),
      lanes_(resolve_lanes_of(p)),
      originals_("originals",
                 {.words = static_cast<std::uint64_t>((p.line_pixels + 3) / 4),
                  .word_bits = 100,
                  // A block is looked up while its neighbour may be written.
                  .read_during_write = ReadDuringWrite::kNewWord,
                  .content = "four pixels before blending, and flags whether they were blended",
                  .columns = static_cast<std::uint64_t>(p.line_pixels)}),
      linear_rom_("linear_rom",
                  {.words = spec::geometric::kLinear12FromSrgb.size(),
                   .word_bits = 12,
                   .kind = MemoryKind::kRom,
                   .read_ports = 9 * lanes_,
                   .write_ports = 0,
                   .content = "linear light value of a code"},
                  spec::geometric::kLinear12FromSrgb),
      encode_rom_("encode_rom",
                  {.words = spec::geometric::kSrgbFromLinear12.size(),
                   .word_bits = 8,
                   .kind = MemoryKind::kRom,
                   .read_ports = 3 * lanes_,
                   .write_ports = 0,
                   .content = "code of a linear light value"},
                  spec::geometric::kSrgbFromLinear12),
      stalled_colours_(declare_stall("colours", "a line of colours has not arrived")) {
  for (std::uint32_t lane = 0; lane < lanes_; ++lane)
    for (const char* const channel : {"r", "g", "b"}) {
      const std::string at = std::to_string(lane) + "." + channel;
      for (const char* const operand : {" centre", " first", " second"})
        light_.emplace_back(linear_rom_, at + operand);
      codes_.emplace_back(encode_rom_, at);
    }
}

// Stage 1: line `number` = 3 i + j of the block (BlockToken::lines).
void Resolver::place(bool tiled, const Line& line, std::uint32_t number) {
  const std::size_t i = number / 3, j = number % 3;
  Window& w = window_;
  if (tiled) {
    for (std::size_t k = 0; k < 4; ++k) {
      if (i == 0) w.up[k] = pixel_of(line, 12 + k);
      if (i == 2) w.down[k] = pixel_of(line, k);
      if (i == 1 && j == 0) w.left[k] = pixel_of(line, 4 * k + 3);
      if (i == 1 && j == 2) w.right[k] = pixel_of(line, 4 * k);
    }
    if (number == 4)
      for (std::size_t k = 0; k < 16; ++k) w.own[k] = pixel_of(line, k);
    return;
  }
  if (j == 0) {
    w.left[i - 1] = pixel_of(line, 15);
  } else if (j == 2) {
    w.right[i - 1] = pixel_of(line, 0);
  } else {
    const std::size_t first = std::size_t{4} * (block(newest_).x & 3);
    for (std::size_t k = 0; k < 4; ++k) {
      const Rgba pixel = pixel_of(line, first + k);
      (i == 0 ? w.up[k] : i == 5 ? w.down[k] : w.own[4 * (i - 1) + k]) = pixel;
    }
    if (i == 0 || i == 5) return;
    if (first != 0) w.left[i - 1] = pixel_of(line, first - 1);
    if (first != 12) w.right[i - 1] = pixel_of(line, first + 4);
  }
}

Activity Resolver::load(Cycle cycle) {
  if (!loading_) {
    if (!blocks_in.can_pop(cycle)) return kIdle;
    const BlockToken& token = block(++newest_) = blocks_in.take(cycle);
    loading_ = true;
    to_load_ = token.end ? 0 : token.lines;
    if (!token.end) originals_read_.read(cycle, token.x);
    if (to_load_ == 0) return kBusy;
  }
  if (to_load_ == 0) return kStalledDownstream;
  if (!colours_.ready(cycle)) return stalled_colours_;
  place(configuration_in.read(cycle).tiled, colours_.line(cycle),
        static_cast<std::uint32_t>(std::countr_zero(to_load_)));
  colours_.release(cycle);
  to_load_ &= to_load_ - 1;
  return kBusy;
}

// Replaces blended neighbours by their original values.
void Resolver::restore(Cycle cycle, const BlockToken& block) {
  const auto over = [](const Originals& kept, std::array<Rgba, 4>& pixels) {
    for (std::size_t k = 0; k < 4; ++k)
      if (kept.blended >> k & 1) pixels[k] = kept.pixel[k];
  };
  if (block.above) over(originals_read_.at(cycle, block.x), sources_.up);
  if (has_left_ && left_x_ + 1 == block.x && left_y_ == block.y) over(left_, sources_.left);
}

// Stage 2.
void Resolver::move_on(Cycle cycle) {
  const BlockToken& token = block(newest_);
  blending_ = true;
  loading_ = false;
  blended_block_ = newest_;
  to_blend_ = token.end ? 0 : token.blended;
  sources_ = window_;
  loaded_beats_ = std::max(1, std::popcount(token.lines));
  if (token.end) {
    has_left_ = false;
    return;
  }
  if (!configuration_in.read(cycle).frame_copy) restore(cycle, token);
  Originals below;
  left_.blended = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    below.pixel[k] = window_.own[12 + k];
    below.blended |= static_cast<std::uint8_t>((token.blended >> (12 + k) & 1) << k);
    left_.pixel[k] = window_.own[4 * k + 3];
    left_.blended |= static_cast<std::uint8_t>((token.blended >> (4 * k + 3) & 1) << k);
  }
  originals_write_.write(cycle, token.x, below);
  left_x_ = token.x;
  left_y_ = token.y;
  has_left_ = true;
}

// Stage 3.
void Resolver::take_pixels(Cycle cycle, Beat& beat) {
  const BlockToken& token = block(blended_block_);
  const bool linear = configuration_in.read(cycle).linear_light;
  beat.block = static_cast<std::uint8_t>(blended_block_ % kBlocks);
  beat.count = 0;
  auto light = light_.begin();
  for (; to_blend_ != 0 && beat.count < lanes_; to_blend_ &= to_blend_ - 1) {
    const auto p = static_cast<std::size_t>(std::countr_zero(to_blend_)), x = p & 3, y = p >> 2;
    const bool horizontal = token.horizontal >> p & 1;
    const auto& [up, down, left, right] = token.weights[p];
    Operands& o = beat.operands[beat.count];
    o.pixel = static_cast<std::uint8_t>(p);
    o.code[0] = sources_.own[p];
    if (horizontal) {
      o.weight = {left, right};
      o.code[1] = x > 0 ? sources_.own[p - 1] : sources_.left[y];
      o.code[2] = x < 3 ? sources_.own[p + 1] : sources_.right[y];
    } else {
      o.weight = {up, down};
      o.code[1] = y > 0 ? sources_.own[p - 4] : sources_.up[x];
      o.code[2] = y < 3 ? sources_.own[p + 4] : sources_.down[x];
    }
    if (linear)
      for (std::size_t c = 0; c < 3; ++c)
        for (std::size_t operand = 0; operand < 3; ++operand)
          (light++)->read(cycle, o.code[operand][c]);
    ++beat.count;
  }
  beat.last = to_blend_ == 0;
  blending_ = !beat.last;
  --loaded_beats_;
}

// Stage 4.
void Resolver::subtract(Cycle cycle, Beat& beat) {
  const bool linear = configuration_in.read(cycle).linear_light;
  auto port = light_.begin();
  for (std::size_t lane = 0; lane < beat.count; ++lane) {
    Operands& o = beat.operands[lane];
    for (std::size_t c = 0; c < 3; ++c) {
      const auto light = [&](std::size_t operand) -> std::int32_t {
        const std::uint8_t code = o.code[operand][c];
        return linear ? (port++)->at(cycle, code) : code;
      };
      o.centre[c] = light(0);
      o.first[c] = light(1) - o.centre[c];
      o.second[c] = light(2) - o.centre[c];
    }
  }
}

// Stage 5.
void Resolver::multiply(Beat& beat) {
  for (std::size_t lane = 0; lane < beat.count; ++lane) {
    Operands& o = beat.operands[lane];
    for (std::size_t c = 0; c < 3; ++c)
      o.sum[c] = o.weight[0] * o.first[c] + o.weight[1] * o.second[c];
  }
}

// Stage 6.
void Resolver::round(Cycle cycle, Beat& beat) {
  const bool linear = configuration_in.read(cycle).linear_light;
  auto code = codes_.begin();
  for (std::size_t lane = 0; lane < beat.count; ++lane) {
    Operands& o = beat.operands[lane];
    for (std::size_t c = 0; c < 3; ++c) {
      const std::int32_t v = o.sum[c], moved = (std::abs(v) + 128) >> 8;
      o.value[c] = static_cast<std::uint16_t>(v < 0 ? o.centre[c] - moved : o.centre[c] + moved);
      if (linear) (code++)->read(cycle, o.value[c]);
    }
  }
}

// Stage 7.
void Resolver::encode(Cycle cycle, const Beat& beat) {
  const FrameConfiguration& configuration = configuration_in.read(cycle);
  auto code = codes_.begin();
  for (std::size_t lane = 0; lane < beat.count; ++lane) {
    const Operands& o = beat.operands[lane];
    Rgba& result = results_[o.pixel];
    for (std::size_t c = 0; c < 3; ++c)
      result[c] = configuration.linear_light ? (code++)->at(cycle, o.value[c])
                                             : static_cast<std::uint8_t>(o.value[c]);
    result[3] = static_cast<std::uint8_t>(configuration.mark ? o.code[0][3] & 0xFE : o.code[0][3]);
  }
  blended_pixels += beat.count;
  if (beat.last) close(beat.block, configuration.tiled);
}

// Ends a block.
void Resolver::close(std::uint32_t number, bool tiled) {
  const BlockToken& token = block(number);
  if (token.end) {
    ended_ = true;
    return;
  }
  ++blocks;
  written_block_ = number;
  written_ = results_;
  if (tiled) {
    to_write_ = token.blended != 0;
  } else {
    for (std::uint32_t row = 0; row < 4; ++row)
      to_write_ |= static_cast<std::uint32_t>((token.blended >> (4 * row) & 0xF) != 0) << row;
  }
  if (!observer) return;
  spec::geometric::BlockRecord record;
  record.x = token.x;
  record.y = token.y;
  record.weights = token.weights;
  record.blended = token.blended;
  for (std::size_t i = 0; i < results_.size(); ++i)
    if (token.blended >> i & 1) record.pixels[i] = results_[i];
  observer(record);
}

// Stage 8; false: the link is not ready.
bool Resolver::write(Cycle cycle) {
  if (!memory.requests_out.can_push(cycle)) return false;
  const FrameConfiguration& configuration = configuration_in.read(cycle);
  const BlockToken& token = block(written_block_);
  const auto row = static_cast<std::uint32_t>(std::countr_zero(to_write_));
  const std::uint32_t first_pixel = configuration.tiled ? 0 : 4 * row,
                      pixels = configuration.tiled ? 16 : 4,
                      at = configuration.tiled ? 0 : 4u * (token.x & 3);  // position in the line
  const std::uint32_t offset = configuration.tiled
                                   ? configuration.line_offset(token.x, token.y)
                                   : configuration.line_offset(token.x >> 2, token.y * 4u + row);
  std::uint64_t mask = 0;
  for (std::uint32_t k = 0; k < pixels; ++k)
    if (token.blended >> (first_pixel + k) & 1) mask |= std::uint64_t{0xF} << (4 * (at + k));
  Line& line = memory.write(cycle, configuration.colour_base + offset, 0, mask);
  line.fill(0);
  for (std::uint32_t k = 0; k < pixels; ++k)
    std::copy_n(written_[first_pixel + k].begin(), 4,
                line.begin() + static_cast<std::ptrdiff_t>(4 * (at + k)));
  to_write_ &= to_write_ - 1;
  ++writes_;
  ++lines_written;
  return true;
}

// Stages 7 to 3; false: the previous block is not written yet.
bool Resolver::blend(Cycle cycle) {
  if (const Beat* next = pipe_.at(4); next && next->last && to_write_ != 0) return false;
  pipe_.move();
  if (const Beat* beat = pipe_.at(5)) encode(cycle, *beat);
  if (Beat* beat = pipe_.at(4)) round(cycle, *beat);
  if (Beat* beat = pipe_.at(3)) multiply(*beat);
  if (Beat* beat = pipe_.at(2)) subtract(cycle, *beat);
  if (blending_) take_pixels(cycle, pipe_.enter());
  return true;
}

Activity Resolver::tick(Cycle cycle) {
  if (phase_in.read(cycle) != Phase::kResolve) {
    if (resolved_out.driven()) resolved_out.drive(cycle, false);
    ended_ = false;
    return kIdle;
  }
  if (memory.responses_in.can_pop(cycle)) {
    memory.responses_in.pop(cycle);
    --writes_;
  }
  const bool writes = to_write_ != 0, wrote = writes && write(cycle);
  const bool takes = blending_, blended = (takes || !pipe_.empty()) && blend(cycle);
  const bool beyond = takes && blended && loaded_beats_ < 0;
  if (loading_ && to_load_ == 0 && !blending_) move_on(cycle);
  const Activity loaded = load(cycle);
  colours_.read_ahead(cycle);
  if (ended_ && writes_ == 0 && to_write_ == 0 && !resolved_out.driven())
    resolved_out.drive(cycle, true);
  // The activity is that of the limiting stage: loading; blending, if it takes longer than loading
  // or a loaded block waits for it; writing, if blending waits for it.
  if (loaded == kBusy || beyond) return kBusy;
  if (loaded == kStalledDownstream && (blended || wrote)) return kBusy;
  return loaded == kIdle && writes && !wrote ? kStalledDownstream : loaded;
}

void Resolver::reset() {
  pipe_.reset();
  newest_ = 0;
  loading_ = blending_ = has_left_ = ended_ = false;
  to_load_ = to_blend_ = to_write_ = writes_ = 0;
  loaded_beats_ = 0;
}

Datasheet Resolver::datasheet(const spec::geometric::Parameters& p) {
  const std::uint32_t lanes = resolve_lanes_of(p), token = Payload::of<BlockToken>().bits();
  // Alpha is only kept of a block's own pixels.
  constexpr std::uint32_t kOwn = 16 * 32, kSide = 4 * 24, kWindow = kOwn + 4 * kSide,
                          kWeights = 16 * 32;
  // A block in the blend: position, blended pixels, last beat, end, lanes in use.
  constexpr std::uint32_t kBlock = 22 + 16 + 2 + 3 + 1;
  return {
      .unit = "Resolver",
      .does = "Blends the pixels of a touched block and writes them back, in place.",
      .latency = {8, "8 for a block of one line and resolve_lanes pixels, plus the wait for lines"},
      .interval = {1,
                   "max(1, lines, ceil(blended pixels / resolve_lanes), lines to write) per block"},
      .stages =
          {{.clock = "1",
            .work = "one line per cycle into a window of 16 pixels and their 16 neighbours",
            .operators = {op::priority(18), op::logic(80), op::mux(4 * 32, 4), 2 * op::mux(24, 4),
                          op::mux(kOwn, 2), 4 * op::mux(kSide, 2)},
            .longest = {op::priority(18), op::logic(8), op::mux(4 * 32, 4), op::mux(kOwn, 2)},
            .registers = token + kWindow + 1},
           {.clock = "2",
            .work = "original values of blended neighbours",
            .path = "SRAM read",
            .operators = {2 * op::mux(kSide, 2), op::add(11), op::equal(22), op::logic(16)},
            .longest = {op::logic(4), op::mux(kSide, 2)},
            .registers = kWindow + (kSide + 4 + 22 + 1) + kWeights + 3 * 16 + 22 + 2},
           {.clock = "3",
            .work = "selection of pixels, address of linear_rom",
            .operators = {lanes * op::priority(16), op::logic(32 * lanes), 2 * op::mux(16 * 24, 2),
                          op::mux(16 * 16, 2), lanes * op::mux(32, 16), 2 * lanes * op::mux(24, 16),
                          lanes * op::mux(16, 16)},
            .longest = {lanes * op::priority(16), op::mux(32, 16)},
            .registers = lanes * (4 + 32 + 2 * 24 + 16) + kBlock},
           {.clock = "4",
            .work = "linear light, differences",
            .operators = {9 * lanes * op::mux(12, 2), 6 * lanes * op::subtract(13)},
            .longest = {op::rom_read(12, 256), op::mux(12, 2), op::subtract(13)},
            .registers = lanes * (4 + 8 + 16 + 3 * 12 + 6 * 13) + kBlock},
           {.clock = "5",
            .work = "products",
            .operators = {6 * lanes * op::multiply(8, 13), 3 * lanes * op::add(22)},
            .longest = {op::multiply(8, 13), op::add(22)},
            .registers = lanes * (4 + 8 + 3 * 12 + 3 * 22) + kBlock},
           {.clock = "6",
            .work = "rounding, address of encode_rom",
            .operators = {3 * lanes * op::magnitude(22), 3 * lanes * op::add(15),
                          3 * lanes * op::subtract(13)},
            .longest = {op::magnitude(22), op::add(15), op::subtract(13)},
            .registers = lanes * (4 + 8 + 3 * 12) + kBlock},
           {.clock = "7",
            .work = "codes; product of the block's address",
            .operators = built({3 * lanes * op::mux(8, 2), op::logic(20 * lanes),
                                16 * op::mux(32, lanes), op::mux(kOwn, 2),
                                op::mux(11, 2), op::mux(10, 2), op::multiply(11, 10), op::add(22)}),
            .longest =
                built({op::rom_read(8, 4096), op::mux(8, 2), op::mux(32, lanes), op::mux(kOwn, 2)}),
            .registers = 2 * kOwn + 22 + 16 + 2 + 4 + 22},
           {.clock = "8",
            .work = "write",
            .operators = {op::priority(4), op::add(13), op::mux(13, 4), op::add(24), op::add(26),
                          op::mux(4 * 32, 4), op::mux(kOwn, 2), op::logic(64), 2 * op::add(11)},
            .longest = {op::priority(4), op::mux(13, 4), op::add(24), op::add(26)},
            .registers = 11 + 1,
            .on = "lines_written"}},
      .formats = "weights U0.8, linear light U0.12.",
      .cost = "resolve_lanes = " + std::to_string(lanes) + "."};
}

}  // namespace deburr::rtl::geometric
