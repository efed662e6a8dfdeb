// SPDX-License-Identifier: MIT
// Set-associative cache of texture lines. It checks tags long before it reads data, so that memory
// latency overlaps with work.
//
//     texels_in -> TagStage -> LatencyFifo -> DataStage -> texels_out
//                   |    ^                     |    ^
//                   |    +----- line_used -----+    |
//                   +-> MissQueue (fill buffer) ----+
//                           |
//                       MemoryPort (TLM-2.0)
//
// With `decode = after`, a BlockDecoder follows the DataStage:
// docs/reference/texture/compressed.md. With `decode = before`, a BlockFetcher is between MissQueue
// and MemoryPort. Links with two entries connect its units; `line_used` is a
// wire. Order of fills, merged misses: docs/reference/texture/cache.md. Wide      With a width
// above 1 the units are those of Wide below, behind a GroupFormer, and the
//           tokens are groups: docs/reference/texture/width.md.
// Source    Igehy, Eldridge, Proudfoot, "Prefetching in a texture cache architecture", 1998.
#pragma once

#include <cstdint>
#include <memory>
#include <systemc>

#include "rtl_model/fabric/datasheet.h"
#include "rtl_model/fabric/link.h"
#include "rtl_model/fabric/memory_port.h"
#include "rtl_model/fabric/wire.h"
#include "rtl_model/texture/block_decoder.h"
#include "rtl_model/texture/block_fetcher.h"
#include "rtl_model/texture/data_stage.h"
#include "rtl_model/texture/group_former.h"
#include "rtl_model/texture/latency_fifo.h"
#include "rtl_model/texture/miss_queue.h"
#include "rtl_model/texture/tag_stage.h"
#include "rtl_model/texture/wide_data_stage.h"
#include "rtl_model/texture/wide_tag_stage.h"

namespace deburr::rtl::texture {

class TextureCache final : public sc_core::sc_module {
 public:
  // Width 1; above, the groups are bound instead.
  In<TexelToken> texels_in{"texels_in"};
  Out<TexelQuadToken> texels_out{"texels_out"};
  In<TexelGroup> groups_in{"groups_in"};
  Out<TexelQuadGroup> groups_out{"groups_out"};

  // The FIFO's depth and the number of outstanding lines must not be 0.
  TextureCache(const sc_core::sc_module_name& name, ClockDomain& clock,
               const spec::texture::Parameters& parameters, ControlRegisters& registers);

  // Width 1, and above.
  struct Narrow {
    Narrow(ClockDomain& clock, const spec::texture::Parameters& p, const FillBuffer::Reader& fills);

    TagStage tag_stage;
    LatencyFifo latency_fifo;
    DataStage data_stage;
    const std::unique_ptr<BlockDecoder> block_decoder;
    Link<CacheToken> requests;
    Wire<bool> line_used{"line_used", false};
  };
  struct Wide {
    Wide(ClockDomain& clock, const spec::texture::Parameters& p, const FillBuffer::Reader& fills);

    GroupFormer group_former;
    WideTagStage tag_stage;
    WideLatencyFifo latency_fifo;
    WideDataStage data_stage;
    const std::unique_ptr<wide::BlockDecoder> block_decoder;
    Link<LineGroup> groups;
    Link<CacheGroup> requests;
    Wire<std::uint8_t> lines_used{"lines_used", 0, {.widths = {{"value", 3}}}};
    Wire<SlotStall> data_stall{"data_stall", SlotStall::kNone, {.widths = {{"value", 3}}}};
    Wire<SlotStall> tag_stall{"tag_stall", SlotStall::kNone, {.widths = {{"value", 3}}}};
  };

  MissQueue miss_queue;
  // Exactly one of the two is built.
  const std::unique_ptr<Narrow> narrow;
  const std::unique_ptr<Wide> wide;
  TagUnit& tag_stage;
  DataUnit& data_stage;
  BlockDecoderBase* const block_decoder;              // nullptr without decoders
  const std::unique_ptr<BlockFetcher> block_fetcher;  // with `decode = before`
  MemoryPort memory_port;

  // Of the unit that receives the responses.
  const Counter& memory_errors() const {
    return block_fetcher ? block_fetcher->memory_errors : miss_queue.memory_errors;
  }
  void invalidate() {
    tag_stage.invalidate();
    if (block_fetcher) block_fetcher->invalidate();
  }

  static Datasheet memory_port_datasheet(const spec::texture::Parameters& parameters);
  static Datasheet datasheet(const spec::texture::Build& build = {});

 private:
  Link<MissToken> misses_;
  std::unique_ptr<Link<BlockGroup>> blocks_;  // with decoders
  // From the MissQueue and to it, with a BlockFetcher.
  std::unique_ptr<Link<MemoryRequest>> lines_;
  std::unique_ptr<Link<MemoryResponse>> fills_;
  Link<MemoryRequest> memory_requests_;
  Link<MemoryResponse> memory_responses_;
};

}  // namespace deburr::rtl::texture
