// SPDX-License-Identifier: MIT
#include "tb/engines/texture/texture_checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "spec/texture/registers.h"
#include "tb/engines/texture/texture_history.h"

namespace deburr::tb {
namespace {

using golden::texture::TextureGolden;
using spec::texture::Colour;

// The memory model records longer reads in parts of this size.
constexpr std::uint64_t kMemoryGrain = 64;

std::string describe_colour(const Colour& c) {
  return fmt::format("tag {} lane {}{} RGBA ({}, {}, {}, {})", c.tag, c.lane, c.last ? " last" : "",
                     c.rgba[0], c.rgba[1], c.rgba[2], c.rgba[3]);
}
std::string describe_fill(const TextureChecks::Fill& f) {
  return fmt::format("read of address {:#x}", f.address);
}

}  // namespace

TextureChecks::TextureChecks(const TextureScene& scene, const TextureSetup& setup,
                             const SentQuads& sent, bool golden)
    : colours("colours", 0, describe_colour),
      fills("line fills", 0, describe_fill),
      registers(spec::texture::kRegisters),
      scene_(scene),
      setup_(setup),
      sent_(sent),
      used_(golden),
      golden_(make_model()) {
  colours.call_items([this](const Colour& c) { return place(c); });
  listen();
}

TextureGolden TextureChecks::make_model() const {
  return make_golden(scene_, setup_.texture,
                     used_ ? TextureGolden::Traffic::kPredict : TextureGolden::Traffic::kIgnore,
                     error_range(setup_.memory));
}

void TextureChecks::listen() {
  if (used_ && !setup_.expectation)
    golden_.set_memory_line_sink([this](std::uint32_t line) { expect_line(line); });
}

void TextureChecks::begin(const Image& blank) {
  golden_frame_ = blank;
  fills_checked_ = 0;
}

void TextureChecks::restart() {
  colours.restart();
  fills.restart();
  golden_ = make_model();
  listen();
}

void TextureChecks::expect_line(std::uint32_t line) {
  const std::uint64_t line_bytes = golden_.cache().line_bytes(), begin = line * line_bytes;
  for (std::uint64_t a = begin; a < begin + line_bytes; a += kMemoryGrain) fills.expect({a});
}

void TextureChecks::expect(const traces::TracedQuad& quad, std::uint64_t number,
                           TextureHistory* history) {
  if (!used_) return;
  const auto expect_colour = [&](const Colour& colour) {
    colours.expect(colour);
    show(quad, colour, golden_frame_);
  };
  if (history) {
    for (const Colour& colour : history->expect(quad, golden_)) expect_colour(colour);
    return;
  }
  if (!setup_.expectation) {
    golden_.process(quad.quad, expect_colour);
    return;
  }
  const TextureExpectation& all = *setup_.expectation;
  const TextureExpectation::Totals from = number > 0 ? all.totals[number - 1]
                                                     : TextureExpectation::Totals(),
                                   to = all.totals[number];
  for (std::size_t i = from.fills; i < to.fills; ++i) expect_line(all.fills[i]);
  for (std::size_t i = from.colours; i < to.colours; ++i) expect_colour(all.colours[i]);
}

bool TextureChecks::got(const Colour& colour, rtl::Cycle cycle) {
  if (!used_) return true;
  const std::uint64_t before = colours.mismatches();
  colours.got(colour, cycle);
  return colours.mismatches() == before;
}

void TextureChecks::check_traffic(platform::MemoryModel& memory, rtl::Cycle cycle, bool forget) {
  if (used_)
    for (; fills_checked_ < memory.lines_read().size(); ++fills_checked_)
      fills.got({memory.lines_read()[fills_checked_]}, cycle);
  if (!forget) return;
  memory.forget_lines();
  fills_checked_ = 0;
}

void TextureChecks::finish(std::uint64_t fragments, const platform::MemoryModel& memory,
                           platform::RegisterBus& bus) {
  if (!used_) return;
  namespace reg = spec::texture::reg;
  colours.require(fragments);
  fills.require(std::max<std::uint64_t>(1, memory.bytes_read() / kMemoryGrain));
  const golden::texture::TextureWork& expected_work = work();
  const std::pair<std::uint32_t, std::uint64_t> expected[] = {
      {reg::kFragments, expected_work.fragments},
      {reg::kBilinears, expected_work.bilinears},
      {reg::kLineFills, expected_work.line_fills},
      {reg::kClamped, expected_work.clamped},
      {reg::kSaturated, expected_work.saturated},
      {reg::kMemoryErrors, expected_work.memory_errors},
      {reg::kInvalidFragments, expected_work.invalid_fragments}};
  registers.check(bus, expected);
}

void TextureChecks::check_figures(const rtl::texture::TextureUnit& unit,
                                  const platform::MemoryModel& memory) {
  if (!used_) return;
  const golden::texture::TextureWork& expected = work();
  const rtl::texture::TextureCache& cache = unit.cache;
  figures.check(unit, cache.memory_port, memory);
  for (const auto& [counter, value] :
       {std::pair(&cache.miss_queue.fill_bytes, expected.line_fills * golden_.cache().line_bytes()),
        {&cache.tag_stage.requests, expected.bilinears},
        {&cache.tag_stage.misses, expected.line_fills},
        {&cache.data_stage.lines_written, expected.line_fills},
        {&unit.address.level.magnified, expected.magnified},
        {&unit.address.walker.samples, expected.samples},
        {&unit.filter.fragments, expected.fragments}})
    figures.check(unit, *counter, value);
}

std::string TextureChecks::place(const Colour& c) const {
  const traces::TracedQuad* quad = sent_.find(c.tag);
  if (!quad || !quad->placed || c.lane >= 4) return "no pixel";
  return fmt::format("pixel ({}, {})", quad->x(c.lane), quad->y(c.lane));
}

}  // namespace deburr::tb
