// SPDX-License-Identifier: MIT
#include "tb/fuzz/c_calls.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <functional>
#include <memory>
#include <stdexcept>
#include <utility>

#include "golden/c/deburr_golden.h"
#include "golden/c/every_engine.h"

namespace deburr::tb {
namespace {

// Larger frames or memories would be slow and find nothing else.
constexpr std::uint32_t kMostPixels = 1 << 14;
constexpr std::uint32_t kMostMemory = 1 << 18;
constexpr std::size_t kMostElements = 1 << 12;

// Words that random mutation would rarely produce; other texts are taken from the input.
constexpr std::array<const char*, 46> kWords = {"preset",
                                                "quality",
                                                "deburr",
                                                "paper",
                                                "smaa",
                                                "smaa-dynamic",
                                                "mlaa",
                                                "gpaa",
                                                "gpaa-optimised",
                                                "ultra",
                                                "low",
                                                "axes",
                                                "eight",
                                                "two",
                                                "count",
                                                "floor",
                                                "kernel",
                                                "tent",
                                                "spread",
                                                "cache.bytes",
                                                "cache.ways",
                                                "cache.line_bytes",
                                                "256",
                                                "64",
                                                "1",
                                                "0",
                                                "-1",
                                                "0x10",
                                                "true",
                                                "false",
                                                "edges.source",
                                                "depth",
                                                "predicated",
                                                "bypass",
                                                "masked",
                                                "window_rows",
                                                "10",
                                                "line_pixels",
                                                "depth_test",
                                                "off",
                                                "pixels",
                                                "edges",
                                                "probes",
                                                "weights",
                                                "weights",
                                                "samples"};
constexpr std::array<const char*, 20> kFields = {"width",
                                                 "height",
                                                 "format",
                                                 "layout",
                                                 "wrap_s",
                                                 "wrap_t",
                                                 "min_filter",
                                                 "mag_filter",
                                                 "levels",
                                                 "max_count_log2",
                                                 "bias",
                                                 "min_lod",
                                                 "max_lod",
                                                 "base0",
                                                 "base3",
                                                 "rgb565",
                                                 "l8",
                                                 "linear",
                                                 "linear_mipmap_linear",
                                                 "tiled"};

class Input {
 public:
  explicit Input(std::string_view bytes) : rest_(bytes) {}
  bool empty() const { return rest_.empty(); }
  std::uint32_t byte() {
    if (rest_.empty()) return 0;
    const auto value = static_cast<unsigned char>(rest_.front());
    rest_.remove_prefix(1);
    return value;
  }
  // Small numbers take one byte; larger ones take four after 255.
  std::uint32_t number() {
    const std::uint32_t first = byte();
    if (first != 255) return first;
    std::uint32_t value = 0;
    for (int i = 0; i < 4; ++i) value = value << 8 | byte();
    return value;
  }
  std::size_t size() { return number() % (kMostElements + 1); }
  template <std::size_t N>
  std::string text(const std::array<const char*, N>& words) {
    const std::uint32_t which = byte();
    if (which < N) return words[which];
    const std::size_t length = std::min<std::size_t>(which - N, rest_.size());
    std::string own(rest_.substr(0, length));
    rest_.remove_prefix(length);
    return own;
  }

 private:
  std::string_view rest_;
};

// A separate array for each call, so that a sanitizer detects accesses beyond its end.
template <class Element>
class Array {
 public:
  Array(Input& input, std::size_t size) : size_(size) {
    elements_ = std::make_unique<Element[]>(size);
    const std::uint32_t fill = input.byte();
    null_ = fill == 254;
    for (std::size_t i = 0; i < size; ++i)
      elements_[i] = i < 64 ? static_cast<Element>(input.number()) : static_cast<Element>(fill * i);
    before_.assign(elements_.get(), elements_.get() + size);
  }
  Element* data() const { return null_ ? nullptr : elements_.get(); }
  std::size_t size() const { return size_; }
  bool changed() const { return !std::equal(before_.begin(), before_.end(), elements_.get()); }

 private:
  std::size_t size_;
  bool null_ = false;
  std::unique_ptr<Element[]> elements_;
  std::vector<Element> before_;
};

void demand(bool condition, const char* what) {
  if (!condition) throw std::logic_error(what);
}

struct Close {
  void operator()(deburr_golden* golden) const { deburr_close(golden); }
};
using OwnedHandle = std::unique_ptr<deburr_golden, Close>;

class Calls {
 public:
  explicit Calls(std::string_view bytes) : input_(bytes) {
    for (const golden::c::MakeHandle make : golden::c::kMakeHandle) handles_.emplace_back(make());
  }
  void run() {
    const auto& calls = all();
    while (!input_.empty()) calls[input_.byte() % calls.size()](*this);
  }

 private:
  using Call = std::function<void(Calls&)>;
  static const std::vector<Call>& all();

  // One of all handles, or null.
  deburr_golden* handle() {
    const std::uint32_t which = input_.byte() % 16;
    return which == 15 ? nullptr : handles_[which % handles_.size()].get();
  }
  std::uint32_t number() { return input_.number(); }
  void expect(deburr_golden* golden, int status, bool changed = false) {
    demand(status == DEBURR_OK || status == DEBURR_ARGUMENT || status == DEBURR_CONFIGURATION,
           "unexpected status");
    if (status == DEBURR_OK) return;
    demand(!changed, "a failed call wrote to its output");
    std::array<char, 60> text{};
    demand(deburr_error(golden, status, text.data(), text.size()) == DEBURR_OK &&
               std::strlen(text.data()) > 20,
           "a failed call left no error text");
  }
  template <class Element, class Function, class... Arguments>
  void give(Function&& function, deburr_golden* golden, Arguments... arguments) {
    const Array<Element> array(input_, input_.size());
    expect(golden, function(golden, arguments..., array.data(), array.size()), array.changed());
  }
  template <class Element, class Function, class... Arguments>
  void give_rows(Function&& function, deburr_golden* golden, Arguments... arguments) {
    const std::uint32_t stride = number();
    const Array<Element> array(input_, input_.size());
    const int status = function(golden, arguments..., array.data(), array.size(), stride);
    expect(golden, status, array.changed());
  }
  void put_text(const std::function<int(deburr_golden*, char*, std::size_t)>& function) {
    deburr_golden* const golden = handle();
    const Array<char> text(input_, input_.size());
    expect(golden, function(golden, text.data(), text.size()), text.changed());
  }
  void quad(bool analyse) {
    deburr_golden* const golden = handle();
    const std::uint32_t texture = number(), coverage = number(), clamped = number();
    const Array<std::int32_t> s(input_, 4), t(input_, 4);
    if (analyse) {
      std::int64_t value = 77;
      const std::string what = input_.text(kWords);
      const int status = deburr_texture_analyse(golden, texture, coverage, s.data(), t.data(),
                                                what.c_str(), &value);
      expect(golden, status, value != 77);
      return;
    }
    const Array<std::uint8_t> rgba(input_, 16);
    expect(golden,
           deburr_texture_quad(golden, texture, coverage, clamped, s.data(), t.data(), rgba.data()),
           rgba.changed());
  }
  void memory() {
    const std::uint64_t bytes = std::uint64_t{number()} << (input_.byte() % 33);
    deburr_golden* const golden = handle();
    if (bytes > kMostMemory && bytes <= (std::uint64_t{1} << 32)) return;
    expect(golden, deburr_texture_memory(golden, bytes));
  }
  void begin() {
    const std::uint32_t width = number(), height = number();
    deburr_golden* const golden = handle();
    if (std::uint64_t{width} * height > kMostPixels && width <= 8192 && height <= 8192) return;
    expect(golden, deburr_frame_begin(golden, width, height));
  }
  void field() {
    deburr_golden* const golden = handle();
    const std::uint32_t texture = number();
    const std::string name = input_.text(kFields), text = input_.text(kFields);
    expect(golden, deburr_texture_field(golden, texture, name.c_str(), text.c_str()));
  }
  void parameter() {
    deburr_golden* const golden = handle();
    const std::string name = input_.text(kWords), text = input_.text(kWords);
    expect(golden, deburr_set(golden, name.c_str(), text.c_str()));
  }

  Input input_;
  std::vector<OwnedHandle> handles_;
};

const std::vector<Calls::Call>& Calls::all() {
  static const std::vector<Call> calls = {
      [](Calls& c) { c.parameter(); },
      [](Calls& c) { c.memory(); },
      [](Calls& c) { c.field(); },
      [](Calls& c) { c.quad(false); },
      [](Calls& c) { c.begin(); },
      [](Calls& c) { c.give_rows<std::uint8_t>(deburr_frame_pixels, c.handle()); },
      [](Calls& c) {
        deburr_golden* const golden = c.handle();
        c.expect(golden, deburr_frame_process(golden));
      },
      [](Calls& c) { c.give_rows<std::uint32_t>(deburr_frame_depth, c.handle()); },
      [](Calls& c) { c.give<std::uint32_t>(deburr_geometric_vertices, c.handle()); },
      [](Calls& c) { c.give<std::uint32_t>(deburr_geometric_edges, c.handle()); },
      [](Calls& c) {
        deburr_golden* const golden = c.handle();
        c.give<std::uint8_t>(deburr_geometric_facing, golden, c.number());
      },
      [](Calls& c) {
        deburr_golden* const golden = c.handle();
        const std::string plane = c.input_.text(kWords);
        c.give_rows<std::uint8_t>(deburr_plane, golden, plane.c_str());
      },
      [](Calls& c) { c.give_rows<std::uint8_t>(deburr_morphological_edges, c.handle()); },
      [](Calls& c) { c.give<std::uint8_t>(deburr_geometric_classes, c.handle()); },
      [](Calls& c) {
        deburr_golden* const golden = c.handle();
        c.expect(golden, deburr_frame_detail(golden, c.number()));
      },
      [](Calls& c) { c.quad(true); },
      [](Calls& c) {
        deburr_golden* const golden = c.handle();
        const std::uint32_t texture = c.number(), offset = c.number(), word = c.number();
        c.expect(golden, deburr_texture_register(golden, texture, offset, word));
      },
      [](Calls& c) {
        deburr_golden* const golden = c.handle();
        std::uint64_t behind = 77;
        const std::uint32_t texture = c.number(), address = c.number();
        const int status = deburr_texture_place(golden, texture, address, &behind);
        c.expect(golden, status, behind != 77);
      },
      [](Calls& c) {
        deburr_golden* const golden = c.handle();
        const std::uint32_t texture = c.number(), level = c.number();
        c.give_rows<std::uint8_t>(deburr_texture_level, golden, texture, level);
      },
      [](Calls& c) {
        deburr_golden* const golden = c.handle();
        c.give<std::uint8_t>(deburr_texture_write, golden, c.number());
      },
      [](Calls& c) {
        deburr_golden* const golden = c.handle();
        c.give<std::uint8_t>(deburr_texture_read, golden, c.number());
      },
      [](Calls& c) {
        deburr_golden* const golden = c.handle();
        std::uint32_t count = 77;
        const Array<std::uint32_t> lines(c.input_, c.input_.size());
        const int status = deburr_texture_fills(golden, lines.data(), lines.size(), &count);
        c.expect(golden, status, lines.changed() || count != 77);
      },
      [](Calls& c) {
        deburr_golden* const golden = c.handle();
        c.expect(golden,
                 c.number() % 2 == 0 ? deburr_reset(golden) : deburr_texture_invalidate(golden));
      },
      [](Calls& c) {
        deburr_golden* const golden = c.handle();
        const std::uint32_t x = c.number(), y = c.number(), rgba = c.number(), depth = c.number();
        c.expect(golden, deburr_frame_put(golden, x, y, rgba, depth));
      },
      [](Calls& c) {
        deburr_golden* const golden = c.handle();
        const std::string plane = c.input_.text(kWords);
        const std::uint32_t x = c.number(), y = c.number();
        std::uint32_t value = 77, width = 77, height = 77;
        int status = deburr_plane_pixel(golden, plane.c_str(), x, y, &value);
        c.expect(golden, status, value != 77);
        value = 77;
        status = deburr_plane_shape(golden, plane.c_str(), &width, &height, &value);
        c.expect(golden, status, value != 77 || width != 77 || height != 77);
      },
      [](Calls& c) {
        const std::string name = c.input_.text(kWords);
        c.put_text([&](deburr_golden* golden, char* text, std::size_t size) {
          return deburr_get(golden, name.c_str(), text, size);
        });
      },
      [](Calls& c) {
        const std::uint32_t index = c.number();
        c.put_text([&](deburr_golden* golden, char* text, std::size_t size) {
          return index % 2 == 0 ? deburr_parameter_name(golden, index, text, size)
                                : deburr_counter_name(golden, index, text, size);
        });
      },
      [](Calls& c) {
        deburr_golden* const golden = c.handle();
        const std::string name = c.input_.text(kWords);
        std::uint64_t value = 77;
        const int status = deburr_counter(golden, name.c_str(), &value);
        c.expect(golden, status, status != DEBURR_OK && value != 77);
      },
      [](Calls& c) {
        deburr_golden* const golden = c.handle();
        const std::uint32_t texture = c.number();
        c.expect(golden,
                 texture == 99 ? deburr_check(golden) : deburr_texture_check(golden, texture));
      },
      [](Calls& c) { c.give<std::uint32_t>(deburr_error_lines, c.handle()); }};
  return calls;
}

// Writes the format that Input reads.
class Seed {
 public:
  Seed& bytes(std::initializer_list<int> values) {
    for (const int value : values) text_ += static_cast<char>(value);
    return *this;
  }
  Seed& number(std::uint32_t value) {
    text_ += '\xff';
    for (int shift = 24; shift >= 0; shift -= 8) text_ += static_cast<char>(value >> shift);
    return *this;
  }
  // Size, fill, and the first 64 elements.
  Seed& array(std::uint32_t size, int fill) {
    number(size).bytes({fill});
    for (std::uint32_t i = 0; i < std::min(size, 64u); ++i) bytes({static_cast<int>(i * 7 % 250)});
    return *this;
  }
  template <std::size_t N>
  Seed& word(const std::array<const char*, N>& words, std::string_view word) {
    const auto found = std::find(words.begin(), words.end(), word);
    if (found != words.end()) return bytes({static_cast<int>(found - words.begin())});
    bytes({static_cast<int>(N + word.size())});
    text_ += word;
    return *this;
  }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

// Index of the handle made by a function.
constexpr int place(golden::c::MakeHandle make) {
  const auto& all = golden::c::kMakeHandle;
  return static_cast<int>(std::find(all.begin(), all.end(), make) - all.begin());
}
constexpr int kTexture = place(deburr_texture_new);
constexpr int kSmoother = place(deburr_morphological_new);
constexpr int kDrawn = place(deburr_geometric_new);

}  // namespace

void c_calls(std::string_view bytes) { Calls(bytes).run(); }

std::vector<std::string> c_calls_seeds() {
  Seed quads;
  quads.bytes({0, kTexture}).word(kWords, "preset").word(kWords, "paper");
  quads.bytes({1, 64, 8, kTexture});
  for (const auto& [name, text] : {std::pair{"width", "16"},
                                   {"height", "8"},
                                   {"levels", "5"},
                                   {"format", "rgb565"},
                                   {"layout", "tiled"},
                                   {"min_filter", "linear_mipmap_linear"},
                                   {"max_count_log2", "4"}})
    quads.bytes({2, kTexture, 0}).word(kFields, name).word(kFields, text);
  quads.bytes({17, kTexture, 0, 64});
  quads.bytes({18, kTexture, 0, 1, 0}).array(64, 3);
  for (int i = 0; i < 3; ++i) {
    quads.bytes({3, kTexture, 0, 15, 0, 0});
    for (std::uint32_t k = 0; k < 4; ++k) quads.number((k + 1) << 21);
    quads.bytes({0});
    for (std::uint32_t k = 0; k < 4; ++k) quads.number(k << 19);
    quads.bytes({0}).number(0);
    for (int k = 0; k < 15; ++k) quads.bytes({0});
  }
  quads.bytes({21, kTexture}).array(8, 1);

  const auto frame = [](int engine, std::string_view preset) {
    Seed seed;
    seed.bytes({0, engine}).word(kWords, "preset").word(kWords, preset);
    seed.bytes({14, engine, 1, 4, 12, 9, engine, 5, engine, 0}).array(12 * 9 * 4, 77);
    seed.bytes({7, engine, 0}).array(12 * 9, 201);
    return seed;
  };
  Seed smoothed = frame(kSmoother, "smaa");
  smoothed.bytes({6, kSmoother, 11, kSmoother}).word(kWords, "probes").bytes({0});
  smoothed.array(12 * 9 * 4, 0);
  smoothed.bytes({12, kSmoother, 0}).number(12 * 9).bytes({0});
  for (int i = 0; i < 64; ++i) smoothed.bytes({i < 13 || i % 12 == 0 ? 0 : 1});
  smoothed.bytes({6, kSmoother});
  Seed drawn = frame(kDrawn, "gpaa");
  drawn.bytes({8, kDrawn}).number(12).bytes({0});
  for (const std::uint32_t word : {100u, 200u, 9u, 1u, 2900u, 1700u, 9u, 1u, 300u, 2000u, 0u, 1u})
    drawn.number(word);
  drawn.bytes({9, kDrawn}).number(8).bytes({0});
  for (const std::uint32_t word : {0u, 1u, 1u << 24, 0u, 1u, 2u, 0u, 1u}) drawn.number(word);
  drawn.bytes({10, kDrawn, 2}).array(1, 0);
  drawn.bytes({6, kDrawn, 13, kDrawn}).array(2, 0);
  drawn.bytes({11, kDrawn}).word(kWords, "weights").bytes({0}).array(12 * 9 * 4, 0);
  return {quads.text(), smoothed.text(), drawn.text()};
}

}  // namespace deburr::tb
