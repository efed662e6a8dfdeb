// SPDX-License-Identifier: MIT
#include "rtl_model/texture/level_unit.h"

#include <algorithm>
#include <cstddef>

#include "rtl_model/texture/datasheets.h"
#include "spec/texture/tables.h"

namespace deburr::rtl::texture {
namespace {

constexpr int kFractionBits = 12;
constexpr std::int32_t kAlmostOne = (1 << kFractionBits) - 1;

bool is_linear(spec::texture::MinFilter filter) {
  return filter == spec::texture::MinFilter::kLinear ||
         filter == spec::texture::MinFilter::kLinearMipmapNearest ||
         filter == spec::texture::MinFilter::kLinearMipmapLinear;
}

}  // namespace

template <class Width>
LevelUnitOf<Width>::LevelUnitOf(const sc_core::sc_module_name& name, ClockDomain& clock,
                                const Descriptors::Reader& descriptors, spec::texture::Axes axes,
                                spec::texture::CountRule count, spec::texture::CountCap cap)
    : LevelUnitBase(name, clock),
      descriptors_(descriptors),
      area_(axes != spec::texture::Axes::kTwo),
      count_(count),
      cap_(cap) {}

// Part of L that is converted to samples instead of a coarser level: U3.12.
template <class Width>
std::int32_t LevelUnitOf<Width>::as_samples(std::int32_t lb_max, std::int32_t lb_minor,
                                            int limit) const {
  if (lb_max <= 0) return 0;  // the footprint fits in a texel
  // Logarithm of d_max / d_min, which is d_max^2 / area: U6.12.
  const std::int32_t ratio = std::max((area_ ? lb_max << 1 : lb_max) - lb_minor, 0);
  const auto rounded_up = [](std::int32_t lb) { return (lb + kAlmostOne) & ~kAlmostOne; };
  const bool any = count_ == spec::texture::CountRule::kAny;
  std::int32_t taken = any                                          ? ratio
                       : count_ == spec::texture::CountRule::kFloor ? ratio & ~kAlmostOne
                                                                    : rounded_up(ratio);
  taken = std::min(taken, limit << kFractionBits);
  if (cap_ == spec::texture::CountCap::kTexel)
    taken = std::min(taken, any ? lb_max : rounded_up(lb_max));
  return taken;
}

// N - 1.
template <class Width>
int LevelUnitOf<Width>::last_index(std::int32_t as_samples) const {
  if (count_ != spec::texture::CountRule::kAny) return (1 << (as_samples >> kFractionBits)) - 1;
  int last = 0;
  for (std::size_t n = 1; n < spec::texture::kLog2Count.size(); ++n)
    last += as_samples > std::int32_t{spec::texture::kLog2Count[n]} ? 1 : 0;
  return last;
}

template <class Width>
Activity LevelUnitOf<Width>::tick(Cycle cycle) {
  const bool arrives = logs_in.can_pop(cycle);
  if (pipe_.empty() && !arrives) return kIdle;
  if (pipe_.leaves() && !levels_out.can_push(cycle)) return kStalledDownstream;
  pipe_.move();
  if (const auto* done = pipe_.at(kStages)) levels_out.push(cycle, *done);
  if (arrives) {
    // The fragments of a group are of one quad.
    const auto& group = logs_in.take(cycle);
    const TextureState& texture = descriptors_.read(cycle, nth(group, 0).ticket.texture);
    each(group, pipe_.enter(),
         [&](const Log2Token& in, LevelToken& out) { choose(texture, in, out); });
  }
  return kBusy;
}

// Computes all stages at once. Intermediate results are not observable, since a descriptor does not
// change while the unit is busy.
template <class Width>
void LevelUnitOf<Width>::choose(const TextureState& texture, const Log2Token& in, LevelToken& out) {
  // Stage 1.
  out.ticket = in.ticket;
  out.s = in.s;
  out.t = in.t;
  out.axis_s = in.axis_s;
  out.axis_t = in.axis_t;
  out.diagonal = in.diagonal;
  out.last_index = out.level = out.fraction = 0;
  out.linear = false;
  if (!out.ticket.valid) return;
  const std::int32_t taken = as_samples(in.lb_max, in.lb_minor, texture.max_count_log2);
  // Stage 2.
  out.last_index = static_cast<std::uint8_t>(last_index(taken));
  std::int32_t l = in.lb_max - taken + texture.bias;  // S8.12
  l = std::min(std::max(l, texture.min_lod), texture.max_lod);
  // Stage 3.
  if (l > 0) {
    minify(texture, l, out);
  } else {
    ++magnified;
    out.linear = texture.mag_filter == spec::texture::MagFilter::kLinear;
  }
  // All samples would be the only texel of the level.
  if ((texture.width | texture.height) >> out.level <= 1) out.last_index = 0;
}

template <class Width>
inline void LevelUnitOf<Width>::minify(const TextureState& texture, std::int32_t l,
                                       LevelToken& out) {
  out.linear = is_linear(texture.min_filter);
  const std::int32_t coarsest = texture.levels - 1;
  switch (texture.min_filter) {
    case spec::texture::MinFilter::kNearest:
    case spec::texture::MinFilter::kLinear:
      break;
    case spec::texture::MinFilter::kNearestMipmapNearest:
    case spec::texture::MinFilter::kLinearMipmapNearest:
      out.level =
          static_cast<std::uint8_t>(std::min((l + (kAlmostOne >> 1)) >> kFractionBits, coarsest));
      break;
    case spec::texture::MinFilter::kNearestMipmapLinear:
    case spec::texture::MinFilter::kLinearMipmapLinear: {
      const std::int32_t rounded = (l + 8) >> 4;  // S8.8
      const bool beyond = (rounded >> 8) >= coarsest;
      out.level = static_cast<std::uint8_t>(beyond ? coarsest : rounded >> 8);
      out.fraction = static_cast<std::uint8_t>(beyond ? 0 : rounded & 255);
      if (out.fraction != 0) ++two_levels;
      break;
    }
  }
}

template <class Width>
Datasheet LevelUnitOf<Width>::datasheet(const spec::texture::Parameters& p) {
  using spec::texture::CountCap, spec::texture::CountRule;
  const bool any = p.count == CountRule::kAny;
  // Ticket, position, axis and valid; lb d_max; E.
  const std::uint32_t kept = Payload::of<LevelToken>(axis_shape(p)).bits() - 4 - 4 - 8 - 1 + 1;
  const std::uint32_t taken = any ? 15 : 3;
  Datasheet sheet =
      {.unit = "LevelUnit",
       .variant = chosen("count", spec::texture::kCountNames, p.count) + ", " + chosen_axes(p),
       .does = "Number of samples, mip level, level fraction and filter of a fragment.",
       .latency = {3},
       .stages =
           {{.clock = "1",
             .work = "difference of the logarithms (area: twice that of the axis minus that of the "
                     "area), the part taken as samples (E); descriptor selected: is its last level "
                     "1 x 1?",
             .operators = {op::subtract(19), op::maximum(taken + 3)},
             .longest = {op::subtract(19), op::maximum(taken + 3)},
             .registers = kept + 18 + taken},
            {.clock = "2",
             .work =
                 "level of detail with bias, clamped to its range; number of samples (`any`: 15 "
                 "parallel comparisons, whose ones are counted)",
             .operators = {op::subtract(19), op::add(20), 2 * op::maximum(20), op::compare(20)},
             .longest = {op::subtract(19), op::add(20), 2 * op::maximum(20), op::compare(20)},
             .registers = kept + 20 + 4 + 1},
            {.clock = "3",
             .work = "level and fraction by mode, filter, magnification; one sample if the level "
                     "is 1 x 1",
             .operators = {op::add(20), op::add(17), 2 * op::compare(8), op::mux(4, 4),
                           op::equal(4), op::logic(84)},
             .longest = {op::add(17), op::compare(8), op::mux(4, 4), op::equal(4)}}},
       .formats = "S5.12 in; L in U6.12, E in U3.12; l in S8.12, rounded to S8.8.",
       .copies = Sizes(p).fragments,
       .per = "fragment",
       .shared = {op::leading_one(13), op::equal(4), op::logic(13)},
       // Bias, limits, filters, levels and size of the last one; the last three once more.
       .shared_registers = 3 * 16 + 2 * (4 + 4 + 1)};
  auto& first = sheet.stages[0];
  const bool rounded = p.count == CountRule::kCeil, capped = p.count_cap == CountCap::kTexel;
  if (rounded) {
    first.operators.push_back(op::add(18));
    first.longest.insert(first.longest.begin() + 1, op::add(18));
  }
  if (capped) {
    first.operators.push_back(op::maximum(taken + 3));
    first.longest.push_back(op::maximum(taken + 3));
  }
  if (capped && !any) first.operators.push_back(op::add(18));
  if (any) {
    sheet.stages[1].operators.push_back(15 * op::compare(15));
    sheet.stages[1].operators.push_back(op::count_ones(15));
  }
  return sheet;
}

template class LevelUnitOf<Narrow>;
template class LevelUnitOf<Wide>;

}  // namespace deburr::rtl::texture
