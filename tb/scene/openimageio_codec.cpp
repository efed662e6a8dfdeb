// SPDX-License-Identifier: MIT
// The module libdeburr_images.so: the only part of the program that is linked with OpenImageIO.
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <cctype>

#include "tb/scene/image_codec.h"

namespace deburr::tb {
namespace {

std::string on_one_line(std::string text) {
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back()))) text.pop_back();
  for (std::size_t at; (at = text.find('\n')) != std::string::npos;) text.replace(at, 1, "; ");
  return text.empty() ? "no reason given" : text;
}

ImageDecoder::Header header_of(OIIO::ImageInput& input) {
  const OIIO::ImageSpec spec = input.spec();
  ImageDecoder::Header header;
  header.width = spec.width;
  header.height = spec.height;
  header.channels = spec.nchannels;
  header.flat = spec.depth <= 1 && !spec.deep;
  header.file_format = input.format_name();
  header.value_format = spec.format.c_str();
  header.floating_point = spec.format.is_floating_point();
  header.colour_space = spec.get_string_attribute("oiio:ColorSpace");
  header.orientation = spec.get_int_attribute("Orientation", 1);
  header.several = input.seek_subimage(1, 0);
  input.geterror();  // that there is none is no error
  input.seek_subimage(0, 0);
  return header;
}

class Decoder final : public ImageDecoder {
 public:
  using Reader = std::unique_ptr<OIIO::Filesystem::IOMemReader>;
  Decoder(std::unique_ptr<OIIO::ImageInput> input, Reader reader)
      : reader_(std::move(reader)), input_(std::move(input)), header_(header_of(*input_)) {}

  const Header& header() const override { return header_; }
  bool read(int channels, std::uint8_t* values) override {
    return input_->read_image(0, 0, 0, channels, OIIO::TypeUInt8, values);
  }
  bool read(int channels, float* values) override {
    return input_->read_image(0, 0, 0, channels, OIIO::TypeFloat, values);
  }
  std::string error() override {
    return on_one_line(input_->has_error() ? input_->geterror() : OIIO::geterror());
  }

 private:
  Reader reader_;  // null for a file; the input reads from it
  std::unique_ptr<OIIO::ImageInput> input_;
  Header header_;
};

OIIO::ImageSpec read_hints() {
  OIIO::ImageSpec hints;
  hints.attribute("oiio:UnassociatedAlpha", 1);  // colours as stored, not multiplied by alpha
  return hints;
}

ImageCodec::Source source(std::unique_ptr<OIIO::ImageInput> input, Decoder::Reader reader) {
  if (!input) return {nullptr, on_one_line(OIIO::geterror())};
  return {std::make_unique<Decoder>(std::move(input), std::move(reader)), ""};
}

class Codec final : public ImageCodec {
 public:
  Source open_file(const std::string& path) const override {
    const OIIO::ImageSpec hints = read_hints();
    return source(OIIO::ImageInput::open(path, &hints), nullptr);
  }

  Source open_memory(const std::string& name, std::string_view bytes) const override {
    auto reader = std::make_unique<OIIO::Filesystem::IOMemReader>(const_cast<char*>(bytes.data()),
                                                                  bytes.size());
    OIIO::ImageSpec hints = read_hints();
    OIIO::Filesystem::IOProxy* proxy = reader.get();
    hints.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
    auto input = OIIO::ImageInput::open(name, &hints, reader.get());
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
    OIIO::ImageSpec spec(pixels.width, pixels.height, pixels.channels,
                         pixels.floating_point ? OIIO::TypeFloat : OIIO::TypeUInt8);
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
