// SPDX-License-Identifier: MIT
#include "rtl_model/texture/texture_cache.h"

#include <algorithm>
#include <bit>
#include <cstdint>

#include "rtl_model/texture/datasheets.h"

namespace deburr::rtl::texture {
namespace {

constexpr std::uint32_t kAddressBits = 32;

// Of an index into the fill buffer, which is the tag of a request of the MissQueue.
std::uint32_t entry_bits(const spec::texture::Parameters& p) {
  return static_cast<std::uint32_t>(
      std::bit_width(static_cast<std::uint32_t>(p.cache_outstanding - 1)));
}

std::uint32_t tag_bits(const spec::texture::Parameters& p) {
  return has_fetcher(p) ? BlockFetcher::tag_bits(p) : entry_bits(p);
}

MemoryPortParameters port_parameters(const spec::texture::Parameters& p) {
  MemoryPortParameters port;
  port.outstanding = static_cast<std::uint32_t>(p.cache_outstanding);
  port.line_bytes = std::min(static_cast<std::uint32_t>(p.cache_line_bytes), kLineBytes);
  port.max_burst_lines = static_cast<std::uint32_t>(p.cache_line_bytes) / port.line_bytes;
  port.read_only = true;
  return port;
}

// Between MissQueue and BlockFetcher: numbers of lines, and lines without an address.
PayloadShape line_shape(const spec::texture::Parameters& p) {
  PayloadShape shape = request_shape(port_parameters(p), line_bits(p), entry_bits(p));
  shape.widths.emplace_back("lines", 0);
  return shape;
}
PayloadShape fill_shape(const spec::texture::Parameters& p) {
  return response_shape(port_parameters(p), 0, entry_bits(p));
}

}  // namespace

TextureCache::Narrow::Narrow(ClockDomain& clock, const spec::texture::Parameters& p,
                             const FillBuffer::Reader& fills)
    : tag_stage("tag_stage", clock, p),
      latency_fifo("latency_fifo", clock, p),
      data_stage("data_stage", clock, p, fills),
      block_decoder(has_decoders(p) ? std::make_unique<BlockDecoder>("block_decoder", clock, p)
                                    : nullptr),
      requests("requests", 2, cache_shape(p)) {
  tag_stage.requests_out(requests);
  latency_fifo.requests_in(requests);
  data_stage.requests_in(latency_fifo.entries.link());
  data_stage.line_used_out(line_used);
  tag_stage.line_used_in(line_used);
}

TextureCache::Wide::Wide(ClockDomain& clock, const spec::texture::Parameters& p,
                         const FillBuffer::Reader& fills)
    : group_former("group_former", clock, p),
      tag_stage("tag_stage", clock, p),
      latency_fifo("latency_fifo", clock, p),
      data_stage("data_stage", clock, p, fills),
      block_decoder(has_decoders(p)
                        ? std::make_unique<wide::BlockDecoder>("block_decoder", clock, p)
                        : nullptr),
      groups("groups", 2, line_group_shape(p)),
      requests("requests", 2, cache_group_shape(p)) {
  group_former.groups_out(groups);
  tag_stage.groups_in(groups);
  tag_stage.requests_out(requests);
  latency_fifo.requests_in(requests);
  data_stage.requests_in(latency_fifo.entries.link());
  data_stage.lines_used_out(lines_used);
  tag_stage.lines_used_in(lines_used);
  data_stage.stall_out(data_stall);
  tag_stage.stall_in(data_stall);
  tag_stage.stall_out(tag_stall);
  group_former.stall_in(tag_stall);
}

TextureCache::TextureCache(const sc_core::sc_module_name& name, ClockDomain& clock,
                           const spec::texture::Parameters& p, ControlRegisters& registers)
    : sc_module(name),
      miss_queue("miss_queue", clock, p, registers),
      narrow(p.width == 1 ? std::make_unique<Narrow>(clock, p, miss_queue.fills.reader())
                          : nullptr),
      wide(narrow ? nullptr : std::make_unique<Wide>(clock, p, miss_queue.fills.reader())),
      tag_stage(narrow ? static_cast<TagUnit&>(narrow->tag_stage) : wide->tag_stage),
      data_stage(narrow ? static_cast<DataUnit&>(narrow->data_stage) : wide->data_stage),
      block_decoder(narrow ? static_cast<BlockDecoderBase*>(narrow->block_decoder.get())
                           : wide->block_decoder.get()),
      block_fetcher(has_fetcher(p)
                        ? std::make_unique<BlockFetcher>("block_fetcher", clock, p, registers)
                        : nullptr),
      memory_port("memory_port", clock, port_parameters(p)),
      misses_("misses", 2, miss_shape(p)),
      memory_requests_("memory_requests", 2,
                       request_shape(port_parameters(p), kAddressBits, tag_bits(p))),
      memory_responses_("memory_responses", 2,
                        response_shape(port_parameters(p), kAddressBits, tag_bits(p))) {
  const auto leave = [&](auto& units, auto& out) {
    if (!units.block_decoder) return units.data_stage.texels_out->bind(out);
    blocks_ = std::make_unique<Link<BlockGroup>>("blocks", 2, block_shape(p));
    units.data_stage.blocks_out->bind(*blocks_);
    units.block_decoder->blocks_in(*blocks_);
    units.block_decoder->texels_out(out);
  };
  if (narrow) {
    narrow->tag_stage.texels_in(texels_in);
    narrow->tag_stage.misses_out(misses_);
    leave(*narrow, texels_out);
  } else {
    wide->group_former.texels_in(groups_in);
    wide->tag_stage.misses_out(misses_);
    leave(*wide, groups_out);
  }
  miss_queue.misses_in(misses_);
  memory_port.requests_in(memory_requests_);
  memory_port.responses_out(memory_responses_);
  if (block_fetcher) {
    lines_ = std::make_unique<Link<MemoryRequest>>("lines", 2, line_shape(p));
    fills_ = std::make_unique<Link<MemoryResponse>>("fills", 2, fill_shape(p));
    miss_queue.requests_out(*lines_);
    block_fetcher->lines_in(*lines_);
    block_fetcher->requests_out(memory_requests_);
    block_fetcher->responses_in(memory_responses_);
    block_fetcher->fills_out(*fills_);
    miss_queue.responses_in(*fills_);
  } else {
    miss_queue.requests_out(memory_requests_);
    miss_queue.responses_in(memory_responses_);
  }
}

Datasheet TextureCache::memory_port_datasheet(const spec::texture::Parameters& parameters) {
  spec::texture::Parameters p = parameters;
  p.cache_outstanding = MissQueue::entries(p, {});
  return MemoryPort::datasheet(port_parameters(p), tag_bits(p));
}

Datasheet TextureCache::datasheet(const spec::texture::Build& build) {
  const auto decoded = [&](Datasheet sheet) {
    if (!has_decoders(build)) return sheet;
    sheet.does.replace(sheet.does.find(" and "), 5, ", ")
        .insert(sheet.does.find(", for"), " and BlockDecoder");
    sheet.latency.cycles += BlockDecoder::datasheet().latency.cycles;
    return sheet;
  };
  if (build.width > 1) {
    Datasheet sheet = {
        .unit = "TextureCache",
        .variant = "`width` above 1" + with_decoders(build),
        .does =
            "GroupFormer, WideTagStage, WideLatencyFifo and WideDataStage, for a group that "
            "hits.",
        .interval = {1, "one group per cycle while every line hits"}};
    for (const Datasheet& block : {GroupFormer::datasheet(), WideTagStage::datasheet(),
                                   WideLatencyFifo::datasheet(), WideDataStage::datasheet()})
      sheet.latency.cycles += block.latency.cycles;
    return decoded(sheet);
  }
  Datasheet sheet = {
      .unit = "TextureCache",
      .variant = "`width = 1`" + with_decoders(build),
      .does = "TagStage, LatencyFifo and DataStage, for a request that hits.",
      .interval = {1, "one request per cycle while every line hits and no bank conflict occurs"}};
  for (const Datasheet& block :
       {TagStage::datasheet(), LatencyFifo::datasheet(), DataStage::datasheet()})
    sheet.latency.cycles += block.latency.cycles;
  return decoded(sheet);
}

}  // namespace deburr::rtl::texture
