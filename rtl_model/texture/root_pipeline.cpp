// SPDX-License-Identifier: MIT
#include "rtl_model/texture/root_pipeline.h"

#include <bit>

namespace deburr::rtl::texture {

RootPipeline::Root RootPipeline::squares(std::uint32_t s, std::uint32_t t) {
  return {std::uint64_t{s} * s, std::uint64_t{t} * t, 0};
}

void RootPipeline::sum(Root& r) {
  r.radicand += r.remainder;
  r.remainder = 0;
}

void RootPipeline::two_digits(Root& r) {
  for (int digit = 0; digit < 2; ++digit) {
    r.remainder = r.remainder << 2 | r.radicand >> 62;
    r.radicand <<= 2;
    const std::uint64_t trial = std::uint64_t{r.root} << 2 | 1;
    const bool one = r.remainder >= trial;
    if (one) r.remainder -= trial;
    r.root = r.root << 1 | (one ? 1u : 0u);
  }
}

std::uint32_t RootPipeline::root(std::uint64_t radicand) {
  if (radicand == 0) return 0;
  // Leading zero bits give zero digits, so the model skips those stages.
  const int first = std::countl_zero(radicand) / 4;
  Root r = {radicand << 4 * first, 0, 0};
  for (int stage = first; stage < kDigitStages; ++stage) two_digits(r);
  return r.root;
}

bool RootPipeline::step(const DerivativeToken* next, FootprintToken* result) {
  pipe_.move();
  const Entry* done = pipe_.at(kStages);
  if (done) {
    const DerivativeToken& token = done->token;
    const bool x_is_major = done->x_is_major;
    *result = {token.ticket,
               token.s,
               token.t,
               x_is_major ? token.s_x : token.s_y,
               x_is_major ? token.t_x : token.t_y,
               x_is_major ? done->x.root : done->y.root,
               false,
               x_is_major ? done->y.root : done->x.root};
  }
  if (Entry* entry = pipe_.at(3)) entry->x_is_major = entry->x.radicand >= entry->y.radicand;
  for (std::size_t stage = 3; stage < 3 + kDigitStages; ++stage)
    if (Entry* entry = pipe_.at(stage)) {
      two_digits(entry->x);
      two_digits(entry->y);
    }
  if (Entry* entry = pipe_.at(2)) {
    sum(entry->x);
    sum(entry->y);
  }
  if (next)
    pipe_.enter() = {*next, squares(next->size_s_x, next->size_t_x),
                     squares(next->size_s_y, next->size_t_y), false};
  return done != nullptr;
}

}  // namespace deburr::rtl::texture
