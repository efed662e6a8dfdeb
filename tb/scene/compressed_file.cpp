// SPDX-License-Identifier: MIT
#include "tb/scene/compressed_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <span>

#include "golden/texture/block_decoder.h"
#include "spec/error.h"
#include "tb/scene/image_io.h"

namespace deburr::tb {
namespace {

using spec::texture::Format;

// A format as a container names it: FourCC of DDS, DXGI_FORMAT, VkFormat, or OpenGL's number.
struct FormatCode {
  std::uint32_t code;
  Format format;
  bool srgb = false;
};
constexpr std::uint32_t four_cc(std::string_view text) {
  std::uint32_t code = 0;
  for (std::size_t i = 4; i-- > 0;) code = code << 8 | static_cast<unsigned char>(text[i]);
  return code;
}
constexpr std::array<FormatCode, 6> kFourCc = {{{four_cc("DXT1"), Format::kBc1},
                                                {four_cc("DXT5"), Format::kBc3},
                                                {four_cc("ATI1"), Format::kBc4},
                                                {four_cc("BC4U"), Format::kBc4},
                                                {four_cc("ATI2"), Format::kBc5},
                                                {four_cc("BC5U"), Format::kBc5}}};
constexpr std::array<FormatCode, 6> kDxgi = {{{71, Format::kBc1},
                                              {72, Format::kBc1, true},
                                              {77, Format::kBc3},
                                              {78, Format::kBc3, true},
                                              {80, Format::kBc4},
                                              {83, Format::kBc5}}};
constexpr std::array<FormatCode, 14> kVulkan = {{{131, Format::kBc1},
                                                 {132, Format::kBc1, true},
                                                 {133, Format::kBc1},
                                                 {134, Format::kBc1, true},
                                                 {137, Format::kBc3},
                                                 {138, Format::kBc3, true},
                                                 {139, Format::kBc4},
                                                 {141, Format::kBc5},
                                                 {147, Format::kEtc2Rgb},
                                                 {148, Format::kEtc2Rgb, true},
                                                 {149, Format::kEtc2RgbA1},
                                                 {150, Format::kEtc2RgbA1, true},
                                                 {151, Format::kEtc2Rgba8},
                                                 {152, Format::kEtc2Rgba8, true}}};
constexpr std::array<FormatCode, 14> kOpenGl = {{{0x83F0, Format::kBc1},
                                                 {0x83F1, Format::kBc1},
                                                 {0x8C4C, Format::kBc1, true},
                                                 {0x8C4D, Format::kBc1, true},
                                                 {0x83F3, Format::kBc3},
                                                 {0x8C4F, Format::kBc3, true},
                                                 {0x8DBB, Format::kBc4},
                                                 {0x8DBD, Format::kBc5},
                                                 {0x9274, Format::kEtc2Rgb},
                                                 {0x9275, Format::kEtc2Rgb, true},
                                                 {0x9276, Format::kEtc2RgbA1},
                                                 {0x9277, Format::kEtc2RgbA1, true},
                                                 {0x9278, Format::kEtc2Rgba8},
                                                 {0x9279, Format::kEtc2Rgba8, true}}};
constexpr std::string_view kFormats = "BC1, BC3, unsigned BC4 or BC5, or ETC2 (RGB, RGBA1, RGBA8)";

constexpr std::string_view kDdsMagic = "DDS ", kKtx1Magic = "\xABKTX 11\xBB\r\n\x1A\n",
                           kKtx2Magic = "\xABKTX 20\xBB\r\n\x1A\n";
constexpr std::size_t kDdsHeader = 128, kDx10Header = 148;

const FormatCode* find(std::span<const FormatCode> codes, std::uint64_t code) {
  const auto found = std::find_if(codes.begin(), codes.end(),
                                  [&](const FormatCode& each) { return each.code == code; });
  return found == codes.end() ? nullptr : &*found;
}

// Bytes of a number, which must be within the file.
std::uint64_t number_at(std::string_view bytes, std::size_t at, std::size_t size, bool big_endian) {
  std::uint64_t number = 0;
  for (std::size_t i = 0; i < size; ++i)
    number = number << 8 | static_cast<unsigned char>(bytes[at + (big_endian ? i : size - 1 - i)]);
  return number;
}

bool is_dx10(std::string_view dds) { return number_at(dds, 84, 4, false) == four_cc("DX10"); }
const FormatCode* dds_format(std::string_view dds) {
  if (dds.size() < kDdsHeader) return nullptr;
  if (!is_dx10(dds)) return find(kFourCc, number_at(dds, 84, 4, false));
  constexpr std::uint64_t kPremultiplied = 2;
  if (dds.size() < kDx10Header || (number_at(dds, 144, 4, false) & 7) == kPremultiplied)
    return nullptr;
  return find(kDxgi, number_at(dds, 128, 4, false));
}

class Reader {
 public:
  Reader(const std::string& name, std::string_view bytes) : name_(name), bytes_(bytes) {}

  CompressedTexture read() {
    if (bytes_.starts_with(kKtx1Magic)) {
      read_ktx1();
    } else if (bytes_.starts_with(kKtx2Magic)) {
      read_ktx2();
    } else {
      read_dds();
    }
    return std::move(texture_);
  }

 private:
  [[noreturn]] void fail(const std::string& reason) const {
    throw spec::FileError(fmt::format("cannot read the image '{}': {}", name_, reason));
  }
  void require_header(std::size_t size, std::string_view container) const {
    if (bytes_.size() < size)
      fail(
          fmt::format("the file has {} bytes, and the header of its {} {}: it is truncated; copy "
                      "it again",
                      bytes_.size(), container, size));
  }
  std::uint64_t word(std::size_t at) const { return number_at(bytes_, at, 4, big_endian_); }

  // `arrays`: number of elements of an array, 0 or 1 if there is none.
  void reject_more_than_one_image(std::uint64_t faces, std::uint64_t depth,
                                  std::uint64_t arrays) const {
    if (faces > 1) fail("it is a cube map; write one of its faces to a file of its own");
    if (depth > 1)
      fail(fmt::format("it is a volume of {} slices; write one of them to a file of its own",
                       depth));
    if (arrays > 1)
      fail(fmt::format("it is an array of {} textures; write one of them to a file of its own",
                       arrays));
  }

  void set_format(const FormatCode* code, std::string_view what) {
    if (code == nullptr)
      fail(fmt::format("its format ({}) is not supported; write it as {}, or as PNG", what,
                       kFormats));
    texture_.format = code->format;
    texture_.srgb = code->srgb;
  }

  void set_levels(std::uint64_t width, std::uint64_t height, std::uint64_t levels) {
    if (width < 1 || height < 1)
      fail(fmt::format("its header says {} x {} texels; the file is damaged or one-dimensional",
                       width, height));
    if (width > kMaxImageSide || height > kMaxImageSide)
      fail(fmt::format("its header says {} x {} texels, the limit is {} x {}; scale it down", width,
                       height, kMaxImageSide, kMaxImageSide));
    const auto most = static_cast<std::uint64_t>(std::bit_width(std::max(width, height)));
    if (levels > most)
      fail(
          fmt::format("its header says {} levels, and {} x {} texels have at most {}; the file is "
                      "damaged",
                      levels, width, height, most));
    for (std::uint64_t k = 0; k < std::max<std::uint64_t>(levels, 1); ++k)
      texture_.levels.push_back({static_cast<int>(std::max<std::uint64_t>(1, width >> k)),
                                 static_cast<int>(std::max<std::uint64_t>(1, height >> k)),
                                 {}});
  }

  std::uint64_t bytes_of(const CompressedTexture::Level& level) const {
    return std::uint64_t{
               spec::texture::kFormatBlockBytes[static_cast<std::size_t>(texture_.format)]} *
           static_cast<std::uint64_t>((level.width + 3) / 4) *
           static_cast<std::uint64_t>((level.height + 3) / 4);
  }
  void take(std::size_t k, std::uint64_t offset) {
    CompressedTexture::Level& level = texture_.levels[k];
    const std::uint64_t size = bytes_of(level);
    if (offset > bytes_.size() || size > bytes_.size() - offset)
      fail(
          fmt::format("level {} of {} x {} texels needs {} bytes from byte {} on, and the file has "
                      "{}: it is truncated; copy it again",
                      k, level.width, level.height, size, offset, bytes_.size()));
    const std::string_view part = bytes_.substr(offset, size);
    level.blocks.assign(part.begin(), part.end());
  }
  void require_size(std::size_t k, std::uint64_t size) const {
    const CompressedTexture::Level& level = texture_.levels[k];
    if (size != bytes_of(level))
      fail(
          fmt::format("level {} has {} bytes, but the blocks of its {} x {} texels have {}; the "
                      "file is damaged",
                      k, size, level.width, level.height, bytes_of(level)));
  }

  void read_dds() {
    constexpr std::uint64_t kCubeMap = 0xFE00, kVolume = 0x200000, kHasLevels = 0x20000,
                            kTexture2d = 3, kDx10CubeMap = 4;
    require_header(kDdsHeader, "DDS");
    if (word(4) != 124 || word(76) != 32) fail("its DDS header is damaged; write it again");
    const std::uint64_t more = word(112);
    bool cube = (more & kCubeMap) != 0;
    std::uint64_t arrays = 1, offset = kDdsHeader;
    if (is_dx10(bytes_)) {
      require_header(kDx10Header, "DDS");
      offset = kDx10Header;
      cube = cube || (word(136) & kDx10CubeMap) != 0;
      arrays = word(140);
      if (word(132) != kTexture2d && (more & kVolume) == 0)
        fail("its header does not say a texture of two dimensions; write it as such");
    }
    reject_more_than_one_image(
        cube ? 6 : 1, (more & kVolume) != 0 ? std::max<std::uint64_t>(word(24), 2) : 1, arrays);
    set_format(dds_format(bytes_), "another DDS format");
    set_levels(word(16), word(12), (word(8) & kHasLevels) != 0 ? word(28) : 1);
    for (std::size_t k = 0; k < texture_.levels.size(); ++k) {
      take(k, offset);
      offset += texture_.levels[k].blocks.size();
    }
  }

  void read_ktx1() {
    constexpr std::size_t kHeader = 64;
    require_header(kHeader, "KTX");
    if (word(12) == 0x01020304) big_endian_ = true;
    if (word(12) != 0x04030201) fail("its KTX header is damaged; write it again");
    reject_more_than_one_image(word(52), word(44), word(48));
    set_format(find(kOpenGl, word(28)), fmt::format("glInternalFormat 0x{:04X}", word(28)));
    set_levels(word(36), word(40), word(56));
    std::uint64_t offset = kHeader + word(60);
    for (std::size_t k = 0; k < texture_.levels.size(); ++k) {
      if (offset > bytes_.size() || bytes_.size() - offset < 4)
        fail(
            fmt::format("level {} would begin at byte {}, and the file has {}: it is truncated; "
                        "copy it again",
                        k, offset, bytes_.size()));
      require_size(k, word(offset));
      take(k, offset + 4);
      offset += 4 + texture_.levels[k].blocks.size();  // a multiple of 4
    }
  }

  void read_ktx2() {
    constexpr std::size_t kHeader = 80, kEntry = 24;
    require_header(kHeader, "KTX 2");
    reject_more_than_one_image(word(36), word(28), word(32));
    if (const std::uint64_t scheme = word(44); scheme != 0)
      fail(fmt::format("it is supercompressed ({}); write it without supercompression",
                       scheme == 1   ? std::string("Basis LZ")
                       : scheme == 2 ? std::string("Zstandard")
                       : scheme == 3 ? std::string("ZLIB")
                                     : fmt::format("scheme {}", scheme)));
    set_format(find(kVulkan, word(12)), fmt::format("vkFormat {}", word(12)));
    set_levels(word(20), word(24), word(40));
    require_header(kHeader + kEntry * texture_.levels.size(), "KTX 2");
    for (std::size_t k = 0; k < texture_.levels.size(); ++k) {
      const std::size_t entry = kHeader + kEntry * k;
      require_size(k, number_at(bytes_, entry + 8, 8, false));
      take(k, number_at(bytes_, entry, 8, false));
    }
  }

  const std::string& name_;
  std::string_view bytes_;
  bool big_endian_ = false;
  CompressedTexture texture_;
};

}  // namespace

bool is_compressed_file(std::string_view head) {
  return head.starts_with(kKtx1Magic) || head.starts_with(kKtx2Magic) ||
         (head.starts_with(kDdsMagic) && dds_format(head) != nullptr);
}

CompressedTexture read_compressed(const std::string& name, std::string_view bytes) {
  return Reader(name, bytes).read();
}

Image decoded(const CompressedTexture::Level& level, Format format) {
  Image image(level.width, level.height);
  const std::size_t bytes = spec::texture::kFormatBlockBytes[static_cast<std::size_t>(format)];
  const std::uint8_t* block = level.blocks.data();
  for (int top = 0; top < level.height; top += 4)
    for (int left = 0; left < level.width; left += 4, block += bytes) {
      const std::array<std::uint32_t, 16> texels =
          golden::texture::decode_block(format, spec::texture::BlockRule::kTruncated, block);
      for (int y = top; y < std::min(top + 4, level.height); ++y)
        for (int x = left; x < std::min(left + 4, level.width); ++x) {
          const std::uint32_t texel = texels[static_cast<std::size_t>(4 * (y - top) + x - left)];
          image.at(x, y) = {static_cast<std::uint8_t>(texel), static_cast<std::uint8_t>(texel >> 8),
                            static_cast<std::uint8_t>(texel >> 16),
                            static_cast<std::uint8_t>(texel >> 24)};
        }
    }
  return image;
}

}  // namespace deburr::tb
