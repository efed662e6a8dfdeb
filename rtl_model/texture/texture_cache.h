// SPDX-License-Identifier: MIT
// Set-associative cache of texture lines that checks tags long before it reads data, so that memory
// latency overlaps with work.
//
//   texels_in -> TagStage -> LatencyFifo -> DataStage -> texels_out
//                   |                          ^
//                   +-> MissQueue (fill buffer)+
//                           |
//                       MemoryPort (TLM-2.0)
//
// Latency 5 for a request that hits (TagStage 2, LatencyFifo 1, DataStage 2); one request a clock
// while no line is missing and no bank is asked for two words. Stalls: those of its blocks. Made
// for 250 MHz; longest path: in the TagStage a comparison of tags, then four choices of a way one
// behind the other; in the DataStage an SRAM read, then a choice of 1 in 32 words and of a byte.
// Cost: that of its blocks, and links of two places between them. Fill order, merged misses:
// docs/texture_unit.md. Source: Igehy, Eldridge, Proudfoot, "Prefetching in a texture cache
// architecture", 1998.
#pragma once

#include <systemc>

#include "rtl_model/fabric/link.h"
#include "rtl_model/fabric/memory_port.h"
#include "rtl_model/texture/data_stage.h"
#include "rtl_model/texture/latency_fifo.h"
#include "rtl_model/texture/miss_queue.h"
#include "rtl_model/texture/tag_stage.h"

namespace deburr::rtl::texture {

class TextureCache final : public sc_core::sc_module {
 public:
  In<TexelToken> texels_in{"texels_in"};
  Out<TexelQuadToken> texels_out{"texels_out"};

  TextureCache(const sc_core::sc_module_name& name, ClockDomain& clock,
               const spec::texture::Parameters& parameters, ControlRegisters& registers);

  MissQueue miss_queue;
  TagStage tag_stage;
  LatencyFifo latency_fifo;
  DataStage data_stage;
  MemoryPort memory_port;

 private:
  Link<MissToken> misses_;
  Link<CacheToken> requests_;
  Link<MemoryRequest> memory_requests_;
  Link<MemoryResponse> memory_responses_;
};

}  // namespace deburr::rtl::texture
