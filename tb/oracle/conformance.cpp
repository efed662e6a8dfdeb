// SPDX-License-Identifier: MIT
#include "tb/oracle/conformance.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "golden/texture/texture_golden.h"
#include "spec/texture/parameters.h"

namespace deburr::tb::texture {
namespace {

using golden::ideal::Verdict;
using spec::texture::MinFilter;

constexpr int kQuadsOfLod = 1024;

golden::ideal::Rgba real(const std::array<std::uint8_t, 4>& colour) {
  return {static_cast<double>(colour[0]), static_cast<double>(colour[1]),
          static_cast<double>(colour[2]), static_cast<double>(colour[3])};
}

void merge(CaseResult& into, const CaseResult& other) {
  into.verdict = std::max(into.verdict, other.verdict);
  if (other.deviation > into.deviation) into.worst = other.worst;
  into.deviation = std::max(into.deviation, other.deviation);
  into.low_deviation = std::max(into.low_deviation, other.low_deviation);
  into.fragments += other.fragments;
  into.rejected += other.rejected;
  into.undecided += other.undecided;
}

struct Sweep {
  std::vector<Size> sizes{std::begin(kFilteringSizes), std::end(kFilteringSizes)};
  std::vector<MinFilter> filters;
  std::vector<Pattern> patterns{Pattern::kLevels, Pattern::kComposite};
  std::vector<std::int16_t> biases{0};  // S7.8
  int quads = 256;
};

CaseResult check_all(const FilterFactory& filter, const Sweep& sweep) {
  CaseResult sum;
  sum.verdict = Verdict::kHigh;
  std::uint32_t seed = 1;
  for (const Size& size : sweep.sizes)
    for (const MinFilter min_filter : sweep.filters)
      for (const Pattern pattern : sweep.patterns)
        for (const std::int16_t bias : sweep.biases) {
          FilteringCase c{pattern, size, {}, sweep.quads, seed++};
          c.descriptor.min_filter = min_filter;
          c.descriptor.lod_bias = bias;
          merge(sum, check(c, filter));
        }
  return sum;
}

// Compares the golden model's level of detail over the fragments of all sizes.
void measure_lod(const spec::texture::Parameters& parameters, ConformanceRow& row) {
  constexpr golden::ideal::Precision kExact{"exact", 1000, 1000, 1000, 1000};
  std::uint32_t seed = 1;
  for (const Size& size : kFilteringSizes) {
    const EncodedTexture texture =
        make_texture(Pattern::kLevels, spec::texture::Format::kRgba8, size.width, size.height, 1);
    EncodedMemory memory;
    const spec::texture::Descriptor descriptor =
        memory.place(texture, spec::texture::Layout::kTiled);
    golden::texture::TextureGolden unit(parameters, memory.bytes(),
                                        golden::texture::TextureGolden::Traffic::kIgnore);
    unit.set_texture(0, descriptor);
    const golden::ideal::Texture ideal = ideal_texture(texture);
    const golden::ideal::Sampler sampler = sampler_of(descriptor);
    for (const spec::texture::Quad& quad : filtering_quads(size, kQuadsOfLod, seed++)) {
      for (int lane = 0; lane < 4; ++lane) {
        const double l = unit.analyse(quad, lane).lod.l / 4096.0;
        const golden::ideal::Fragment f = fragment_of(quad, lane);
        const golden::ideal::Interval legal = golden::ideal::legal_lod(ideal, sampler, f, kExact);
        const double rho = std::max(std::hypot(f.ds_dx * size.width, f.dt_dx * size.height),
                                    std::hypot(f.ds_dy * size.width, f.dt_dy * size.height));
        if (l <= 0.0 || rho <= 1.0) continue;  // clamped at 0: no error is visible
        row.lod_below = std::max(row.lod_below, legal.low - l);
        row.lod_above = std::max(row.lod_above, l - legal.high);
        const double error = l - std::log2(rho);
        row.lod_error_low = std::min(row.lod_error_low, error);
        row.lod_error_high = std::max(row.lod_error_high, error);
      }
    }
  }
}

}  // namespace

std::string case_name(const FilteringCase& c) {
  constexpr std::array<std::string_view, 5> kPatternNames = {"noise", "composite", "levels",
                                                             "pyramid", "checker"};
  const spec::texture::Descriptor& d = c.descriptor;
  return fmt::format("{} {}x{} {} {} min {} mag {} wrap {} {} bias {} lod {}..{} seed {}",
                     kPatternNames[static_cast<std::size_t>(c.pattern)], c.size.width,
                     c.size.height, spec::texture::kFormatNames[static_cast<std::size_t>(d.format)],
                     spec::texture::kLayoutNames[static_cast<std::size_t>(d.layout)],
                     spec::texture::kMinFilterNames[static_cast<std::size_t>(d.min_filter)],
                     spec::texture::kMagFilterNames[static_cast<std::size_t>(d.mag_filter)],
                     spec::texture::kWrapNames[static_cast<std::size_t>(d.wrap_s)],
                     spec::texture::kWrapNames[static_cast<std::size_t>(d.wrap_t)],
                     d.lod_bias / 256.0, d.min_lod / 256.0, d.max_lod / 256.0, c.seed);
}

FilterFactory golden_filter(const spec::texture::Parameters& parameters) {
  return [parameters](const EncodedTexture& texture, const spec::texture::Descriptor& state) {
    struct Unit {
      EncodedMemory memory;
      std::unique_ptr<golden::texture::TextureGolden> golden;
    };
    auto unit = std::make_shared<Unit>();
    spec::texture::Descriptor descriptor = state;
    const spec::texture::Descriptor placed = unit->memory.place(texture, state.layout);
    descriptor.width = placed.width;
    descriptor.height = placed.height;
    descriptor.levels = placed.levels;
    descriptor.format = placed.format;
    descriptor.base = placed.base;
    unit->golden = std::make_unique<golden::texture::TextureGolden>(
        parameters, unit->memory.bytes(), golden::texture::TextureGolden::Traffic::kIgnore);
    unit->golden->set_texture(0, descriptor);
    return [unit](const spec::texture::Quad& quad) {
      std::array<std::array<std::uint8_t, 4>, 4> colours{};
      for (const spec::texture::Colour& colour : unit->golden->process(quad))
        colours[colour.lane] = colour.rgba;
      return colours;
    };
  };
}

CaseResult check(const FilteringCase& c, const FilterFactory& filter) {
  const EncodedTexture texture =
      make_texture(c.pattern, c.descriptor.format, c.size.width, c.size.height, c.seed);
  const golden::ideal::Texture ideal = ideal_texture(texture);
  const golden::ideal::Sampler sampler = sampler_of(c.descriptor);
  golden::ideal::Checker checker(ideal, sampler);
  const QuadFilter sample = filter(texture, c.descriptor);
  for (const spec::texture::Quad& quad :
       filtering_quads(c.size, c.quads, c.seed, sampler.lod_bias)) {
    const auto colours = sample(quad);
    for (int lane = 0; lane < 4; ++lane)
      checker.add(fragment_of(quad, lane), real(colours[static_cast<std::size_t>(lane)]));
  }
  CaseResult result;
  result.verdict = checker.verdict();
  result.deviation = checker.deviation();
  result.low_deviation = checker.low_deviation();
  result.fragments = checker.fragments();
  result.rejected = checker.rejected();
  result.undecided = checker.undecided();
  if (result.deviation <= 0.5) return result;
  const golden::ideal::Fragment& f = checker.worst();
  const golden::ideal::Rgba& colour = checker.worst_colour();
  const golden::ideal::Rgba exact = golden::ideal::exact_colour(ideal, sampler, f);
  result.worst = fmt::format(
      "{}: s {:.9f} t {:.9f} dx ({:.9f}, {:.9f}) dy ({:.9f}, {:.9f}) got ({}, {}, {}, {}), "
      "the exact filter gives ({:.2f}, {:.2f}, {:.2f}, {:.2f}), off by {:.2f}",
      case_name(c), f.s, f.t, f.ds_dx, f.dt_dx, f.ds_dy, f.dt_dy, colour[0], colour[1], colour[2],
      colour[3], exact[0], exact[1], exact[2], exact[3], result.deviation);
  return result;
}

std::vector<ConformanceRow> conformance_table() {
  std::vector<ConformanceRow> rows;
  for (std::size_t footprint = 0; footprint < spec::texture::kFootprintNames.size(); ++footprint) {
    for (std::size_t log2 = 0; log2 < spec::texture::kLog2Names.size(); ++log2) {
      spec::texture::Parameters parameters =
          spec::texture::preset_parameters(spec::texture::Preset::kPaper);
      parameters.footprint = static_cast<spec::texture::FootprintRule>(footprint);
      parameters.log2 = static_cast<spec::texture::Log2Rule>(log2);
      ConformanceRow row;
      row.footprint = parameters.footprint;
      row.log2 = parameters.log2;
      measure_lod(parameters, row);
      const FilterFactory filter = golden_filter(parameters);
      row.mipmap_nearest = check_all(
          filter, {.filters = {MinFilter::kNearestMipmapNearest, MinFilter::kLinearMipmapNearest}});
      row.mipmap_linear = check_all(
          filter, {.filters = {MinFilter::kNearestMipmapLinear, MinFilter::kLinearMipmapLinear}});
      std::vector<std::int16_t> biases;
      for (int step = -64; step < 64; ++step) biases.push_back(static_cast<std::int16_t>(2 * step));
      row.biased = check_all(
          filter, {.sizes = {{31, 55}},
                   .filters = {MinFilter::kLinearMipmapNearest, MinFilter::kLinearMipmapLinear},
                   .patterns = {Pattern::kLevels},
                   .biases = biases,
                   .quads = 256});
      row.pyramid = check_all(
          filter, {.filters = {MinFilter::kLinearMipmapLinear}, .patterns = {Pattern::kPyramid}});
      row.verdict = std::max({row.mipmap_nearest.verdict, row.mipmap_linear.verdict,
                              row.biased.verdict, row.pyramid.verdict});
      rows.push_back(std::move(row));
    }
  }
  return rows;
}

std::string conformance_markdown(const std::vector<ConformanceRow>& rows) {
  std::string text =
      "| footprint | log2 | verdict | `*_MIPMAP_NEAREST` | `*_MIPMAP_LINEAR` | with LOD bias | box "
      "pyramid | LOD below legal | LOD against exact |\n"
      "|---|---|---|---|---|---|---|---|---|\n";
  const auto cell = [](const CaseResult& r) {
    return fmt::format("{}, {:.1f}", golden::ideal::verdict_name(r.verdict), r.deviation);
  };
  for (const ConformanceRow& row : rows) {
    if (row.footprint != spec::texture::FootprintRule::kHalf &&
        row.footprint != spec::texture::FootprintRule::kExact)
      continue;
    text += fmt::format(
        "| `{}` | `{}` | **{}** | {} | {} | {} | {} | {:.4f} | {:+.3f} .. {:+.3f} |\n",
        spec::texture::kFootprintNames[static_cast<std::size_t>(row.footprint)],
        spec::texture::kLog2Names[static_cast<std::size_t>(row.log2)],
        golden::ideal::verdict_name(row.verdict), cell(row.mipmap_nearest), cell(row.mipmap_linear),
        cell(row.biased), cell(row.pyramid), row.lod_below, row.lod_error_low, row.lod_error_high);
  }
  return text;
}

}  // namespace deburr::tb::texture
