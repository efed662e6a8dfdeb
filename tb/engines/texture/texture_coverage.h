// SPDX-License-Identifier: MIT
// Functional coverage of the texture unit: properties of the run's fragments, as the golden model
// analyses them, and events in the cache.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "golden/texture/texture_golden.h"
#include "rtl_model/texture/texture_unit.h"
#include "spec/texture/descriptor.h"
#include "spec/texture/packets.h"
#include "spec/texture/parameters.h"
#include "tb/harness/coverage.h"

namespace deburr::tb {

class TextureCoverage {
 public:
  explicit TextureCoverage(const spec::texture::Configuration& configuration)
      : configuration_(configuration) {}

  // Adds a quad that is sent to the unit.
  void see(const golden::texture::TextureGolden& golden, const spec::texture::Quad& quad);
  void clear() { *this = TextureCoverage(configuration_); }
  // Also adds the unit's own counts.
  Coverage bins(const rtl::texture::TextureUnit& unit) const;

  // Every bin, without hits.
  static Coverage declared();
  static std::span<const CoverageGroup> groups();

 private:
  template <class Names>
  using Counts = std::array<std::uint64_t, std::tuple_size_v<Names>>;
  using ByWrap = Counts<decltype(spec::texture::kWrapNames)>;
  using ByMode = std::array<ByWrap, spec::texture::kMinFilterNames.size()>;

  spec::texture::Configuration configuration_;
  std::array<ByMode, spec::texture::kLayoutNames.size()> modes_{};
  Counts<decltype(spec::texture::kFormatNames)> formats_{};
  Counts<decltype(spec::texture::kMagFilterNames)> magnified_{};
  std::uint64_t srgb_ = 0, compressed_ = 0;
  std::array<std::uint64_t, 17> samples_{};
  std::array<std::uint64_t, 8> major_{};
  std::array<std::uint64_t, 2> diagonals_{};  // by kernel: box, tent
};

}  // namespace deburr::tb
