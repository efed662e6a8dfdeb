// SPDX-License-Identifier: MIT
#include "software.h"

#include <algorithm>
#include <array>
#include <sstream>
#include <vector>

#include "deburr_registers.h"
#include "memory_map.h"
#include "painter.h"
#include "spec/error.h"

namespace platform {

namespace {

const sc_core::sc_time kAccess(20, sc_core::SC_NS);  // time per access
// After a clock edge. At the edge, the order of SystemC's processes, and so the quantum, would
// decide in which cycle the engines see an access.
const sc_core::sc_time kPhase(1, sc_core::SC_NS);
const sc_core::sc_time kReset(40, sc_core::SC_NS);  // ten edges of the slower clock
const sc_core::sc_time kMidFrame(4000, sc_core::SC_NS);

using Level = std::vector<std::array<std::uint8_t, 4>>;

// Tiles of a floor.
Level level_0() {
  Level texels(kSide * kSide);
  for (unsigned y = 0; y < kSide; ++y)
    for (unsigned x = 0; x < kSide; ++x) {
      const bool light = (x / 16 + y / 16) % 2 == 0, joint = x % 16 == 0 || y % 16 == 0;
      const auto grain = static_cast<std::uint8_t>((x * 7 + y * 13 + x * y) % 16);
      const auto base = static_cast<std::uint8_t>(joint ? 60 : light ? 208 : 112);
      texels[y * kSide + x] = {static_cast<std::uint8_t>(base + grain), base,
                               static_cast<std::uint8_t>(base - grain), 255};
    }
  return texels;
}

Level half_of(const Level& level, unsigned side) {
  Level half(side / 2 * (side / 2));
  for (unsigned y = 0; y < side / 2; ++y)
    for (unsigned x = 0; x < side / 2; ++x)
      for (unsigned c = 0; c < 4; ++c) {
        unsigned sum = 2;
        for (unsigned i = 0; i < 4; ++i) sum += level[(2 * y + i / 2) * side + 2 * x + i % 2][c];
        half[y * (side / 2) + x][c] = static_cast<std::uint8_t>(sum / 4);
      }
  return half;
}

}  // namespace

Software::Software(const sc_core::sc_module_name& name) : sc_module(name) { SC_THREAD(program); }

void Software::program() {
  time_.reset();
  core_reset_n.write(false);
  pixel_reset_n.write(false);
  wait(kReset + kPhase);
  core_reset_n.write(true);
  pixel_reset_n.write(true);
  wait(kReset);
  expect(kTextureUnit + DEBURR_TEXTURE_ID, DEBURR_TEXTURE_ID_RESET);
  expect(kSmoother + DEBURR_MORPHOLOGICAL_ID, DEBURR_MORPHOLOGICAL_ID_RESET);
  set_up_texture();
  set_up_smoother();
  look_at_memory();
  reset_core_in_mid_frame();
  reset_pixels_in_mid_frame();
  wait_for_frame();
  frame_cycles_ = read(kSmoother + DEBURR_MORPHOLOGICAL_FRAME_CYCLES);
  blended_pixels_ = read(kSmoother + DEBURR_MORPHOLOGICAL_BLENDED_PIXELS);
  bilinears_ = read(kTextureUnit + DEBURR_TEXTURE_BILINEARS);
  texture_failed_ = texture_interrupt.read();  // prints only errors
  time_.sync();
  on_end();
}

// The painter has not sent a pixel yet, so the smoother does not see anything of the first frame.
void Software::reset_core_in_mid_frame() {
  write(kPainter + kPainterStart, 1);
  time_.sync();
  wait(kMidFrame);
  require(read(kTextureUnit + DEBURR_TEXTURE_FRAGMENTS) > 0, "the texture unit has not begun");
  time_.sync();
  core_reset_n.write(false);
  wait(kReset);
  core_reset_n.write(true);
  wait(kReset);
  require(read(kTextureUnit + DEBURR_TEXTURE_FRAGMENTS) == 0, "the texture unit is not reset");
  require(read(kTextureUnit + DEBURR_TEXTURE_TEXTURE0_SIZE) == 0, "the texture is not reset");
  set_up_texture();
  write(kPainter + kPainterStart, 1);
}

// The painter starts again while the smoother is in reset, so the next pixel that the smoother gets
// is the first of a frame.
void Software::reset_pixels_in_mid_frame() {
  while (read(kSmoother + DEBURR_MORPHOLOGICAL_STATUS) & DEBURR_MORPHOLOGICAL_STATUS_IDLE_MASK)
    time_.sync();
  time_.sync();
  wait(kMidFrame);
  require(!(read(kSmoother + DEBURR_MORPHOLOGICAL_STATUS) & DEBURR_MORPHOLOGICAL_STATUS_IDLE_MASK),
          "the smoother's frame has ended");
  time_.sync();
  pixel_reset_n.write(false);
  write(kPainter + kPainterStart, 1);
  time_.sync();
  wait(kReset);
  pixel_reset_n.write(true);
  wait(kReset);
  require(read(kSmoother + DEBURR_MORPHOLOGICAL_STATUS) == DEBURR_MORPHOLOGICAL_STATUS_IDLE_MASK,
          "the smoother is not reset");
  set_up_smoother();
}

// Writes the mip chain into memory, then descriptor 0. Rows of a level begin at multiples of 64
// bytes.
void Software::set_up_texture() {
  std::uint64_t address = kTexture;
  Level level = level_0();
  for (unsigned k = 0, side = kSide; k < kLevels; ++k, side /= 2) {
    if (k > 0) level = half_of(level, 2 * side);
    write(kTextureUnit + DEBURR_TEXTURE_TEXTURE0_BASE_0 + 4 * k,
          static_cast<std::uint32_t>(address));
    for (unsigned y = 0; y < side; ++y) {
      access(tlm::TLM_WRITE_COMMAND, address, level[y * side].data(), 4 * side);
      address += (4 * side + 63) / 64 * 64;
    }
  }
  write(kTextureUnit + DEBURR_TEXTURE_TEXTURE0_SIZE,
        DEBURR_IN(DEBURR_TEXTURE_TEXTURE0_SIZE_WIDTH, kSide) |
            DEBURR_IN(DEBURR_TEXTURE_TEXTURE0_SIZE_HEIGHT, kSide));
  write(kTextureUnit + DEBURR_TEXTURE_TEXTURE0_LOD_CLAMP,
        DEBURR_IN(DEBURR_TEXTURE_TEXTURE0_LOD_CLAMP_MAX_LOD, 12 << 8));
  write(kTextureUnit + DEBURR_TEXTURE_TEXTURE0_MODE,
        DEBURR_CHOICE(DEBURR_TEXTURE_TEXTURE0_MODE_FORMAT, RGBA8) |
            DEBURR_CHOICE(DEBURR_TEXTURE_TEXTURE0_MODE_LAYOUT, LINEAR) |
            DEBURR_CHOICE(DEBURR_TEXTURE_TEXTURE0_MODE_WRAP_S, REPEAT) |
            DEBURR_CHOICE(DEBURR_TEXTURE_TEXTURE0_MODE_WRAP_T, REPEAT) |
            DEBURR_CHOICE(DEBURR_TEXTURE_TEXTURE0_MODE_MIN_FILTER, LINEAR_MIPMAP_LINEAR) |
            DEBURR_CHOICE(DEBURR_TEXTURE_TEXTURE0_MODE_MAG_FILTER, LINEAR) |
            DEBURR_IN(DEBURR_TEXTURE_TEXTURE0_MODE_LEVELS, kLevels) |
            DEBURR_IN(DEBURR_TEXTURE_TEXTURE0_MODE_MAX_COUNT_LOG2, 3));
}

// The engine runs with its reset configuration.
void Software::set_up_smoother() {
  write(kSmoother + DEBURR_MORPHOLOGICAL_PIXEL_BASE, static_cast<std::uint32_t>(kFrame));
  write(kSmoother + DEBURR_MORPHOLOGICAL_SIZE,
        DEBURR_IN(DEBURR_MORPHOLOGICAL_SIZE_WIDTH, kWidth) |
            DEBURR_IN(DEBURR_MORPHOLOGICAL_SIZE_HEIGHT, kHeight));
}

// Reads as a debugger would, without time; also checks that this memory offers no direct memory
// interface.
void Software::look_at_memory() {
  Level row(kSide);
  tlm::tlm_generic_payload payload;
  payload.set_command(tlm::TLM_READ_COMMAND);
  payload.set_address(kTexture);
  payload.set_data_ptr(row[0].data());
  payload.set_data_length(4 * kSide);
  payload.set_streaming_width(4 * kSide);
  const Level level = level_0();
  if (bus->transport_dbg(payload) != 4 * kSide ||
      !std::equal(row.begin(), row.end(), level.begin()))
    throw deburr::spec::SimulationError(std::string(name()) + ": the texture is not in memory");
  tlm::tlm_dmi direct;
  if (bus->get_direct_mem_ptr(payload, direct))
    throw deburr::spec::SimulationError(std::string(name()) + ": memory offers direct access");
}

// An interrupt comes in simulated time: software waits until its local time is reached.
void Software::wait_for_frame() {
  time_.sync();
  while (!smoother_interrupt.read()) wait(smoother_interrupt.posedge_event());
  wait(kPhase);
  const std::uint32_t status = read(kSmoother + DEBURR_MORPHOLOGICAL_STATUS);
  if (!(status & DEBURR_MORPHOLOGICAL_STATUS_FRAME_DONE_MASK) ||
      (status & (DEBURR_MORPHOLOGICAL_STATUS_FRAMING_MASK |
                 DEBURR_MORPHOLOGICAL_STATUS_MEMORY_ERROR_MASK))) {
    std::ostringstream text;
    text << name() << ": the smoother interrupts with STATUS 0x" << std::hex << status;
    throw deburr::spec::SimulationError(text.str());
  }
  write(kSmoother + DEBURR_MORPHOLOGICAL_STATUS, DEBURR_MORPHOLOGICAL_STATUS_FRAME_DONE_MASK);
  wait(sc_core::SC_ZERO_TIME);
  wait(sc_core::SC_ZERO_TIME);
  if (smoother_interrupt.read())
    throw deburr::spec::SimulationError(std::string(name()) + ": the interrupt stays high");
}

// ---- the bus ----

void Software::access(tlm::tlm_command command, std::uint64_t address, void* data, unsigned bytes) {
  tlm::tlm_generic_payload payload;
  payload.set_command(command);
  payload.set_address(address);
  payload.set_data_ptr(static_cast<unsigned char*>(data));
  payload.set_data_length(bytes);
  payload.set_streaming_width(bytes);
  sc_core::sc_time delay = time_.get_local_time();
  bus->b_transport(payload, delay);
  if (payload.is_response_error()) {
    std::ostringstream text;
    text << name() << ": access to 0x" << std::hex << address << ": "
         << payload.get_response_string();
    throw deburr::spec::SimulationError(text.str());
  }
  time_.set(delay + kAccess);
  if (time_.need_sync()) time_.sync();
}

// Registers are little-endian.
std::uint32_t Software::read(std::uint64_t address) {
  std::array<std::uint8_t, 4> bytes{};
  access(tlm::TLM_READ_COMMAND, address, bytes.data(), 4);
  std::uint32_t value = 0;
  for (unsigned i = 0; i < 4; ++i) value |= static_cast<std::uint32_t>(bytes[i]) << (8 * i);
  return value;
}

void Software::write(std::uint64_t address, std::uint32_t value) {
  std::array<std::uint8_t, 4> bytes{};
  for (unsigned i = 0; i < 4; ++i) bytes[i] = static_cast<std::uint8_t>(value >> (8 * i));
  access(tlm::TLM_WRITE_COMMAND, address, bytes.data(), 4);
}

void Software::require(bool holds, const char* what) const {
  if (!holds) throw deburr::spec::SimulationError(std::string(name()) + ": " + what);
}

void Software::expect(std::uint64_t address, std::uint32_t value) {
  if (read(address) == value) return;
  std::ostringstream text;
  text << name() << ": another unit than expected at 0x" << std::hex << address;
  throw deburr::spec::SimulationError(text.str());
}

}  // namespace platform
