// SPDX-License-Identifier: MIT
#include "tb/engines/texture/texture_coverage.h"

#include <fmt/format.h>

#include <string>

namespace deburr::tb {
namespace {

using spec::texture::Kernel;

constexpr std::array kGroups = {
    CoverageGroup{"texture/mode",
                  "Fragments that are not magnified, by filter, wrap mode (of either axis) and "
                  "layout of the texels."},
    CoverageGroup{"texture/format", "Fragments by the format of the texels."},
    CoverageGroup{"texture/magnified", "Magnified fragments, by the filter for them."},
    CoverageGroup{"texture/output", "Fragments of sRGB textures, by output format."},
    CoverageGroup{"texture/samples", "Fragments by their number of samples N."},
    CoverageGroup{"texture/major",
                  "Fragments by number of candidate directions, and the longest of them."},
    CoverageGroup{"texture/tent",
                  "Fragments with the kernel tent: narrow with fewer than four samples, which it "
                  "does not change, and wide."},
    CoverageGroup{"texture/diagonal",
                  "Fragments with the kernel axis whose major axis is a diagonal of the pixel: box "
                  "with fewer than five samples, and tent."},
    CoverageGroup{"texture/blend", "Fragments by the order of sums over samples and levels."},
    CoverageGroup{"texture/derivatives", "Fragments by the rule for differences."},
    CoverageGroup{"texture/cache", "Lookups by outcome, and cycles with a full miss queue."},
    CoverageGroup{"texture/block",
                  "Compressed blocks decoded: colours and steps between values of BC, modes of "
                  "ETC2, and blocks with holes (docs/reference/texture/compressed.md)."},
    CoverageGroup{"texture/decode", "Fragments of compressed textures, by where they are decoded."},
    CoverageGroup{"texture/slots", "Slots of widths above 1 without a request, by cause."}};

constexpr std::array<std::string_view, 4> kCache = {"hit", "miss", "merged", "queue_full"};
constexpr int kMaxSamples = 16;

using rtl::texture::GroupFormer;
struct SlotBin {
  const char* name;
  rtl::Counter GroupFormer::*slots;
};
constexpr std::array kSlots = {SlotBin{"lookups", &GroupFormer::lookups},
                               SlotBin{"banks", &GroupFormer::banks},
                               SlotBin{"set", &GroupFormer::set},
                               SlotBin{"partial_quad", &GroupFormer::partial_quad},
                               SlotBin{"starved", &GroupFormer::starved},
                               SlotBin{"allocate", &GroupFormer::allocate},
                               SlotBin{"miss_queue", &GroupFormer::miss_queue},
                               SlotBin{"wait_fill", &GroupFormer::wait_fill},
                               SlotBin{"write_fill", &GroupFormer::write_fill},
                               SlotBin{"bank_pass", &GroupFormer::bank_pass},
                               SlotBin{"output", &GroupFormer::output}};

template <class Enum>
std::size_t index(Enum e) {
  return static_cast<std::size_t>(e);
}

}  // namespace

std::span<const CoverageGroup> TextureCoverage::groups() { return kGroups; }

Coverage TextureCoverage::declared() {
  Coverage coverage;
  for (const auto mode : spec::texture::kMinFilterNames)
    for (const auto wrap : spec::texture::kWrapNames)
      for (const auto layout : spec::texture::kLayoutNames)
        coverage.declare(fmt::format("texture/mode/{}/{}/{}", mode, wrap, layout));
  for (const auto format : spec::texture::kFormatNames)
    coverage.declare(fmt::format("texture/format/{}", format));
  for (const auto filter : spec::texture::kMagFilterNames)
    coverage.declare(fmt::format("texture/magnified/{}", filter));
  for (const auto output : spec::texture::kSrgbOutputNames)
    coverage.declare(fmt::format("texture/output/{}", output));
  for (int n = 1; n <= kMaxSamples; ++n) coverage.declare(fmt::format("texture/samples/{}", n));
  for (const int axes : {2, 4, 8})
    for (int k = 0; k < axes; ++k) coverage.declare(fmt::format("texture/major/{}/{}", axes, k));
  coverage.declare("texture/tent/narrow");
  coverage.declare("texture/tent/wide");
  for (const char* kernel : {"box", "tent"})
    coverage.declare(fmt::format("texture/diagonal/{}", kernel));
  for (const auto blend : spec::texture::kBlendNames)
    coverage.declare(fmt::format("texture/blend/{}", blend));
  for (const auto rule : spec::texture::kDerivativesNames)
    coverage.declare(fmt::format("texture/derivatives/{}", rule));
  for (const auto kind : rtl::texture::kBlockKindNames)
    coverage.declare(fmt::format("texture/block/{}", kind));
  for (const auto where : spec::texture::kDecodeNames)
    if (where != "none") coverage.declare(fmt::format("texture/decode/{}", where));
  for (const auto outcome : kCache) coverage.declare(fmt::format("texture/cache/{}", outcome));
  for (const SlotBin& bin : kSlots) coverage.declare(fmt::format("texture/slots/{}", bin.name));
  coverage.declare("texture/slots/decoders");
  return coverage;
}

void TextureCoverage::see(const golden::texture::TextureGolden& golden,
                          const spec::texture::Quad& quad) {
  const spec::texture::Descriptor& texture = golden.texture(quad.texture);
  for (int lane = 0; lane < 4; ++lane) {
    if (!(quad.coverage >> lane & 1)) continue;
    const golden::texture::FragmentAnalysis a = golden.analyse(quad, lane);
    if (!a.valid) continue;
    ++formats_[index(texture.format)];
    srgb_ += texture.srgb || texture.format == spec::texture::Format::kSrgb8A8;
    compressed_ += is_compressed(texture.format);
    ++samples_[index(a.lod.samples)];
    ++major_[index(a.footprint.major)];
    const int directions = golden::texture::candidates(configuration_.axes);
    if (directions > 2 && a.footprint.major % (directions / 2) == directions / 4)
      ++diagonals_[a.lod.samples >= 5 ? 1 : 0];
    if (a.lod.magnified) {
      ++magnified_[index(texture.mag_filter)];
      continue;
    }
    ByWrap& wraps = modes_[index(texture.layout)][index(texture.min_filter)];
    ++wraps[index(texture.wrap_s)];
    if (texture.wrap_t != texture.wrap_s) ++wraps[index(texture.wrap_t)];
  }
}

Coverage TextureCoverage::bins(const rtl::texture::TextureUnit& unit) const {
  Coverage coverage = declared();
  for (std::size_t layout = 0; layout < modes_.size(); ++layout)
    for (std::size_t mode = 0; mode < modes_[layout].size(); ++mode)
      for (std::size_t wrap = 0; wrap < modes_[layout][mode].size(); ++wrap)
        coverage.hit(
            fmt::format("texture/mode/{}/{}/{}", spec::texture::kMinFilterNames[mode],
                        spec::texture::kWrapNames[wrap], spec::texture::kLayoutNames[layout]),
            modes_[layout][mode][wrap]);
  for (std::size_t format = 0; format < formats_.size(); ++format)
    coverage.hit(fmt::format("texture/format/{}", spec::texture::kFormatNames[format]),
                 formats_[format]);
  for (std::size_t filter = 0; filter < magnified_.size(); ++filter)
    coverage.hit(fmt::format("texture/magnified/{}", spec::texture::kMagFilterNames[filter]),
                 magnified_[filter]);
  coverage.hit(fmt::format("texture/output/{}",
                           spec::texture::kSrgbOutputNames[index(configuration_.srgb_output)]),
               srgb_);
  for (std::size_t n = 1; n < samples_.size(); ++n) {
    coverage.hit(fmt::format("texture/samples/{}", n), samples_[n]);
    if (configuration_.kernel == Kernel::kTent)
      coverage.hit(n < 4 ? "texture/tent/narrow" : "texture/tent/wide", samples_[n]);
  }
  if (configuration_.kernel == Kernel::kAxis) {
    coverage.hit("texture/diagonal/box", diagonals_[0]);
    coverage.hit("texture/diagonal/tent", diagonals_[1]);
  }
  const int axes = golden::texture::candidates(configuration_.axes);
  for (int k = 0; k < axes; ++k)
    coverage.hit(fmt::format("texture/major/{}/{}", axes, k), major_[index(k)]);
  const std::uint64_t fragments = unit.filter.fragments.value();
  coverage.hit(
      fmt::format("texture/blend/{}", spec::texture::kBlendNames[index(configuration_.blend)]),
      fragments);
  coverage.hit(fmt::format("texture/derivatives/{}",
                           spec::texture::kDerivativesNames[index(configuration_.derivatives)]),
               fragments);
  if (compressed_ != 0)
    coverage.hit(fmt::format("texture/decode/{}",
                             spec::texture::kDecodeNames[index(unit.parameters().decode)]),
                 compressed_);
  for (std::size_t kind = 0; kind < rtl::texture::kBlockKindNames.size(); ++kind)
    coverage.hit(fmt::format("texture/block/{}", rtl::texture::kBlockKindNames[kind]),
                 (unit.cache.block_decoder ? unit.cache.block_decoder->kinds[kind] : 0) +
                     (unit.cache.block_fetcher ? unit.cache.block_fetcher->kinds[kind] : 0));
  if (unit.cache.wide) {
    const GroupFormer& former = unit.cache.wide->group_former;
    for (const SlotBin& bin : kSlots)
      coverage.hit(fmt::format("texture/slots/{}", bin.name), (former.*bin.slots).value());
    if (former.decoders) coverage.hit("texture/slots/decoders", former.decoders->value());
  }
  const auto& tags = unit.cache.tag_stage;
  coverage.hit("texture/cache/hit", tags.hits.value());
  coverage.hit("texture/cache/miss", tags.misses.value());
  coverage.hit("texture/cache/merged", tags.merged.value());
  for (const rtl::Unit::StallCause& cause : tags.stalls())
    if (cause.name == "miss_queue_full") coverage.hit("texture/cache/queue_full", cause.cycles);
  return coverage;
}

}  // namespace deburr::tb
