// SPDX-License-Identifier: MIT
#include "tb/engines/texture/texture_faults.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <utility>

namespace deburr::tb {

namespace {

using Fault = rtl::texture::BlockDecoderBase::Fault;
using spec::texture::Decode, spec::texture::Format, spec::texture::Kernel;

// A fault in blocks, and the formats in which it shows.
struct BlockFault {
  const char *name, *meaning;
  Decode decode;
  const char* formats;
  bool (*shows)(Format);
  Fault fault = Fault::kNone;
};
bool has_colours(Format format) {
  return is_compressed(format) && format != Format::kBc4 && format != Format::kBc5;
}
bool has_values(Format format) {
  return format == Format::kBc3 || format == Format::kBc4 || format == Format::kBc5;
}
bool is_etc(Format format) { return format >= Format::kEtc2Rgb && format <= Format::kEtc2Rgba8; }
bool has_halves(Format format) {
  return is_compressed(format) &&
         spec::texture::kFormatBlockBytes[static_cast<std::size_t>(format)] == 16;
}
constexpr std::array<BlockFault, 6> kBlockFaults = {{
    {"swapped-modes",
     "Blocks of ETC2 in mode T are decoded as in mode H, and the reverse; only files have them.",
     Decode::kAfter, "etc2", is_etc, Fault::kModes},
    {"swapped-selectors", "The two bits of each selector of colours are swapped.", Decode::kAfter,
     "bc1, bc3 or etc2", has_colours, Fault::kSelectors},
    {"wrong-alpha-mode", "Values of BC have the steps of the other mode.", Decode::kAfter,
     "bc3, bc4 or bc5", has_values, Fault::kValues},
    {"wrong-edge-block", "The second texel of a request is taken from the block of the first.",
     Decode::kAfter, "blocks", spec::texture::is_compressed, Fault::kEdge},
    {"late-half", "The second half of a block of 16 bytes comes one request late.", Decode::kAfter,
     "bc3, bc5 or etc2_rgba8", has_halves, Fault::kHalf},
    {"replaced-line",
     "A memory line is replaced while blocks wait for it, which get those of another.",
     Decode::kBefore, "blocks", spec::texture::is_compressed},
}};

}  // namespace

std::vector<InjectedFault> TextureFaults::list(const platform::TextureMemory& textures) const {
  std::vector<InjectedFault> list = {
      {"flip-bit", "Flips a bit of the red channel of colour 100.", "flip:colours:100:rgba.r.4"},
      {"drop-colour", "Drops colour 100.", "drop:colours:100"},
      {"duplicate-colour", "Delivers colour 100 twice.", "duplicate:colours:100"},
      {"drop-quad", "Drops quad 50 on its way into the unit.", "drop:quads:50"},
      {"duplicate-fetch", "Line fill 20 is read from memory twice; the picture stays perfect."},
      {"duplicate-request", "The cache's request for line fill 20 is answered twice.",
       "duplicate:texture.texture_cache.memory_requests:20"},
      {"stuck-ready", "Holds back the texel addresses from cycle 500 on.",
       "stuck_ready:texture.texels:500"},
      {"wrong-texel", "The texture in memory is not what the golden model reads."},
      {"wrong-axis", "Flips a bit of fragment 100's major axis.",
       "flip:texture.address_unit.footprints:100:axis_s.22"},
      {"wrong-ratio", "Flips a bit of what gives fragment 100's ratio of sides.",
       "flip:texture.address_unit.footprints:100:minor.24"},
      {"wrong-count", "Flips a bit of fragment 100's number of samples.",
       "flip:texture.address_unit.levels:100:last_index.0"},
      {"wrong-sample", "Gives request 401 the weight of another number of samples.",
       "flip:texture.texel_quads:401:control.last_index.2"},
      {"wrong-kernel", "Fragments on a diagonal have the box of all others instead of a tent.", "",
       setup_.texture.kernel != Kernel::kAxis ? "texture.kernel = axis"
       : setup_.stand_ins                     ? "the SystemC unit: leave out run.hdl"
                                              : ""},
      {"wrong-replacement", "The cache replaces by FIFO where LRU was ordered."}};
  for (const BlockFault& fault : kBlockFaults) {
    const auto& all = textures.descriptors();
    const bool shows =
        std::any_of(all.begin(), all.end(), [&](const auto& d) { return fault.shows(d.format); });
    const auto decode = spec::texture::kDecodeNames[static_cast<std::size_t>(fault.decode)];
    list.push_back({fault.name, fault.meaning, "",
                    setup_.texture.decode != fault.decode
                        ? fmt::format("texture.decode = {}", decode)
                    : !shows ? fmt::format("a texture of {}", fault.formats)
                             : ""});
  }
  for (InjectedFault& fault : memory_faults()) list.push_back(std::move(fault));
  return list;
}

spec::texture::Parameters TextureFaults::as_built() const {
  spec::texture::Parameters p = setup_.texture;
  if (injected("wrong-kernel")) p.kernel = Kernel::kBox;
  if (injected("wrong-replacement")) p.cache_replacement = spec::texture::Replacement::kFifo;
  return p;
}

void TextureFaults::inject(rtl::texture::TextureUnit& unit) const {
  for (const BlockFault& fault : kBlockFaults) {
    if (!injected(fault.name)) continue;
    if (unit.cache.block_decoder) unit.cache.block_decoder->fault = fault.fault;
    if (unit.cache.block_fetcher) unit.cache.block_fetcher->replaces_used_lines = true;
  }
}

void TextureFaults::load(platform::TextureDriver& driver,
                         const platform::TextureMemory& textures) const {
  if (!injected("wrong-texel")) return driver.load(textures.bytes());
  std::vector<std::uint8_t> bytes = textures.bytes();
  for (std::uint8_t& byte : bytes) byte ^= 0x10;
  driver.load(bytes);
}

}  // namespace deburr::tb
