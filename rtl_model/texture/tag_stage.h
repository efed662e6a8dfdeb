// SPDX-License-Identifier: MIT
// Looks up the up to four lines of a bilinear request, allocates those that miss, and sends them to
// the MissQueue.
//
// Position  First unit of the TextureCache.
// Interval  1: the lines of a request are looked up in series, and changes are forwarded to the
//           sets that the next request reads in the same cycle.
// Stalls    miss_queue_full  The request misses and the MissQueue is not ready.
//           fifo_full        The LatencyFifo is full.
// Note      Tags change when a fill is requested, data when it is used:
//           docs/reference/texture/cache.md, Order of fills. `line_used_in` is only for the
//           counters: it separates hits from lines whose fill is in flight.
// Source    Igehy, Eldridge, Proudfoot, "Prefetching in a texture cache architecture", 1998.
#pragma once

#include <array>
#include <cstdint>
#include <systemc>

#include "rtl_model/fabric/datasheet.h"
#include "rtl_model/fabric/wire.h"
#include "rtl_model/texture/cache_units.h"
#include "rtl_model/texture/tokens.h"
#include "spec/texture/parameters.h"

namespace deburr::rtl::texture {

class TagStage final : public TagUnit {
 public:
  In<TexelToken> texels_in{"texels_in"};
  Out<CacheToken> requests_out{"requests_out"};
  Out<MissToken> misses_out{"misses_out"};
  WireIn<bool> line_used_in{"line_used_in"};  // from the DataStage: it has used the oldest fill

  TagStage(const sc_core::sc_module_name& name, ClockDomain& clock,
           const spec::texture::Parameters& parameters);
  Activity tick(Cycle cycle) override;
  void reset() override;

  static Datasheet datasheet(const spec::texture::Parameters& parameters = {});

 private:
  // A request after stage 1.
  struct Request {
    TexelToken token;
    std::array<std::uint32_t, 4> line;  // U27 (decode = before: U32)
    std::array<std::uint8_t, 4> first;  // U2, first texel in the same line
    bool one_line;
    Cycle read_at;  // check only, no hardware: when its sets were read
  };
  void read_sets(Cycle cycle);
  [[gnu::noinline]] void read_sets_of_blocks(Cycle cycle);
  bool would_miss() const;
  void look_up(Cycle cycle, CacheToken& out);
  struct Line {
    std::uint32_t place;  // address of its slot and bank rotation; 0: it missed
    std::uint8_t source;  // as in CacheToken
  };
  Line look_up_line(Cycle cycle, std::size_t texel, CacheToken& out, MissToken& missed);
  [[gnu::noinline]] Line order(std::uint32_t line, std::size_t texel, CacheToken& out,
                               MissToken& missed);

  bool blocks_;  // `decode = before`: lines of decoded blocks
  std::uint32_t line_log2_;
  std::uint32_t turn_;  // bytes
  // Registers.
  Request request_{};
  bool occupied_ = false;
};

}  // namespace deburr::rtl::texture
