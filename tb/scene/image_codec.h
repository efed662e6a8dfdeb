// SPDX-License-Identifier: MIT
// Interface to OpenImageIO. OpenImageIO pulls in some 250 libraries, and loading them takes longer
// than most tests, so it is in a module (libdeburr_images.so, openimageio_codec.cpp) that is loaded
// when the first image needs it. Only plain data and virtual function calls cross this interface;
// exceptions do not.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace deburr::tb {

// An opened image whose header was decoded.
class ImageDecoder {
 public:
  struct Header {
    int width = 0, height = 0, channels = 0;  // of the stored pixels
    int other_layers = 0;                     // channels of an EXR after its first layer
    // Size of the whole image (the display window of an EXR), and position of the stored pixels in
    // it.
    int full_width = 0, full_height = 0, x = 0, y = 0;
    int alpha = -1;             // index of the alpha channel
    bool alpha_named = false;   // the file declares that channel as alpha
    int depth = -1;             // index of the only channel named as depth, in any layer
    bool associated = false;    // colours are stored multiplied by alpha
    bool cmyk = false;          // converted to RGB by the decoder
    std::string other_colours;  // "CIELAB", ...: returned unconverted as R, G and B
    std::string
        odd_channels;  // "Y, BY, RY": an EXR's channels if they are not R, G, B or a single Y
    std::vector<std::string> names;  // an EXR's channels, all layers
    bool lossy = false;              // lossy compression
    bool flat = true;                // false for a volume or a deep image
    std::string file_format;         // "png", "jpeg", ...
    std::string value_format;        // "uint8", "uint16", "half", "float", ...
    bool floating_point = false;
    std::string colour_space;  // as declared by the file or implied by its format
    int orientation = 1;
    bool several = false;  // several images in the file; the first one is read
  };

  virtual ~ImageDecoder() = default;
  virtual const Header& header() const = 0;
  // Reads the first `channels` channels of all pixels, top row first. Integers read as floats are
  // divided by their maximum. Returns false on failure; see error().
  virtual bool read(int channels, std::uint8_t* values) = 0;
  virtual bool read(int channels, float* values) = 0;
  virtual bool read_channel(int channel, float* values) = 0;  // any layer
  virtual std::string error() = 0;                            // one line
};

class ImageCodec {
 public:
  struct Source {
    std::unique_ptr<ImageDecoder> decoder;  // null: `error` says why
    std::string error;
  };
  struct Pixels {
    int width = 0, height = 0, channels = 0;
    const void* values = nullptr;  // 8-bit
    std::size_t pixel_bytes = 0;   // stride between pixels
  };
  struct Encoded {
    bool writable =
        false;  // the file name's extension selects a format that can be written to memory
    std::vector<unsigned char> bytes;
    std::string error;  // empty on success
  };

  virtual ~ImageCodec() = default;
  virtual Source open_file(const std::string& path) const = 0;
  // The format is guessed from the name; `bytes` must outlive the decoder.
  virtual Source open_memory(const std::string& name, std::string_view bytes) const = 0;
  virtual Encoded encode(const std::string& path, const Pixels& pixels) const = 0;
};

// Loads the module on the first call. Throws FileError if it cannot be loaded.
const ImageCodec& image_codec();

inline constexpr const char* kImageModule = "libdeburr_images.so";
inline constexpr const char* kImageModuleEntry = "deburr_image_codec";  // const ImageCodec* ()

}  // namespace deburr::tb
