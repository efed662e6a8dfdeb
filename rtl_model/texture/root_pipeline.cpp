// SPDX-License-Identifier: MIT
#include "rtl_model/texture/root_pipeline.h"

#include <algorithm>

namespace deburr::rtl::texture {

RootPipeline::Root RootPipeline::start(std::uint32_t s, std::uint32_t t) {
  return {std::uint64_t{s} * s + std::uint64_t{t} * t, 0, 0};
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

bool RootPipeline::step(const DerivativeToken* next, FootprintToken* result) {
  const bool leaves = leaving();
  head_ = (head_ - 1) & 15;  // what was stage k's is now stage k + 1's
  occupied_ <<= 1;
  for (int stage = 1; stage <= kRegisters; ++stage)
    if (occupied_ >> stage & 1) {
      two_digits(entry(stage).x);
      two_digits(entry(stage).y);
    }
  if (leaves) {
    const Entry& done = entry(kRegisters);
    const bool x_is_major = done.x.root >= done.y.root;
    const DerivativeToken& token = done.token;
    *result = {token.ticket,
               token.s,
               token.t,
               x_is_major ? token.s_x : token.s_y,
               x_is_major ? token.t_x : token.t_y,
               std::max(done.x.root, done.y.root),
               std::min(done.x.root, done.y.root)};
    occupied_ &= ~(1u << kRegisters);
  }
  if (next) {
    Entry& first = entry(0);
    first = {*next, start(next->size_s_x, next->size_t_x), start(next->size_s_y, next->size_t_y)};
    two_digits(first.x);
    two_digits(first.y);
    occupied_ |= 1;
  }
  return leaves;
}

}  // namespace deburr::rtl::texture
