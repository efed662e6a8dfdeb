// SPDX-License-Identifier: MIT
#include "rtl_model/texture/block_decoder.h"

#include <algorithm>
#include <array>
#include <string>

#include "rtl_model/texture/datasheets.h"

namespace deburr::rtl::texture {

namespace {

using spec::texture::BlockRule, spec::texture::Format;

}  // namespace

template <class Width>
BlockDecoderOf<Width>::BlockDecoderOf(const sc_core::sc_module_name& name, ClockDomain& clock,
                                      const spec::texture::Parameters& p)
    : BlockDecoderBase(name, clock), decoders_(decoders(p)), rule_(p.bc) {}

// Last stage first.
template <class Width>
Activity BlockDecoderOf<Width>::tick(Cycle cycle) {
  const bool arrives = cycles_left_ == 0 && blocks_in.can_pop(cycle);
  if (pipe_.empty() && cycles_left_ == 0 && !arrives) return kIdle;
  if (pipe_.leaves() && !texels_out.can_push(cycle)) return kStalledDownstream;
  pipe_.move();
  if (const auto* done = pipe_.at(kStages)) texels_out.push(cycle, *done);
  if (arrives) {
    const BlockGroup& arrived = blocks_in.take(cycle);
    if (fault != Fault::kNone) changed_ = faulty(arrived);
    const BlockGroup& group = fault == Fault::kNone ? arrived : changed_;
    blocks += group.blocks;
    if (group.blocks <= decoders_) {
      decode(group, pipe_.enter());
    } else {
      decode(group, in_hand_);
      cycles_left_ = (group.blocks - 1u) / decoders_;
    }
  } else if (cycles_left_ != 0 && --cycles_left_ == 0) {
    pipe_.enter() = in_hand_;
  }
  return kBusy;
}

template <class Width>
void BlockDecoderOf<Width>::decode(const BlockGroup& group, typename Width::TexelQuads& texels) {
  std::array<block_colours::Palette, spec::texture::kMostDecoders> palettes;
  std::uint32_t known = 0;  // bit k: of block k
  set_count(texels, group.count);
  for (std::size_t r = 0; r < count_of(texels); ++r) {
    const BlockRequest& request = group.at[r];
    TexelQuadToken& out = nth(texels, r);
    out.ticket = request.ticket;
    out.control = request.control;
    out.texel = request.texel;
    if (!request.ticket.valid || request.control.codec == 0) continue;
    const Format format = format_of(request.control.codec);
    for (std::uint32_t i = 0; i < 4; ++i) {
      const std::size_t k = std::min<std::size_t>(request.index[i], palettes.size() - 1);
      if ((known >> k & 1) == 0) {
        palettes[k] = block_colours::counted_palette(group.block[k], format, rule_, fault, kinds);
        known |= 1U << k;
      }
      const std::uint32_t x = request.control.within >> 2 * (i % 2) & 3,
                          y = request.control.within >> (4 + 2 * (i / 2)) & 3;
      out.texel[i] = block_colours::select(
          palettes[k], block_colours::selectors(group.block[k], format, x, y, fault), format, x, y);
    }
  }
}

template <class Width>
BlockGroup BlockDecoderOf<Width>::faulty(BlockGroup group) {
  const auto blocks_now = group.block;
  if (fault == Fault::kEdge)
    for (BlockRequest& request : group.at) request.index[1] = request.index[0];
  if (fault == Fault::kHalf)
    for (std::size_t k = 0; k < group.block.size(); ++k)
      std::copy_n(previous_[k].begin() + 2, 2, group.block[k].begin() + 2);
  previous_ = blocks_now;
  return group;
}

template <class Width>
void BlockDecoderOf<Width>::reset() {
  pipe_.reset();
  cycles_left_ = 0;
}

template <class Width>
Datasheet BlockDecoderOf<Width>::datasheet(const spec::texture::Parameters& p) {
  const Sizes z(p);
  const std::uint32_t d = decoders(p), passes = z.width == 1 ? (4 + d - 1) / d : 1;
  const auto [first, second] = block_colours::stages(p.bc, "1", "2", op::mux(128, passes));
  const std::uint32_t request = Payload::of<BlockGroup>(block_shape(p)).bits() - 3 -
                                (z.width == 1 ? spec::texture::kBlocksPerRequest : d) * 128;
  Datasheet sheet = {
      .unit = "BlockDecoder",
      .variant = chosen("width", z.width) + ", " + chosen("cache.decoders", d) + ", " +
                 chosen("bc", spec::texture::kBlockRuleNames, p.bc),
      .does = "Decodes the blocks of a request to texels.",
      .latency = {3},
      .interval = {1, "max(1, ceil(n / D)) cycles per request of n distinct blocks"},
      .stages = {first, second},
      .formats = "blocks of 8 or 16 bytes, texels of four channels U8.0.",
      .copies = d,
      .per = "block",
      // Two stages of the requests; of a request in passes its texels so far, and the pass.
      .shared_registers = 2 * request + (passes > 1 ? 4 * 32 + 2 : 0)};
  // Each texel chooses the summands and selectors of its block.
  const std::uint32_t n = z.texels;
  sheet.stages.push_back(
      {.clock = "3",
       .work = "selects and sums texels",
       .longest = {op::mux(block_colours::kSummandBits, d), op::mux(9, 4), 2 * op::add(11),
                   op::logic(block_colours::kClamp), op::mux(32, 3)}});
  sheet.shared = block_colours::of_texels(n);
  sheet.shared.push_back(n * op::mux(block_colours::kSummandBits + 64, d));
  return sheet;
}

template class BlockDecoderOf<Narrow>;
template class BlockDecoderOf<Wide>;

}  // namespace deburr::rtl::texture
