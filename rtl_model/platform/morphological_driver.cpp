// SPDX-License-Identifier: MIT
#include "rtl_model/platform/morphological_driver.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "rtl_model/platform/region_check.h"
#include "spec/error.h"
#include "spec/morphological/registers.h"

namespace deburr::platform {

DriverLayout MorphologicalDriver::layout() {
  return {"morphological engine", spec::morphological::kRegisters};
}

void MorphologicalDriver::set_configuration(const spec::morphological::Parameters& p) {
  require_idle("a new configuration");
  const std::pair<std::uint32_t, std::int32_t> thresholds[] = {
      {spec::morphological::reg::kThreshold, p.threshold},
      {spec::morphological::reg::kThresholdOn, p.threshold_on_depth_edge},
      {spec::morphological::reg::kThresholdOff, p.threshold_off_depth_edge},
      {spec::morphological::reg::kAlpha, p.alpha},
      {spec::morphological::reg::kFloor, p.floor},
      {spec::morphological::reg::kDepthThreshold, p.depth_threshold}};
  registers_.write(spec::morphological::reg::kConfiguration,
                   spec::morphological::configuration_word(p));
  for (const auto& [offset, value] : thresholds)
    registers_.write(offset, static_cast<std::uint32_t>(value));
  registers_.write(spec::morphological::reg::kSmaa, spec::morphological::smaa_word(p));
}

void MorphologicalDriver::place(std::uint32_t base) {
  if (base % spec::morphological::kFrameLineBytes != 0)
    reject(fmt::format("frame base {:#x} is not a multiple of {}", base,
                       spec::morphological::kFrameLineBytes));
  require_idle("PIXEL_BASE");
  registers_.write(spec::morphological::reg::kPixelBase, base);
  base_ = base;
}

void MorphologicalDriver::set_size(int width, int height) {
  const auto across = static_cast<std::uint64_t>(std::max(0, width)),
             down = static_cast<std::uint64_t>(std::max(0, height));
  require_range("width of the frame", across, 1, spec::morphological::kMaxFrameSize);
  require_range("height of the frame", down, 1, spec::morphological::kMaxFrameSize);
  if (width > built_.line_pixels)
    reject(fmt::format("a frame of {} pixels does not fit into line_pixels = {}", width,
                       built_.line_pixels));
  if (memory_ != nullptr && built_.storage == spec::morphological::Storage::kMemory) {
    const NamedRegion frame = {"pixels", base_, frame_bytes(width, height)};
    if (const std::string complaint =
            region_complaint({&frame, 1}, spec::morphological::kFrameLineBytes, memory_->size());
        !complaint.empty())
      reject(complaint);
  }
  require_idle("SIZE");
  registers_.write(spec::morphological::reg::kSize,
                   spec::morphological::size_word(static_cast<std::uint32_t>(width),
                                                  static_cast<std::uint32_t>(height)));
}

void MorphologicalDriver::load_weights(std::span<const std::int8_t> entries) {
  if (built_.area != spec::morphological::AreaSource::kLearned)
    reject("it was built without learned weights: use area = learned");
  if (entries.size() != kWeightEntries)
    reject(fmt::format("{} learned weights, expected {}", entries.size(), kWeightEntries));
  require_idle("learned weights");
  registers_.write(spec::morphological::reg::kWeightsAddress, 0);
  for (const std::int8_t entry : entries)
    registers_.write(spec::morphological::reg::kWeightsData, static_cast<std::uint8_t>(entry));
  const std::uint32_t sum = registers_.read(spec::morphological::reg::kWeightsSum),
                      expected = weights_sum(entries);
  if (sum != expected)
    throw spec::SimulationError(
        fmt::format("after loading the learned weights WEIGHTS_SUM reads {:#x}, expected {:#x}",
                    sum, expected));
}

spec::morphological::Work MorphologicalDriver::work() {
  spec::morphological::Work work;
  for (const spec::morphological::WorkCount& each : spec::morphological::kWorkCounts)
    work.*each.count = registers_.read(each.offset);
  return work;
}

std::uint32_t MorphologicalDriver::frame_cycles() {
  return registers_.read(spec::morphological::reg::kFrameCycles);
}

}  // namespace deburr::platform
