// SPDX-License-Identifier: MIT
// Runs a texture filter through Khronos's filtering criterion, and tabulates the verdict of each
// footprint and logarithm rule of the texture unit. Used by the tests here, by `deburr papers`, and
// by the program that writes docs/measurements/filtering_conformance.md.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "golden/ideal/filtering_criterion.h"
#include "spec/texture/descriptor.h"
#include "spec/texture/packets.h"
#include "spec/texture/parameters.h"
#include "tb/oracle/encoded_texture.h"
#include "tb/oracle/filtering_cases.h"

namespace deburr::tb::texture {

// A texture with its sampler state.
struct FilteringCase {
  Pattern pattern = Pattern::kComposite;
  Size size{32, 64};
  spec::texture::Descriptor descriptor{};  // format, layout, wraps, filters, bias, clamps
  int quads = 64;
  std::uint32_t seed = 1;
};
std::string case_name(const FilteringCase& filtering_case);

// Colours of the four lanes of a quad.
using QuadFilter =
    std::function<std::array<std::array<std::uint8_t, 4>, 4>(const spec::texture::Quad&)>;
// Makes a filter for a texture; the filter may keep references to the arguments.
using FilterFactory =
    std::function<QuadFilter(const EncodedTexture&, const spec::texture::Descriptor& state)>;

// The golden model with the given parameters.
FilterFactory golden_filter(const spec::texture::Parameters& parameters);

struct CaseResult {
  golden::ideal::Verdict verdict = golden::ideal::Verdict::kFail;
  double deviation = 0.0;  // largest deviation at high precision, in 8-bit steps
  double low_deviation =
      0.0;  // largest deviation at low precision, among the fragments that high precision rejected
  std::int64_t fragments = 0, rejected = 0, undecided = 0;
  std::string worst;  // fragment and colour of the largest deviation; empty up to 1/2
};
CaseResult check(const FilteringCase& filtering_case, const FilterFactory& filter);

// Result of one footprint rule with one logarithm rule.
struct ConformanceRow {
  spec::texture::FootprintRule footprint;
  spec::texture::Log2Rule log2;
  // Largest distance of the level of detail below and above the legal interval, in levels.
  double lod_below = 0.0, lod_above = 0.0;
  // Level of detail minus the exact one (log2 of the longer side), in levels.
  double lod_error_low = 0.0, lod_error_high = 0.0;
  // All sizes, unrelated full-contrast levels, no LOD bias.
  CaseResult mipmap_nearest, mipmap_linear;
  // *_MIPMAP_NEAREST and *_MIPMAP_LINEAR with 128 LOD biases from -1/2 to 1/2, which move the
  // thresholds between levels over the whole octave.
  CaseResult biased;
  // LINEAR_MIPMAP_LINEAR on box-filtered noise, where neighbouring levels are similar.
  CaseResult pyramid;
  golden::ideal::Verdict verdict = golden::ideal::Verdict::kFail;  // the worst of all four
};

// Every footprint rule with every logarithm rule, 20 rows; takes a few seconds.
std::vector<ConformanceRow> conformance_table();
// A Markdown table of the paper's footprint and the exact one: the others get the same verdicts.
std::string conformance_markdown(const std::vector<ConformanceRow>& rows);

}  // namespace deburr::tb::texture
