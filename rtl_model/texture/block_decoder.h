// SPDX-License-Identifier: MIT
// Decodes the blocks of a request (above width 1 of a group) to texels.
//
// Position  DataStage -> BlockDecoder -> FilterPipeline; only with `decode = after`.
// Latency   3.
// Interval  D blocks are decoded per cycle; a request of n blocks takes max(1, ceil(n / D)) cycles.
// Stalls    downstream  The whole unit stalls.
// Method    Stage 1 finds the mode and the end points of each block, stage 2 the colours that its
//           texels select from, and stage 3 selects. Texels that are not in blocks pass. The model
//           decodes a request when it arrives, then delays it.
// Source    Microsoft, BC1, BC3 to BC5; Khronos Data Format Specification, ETC2.
#pragma once

#include <array>
#include <cstdint>
#include <systemc>

#include "rtl_model/fabric/datasheet.h"
#include "rtl_model/fabric/pipe.h"
#include "rtl_model/fabric/unit.h"
#include "rtl_model/texture/block_colours.h"
#include "rtl_model/texture/tokens.h"
#include "rtl_model/texture/width.h"
#include "spec/texture/parameters.h"

namespace deburr::rtl::texture {

// The part that does not depend on the width.
class BlockDecoderBase : public Unit {
 public:
  using Fault = BlockFault;
  Fault fault = Fault::kNone;

  In<BlockGroup> blocks_in{"blocks_in"};
  Counter blocks{"blocks", "blocks", "distinct blocks of requests decoded"};
  BlockKinds kinds{};

 protected:
  using Unit::Unit;
};

template <class Width>
class BlockDecoderOf : public BlockDecoderBase {
 public:
  Out<typename Width::TexelQuads> texels_out{"texels_out"};

  BlockDecoderOf(const sc_core::sc_module_name& name, ClockDomain& clock,
                 const spec::texture::Parameters& parameters);
  Activity tick(Cycle cycle) override;
  void reset() override;

  static Datasheet datasheet(const spec::texture::Parameters& parameters = {});

 private:
  static constexpr std::size_t kStages = 3;

  void decode(const BlockGroup& group, typename Width::TexelQuads& texels);
  BlockGroup faulty(BlockGroup group);

  const std::uint32_t decoders_;
  const spec::texture::BlockRule rule_;
  Pipe<typename Width::TexelQuads, kStages> pipe_;
  // The request whose last blocks have not entered stage 1, and the cycles until they do.
  typename Width::TexelQuads in_hand_{};
  std::uint32_t cycles_left_ = 0;
  // For faults: the request with one, and the blocks of the previous one.
  BlockGroup changed_{};
  decltype(BlockGroup::block) previous_{};
};

class BlockDecoder final : public BlockDecoderOf<Narrow> {
 public:
  using BlockDecoderOf::BlockDecoderOf;
};
namespace wide {
class BlockDecoder final : public BlockDecoderOf<Wide> {
 public:
  using BlockDecoderOf::BlockDecoderOf;
};
}  // namespace wide

}  // namespace deburr::rtl::texture
