// SPDX-License-Identifier: MIT
#include "tb/scene/image_io.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <memory>
#include <optional>

#include "spec/depth_check.h"
#include "spec/error.h"
#include "tb/base/atomic_file.h"
#include "tb/base/file.h"
#include "tb/scene/image_codec.h"
#include "tb/scene/png.h"
#include "tb/scene/textures.h"

namespace deburr::tb {
namespace {

namespace fs = std::filesystem;
using DecoderPointer = std::unique_ptr<ImageDecoder>;
using Header = ImageDecoder::Header;

// libpng and others also print the errors that they return; this class suppresses the printed copy.
// While such an object exists, nothing else in this process may print.
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

void check_file(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status)) fail_read(path.string(), "no such file; check the path");
  if (!fs::is_regular_file(status))
    fail_read(path.string(), "not a regular file; give an image file");
  const std::uintmax_t size = fs::file_size(path, error);
  if (error) fail_read(path.string(), error.message());
  if (size == 0) fail_read(path.string(), "the file is empty (0 bytes); make it again");
  if (!std::ifstream(path)) fail_read(path.string(), "permission denied");
}

DecoderPointer open_file(const fs::path& path) {
  check_file(path);
  ImageCodec::Source source = image_codec().open_file(path.string());
  if (!source.decoder) {
    fail_read(path.string(), fmt::format("OpenImageIO cannot read it: unsupported format or "
                                         "damaged file ({}); use PNG, JPEG, TIFF, EXR, ...",
                                         source.error));
  }
  return std::move(source.decoder);
}

// Whether the stored pixels cover only part of the image, or extend beyond the image.
bool is_window(const Header& header) {
  return header.x != 0 || header.y != 0 || header.width != header.full_width ||
         header.height != header.full_height;
}

void check_header(const std::string& name, const Header& header) {
  if (header.width < 1 || header.height < 1 || header.channels < 1)
    fail_read(name,
              fmt::format("its header says {} x {} pixels of {} channels; the file is damaged",
                          header.width, header.height, header.channels));
  for (const auto& [width, height] :
       {std::pair(header.width, header.height), std::pair(header.full_width, header.full_height)})
    if (width < 1 || height < 1 || width > kMaxImageSide || height > kMaxImageSide)
      fail_read(name, fmt::format(
                          "its header says {} x {} pixels, the limit is {} x {}; scale or crop it",
                          width, height, kMaxImageSide, kMaxImageSide));
  if ((header.file_format == "rla" || header.file_format == "iff") && is_window(header))
    fail_read(name,
              "it stores a part of an image, which OpenImageIO misplaces in this format; write the "
              "whole image, or an EXR");
  if (!header.other_colours.empty())
    fail_read(
        name,
        fmt::format(
            "its colour type '{}' is not supported; save it as RGB, or as grey with black = 0",
            header.other_colours));
  if (!header.flat) fail_read(name, "it is a volume or a deep image; flatten it to two dimensions");
}

// libjpeg fills the rest of a truncated file with grey and only warns, so check the end marker.
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

// libtiff fills the missing part of a truncated file with zeros, so check that every strip or tile
// of the first image lies within the file.
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

[[noreturn]] void fail_damaged(const std::string& name, ImageDecoder& decoder) {
  fail_read(name, fmt::format("the file is truncated or corrupt ({}); make or copy it again",
                              decoder.error()));
}

template <class Value>
std::vector<Value> read_pixels(const std::string& name, ImageDecoder& decoder, int channels) {
  const Header& header = decoder.header();
  std::vector<Value> values(static_cast<std::size_t>(header.width) *
                            static_cast<std::size_t>(header.height) *
                            static_cast<std::size_t>(channels));
  if (!decoder.read(channels, values.data())) fail_damaged(name, decoder);
  return values;
}

// Maps stored channels to R, G, B and A.
struct Channels {
  int read = 0;  // number of channels to read, from the first
  std::array<std::size_t, 3> colour{};
  std::optional<std::size_t> alpha;  // empty: opaque
};

Channels channels_of(const std::string& name, const Header& header) {
  if (!header.odd_channels.empty())
    fail_read(name, fmt::format("it has the channels {}; an image needs R, G and B, or only Y",
                                header.odd_channels));
  Channels channels;
  std::vector<std::size_t> colours;
  for (int c = 0; c < header.channels && colours.size() < 3; ++c)
    if (c != header.alpha && (c != header.depth || header.channels == 1))
      colours.push_back(static_cast<std::size_t>(c));
  if (colours.empty() || colours.size() == 2)
    fail_read(name, fmt::format("it has {} colour channels; expected one (grey) or three",
                                colours.size()));
  for (std::size_t c = 0; c < 3; ++c) channels.colour[c] = colours[colours.size() == 3 ? c : 0];
  channels.read = static_cast<int>(colours.back()) + 1;
  if (header.alpha >= 0) {
    channels.alpha = static_cast<std::size_t>(header.alpha);
    channels.read = std::max(channels.read, header.alpha + 1);
  }
  return channels;
}

// Places the stored pixels in the whole image; pixels that are not stored get `around`.
template <class Pixel>
ImageOf<Pixel> placed(ImageOf<Pixel> stored, const Header& header, const Pixel& around) {
  if (!is_window(header)) return stored;
  ImageOf<Pixel> image(header.full_width, header.full_height, around);
  for (int y = std::max(header.y, 0); y < std::min(header.y + header.height, image.height); ++y)
    for (int x = std::max(header.x, 0); x < std::min(header.x + header.width, image.width); ++x)
      image.at(x, y) = stored.at(x - header.x, y - header.y);
  return image;
}

// Divides a premultiplied integer colour by alpha: 255 colour / alpha, rounded half up.
std::uint8_t straight_code(std::uint64_t colour, std::uint64_t alpha) {
  return static_cast<std::uint8_t>(
      std::min<std::uint64_t>((510 * colour + alpha) / (2 * alpha), 255));
}

// Clamps to [0, 1], turns NaN into 0, and rounds half up.
std::uint8_t code_of(float value, bool linear) {
  if (!(value > 0.0f)) return 0;
  const double clamped = std::min<double>(value, 1.0);
  return static_cast<std::uint8_t>(
      std::floor(255 * (linear ? linear_to_srgb(clamped) : clamped) + 0.5));
}

constexpr const char *kBytes = "uint8", *kWords = "uint16";
constexpr float kLargestWord = 65535.0f;

// Depends on the name that OpenImageIO gives the file's colour space: "Linear" (every EXR),
// "linear" (HDR), "lin_srgb" and "scene_linear" are linear light. Integers are always taken as
// encoded.
bool declares_linear_light(const Header& header) {
  if (!header.floating_point) return false;
  std::string space = header.colour_space;
  std::transform(space.begin(), space.end(), space.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return space.rfind("lin", 0) == 0 || space.rfind("scene_linear", 0) == 0;
}

void note_window(const Header& header, std::string_view around, ReadReport& report) {
  if (is_window(header))
    report.conversions.push_back(
        fmt::format("{} x {} stored pixels placed at ({}, {}) in an image of {} x {}: the rest is "
                    "{}, pixels outside are dropped",
                    header.width, header.height, header.x, header.y, header.full_width,
                    header.full_height, around));
}

void describe_conversions(const Header& header, const Channels& channels, bool linear,
                          ReadReport& report) {
  report.channels = header.channels;
  report.format = header.value_format;
  report.conversions.clear();
  auto note = [&](std::string text) { report.conversions.push_back(std::move(text)); };
  if (header.value_format != kBytes)
    note(fmt::format("{} values scaled to 8 bits", header.value_format));
  if (linear) note("linear light encoded with the sRGB curve");
  if (!linear && header.floating_point)
    note("the file does not declare linear light: read as sRGB-encoded");
  if (header.cmyk) note("CMYK converted to RGB without its colour profile");
  if (channels.colour[0] == channels.colour[2]) note("grey copied to R, G and B");
  if (header.channels > 4) note(fmt::format("channels 5 to {} ignored", header.channels));
  if (header.other_layers > 0)
    note(fmt::format("only the first layer is read; {} channels of other layers ignored",
                     header.other_layers));
  if (header.associated) note("premultiplied colours divided by alpha");
  if (header.alpha >= 0 && !header.alpha_named && header.file_format == "tiff")
    note(fmt::format(
        "the file does not declare the type of channel {}: read as alpha that is not premultiplied",
        header.alpha + 1));
  note_window(header, "black with alpha 0", report);
  if (header.orientation != 1) note("orientation tag ignored");
  if (header.several) note("only the first of several images is read");
}

// Pixels outside the image are not counted.
void describe_values(const Header& header, const std::vector<float>& values, std::size_t channels,
                     ReadReport& report) {
  spec::Found outside, nan;
  std::size_t seen = 0;
  const auto width = static_cast<std::size_t>(header.full_width);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto stored = static_cast<std::int64_t>(i / channels);
    const std::int64_t x = header.x + stored % header.width, y = header.y + stored / header.width;
    if (x < 0 || y < 0 || x >= header.full_width || y >= header.full_height) continue;
    ++seen;
    const std::size_t place = static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x);
    if (std::isnan(values[i]))
      nan.add(place);
    else if (values[i] < 0.0f || values[i] > 1.0f)
      outside.add(place);
  }
  const auto note = [&](const spec::Found& found, std::string_view what) {
    if (found.number > 0) report.conversions.push_back(found.in_words(seen, width, what));
  };
  note(outside, "clamped to [0, 1]");
  note(nan, "NaN replaced by 0");
}

Image of_bytes(const std::vector<std::uint8_t>& values, const Header& header,
               const Channels& channels) {
  Image image(header.width, header.height);
  const auto step = static_cast<std::size_t>(channels.read);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    const std::uint8_t* const from = &values[i * step];
    const std::uint8_t alpha = channels.alpha ? from[*channels.alpha] : std::uint8_t{255};
    const bool divide = header.associated && alpha != 0;
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint8_t colour = from[channels.colour[c]];
      image.pixels[i][c] = divide ? straight_code(colour, alpha) : colour;
    }
    image.pixels[i][3] = alpha;
  }
  return image;
}

Image of_floats(std::vector<float>& values, const Header& header, const Channels& channels,
                bool linear, ReadReport* report) {
  const auto step = static_cast<std::size_t>(channels.read);
  const bool divide = header.associated && channels.alpha;
  const bool exact = header.value_format == kWords;  // integers divided exactly
  Image image(header.width, header.height);
  for (std::size_t i = 0; i < image.pixels.size() && divide && !exact; ++i) {
    float* const pixel = &values[i * step];
    const float alpha = pixel[*channels.alpha];
    for (std::size_t c = 0; c < step && alpha > 0.0f; ++c)
      if (c != *channels.alpha) pixel[c] /= alpha;
  }
  if (report != nullptr) describe_values(header, values, step, *report);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    const float* const from = &values[i * step];
    const float alpha = channels.alpha ? from[*channels.alpha] : 1.0f;
    const auto integer = [](float value) {
      return static_cast<std::uint64_t>(std::lround(value * kLargestWord));
    };
    for (std::size_t c = 0; c < 3; ++c) {
      const float colour = from[channels.colour[c]];
      image.pixels[i][c] = divide && exact && alpha > 0.0f
                               ? straight_code(integer(colour), integer(alpha))
                               : code_of(colour, linear);
    }
    image.pixels[i][3] = code_of(alpha, false);
  }
  return image;
}

Image decode(const std::string& name, ImageDecoder& decoder, ReadReport* report) {
  const Header& header = decoder.header();
  const Channels channels = channels_of(name, header);
  const bool linear = declares_linear_light(header);
  if (report != nullptr) describe_conversions(header, channels, linear, *report);
  constexpr Rgba8 kNothing = {0, 0, 0, 0};
  if (header.value_format == kBytes)
    return placed(
        of_bytes(read_pixels<std::uint8_t>(name, decoder, channels.read), header, channels), header,
        kNothing);
  std::vector<float> values = read_pixels<float>(name, decoder, channels.read);
  return placed(of_floats(values, header, channels, linear, report), header, kNothing);
}

// NaN is rejected, since it is not a distance and silhouettes would be found around it.
void check_depths(const std::string& name, const DepthImage& depths, ReadReport* report) {
  spec::DepthCheck check;
  for (const float depth : depths.pixels) check.add_binary32(std::bit_cast<std::uint32_t>(depth));
  const auto width = static_cast<std::size_t>(depths.width);
  if (const std::string error = check.error(width); !error.empty()) fail_read(name, error);
  if (const std::string note = check.note(width); !note.empty() && report != nullptr)
    report->conversions.push_back(note);
}

// The real number from which depth_codes() makes this code.
float depth_of_code(std::uint64_t code) {
  return static_cast<float>(static_cast<double>(code) / spec::kLargestDepth);
}

// The depth channel of a multi-channel EXR, by name. Empty if the file has one channel.
std::optional<int> named_depth(const std::string& name, const Header& header, ReadReport* report) {
  const std::size_t all = header.names.size();
  if (header.depth < 0 && (all > 1 || (all == 1 && header.several)))
    fail_read(
        name,
        fmt::format(
            "it has {} {}, but needs exactly one channel named as depth (Z); write only the depth",
            header.several ? "several images, the first with" : "the channels",
            fmt::join(header.names, ", ")));
  if (all < 2) return std::nullopt;
  if (report != nullptr)
    report->conversions.push_back(fmt::format("channel {} of {} read as depth",
                                              header.names[static_cast<std::size_t>(header.depth)],
                                              all));
  return header.depth;
}

std::vector<float> read_channel(const std::string& name, ImageDecoder& decoder, int channel) {
  std::vector<float> values(static_cast<std::size_t>(decoder.header().width) *
                            static_cast<std::size_t>(decoder.header().height));
  if (!decoder.read_channel(channel, values.data())) fail_damaged(name, decoder);
  return values;
}

DecoderPointer open_checked(const fs::path& path) {
  DecoderPointer decoder = open_file(path);
  check_header(path.string(), decoder->header());
  if (decoder->header().file_format == "jpeg") check_complete_jpeg(path);
  if (decoder->header().file_format == "tiff") check_complete_tiff(path);
  return decoder;
}

// OpenImageIO selects a reader by file extension. An image embedded in a glTF has none, so detect
// the format from its first bytes.
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
    fail_read(name,
              fmt::format("OpenImageIO cannot read it: unsupported format or damaged data ({})",
                          source.error));
  check_header(name, source.decoder->header());
  return decode(name, *source.decoder, report);
}

// The largest compressed texture, with some room for a header.
constexpr std::size_t kMostCompressedBytes =
    std::size_t{kMaxImageSide} * kMaxImageSide * 3 / 2 + (1 << 20);

std::string head_of(const fs::path& path) {
  std::string head(kCompressedHeaderBytes, '\0');
  std::ifstream file(path, std::ios::binary);
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(file.gcount()));
  return head;
}

Image decode_compressed(const std::string& name, std::string_view bytes, ReadReport* report) {
  auto texture = std::make_shared<const CompressedTexture>(read_compressed(name, bytes));
  Image image = decoded(texture->levels[0], texture->format);
  if (report != nullptr) *report = {4, kBytes, {}, std::move(texture)};
  return image;
}

[[noreturn]] void fail_write(const fs::path& path, const std::string& reason) {
  throw spec::FileError(fmt::format("cannot write the image '{}': {}", path.string(), reason));
}

// Encodes to memory, because only write_file_atomically() writes to disk.
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
    fail_write(path, fmt::format("its size is {} x {}; each side must be 1 to {}", width, height,
                                 kMaxImageSide));
}

}  // namespace

Image read_image(const fs::path& path, ReadReport* report) {
  check_file(path);
  if (is_compressed_file(head_of(path)))
    return decode_compressed(path.string(), read_file(path, kMostCompressedBytes), report);
  const SilentLibraries silent;
  const DecoderPointer decoder = open_checked(path);
  return decode(path.string(), *decoder, report);
}

Image read_image_memory(const std::string& name, std::string_view bytes, ReadReport* report) {
  const SilentLibraries silent;
  if (bytes.empty()) fail_read(name, "the image is empty (0 bytes)");
  if (is_compressed_file(bytes.substr(0, kCompressedHeaderBytes)))
    return decode_compressed(name, bytes, report);
  const std::string extension = extension_of(bytes);
  if (extension.empty())  // OpenImageIO would try every reader
    fail_read(name, "unknown format of an embedded image; use PNG or JPEG");
  return decode_memory(name, extension, bytes, report);
}

DepthImage read_depth(const fs::path& path, ReadReport* report) {
  const SilentLibraries silent;
  const DecoderPointer decoder = open_checked(path);
  const Header& header = decoder->header();
  const std::string name = path.string();
  if (report != nullptr) {
    *report = {header.channels, header.value_format, {}};
    note_window(header, "infinitely far", *report);
    if (header.several) report->conversions.push_back("only the first of several images is read");
  }
  const std::optional<int> named = named_depth(name, header, report);
  if (named && report != nullptr) report->channels = 1;
  DepthImage depth(header.width, header.height);
  // Colours that the file's encoding or the decoder has converted are no longer exact codes.
  const bool divided = header.value_format == kBytes && header.associated;
  const bool changed = header.cmyk || header.lossy;
  if (named) {
    depth.pixels = read_channel(name, *decoder, *named);
  } else if (header.channels == 1 && header.floating_point) {
    depth.pixels = read_pixels<float>(name, *decoder, 1);
  } else if (header.channels == 1 && header.value_format == kWords) {
    const std::vector<float> values = read_pixels<float>(name, *decoder, 1);
    constexpr std::uint64_t kFrom = 65535, kTo = spec::kLargestDepth;
    for (std::size_t i = 0; i < values.size(); ++i) {
      const auto value = static_cast<std::uint64_t>(std::lround(values[i] * kLargestWord));
      depth.pixels[i] = depth_of_code((2 * kTo * value + kFrom) / (2 * kFrom));
    }
    if (report != nullptr)
      report->conversions.push_back(
          "16-bit grey read as near / w: 0 infinitely far, 65535 at the near plane");
  } else if (header.channels >= 3 && header.value_format == kBytes && !divided && !changed) {
    const auto bytes = read_pixels<std::uint8_t>(name, *decoder, header.channels >= 4 ? 4 : 3);
    const std::size_t step = header.channels >= 4 ? 4 : 3;
    for (std::size_t i = 0; i < depth.pixels.size(); ++i) {
      const std::uint8_t* const from = &bytes[step * i];
      depth.pixels[i] = depth_of_code(static_cast<std::uint64_t>(from[0]) << 16 |
                                      static_cast<std::uint64_t>(from[1]) << 8 | from[2]);
    }
  } else {
    fail_read(name,
              fmt::format("a depth image must have 24 bits in R, G and B (8 bits each), 16-bit "
                          "grey, or one float channel; this one has {} channel{} of {}{}. Write "
                          "only the depth, in one of these formats",
                          header.channels, header.channels == 1 ? "" : "s", header.value_format,
                          divided   ? ", premultiplied by alpha"
                          : changed ? ", changed by compression or conversion"
                                    : ""));
  }
  depth = placed(std::move(depth), header, 0.0f);
  check_depths(name, depth, report);
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
  const auto bytes =
      encode(path, {image.width, image.height, opaque ? 3 : 4, image.pixels.data(), sizeof(Rgba8)});
  const Image back = decode_memory(path.string(), path.extension().string(), view(bytes), nullptr);
  if (back.width != image.width || back.height != image.height ||
      ((!opaque || !is_lossy(path)) && back.pixels != image.pixels))
    fail_write(path, "the format cannot store these pixels exactly; use .png");
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
