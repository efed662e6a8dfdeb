// SPDX-License-Identifier: MIT
// Random compressed blocks as a picture, for comparison of the golden model's decoder with others.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <utility>
#include <vector>

#include "golden/texture/block_decoder.h"
#include "tb/base/random.h"

namespace deburr::tb::texture {

inline std::string_view format_name(spec::texture::Format format) {
  return spec::texture::kFormatNames[static_cast<std::size_t>(format)];
}

// Modes of an ETC2 block, told from its bits.
enum class EtcMode : std::uint8_t { kIndividual, kDifferential, kT, kH, kPlanar };
inline EtcMode etc_mode(const std::uint8_t* colours, bool has_individual) {
  if (has_individual && (colours[3] & 2) == 0) return EtcMode::kIndividual;
  for (const std::size_t channel : {0u, 1u, 2u}) {
    const int base = colours[channel] / 8, difference = colours[channel] % 8;
    const int sum = base + (difference < 4 ? difference : difference - 8);
    if (sum < 0 || sum > 31) return static_cast<EtcMode>(2 + channel);
  }
  return EtcMode::kDifferential;
}

// side x side blocks, row by row.
struct BlockPicture {
  spec::texture::Format format;
  std::size_t side, block_bytes;
  std::vector<std::uint8_t> blocks;

  // Modes of ETC2 are drawn evenly.
  BlockPicture(spec::texture::Format of, std::size_t blocks_per_side, std::uint64_t seed)
      : format(of),
        side(blocks_per_side),
        block_bytes(spec::texture::kFormatBlockBytes[static_cast<std::size_t>(of)]) {
    Random random(seed);
    blocks.resize(side * side * block_bytes);
    for (std::size_t i = 0; i < side * side; ++i) {
      std::uint8_t* const block = &blocks[i * block_bytes];
      do {
        for (std::size_t byte = 0; byte < block_bytes; byte += 4) {
          const std::uint32_t word = random.word();
          std::memcpy(block + byte, &word, 4);
        }
      } while (has_modes() && mode(i) != i % modes());
    }
  }
  bool has_modes() const { return format >= spec::texture::Format::kEtc2Rgb; }
  // Number of modes of the format. With alpha of one bit: four opaque ones, then four with holes.
  std::size_t modes() const {
    return format == spec::texture::Format::kEtc2RgbA1 ? 8 : has_modes() ? 5 : 1;
  }
  std::size_t mode(std::size_t i) const {
    if (!has_modes()) return 0;
    const std::uint8_t* const colours = &blocks[(i + 1) * block_bytes - 8];
    const bool one_bit = format == spec::texture::Format::kEtc2RgbA1;
    const auto code = static_cast<std::size_t>(etc_mode(colours, !one_bit));
    return one_bit ? code - 1 + ((colours[3] & 2) == 0 ? 4 : 0) : code;
  }
  std::size_t texels_per_side() const { return 4 * side; }
  // Channels that the format stores.
  std::size_t channels() const {
    return format == spec::texture::Format::kBc4   ? 1
           : format == spec::texture::Format::kBc5 ? 2
                                                   : 4;
  }
};

using BlockDecoder = std::array<std::uint32_t, 16> (*)(spec::texture::Format,
                                                       spec::texture::BlockRule,
                                                       const std::uint8_t*);

// Number of texels, by mode of their block, of which a stored channel differs from another
// decoder's: `theirs` has rows of texels from the top, of `channels` bytes each.
inline std::vector<std::uint64_t> wrong_texels(
    const BlockPicture& picture, spec::texture::BlockRule rule,
    const std::vector<std::uint8_t>& theirs, std::size_t channels,
    BlockDecoder decode = golden::texture::decode_block) {
  std::vector<std::uint64_t> wrong(picture.modes());
  for (std::size_t i = 0; i < picture.side * picture.side; ++i) {
    const auto texels = decode(picture.format, rule, &picture.blocks[i * picture.block_bytes]);
    for (std::size_t k = 0; k < 16; ++k) {
      const std::size_t x = i % picture.side * 4 + k % 4, y = i / picture.side * 4 + k / 4;
      const std::uint8_t* const their = &theirs[(y * picture.texels_per_side() + x) * channels];
      bool same = true;
      for (std::size_t c = 0; c < picture.channels(); ++c)
        same = same && their[c] == (texels[k] >> 8 * c & 255);
      wrong[picture.mode(i)] += same ? 0 : 1;
    }
  }
  return wrong;
}

// A decoder with a fault, which a comparison must find: two bytes of selectors change places.
inline std::array<std::uint32_t, 16> swapped_selectors(spec::texture::Format format,
                                                       spec::texture::BlockRule rule,
                                                       const std::uint8_t* block) {
  const std::size_t bytes = spec::texture::kFormatBlockBytes[static_cast<std::size_t>(format)];
  std::array<std::uint8_t, 16> changed{};
  std::copy_n(block, bytes, changed.begin());
  std::swap(changed[bytes - 1], changed[bytes - 2]);
  return golden::texture::decode_block(format, rule, changed.data());
}

}  // namespace deburr::tb::texture
