// SPDX-License-Identifier: MIT
#include "tb/scene/image_io.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <memory>

#include "spec/error.h"
#include "tb/base/atomic_file.h"
#include "tb/scene/image_codec.h"
#include "tb/scene/png.h"
#include "tb/scene/textures.h"

namespace deburr::tb {
namespace {

namespace fs = std::filesystem;
using DecoderPointer = std::unique_ptr<ImageDecoder>;
using Header = ImageDecoder::Header;

// libpng and others print on the error stream what they report as well; ours says it once. While it
// lives, nothing else in this process prints.
class SilentLibraries {
 public:
  SilentLibraries() : kept_(::dup(STDERR_FILENO)) {
    std::fflush(stderr);
    const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
    if (kept_ >= 0 && nowhere >= 0) ::dup2(nowhere, STDERR_FILENO);
    if (nowhere >= 0) ::close(nowhere);
  }
  ~SilentLibraries() {
    if (kept_ < 0) return;
    std::fflush(stderr);
    ::dup2(kept_, STDERR_FILENO);
    ::close(kept_);
  }
  SilentLibraries(const SilentLibraries&) = delete;
  SilentLibraries& operator=(const SilentLibraries&) = delete;

 private:
  int kept_;
};

[[noreturn]] void fail_read(const std::string& name, const std::string& reason) {
  throw spec::FileError(fmt::format("cannot read the image '{}': {}", name, reason));
}

DecoderPointer open_file(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status)) fail_read(path.string(), "no such file; check the path");
  if (!fs::is_regular_file(status))
    fail_read(path.string(), "not a regular file; give an image file");
  const std::uintmax_t size = fs::file_size(path, error);
  if (error) fail_read(path.string(), error.message());
  if (size == 0) fail_read(path.string(), "the file is empty (0 bytes); make it again");
  if (!std::ifstream(path)) fail_read(path.string(), "permission denied");
  ImageCodec::Source source = image_codec().open_file(path.string());
  if (!source.decoder) {
    fail_read(path.string(),
              fmt::format("not an image that OpenImageIO understands, or a damaged one ({}); "
                          "give a PNG, JPEG, TIFF, EXR, ...",
                          source.error));
  }
  return std::move(source.decoder);
}

void check_header(const std::string& name, const Header& header) {
  if (header.width < 1 || header.height < 1 || header.channels < 1)
    fail_read(name,
              fmt::format("its header says {} x {} pixels of {} channels; the file is damaged",
                          header.width, header.height, header.channels));
  if (header.width > kMaxImageSide || header.height > kMaxImageSide)
    fail_read(name,
              fmt::format("its header says {} x {} pixels, the limit is {} x {}; scale it down "
                          "or cut it",
                          header.width, header.height, kMaxImageSide, kMaxImageSide));
  if (!header.flat) fail_read(name, "it is a volume or a deep image; flatten it to two dimensions");
}

// libjpeg fills the rest of a truncated file with grey and only warns, so look for the end marker.
void check_complete_jpeg(const fs::path& path) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  const auto size = static_cast<std::streamoff>(file.tellg());
  const std::streamoff tail = std::min<std::streamoff>(size, 4096);
  std::string bytes(static_cast<std::size_t>(tail), '\0');
  file.seekg(size - tail);
  file.read(bytes.data(), tail);
  if (bytes.rfind("\xFF\xD9") == std::string::npos)
    fail_read(path.string(), "the JPEG has no end marker: the file is truncated; copy it again");
}

// libtiff fills the rest of a truncated file with zeros, so see whether every strip or tile of the
// first picture lies within the file.
void check_complete_tiff(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  const std::uint64_t size = fs::file_size(path);
  const bool little = file.get() == 'I';
  const auto number = [&](std::uint64_t at, std::uint64_t bytes) {
    std::uint64_t value = 0;
    file.clear();
    file.seekg(static_cast<std::streamoff>(std::min(at, size)));
    for (std::uint64_t i = 0; i < bytes; ++i) {
      const auto byte = static_cast<std::uint64_t>(file.get() & 255);
      value = little ? value | byte << (8 * i) : value << 8 | byte;
    }
    return value;
  };
  const bool big = number(2, 2) == 43;
  const std::uint64_t word = big ? 8 : 4, entry_bytes = 4 + 2 * word;
  const std::uint64_t directory = number(word, word), first = directory + (big ? 8 : 2);
  std::vector<std::uint64_t> offsets, counts;
  for (std::uint64_t e = 0; e < number(directory, big ? 8 : 2) && first + e * entry_bytes < size;
       ++e) {
    const std::uint64_t at = first + e * entry_bytes, tag = number(at, 2), type = number(at + 2, 2);
    const bool is_offset = tag == 273 || tag == 324, is_count = tag == 279 || tag == 325;
    if (!is_offset && !is_count) continue;
    const std::uint64_t bytes = type == 3 ? 2 : type == 4 ? 4 : 8;
    const std::uint64_t values = std::min(number(at + 4, word), size);
    const std::uint64_t value = at + 4 + word;
    const std::uint64_t from = values * bytes <= word ? value : number(value, word);
    for (std::uint64_t i = 0; i < values; ++i)
      (is_offset ? offsets : counts).push_back(number(from + i * bytes, bytes));
  }
  for (std::size_t i = 0; i < std::min(offsets.size(), counts.size()); ++i)
    if (offsets[i] > size || counts[i] > size - offsets[i])
      fail_read(path.string(),
                fmt::format("the TIFF ends after {} bytes, within its pixels: the file is "
                            "truncated; copy it again",
                            size));
}

template <class Value>
std::vector<Value> read_pixels(const std::string& name, ImageDecoder& decoder, int channels) {
  const Header& header = decoder.header();
  std::vector<Value> values(static_cast<std::size_t>(header.width) *
                            static_cast<std::size_t>(header.height) *
                            static_cast<std::size_t>(channels));
  if (!decoder.read(channels, values.data()))
    fail_read(name, fmt::format("the file is truncated or corrupt ({}); make or copy it again",
                                decoder.error()));
  return values;
}

// Spreads 1 to 4 stored channels over R, G, B, A.
template <class Pixel, class Value>
ImageOf<Pixel> expand(const std::vector<Value>& values, int width, int height, int channels,
                      Value opaque) {
  ImageOf<Pixel> image(width, height);
  const auto step = static_cast<std::size_t>(channels);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    const Value* from = &values[i * step];
    if (channels <= 2)
      image.pixels[i] = {from[0], from[0], from[0], channels == 2 ? from[1] : opaque};
    else
      image.pixels[i] = {from[0], from[1], from[2], channels >= 4 ? from[3] : opaque};
  }
  return image;
}

// How many of some numbers there are, and which is the first.
struct Found {
  std::size_t number = 0, first = 0;
  void add(std::size_t index) {
    if (number++ == 0) first = index;
  }
};

// "12 of 300 values ..., the first at (3, 4)"
std::string in_words(const Found& found, const Header& header, std::size_t values,
                     std::size_t channels, std::string_view what) {
  const std::size_t pixel = found.first / channels, width = static_cast<std::size_t>(header.width);
  return fmt::format("{} of {} values {}, the first at ({}, {})", found.number, values, what,
                     pixel % width, pixel / width);
}

// Clamped to [0, 1], NaN to 0; rounded half up.
std::uint8_t code_of(float value, bool linear) {
  if (!(value > 0.0f)) return 0;
  const double clamped = std::min<double>(value, 1.0);
  return static_cast<std::uint8_t>(
      std::floor(255 * (linear ? linear_to_srgb(clamped) : clamped) + 0.5));
}

constexpr const char* kBytes = "uint8";

// By the name that OpenImageIO gives the file's colour space: "Linear" (every EXR), "linear" (HDR),
// "lin_srgb", "scene_linear". Integers are codes, whatever the file says.
bool declares_linear_light(const Header& header) {
  if (!header.floating_point) return false;
  std::string space = header.colour_space;
  std::transform(space.begin(), space.end(), space.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return space.rfind("lin", 0) == 0 || space.rfind("scene_linear", 0) == 0;
}

void describe_conversions(const Header& header, bool linear, ReadReport& report) {
  report.channels = header.channels;
  report.format = header.value_format;
  report.conversions.clear();
  auto note = [&](std::string text) { report.conversions.push_back(std::move(text)); };
  if (header.value_format != kBytes)
    note(fmt::format("{} values scaled to 8 bits", header.value_format));
  if (linear) note("linear light encoded with the sRGB curve");
  if (!linear && header.floating_point)
    note("the file does not say that it is linear light: taken as encoded");
  if (header.channels <= 2) note("grey copied to R, G and B");
  if (header.channels > 4) note(fmt::format("channels 5 to {} left out", header.channels));
  if (header.orientation != 1) note("orientation tag ignored");
  if (header.several) note("the first of several pictures");
}

void describe_values(const Header& header, const std::vector<float>& values, std::size_t channels,
                     ReadReport& report) {
  Found outside, nan;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (std::isnan(values[i]))
      nan.add(i);
    else if (values[i] < 0.0f || values[i] > 1.0f)
      outside.add(i);
  }
  const auto note = [&](const Found& found, std::string_view what) {
    if (found.number > 0)
      report.conversions.push_back(in_words(found, header, values.size(), channels, what));
  };
  note(outside, "clamped to [0, 1]");
  note(nan, "NaN made 0");
}

Image decode(const std::string& name, ImageDecoder& decoder, ReadReport* report) {
  const Header& header = decoder.header();
  const int channels = std::min(header.channels, 4);
  const bool linear = declares_linear_light(header);
  if (report != nullptr) describe_conversions(header, linear, *report);
  if (header.value_format == kBytes)
    return expand<Rgba8>(read_pixels<std::uint8_t>(name, decoder, channels), header.width,
                         header.height, channels, std::uint8_t{255});
  const std::vector<float> stored = read_pixels<float>(name, decoder, channels);
  if (report != nullptr)
    describe_values(header, stored, static_cast<std::size_t>(channels), *report);
  const FloatImage values = expand<Rgbaf>(stored, header.width, header.height, channels, 1.0f);
  Image image(header.width, header.height);
  for (std::size_t i = 0; i < values.pixels.size(); ++i)
    for (std::size_t c = 0; c < 4; ++c)
      image.pixels[i][c] = code_of(values.pixels[i][c], linear && c < 3);
  return image;
}

// What is no number is at no distance, and silhouettes would be found around it.
void check_depths(const std::string& name, const Header& header, const std::vector<float>& depths,
                  ReadReport* report) {
  Found nan, outside;
  for (std::size_t i = 0; i < depths.size(); ++i) {
    if (std::isnan(depths[i]))
      nan.add(i);
    else if (depths[i] < 0.0f || depths[i] > 1.0f)
      outside.add(i);
  }
  if (nan.number > 0)
    fail_read(name, in_words(nan, header, depths.size(), 1, "are NaN, which is no depth") +
                        ": write 0, infinitely far, where nothing is, and render the rest again");
  if (outside.number > 0 && report != nullptr)
    report->conversions.push_back(
        in_words(outside, header, depths.size(), 1, "lie outside [0, 1]") +
        ": edges from depth use them clamped, so steps among them are lost");
}

DecoderPointer open_checked(const fs::path& path) {
  DecoderPointer decoder = open_file(path);
  check_header(path.string(), decoder->header());
  if (decoder->header().file_format == "jpeg") check_complete_jpeg(path);
  if (decoder->header().file_format == "tiff") check_complete_tiff(path);
  return decoder;
}

// OpenImageIO chooses a reader by extension; a picture inside a glTF has none, so look at its
// bytes.
std::string extension_of(std::string_view bytes) {
  auto starts = [&](std::string_view magic) { return bytes.substr(0, magic.size()) == magic; };
  if (starts("\x89PNG")) return ".png";
  if (starts("\xFF\xD8\xFF")) return ".jpg";
  if (starts("RIFF")) return ".webp";
  if (starts("v/1\x01")) return ".exr";
  if (starts("BM")) return ".bmp";
  if (starts("GIF8")) return ".gif";
  if (starts("II*") || starts("MM")) return ".tif";
  if (starts("DDS ")) return ".dds";
  if (bytes.size() > 1 && bytes[0] == 'P' && bytes[1] >= '1' && bytes[1] <= '6') return ".ppm";
  return "";
}

Image decode_memory(const std::string& name, const std::string& extension, std::string_view bytes,
                    ReadReport* report) {
  const ImageCodec::Source source = image_codec().open_memory("memory" + extension, bytes);
  if (!source.decoder)
    fail_read(name, fmt::format("not an image that OpenImageIO understands, or a damaged one ({})",
                                source.error));
  check_header(name, source.decoder->header());
  return decode(name, *source.decoder, report);
}

[[noreturn]] void fail_write(const fs::path& path, const std::string& reason) {
  throw spec::FileError(fmt::format("cannot write the image '{}': {}", path.string(), reason));
}

// Encodes to memory, so that what reaches the disk is written by write_file_atomically alone.
std::vector<unsigned char> encode(const fs::path& path, const ImageCodec::Pixels& pixels) {
  ImageCodec::Encoded encoded = image_codec().encode(path.string(), pixels);
  if (!encoded.writable)
    fail_write(path,
               fmt::format("the extension '{}' is not a writable image format; use .png or .exr",
                           path.extension().string()));
  if (!encoded.error.empty()) fail_write(path, fmt::format("{}; use .png or .exr", encoded.error));
  return std::move(encoded.bytes);
}

bool is_lossy(const fs::path& path) {
  const std::string extension = path.extension().string();
  return extension == ".jpg" || extension == ".jpeg" || extension == ".webp" || extension == ".gif";
}

std::string_view view(const std::vector<unsigned char>& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

void check_not_empty(const fs::path& path, int width, int height) {
  if (width < 1 || height < 1 || width > kMaxImageSide || height > kMaxImageSide)
    fail_write(path, fmt::format("its size is {} x {}, allowed are 1 to {}", width, height,
                                 kMaxImageSide));
}

}  // namespace

Image read_image(const fs::path& path, ReadReport* report) {
  const SilentLibraries silent;
  const DecoderPointer decoder = open_checked(path);
  return decode(path.string(), *decoder, report);
}

Image read_image_memory(const std::string& name, std::string_view bytes, ReadReport* report) {
  const SilentLibraries silent;
  if (bytes.empty()) fail_read(name, "the image is empty (0 bytes)");
  const std::string extension = extension_of(bytes);
  if (extension.empty())  // every reader there is would try
    fail_read(name, "its first bytes are of no format that is read from memory; use PNG or JPEG");
  return decode_memory(name, extension, bytes, report);
}

FloatImage read_float_image(const fs::path& path) {
  const SilentLibraries silent;
  const DecoderPointer decoder = open_checked(path);
  const Header& header = decoder->header();
  const int channels = std::min(header.channels, 4);
  return expand<Rgbaf>(read_pixels<float>(path.string(), *decoder, channels), header.width,
                       header.height, channels, 1.0f);
}

DepthImage read_depth(const fs::path& path, ReadReport* report) {
  const SilentLibraries silent;
  const DecoderPointer decoder = open_checked(path);
  const Header& header = decoder->header();
  if (report != nullptr) report->conversions.clear();
  DepthImage depth(header.width, header.height);
  if (header.channels == 1 && header.floating_point) {
    depth.pixels = read_pixels<float>(path.string(), *decoder, 1);
    check_depths(path.string(), header, depth.pixels, report);
    return depth;
  }
  if (header.channels < 3 || header.value_format != kBytes)
    fail_read(
        path.string(),
        fmt::format("a depth picture has 24 bits in R, G and B or one float channel, this one has "
                    "{} channels of {}",
                    header.channels, header.value_format));
  const auto bytes = read_pixels<std::uint8_t>(path.string(), *decoder, 3);
  for (std::size_t i = 0; i < depth.pixels.size(); ++i) {
    const std::uint32_t value = static_cast<std::uint32_t>(bytes[3 * i]) << 16 |
                                static_cast<std::uint32_t>(bytes[3 * i + 1]) << 8 |
                                bytes[3 * i + 2];
    depth.pixels[i] = static_cast<float>(value / 16777215.0);
  }
  return depth;
}

void write_image(const fs::path& path, const Image& image) {
  check_not_empty(path, image.width, image.height);
  if (path.extension() == ".png") {
    write_file_atomically(path, encode_png(image));
    return;
  }
  const SilentLibraries silent;
  const bool opaque = std::all_of(image.pixels.begin(), image.pixels.end(),
                                  [](const Rgba8& pixel) { return pixel[3] == 255; });
  const auto bytes = encode(
      path, {image.width, image.height, opaque ? 3 : 4, false, image.pixels.data(), sizeof(Rgba8)});
  const Image back = decode_memory(path.string(), path.extension().string(), view(bytes), nullptr);
  if (back.width != image.width || back.height != image.height ||
      (!is_lossy(path) && back.pixels != image.pixels))
    fail_write(path, "the format does not keep these pixels as they are; use .png");
  write_file_atomically(path, view(bytes));
}

void write_image(const fs::path& path, const FloatImage& image) {
  check_not_empty(path, image.width, image.height);
  const SilentLibraries silent;
  const auto bytes =
      encode(path, {image.width, image.height, 4, true, image.pixels.data(), sizeof(Rgbaf)});
  const ImageCodec::Source source =
      image_codec().open_memory(path.filename().string(), view(bytes));
  if (!source.decoder) fail_write(path, "what was encoded cannot be decoded: " + source.error);
  const Header& got = source.decoder->header();
  bool same = got.width == image.width && got.height == image.height && got.channels == 4 &&
              got.value_format == "float";
  if (same) {
    const auto values = read_pixels<float>(path.string(), *source.decoder, 4);
    // Bits, not values: a NaN must come back too.
    same = std::memcmp(values.data(), image.pixels.data(), values.size() * sizeof(float)) == 0;
  }
  if (!same) fail_write(path, "the format does not keep floats as they are; use .exr");
  write_file_atomically(path, view(bytes));
}

void write_depth24(const fs::path& path, const DepthImage& depth) {
  Image image(depth.width, depth.height);
  for (std::size_t i = 0; i < depth.pixels.size(); ++i) {
    const double inside = depth.pixels[i] > 0.0f ? std::min<double>(depth.pixels[i], 1.0) : 0.0;
    const auto value = static_cast<std::uint32_t>(std::lround(inside * 16777215.0));
    image.pixels[i] = {static_cast<std::uint8_t>(value >> 16),
                       static_cast<std::uint8_t>(value >> 8), static_cast<std::uint8_t>(value),
                       255};
  }
  write_image(path, image);
}

void write_mask(const fs::path& path, const Mask& mask) {
  Image image(mask.width, mask.height);
  for (std::size_t i = 0; i < mask.pixels.size(); ++i) {
    const std::uint8_t value = mask.pixels[i] != 0 ? 255 : 0;
    image.pixels[i] = {value, value, value, 255};
  }
  write_image(path, image);
}

}  // namespace deburr::tb
