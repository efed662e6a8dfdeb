// SPDX-License-Identifier: MIT
#include "rtl_model/texture/texture_cache.h"

#include <algorithm>
#include <bit>
#include <cstdint>

namespace deburr::rtl::texture {
namespace {

constexpr std::uint32_t kAddressBits = 32;

// The tag is an index into the fill buffer.
std::uint32_t tag_bits(const spec::texture::Parameters& p) {
  return static_cast<std::uint32_t>(
      std::bit_width(static_cast<std::uint32_t>(p.cache_outstanding - 1)));
}

MemoryPortParameters port_parameters(const spec::texture::Parameters& p) {
  MemoryPortParameters port;
  port.outstanding = static_cast<std::uint32_t>(p.cache_outstanding);
  port.line_bytes = std::min(static_cast<std::uint32_t>(p.cache_line_bytes), kLineBytes);
  port.max_burst_lines = static_cast<std::uint32_t>(p.cache_line_bytes) / port.line_bytes;
  port.read_only = true;
  return port;
}

}  // namespace

TextureCache::TextureCache(const sc_core::sc_module_name& name, ClockDomain& clock,
                           const spec::texture::Parameters& p, ControlRegisters& registers)
    : sc_module(name),
      miss_queue("miss_queue", clock, p, registers),
      tag_stage("tag_stage", clock, p),
      latency_fifo("latency_fifo", clock, p),
      data_stage("data_stage", clock, p, miss_queue.fills.reader()),
      memory_port("memory_port", clock, port_parameters(p)),
      misses_("misses", 2, miss_shape(p)),
      requests_("requests", 2, cache_shape(p)),
      memory_requests_("memory_requests", 2,
                       request_shape(port_parameters(p), kAddressBits, tag_bits(p))),
      memory_responses_("memory_responses", 2,
                        response_shape(port_parameters(p), kAddressBits, tag_bits(p))) {
  tag_stage.texels_in(texels_in);
  tag_stage.requests_out(requests_);
  latency_fifo.requests_in(requests_);
  data_stage.requests_in(latency_fifo.entries.link());
  data_stage.texels_out(texels_out);

  tag_stage.misses_out(misses_);
  miss_queue.misses_in(misses_);
  miss_queue.requests_out(memory_requests_);
  memory_port.requests_in(memory_requests_);
  memory_port.responses_out(memory_responses_);
  miss_queue.responses_in(memory_responses_);

  data_stage.line_used_out(line_used_);
  tag_stage.line_used_in(line_used_);
}

Datasheet TextureCache::datasheet() {
  Datasheet sheet = {
      .unit = "TextureCache",
      .does = "TagStage, LatencyFifo and DataStage, for a request that hits.",
      .interval = {1, "one request per cycle while every line hits and no bank conflict occurs"}};
  for (const Datasheet& block :
       {TagStage::datasheet(), LatencyFifo::datasheet(), DataStage::datasheet()})
    sheet.latency.cycles += block.latency.cycles;
  return sheet;
}

}  // namespace deburr::rtl::texture
