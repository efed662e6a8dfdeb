// SPDX-License-Identifier: MIT
// The module libdeburr_images.so: the only part of the program linked with OpenImageIO.
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <OpenImageIO/strutil.h>

#include <algorithm>
#include <cctype>

#include "tb/scene/image_codec.h"

namespace deburr::tb {
namespace {

std::string on_one_line(std::string text) {
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back()))) text.pop_back();
  for (std::size_t at; (at = text.find('\n')) != std::string::npos;) text.replace(at, 1, "; ");
  return text.empty() ? "no reason given" : text;
}

using Io = OIIO::Filesystem::IOProxy;

// Bytes of the file, for properties that OpenImageIO does not report. Bytes after its end are 0.
std::string bytes_at(Io& io, std::uint64_t at, std::size_t size) {
  std::string bytes(size, '\0');
  if (at < io.size()) io.pread(bytes.data(), size, static_cast<std::int64_t>(at));
  return bytes;
}

std::uint64_t number_of(std::string_view bytes, bool little_endian) {
  std::uint64_t number = 0;
  for (std::size_t i = 0; i < bytes.size(); ++i)
    number =
        number << 8 | static_cast<unsigned char>(bytes[little_endian ? bytes.size() - 1 - i : i]);
  return number;
}

// Whether a TIFF has the tag ExtraSamples. Without this tag the meaning of alpha is unspecified.
bool has_extra_samples(Io& io) {
  const bool little = bytes_at(io, 0, 1) == "I";
  const auto number = [&](std::uint64_t at, std::size_t size) {
    return number_of(bytes_at(io, at, size), little);
  };
  const bool big = number(2, 2) == 43;
  const std::size_t word = big ? 8 : 4;
  const std::uint64_t directory = number(word, word), entry = 4 + 2 * word;
  const std::uint64_t entries = std::min<std::uint64_t>(number(directory, big ? 8 : 2), 0xFFFF);
  for (std::uint64_t e = 0; e < entries; ++e)
    if (number(directory + (big ? 8 : 2) + e * entry, 2) == 338) return true;
  return false;
}

// DXT2, DXT4, or alpha mode "premultiplied" in a DirectX 10 header.
bool is_premultiplied_dds(Io& io) {
  const std::string code = bytes_at(io, 84, 4);
  return code == "DXT2" || code == "DXT4" ||
         (code == "DX10" && (number_of(bytes_at(io, 144, 4), true) & 7) == 2);
}

// Whether the channel definition box of a JPEG 2000 has a channel of kind "premultiplied opacity".
bool is_premultiplied_jpeg2000(Io& io) {
  const std::string head = bytes_at(io, 0, std::min<std::size_t>(io.size(), 1 << 16));
  const std::size_t box = head.substr(0, head.find("jp2c")).find("cdef");
  if (box == std::string::npos) return false;
  const std::uint64_t channels = number_of(bytes_at(io, box + 4, 2), false);
  for (std::uint64_t c = 0; c < std::min<std::uint64_t>(channels, 64); ++c)
    if (number_of(bytes_at(io, box + 6 + 6 * c + 2, 2), false) == 2) return true;
  return false;
}

// Colours are requested as stored. They are premultiplied if the file says so or if its format
// implies it. Otherwise they are taken as straight (not premultiplied).
bool is_associated(const OIIO::ImageSpec& spec, const std::string& format, Io& io) {
  if (spec.get_int_attribute("oiio:UnassociatedAlpha") != 0) return false;
  constexpr int kTargaPremultiplied = 4;
  if (format == "openexr" || format == "heif") return true;
  if (format == "tiff") return has_extra_samples(io);
  if (format == "targa") return spec.get_int_attribute("targa:alpha_type") == kTargaPremultiplied;
  if (format == "dds") return is_premultiplied_dds(io);
  if (format == "jpeg2000") return is_premultiplied_jpeg2000(io);
  return false;
}

// Channels of the first layer of an EXR, which are contiguous; all channels for other formats.
int channels_of_first_layer(const OIIO::ImageSpec& spec, const std::string& format) {
  if (format != "openexr") return spec.nchannels;
  const auto layer = [&](int channel) {
    const std::string& name = spec.channelnames[static_cast<std::size_t>(channel)];
    return name.substr(0, name.rfind('.') == std::string::npos ? 0 : name.rfind('.'));
  };
  int channels = 1;
  while (channels < spec.nchannels && layer(channels) == layer(0)) ++channels;
  return channels;
}

// "depth.Z" is "z".
std::string last_part(const std::string& channel) {
  return OIIO::Strutil::lower(channel.substr(channel.rfind('.') + 1));
}

// The channel of an EXR whose name says that it holds depth; -1 if there are none or several. A Z
// in a layer that has an X is part of a vector.
int depth_channel(const OIIO::ImageSpec& spec) {
  std::vector<std::string> lower;
  for (const std::string& name : spec.channelnames) lower.push_back(OIIO::Strutil::lower(name));
  int found = -1;
  for (int c = 0; c < spec.nchannels; ++c) {
    std::string name = lower[static_cast<std::size_t>(c)];
    const std::string part = last_part(name);
    if ((part != "z" && part != "depth") || !spec.channelformat(c).is_floating_point()) continue;
    name.back() = 'x';
    if (part == "z" && std::find(lower.begin(), lower.end(), name) != lower.end()) continue;
    if (found >= 0) return -1;
    found = c;
  }
  return found;
}

// The channels of an EXR's first layer that would be read as colours but have other names.
std::string odd_channels(const ImageDecoder::Header& header) {
  std::string letters, names;
  for (int c = 0; c < header.channels && letters.size() < 3; ++c) {
    if (c == header.alpha || (c == header.depth && header.channels > 1)) continue;
    const std::string& name = header.names[static_cast<std::size_t>(c)];
    const std::string part = last_part(name);
    const bool known = part == "r" || part == "g" || part == "b" || part == "y" || part == "red" ||
                       part == "green" || part == "blue";
    letters += known ? part[0] : '?';
    names += (names.empty() ? "" : ", ") + name;
  }
  const bool alone = letters.size() < 2 && letters != "?";
  return alone || letters == "rgb" ? "" : names;
}

// Whether the first image of a WebP uses the lossy chunk type.
bool is_lossy_webp(Io& io) {
  for (std::uint64_t at = 12; at < io.size();) {
    const std::string chunk = bytes_at(io, at, 4);
    if (chunk == "VP8 " || chunk == "VP8L") return chunk == "VP8 ";
    constexpr std::uint64_t kFrameHead = 24;
    at += chunk == "ANMF" ? kFrameHead : 8 + (number_of(bytes_at(io, at + 4, 4), true) + 1) / 2 * 2;
  }
  return false;
}

bool is_lossy(const OIIO::ImageSpec& spec, const std::string& format, Io& io) {
  constexpr std::uint64_t kCompressed = 4;  // flag in the pixel format of a DDS
  if (format == "webp") return is_lossy_webp(io);
  if (format == "dds") return (number_of(bytes_at(io, 80, 4), true) & kCompressed) != 0;
  if (format == "tiff") return spec.get_string_attribute("compression") == "jpeg";
  return format == "jpeg" || format == "heif" || format == "gif";
}

ImageDecoder::Header header_of(OIIO::ImageInput& input, Io& io) {
  const OIIO::ImageSpec spec = input.spec();
  ImageDecoder::Header header;
  header.file_format = input.format_name();
  const std::string& format = header.file_format;
  header.width = header.full_width = spec.width;
  header.height = header.full_height = spec.height;
  header.channels = channels_of_first_layer(spec, format);
  header.other_layers = spec.nchannels - header.channels;
  // For formats other than these, OpenImageIO's windows are wrong or have another meaning.
  if (format == "openexr" || format == "tiff" || format == "dpx" || format == "rla" ||
      format == "iff") {
    header.full_width = spec.full_width;
    header.full_height = spec.full_height;
    const auto difference = [](std::int64_t a, std::int64_t b) {
      constexpr std::int64_t kFar = 1 << 30;  // outside any image
      return static_cast<int>(std::clamp(a - b, -kFar, kFar));
    };
    header.x = difference(spec.x, spec.full_x);
    header.y = difference(spec.y, spec.full_y);
  }
  if (spec.alpha_channel < header.channels && header.channels > 1)
    header.alpha = spec.alpha_channel;
  header.depth = format == "openexr" ? depth_channel(spec) : spec.z_channel;
  header.alpha_named = header.alpha >= 0;
  if (header.alpha_named)
    header.associated = is_associated(spec, format, io);
  else if (format != "openexr" && (spec.nchannels == 2 || spec.nchannels > 3))
    header.alpha = spec.nchannels == 2 ? 1 : 3;
  for (const char* const name : {"tiff:ColorSpace", "jpeg:ColorSpace"})
    header.cmyk = header.cmyk || OIIO::Strutil::icontains(spec.get_string_attribute(name), "CMYK");
  const std::string colours = spec.get_string_attribute("tiff:ColorSpace");
  for (const char* const name : {"CIELAB", "ICCLAB", "ITULAB", "LOGL", "LOGLUV", "color separated"})
    if (colours == name) header.other_colours = colours;
  // OpenImageIO inverts these only in 8 bits, and then inverts alpha too.
  if (spec.get_int_attribute("tiff:PhotometricInterpretation", 1) == 0 &&
      (spec.format != OIIO::TypeUInt8 || spec.nchannels > 1))
    header.other_colours = "grey whose white is 0, of more than 8 bits or with alpha";
  if (format == "openexr") {
    header.names = spec.channelnames;
    header.odd_channels = odd_channels(header);
  }
  header.lossy = is_lossy(spec, format, io);
  header.flat = spec.depth <= 1 && !spec.deep;
  header.value_format = spec.format.c_str();
  header.floating_point = spec.format.is_floating_point();
  header.colour_space = spec.get_string_attribute("oiio:ColorSpace");
  header.orientation = spec.get_int_attribute("Orientation", 1);
  header.several = input.seek_subimage(1, 0);
  input.geterror();  // clears the error: the name does not have to exist
  input.seek_subimage(0, 0);
  return header;
}

OIIO::ImageSpec read_hints(Io* io = nullptr) {
  OIIO::ImageSpec hints;
  hints.attribute("oiio:UnassociatedAlpha", 1);  // colours as stored, not premultiplied
  if (io != nullptr) hints.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &io);
  return hints;
}

// Opens the file only once. ImageInput::open() would open it twice, and some readers then resume
// where they stopped.
std::unique_ptr<OIIO::ImageInput> open_bytes(const std::string& name, Io& bytes) {
  const OIIO::ImageSpec hints = read_hints(&bytes);
  return OIIO::ImageInput::create(name, true, &hints, &bytes);
}

// A modified copy in memory, so that OpenImageIO returns colours as stored.
class ChangedFile {
 public:
  ChangedFile(std::string bytes, const std::string& name)
      : bytes_(std::move(bytes)),
        reader_(bytes_.data(), bytes_.size()),
        input_(open_bytes(name, reader_)) {}
  ChangedFile(const ChangedFile&) = delete;
  ChangedFile& operator=(const ChangedFile&) = delete;
  OIIO::ImageInput* input() { return input_.get(); }

 private:
  std::string bytes_;
  OIIO::Filesystem::IOMemReader reader_;
  std::unique_ptr<OIIO::ImageInput> input_;
};

// OpenImageIO always premultiplies the colours of a WebP. If the alpha flag is cleared, it returns
// the stored colours.
std::string without_alpha(std::string webp) {
  constexpr std::size_t kFlags = 20, kLossless = 24;
  const std::string chunk = webp.substr(12, 4);
  if (chunk == "VP8X") webp[kFlags] = static_cast<char>(webp[kFlags] & ~0x10);
  if (chunk == "VP8L") webp[kLossless] = static_cast<char>(webp[kLossless] & ~0x10);
  return webp;
}

// For DXT2 and DXT4 OpenImageIO divides colours by alpha in bytes, which overflow, and it divides
// by 0. DXT3 and DXT5 have the same blocks with straight alpha.
std::string as_straight(std::string dds) {
  dds[87] = static_cast<char>(dds[87] + 1);
  return dds;
}

// If the first frame of an animated WebP is smaller than the image, OpenImageIO invents the rest.
bool is_partial_webp(Io& io) {
  const auto number = [&](std::uint64_t at) { return number_of(bytes_at(io, at, 3), true); };
  if (bytes_at(io, 12, 4) != "VP8X") return false;
  constexpr std::uint64_t kWidth = 24, kHeight = 27;
  std::uint64_t at = 30;
  while (at < io.size() && bytes_at(io, at, 4) != "ANMF")
    at += 8 + (number_of(bytes_at(io, at + 4, 4), true) + 1) / 2 * 2;
  return at < io.size() &&
         (number(at + 14) != number(kWidth) || number(at + 17) != number(kHeight));
}

class Decoder final : public ImageDecoder {
 public:
  Decoder(std::unique_ptr<OIIO::ImageInput> input, std::unique_ptr<Io> io)
      : io_(std::move(io)), input_(std::move(input)), header_(header_of(*input_, *io_)) {
    const auto bytes = [&] { return bytes_at(*io_, 0, io_->size()); };
    if (header_.file_format == "dds" && bytes_at(*io_, 84, 3) == "DXT" && header_.associated)
      changed_ = std::make_unique<ChangedFile>(as_straight(bytes()), "memory.dds");
    if (header_.file_format == "webp" && header_.alpha_named)
      changed_ = std::make_unique<ChangedFile>(without_alpha(bytes()), "memory.webp");
  }

  const Header& header() const override { return header_; }
  bool read(int channels, std::uint8_t* values) override {
    return read(channels, OIIO::TypeUInt8, values);
  }
  bool read(int channels, float* values) override {
    return read(channels, OIIO::TypeFloat, values);
  }
  bool read_channel(int channel, float* values) override {
    return input_->read_image(0, 0, channel, channel + 1, OIIO::TypeFloat, values);
  }
  std::string error() override {
    OIIO::ImageInput* const input =
        changed_ && changed_->input() ? changed_->input() : input_.get();
    return on_one_line(input->has_error() ? input->geterror() : OIIO::geterror());
  }

 private:
  bool read(int channels, const OIIO::TypeDesc& type, void* values) {
    if (!changed_) return input_->read_image(0, 0, 0, channels, type, values) && !lost_an_error();
    OIIO::ImageInput* const changed = changed_->input();
    if (changed == nullptr) return false;
    // Replaces premultiplied colours by the stored ones.
    const int colours = std::min(channels, changed->spec().nchannels);
    return (colours == channels || input_->read_image(0, 0, 0, channels, type, values)) &&
           changed->read_image(
               0, 0, 0, colours, type, values,
               static_cast<OIIO::stride_t>(channels) * static_cast<OIIO::stride_t>(type.size())) &&
           !lost_an_error();
  }

  // These readers return zeros for the missing part of a truncated file and report success.
  bool lost_an_error() const {
    const OIIO::ImageInput& input = changed_ ? *changed_->input() : *input_;
    return (header_.file_format == "dds" || header_.file_format == "iff") && input.has_error();
  }

  std::unique_ptr<Io> io_;
  std::unique_ptr<OIIO::ImageInput> input_;
  Header header_;
  std::unique_ptr<ChangedFile> changed_;  // null: `input_` returns colours as stored
};

ImageCodec::Source source(std::unique_ptr<OIIO::ImageInput> input, std::unique_ptr<Io> io) {
  if (!input) return {nullptr, on_one_line(OIIO::geterror())};
  if (std::string_view(input->format_name()) == "webp" && is_partial_webp(*io))
    return {nullptr, "the first frame of the animation does not fill the picture"};
  return {std::make_unique<Decoder>(std::move(input), std::move(io)), ""};
}

class Codec final : public ImageCodec {
 public:
  Source open_file(const std::string& path) const override {
    const OIIO::ImageSpec hints = read_hints();
    return source(OIIO::ImageInput::open(path, &hints),
                  std::make_unique<OIIO::Filesystem::IOFile>(path, Io::Read));
  }

  Source open_memory(const std::string& name, std::string_view bytes) const override {
    auto reader = std::make_unique<OIIO::Filesystem::IOMemReader>(const_cast<char*>(bytes.data()),
                                                                  bytes.size());
    auto input = open_bytes(name, *reader);
    return source(std::move(input), std::move(reader));
  }

  Encoded encode(const std::string& path, const Pixels& pixels) const override {
    Encoded encoded;
    const auto output = OIIO::ImageOutput::create(path);
    encoded.writable = output && output->supports("ioproxy");
    if (!encoded.writable) {
      encoded.error = on_one_line(OIIO::geterror());
      return encoded;
    }
    OIIO::ImageSpec spec(pixels.width, pixels.height, pixels.channels, OIIO::TypeUInt8);
    spec.attribute("oiio:UnassociatedAlpha", 1);
    OIIO::Filesystem::IOVecOutput proxy(encoded.bytes);
    if (!output->set_ioproxy(&proxy) || !output->open(path, spec) ||
        !output->write_image(spec.format, pixels.values,
                             static_cast<OIIO::stride_t>(pixels.pixel_bytes)) ||
        !output->close())
      encoded.error = on_one_line(output->geterror());
    return encoded;
  }
};

}  // namespace
}  // namespace deburr::tb

extern "C" const deburr::tb::ImageCodec* deburr_image_codec() {
  static const deburr::tb::Codec codec;
  return &codec;
}
