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
// Links with two entries connect its units; `line_used` is a wire. Order of fills, merged misses:
// docs/reference/texture/cache.md.
// Source    Igehy, Eldridge, Proudfoot, "Prefetching in a texture cache architecture", 1998.
#pragma once

#include <systemc>

#include "rtl_model/fabric/datasheet.h"
#include "rtl_model/fabric/link.h"
#include "rtl_model/fabric/memory_port.h"
#include "rtl_model/fabric/wire.h"
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

  static Datasheet datasheet();

 private:
  Link<MissToken> misses_;
  Link<CacheToken> requests_;
  Link<MemoryRequest> memory_requests_;
  Link<MemoryResponse> memory_responses_;
  Wire<bool> line_used_{"line_used", false};
};

}  // namespace deburr::rtl::texture
