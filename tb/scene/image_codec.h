// SPDX-License-Identifier: MIT
// The border between the program and OpenImageIO. OpenImageIO brings some 250 libraries along,
// which cost every process more to load than most tests take, so it is behind a module
// (libdeburr_images.so, openimageio_codec.cpp) that is opened when the first picture needs it.
// Plain data and virtual functions only cross the border; no exception does.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace deburr::tb {

// A picture whose header was understood.
class ImageDecoder {
 public:
  struct Header {
    int width = 0, height = 0, channels = 0;  // of the pixels that are stored
    int other_layers = 0;                     // channels of an EXR after its first layer
    // The picture that they are a part of (the display window of an EXR), and where in it they lie.
    int full_width = 0, full_height = 0, x = 0, y = 0;
    int alpha = -1;             // the channel that is alpha
    bool alpha_named = false;   // the file says that it is
    int depth = -1;             // the one channel that the file names as depth, of any layer
    bool associated = false;    // colours are stored multiplied by alpha
    bool cmyk = false;          // made RGB by the decoder
    std::string other_colours;  // "CIELAB", ...: what the decoder gives as R, G and B unchanged
    std::string odd_channels;   // "Y, BY, RY": of an EXR, in place of R, G, B or Y alone
    std::vector<std::string> names;  // of an EXR's channels, of all layers
    bool lossy = false;              // values are not those that were written
    bool flat = true;                // neither a volume nor a deep image
    std::string file_format;         // "png", "jpeg", ...
    std::string value_format;        // "uint8", "uint16", "half", "float", ...
    bool floating_point = false;
    std::string colour_space;  // as the file names it, or as its format implies
    int orientation = 1;
    bool several = false;  // pictures in the file; the first one is read
  };

  virtual ~ImageDecoder() = default;
  virtual const Header& header() const = 0;
  // The first `channels` channels of all pixels as they are stored, rows from the top; integers as
  // floats are divided by their maximum. False: error() says why.
  virtual bool read(int channels, std::uint8_t* values) = 0;
  virtual bool read(int channels, float* values) = 0;
  virtual bool read_channel(int channel, float* values) = 0;  // of any layer
  virtual std::string error() = 0;                            // on one line
};

class ImageCodec {
 public:
  struct Source {
    std::unique_ptr<ImageDecoder> decoder;  // null: `error` says why
    std::string error;
  };
  struct Pixels {
    int width = 0, height = 0, channels = 0;
    const void* values = nullptr;  // 8 bits
    std::size_t pixel_bytes = 0;   // from one pixel to the next
  };
  struct Encoded {
    bool writable = false;  // the name's extension is one of a format that can be written to memory
    std::vector<unsigned char> bytes;
    std::string error;  // empty: it went well
  };

  virtual ~ImageCodec() = default;
  virtual Source open_file(const std::string& path) const = 0;
  // The format is guessed by the name; `bytes` must outlive the decoder.
  virtual Source open_memory(const std::string& name, std::string_view bytes) const = 0;
  virtual Encoded encode(const std::string& path, const Pixels& pixels) const = 0;
};

// Loads the module on the first call. Throws FileError if it cannot be loaded.
const ImageCodec& image_codec();

inline constexpr const char* kImageModule = "libdeburr_images.so";
inline constexpr const char* kImageModuleEntry = "deburr_image_codec";  // const ImageCodec* ()

}  // namespace deburr::tb
