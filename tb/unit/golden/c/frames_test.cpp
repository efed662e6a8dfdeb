// SPDX-License-Identifier: MIT
// Engines that smooth frames, through the C interface: pixels and planes equal those of the golden
// models bit for bit, with padded rows, single pixels and given edges; invalid calls change
// nothing.
#include "tb/stimuli/frames.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <new>
#include <string>
#include <vector>

#include "golden/c/frame_handle.h"
#include "golden/geometric/geometric_golden.h"
#include "golden/morphological/morphological_golden.h"
#include "spec/error.h"
#include "tb/base/random.h"
#include "tb/unit/golden/c/support.h"
#include "tb/unit/spec/geometric/vector_frame.h"

namespace deburr::frames_test {
namespace {

using golden::geometric::GeometricGolden;
using golden::morphological::MorphologicalGolden;
using tb::Image;
using tb::c::counter_of;
using tb::c::expect_ok;
using tb::c::expect_rejected;
using tb::c::Handle;

constexpr std::uint8_t kGap = 0xA5;

// Rows of bytes with padding of kGap between them.
struct Rows {
  std::size_t row = 0, height = 0;
  std::uint32_t stride = 0;
  std::vector<std::uint8_t> bytes;

  Rows(std::size_t r, std::size_t h, std::uint32_t gap)
      : row(r),
        height(h),
        stride(static_cast<std::uint32_t>(r) + gap),
        bytes((h - 1) * stride + r, kGap) {}
  // The rows without their padding, which must be unchanged.
  std::vector<std::uint8_t> packed() const {
    std::vector<std::uint8_t> result;
    for (std::size_t i = 0; i < bytes.size(); ++i) {
      if (i % stride < row) {
        result.push_back(bytes[i]);
      } else {
        EXPECT_EQ(bytes[i], kGap);
      }
    }
    return result;
  }
};

template <class Pixel>
std::vector<std::uint8_t> bytes_of(const std::vector<Pixel>& pixels) {
  std::vector<std::uint8_t> bytes;
  for (const Pixel& pixel : pixels) bytes.insert(bytes.end(), pixel.begin(), pixel.end());
  return bytes;
}

std::vector<std::uint8_t> plane_of(deburr_golden* golden, const char* plane, std::uint32_t gap) {
  std::uint32_t width = 0, height = 0, pixel_bytes = 0;
  expect_ok(golden, deburr_plane_shape(golden, plane, &width, &height, &pixel_bytes));
  Rows rows(std::size_t{width} * pixel_bytes, height, gap);
  expect_ok(golden, deburr_plane(golden, plane, rows.bytes.data(), rows.bytes.size(), rows.stride));
  const std::vector<std::uint8_t> packed = rows.packed();
  // The same plane by single pixels.
  for (std::uint32_t i = 0; i < width * height; i += 7) {
    std::uint32_t word = 0, expected = 0;
    expect_ok(golden, deburr_plane_pixel(golden, plane, i % width, i / width, &word));
    for (std::uint32_t b = 0; b < pixel_bytes; ++b)
      expected |= std::uint32_t{packed[std::size_t{i} * pixel_bytes + b]} << (8 * b);
    EXPECT_EQ(word, expected);
  }
  return packed;
}

void begin_frame(deburr_golden* golden, const Image& image, std::uint32_t gap) {
  expect_ok(golden, deburr_frame_begin(golden, static_cast<std::uint32_t>(image.width),
                                       static_cast<std::uint32_t>(image.height)));
  Rows rows(std::size_t{4} * static_cast<std::size_t>(image.width),
            static_cast<std::size_t>(image.height), gap);
  const std::vector<std::uint8_t> bytes = bytes_of(image.pixels);
  for (std::size_t y = 0; y < rows.height; ++y)
    std::memcpy(rows.bytes.data() + y * rows.stride, bytes.data() + y * rows.row, rows.row);
  expect_ok(golden, deburr_frame_pixels(golden, rows.bytes.data(), rows.bytes.size(),
                                        gap == 0 ? 0 : rows.stride));
}

std::vector<std::uint32_t> random_depth(const Image& image, tb::Random& random) {
  std::vector<std::uint32_t> depth(image.pixels.size());
  // In the first eighth only the lowest bit differs.
  for (std::uint32_t& d : depth)
    d = random.chance(500) ? 0x345678 : random.chance(500) ? random.word() >> 8 : 1;
  std::fill_n(depth.begin(), depth.size() / 8, 0u);
  for (std::size_t i = 0; i < depth.size() / 8; ++i) depth[i] += random.below(2);
  return depth;
}

// ---- morphological ------------------------------------------------------------------------------

void expect_same(deburr_golden* handle, const MorphologicalGolden& golden) {
  EXPECT_EQ(plane_of(handle, "pixels", 0), bytes_of(golden.pixels()));
  std::vector<std::uint8_t> edges, weights, probes, decisions;
  for (int y = 0; y < golden.height(); ++y) {
    for (int x = 0; x < golden.width(); ++x) {
      edges.push_back(static_cast<std::uint8_t>((golden.edges().left.at(x, y) ? 1 : 0) +
                                                (golden.edges().top.at(x, y) ? 2 : 0)));
      for (const auto& [first, second] : {golden.top_weights(x, y), golden.left_weights(x, y)})
        weights.insert(weights.end(),
                       {static_cast<std::uint8_t>(first), static_cast<std::uint8_t>(second)});
    }
  }
  for (const auto& probe : golden.probes()) {
    const auto horizontal = static_cast<std::uint8_t>(probe.horizontal ? 1 : 0);
    probes.insert(probes.end(), {horizontal, probe.first, probe.second, probe.edges});
  }
  for (const auto decision : golden.decisions())
    decisions.push_back(static_cast<std::uint8_t>(decision));
  EXPECT_EQ(plane_of(handle, "edges", 3), edges);
  EXPECT_EQ(plane_of(handle, "weights", 1), weights);
  EXPECT_EQ(plane_of(handle, "probes", 5), probes);
  EXPECT_EQ(plane_of(handle, "decisions", 0), decisions);
  EXPECT_EQ(counter_of(handle, "pixels"), golden.work().pixels);
  EXPECT_EQ(counter_of(handle, "edge_pixels"), golden.work().edge_pixels);
  EXPECT_EQ(counter_of(handle, "blended_pixels"), golden.work().blended_pixels);
  EXPECT_EQ(counter_of(handle, "diagonals"), golden.work().diagonal_pixels);
  EXPECT_EQ(counter_of(handle, "bypassed_pixels"), golden.work().bypassed_pixels);
}

TEST(Morphological, FramesMatchGoldenWithEveryPreset) {
  tb::Random random(5);
  const std::vector<Image> images = {tb::stimuli::rendered_like(90, 70, 30),
                                     tb::stimuli::noise_image(), tb::stimuli::line_image(),
                                     Image(1, 1), Image(3, 1)};
  std::uint64_t blended = 0;
  for (const std::string_view preset : spec::morphological::kPresetNames) {
    const Handle handle(deburr_morphological_new());
    expect_ok(handle, deburr_frame_detail(handle.get(), 1));
    expect_ok(handle, deburr_set(handle.get(), "preset", std::string(preset).c_str()));
    const auto code = std::find(spec::morphological::kPresetNames.begin(),
                                spec::morphological::kPresetNames.end(), preset) -
                      spec::morphological::kPresetNames.begin();
    const auto parameters =
        spec::morphological::preset_parameters(static_cast<spec::morphological::Preset>(code));
    for (const Image& image : images) {
      MorphologicalGolden golden(parameters);
      golden.process({image.pixels, image.width, image.height});
      begin_frame(handle.get(), image, random.below(2) * random.below(40));
      expect_ok(handle, deburr_frame_process(handle.get()));
      expect_same(handle.get(), golden);
      blended += golden.work().blended_pixels;
    }
  }
  EXPECT_GT(blended, 5000u);
}

TEST(Morphological, UsesGivenDepthAndEdges) {
  tb::Random random(6);
  Image image = tb::stimuli::rendered_like(80, 50, 20);
  for (auto& pixel : image.pixels) pixel[3] = static_cast<std::uint8_t>(random.next());
  const std::vector<std::uint32_t> depth = random_depth(image, random);
  const Handle handle(deburr_morphological_new());
  expect_ok(handle, deburr_frame_detail(handle.get(), 1));
  expect_ok(handle, deburr_set(handle.get(), "edges.source", "depth"));
  spec::morphological::Parameters parameters;
  parameters.edge_source = spec::morphological::EdgeSource::kDepth;
  MorphologicalGolden golden(parameters);
  const golden::morphological::ImageView view(image.pixels, image.width, image.height);
  golden.process(view, {depth, image.width, image.height});
  EXPECT_GT(golden.work().edge_pixels, 100u);

  begin_frame(handle.get(), image, 0);
  // Rows padded by two words, whose values are ignored.
  std::vector<std::uint32_t> rows;
  for (std::size_t y = 0; y < 50; ++y) {
    rows.insert(rows.end(), depth.begin() + static_cast<std::ptrdiff_t>(80 * y),
                depth.begin() + static_cast<std::ptrdiff_t>(80 * y + 80));
    rows.insert(rows.end(), 2, 0xFFFFFFFF);
  }
  expect_ok(handle, deburr_frame_depth(handle.get(), rows.data(), rows.size() - 2, 82));
  expect_ok(handle, deburr_frame_process(handle.get()));
  expect_same(handle.get(), golden);

  // One pixel per call.
  const Handle stream(deburr_morphological_new());
  expect_ok(stream, deburr_frame_detail(stream.get(), 1));
  expect_ok(stream, deburr_set(stream.get(), "edges.source", "depth"));
  expect_ok(stream, deburr_frame_begin(stream.get(), 80, 50));
  for (std::uint32_t i = 0; i < depth.size(); ++i) {
    std::uint32_t word = 0;
    for (std::size_t c = 0; c < 4; ++c) word |= std::uint32_t{image.pixels[i][c]} << (8 * c);
    expect_ok(stream, deburr_frame_put(stream.get(), i % 80, i / 80, word, depth[i]));
  }
  expect_ok(stream, deburr_frame_process(stream.get()));
  expect_same(stream.get(), golden);

  // Given edges, in padded rows, apply until the next frame begins.
  constexpr int kStride = 83;
  std::vector<std::uint8_t> edges(std::size_t{kStride} * 50, 0);
  golden::morphological::EdgePlanes planes;
  planes.left.resize(80, 50);
  planes.top.resize(80, 50);
  for (int y = 0; y < 50; ++y) {
    for (int x = 0; x < 80; ++x) {
      const bool left = x > 0 && random.chance(200), top = y > 0 && random.chance(200);
      if (left) planes.left.set(x, y);
      if (top) planes.top.set(x, y);
      edges[static_cast<std::size_t>(kStride * y + x)] =
          static_cast<std::uint8_t>((left ? 1 : 0) + (top ? 2 : 0));
    }
  }
  MorphologicalGolden with_edges(parameters);
  with_edges.process(view, planes);
  expect_ok(handle, deburr_morphological_edges(handle.get(), edges.data(), edges.size(), kStride));
  expect_ok(handle, deburr_frame_process(handle.get()));
  expect_same(handle.get(), with_edges);
  begin_frame(handle.get(), image, 0);
  expect_ok(handle, deburr_frame_depth(handle.get(), depth.data(), depth.size(), 0));
  expect_ok(handle, deburr_frame_process(handle.get()));
  expect_same(handle.get(), golden);
}

// Every third line; they apply until the next call, also in later frames and after a reset.
TEST(Morphological, LinesWithErrorsReadAsZero) {
  const Image image = tb::stimuli::rendered_like(90, 70, 30);
  const golden::morphological::ImageView view(image.pixels, image.width, image.height);
  spec::morphological::Parameters parameters;
  parameters.storage = spec::morphological::Storage::kMemory;
  MorphologicalGolden golden(parameters), clean(parameters);
  golden.set_read_errors([](std::uint32_t address) { return address / 64 % 3 == 0; });
  golden.process(view);
  clean.process(view);
  EXPECT_GT(golden.memory_errors(), 100u);
  std::vector<std::uint32_t> lines;
  for (std::uint32_t i = 0; i < 1000; i += 3) lines.push_back(64 * i);
  const Handle handle(deburr_morphological_new());
  expect_ok(handle, deburr_set(handle.get(), "storage", "memory"));
  const auto pixels = [&] {
    begin_frame(handle.get(), image, 0);
    expect_ok(handle, deburr_frame_process(handle.get()));
    return plane_of(handle.get(), "pixels", 0);
  };
  EXPECT_EQ(pixels(), bytes_of(clean.pixels()));
  expect_ok(handle, deburr_error_lines(handle.get(), lines.data(), lines.size()));
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(pixels(), bytes_of(golden.pixels()));
    expect_ok(handle, deburr_reset(handle.get()));
  }
  expect_ok(handle, deburr_error_lines(handle.get(), nullptr, 0));
  EXPECT_EQ(pixels(), bytes_of(clean.pixels()));
}

// ---- geometric ----------------------------------------------------------------------------------

struct Words {
  std::vector<std::uint32_t> vertices, edges;
  std::vector<std::uint8_t> facing;
};

// The words of the mesh in memory, with unused bits set.
Words words_of(const tb::geometric::VectorFrame& frame) {
  Words words;
  for (const auto& v : frame.vertices) {
    words.vertices.insert(words.vertices.end(),
                          {static_cast<std::uint32_t>(v.x), static_cast<std::uint32_t>(v.y),
                           v.depth | 0xAB000000, 0xFFFFFFF0 | (v.usable ? 1u : 0u)});
  }
  for (const auto& e : frame.edges) {
    words.edges.insert(words.edges.end(),
                       {e.v0 | 0xFF000000, e.v1 | 0x11000000,
                        e.f0 | static_cast<std::uint32_t>(e.flags) << 24, e.f1 | 0x77000000});
  }
  words.facing.resize((frame.facing.size() + 7) / 8);
  for (std::size_t f = 0; f < frame.facing.size(); ++f)
    if (frame.facing[f])
      words.facing[f / 8] = static_cast<std::uint8_t>(words.facing[f / 8] | 1u << (f % 8));
  return words;
}

TEST(Geometric, FramesMatchGoldenWithEveryPreset) {
  const tb::geometric::VectorFrame frame = tb::geometric::vector_frame();
  const Words words = words_of(frame);
  const auto faces = static_cast<std::uint32_t>(frame.facing.size());
  for (std::size_t i = 0; i < spec::geometric::kPresetNames.size(); ++i) {
    GeometricGolden golden(
        spec::geometric::preset_parameters(static_cast<spec::geometric::Preset>(i)));
    golden::geometric::FrameInput input;
    input.image = {frame.colours, frame.width, frame.height};
    input.depth = {frame.depths, frame.width, frame.height};
    input.edges = frame.edges;
    input.vertices = frame.vertices;
    input.facing = {words.facing, faces};
    // Two of the lines with depths read as zero.
    input.bases.depth = 0x40000;
    input.bases.colour = 0x80000;
    const std::vector<std::uint32_t> lines = {0x40040, 0x40100};
    const auto bad = [&](std::uint32_t a) { return a == lines[0] || a == lines[1]; };
    golden.process(input);
    EXPECT_GT(golden.work().blended_pixels, 50u);
    GeometricGolden failing(
        spec::geometric::preset_parameters(static_cast<spec::geometric::Preset>(i)));
    failing.set_memory_errors(bad);
    failing.process(input);
    EXPECT_NE(failing.weights(), golden.weights());

    const Handle handle(deburr_geometric_new());
    expect_ok(handle, deburr_set(handle.get(), "geometric.preset",
                                 std::string(spec::geometric::kPresetNames[i]).c_str()));
    expect_ok(handle, deburr_frame_detail(handle.get(), 1));
    expect_ok(handle, deburr_frame_begin(handle.get(), static_cast<std::uint32_t>(frame.width),
                                         static_cast<std::uint32_t>(frame.height)));
    const std::vector<std::uint8_t> pixels = bytes_of(frame.colours);
    expect_ok(handle, deburr_frame_pixels(handle.get(), pixels.data(), pixels.size(), 0));
    expect_ok(handle, deburr_geometric_vertices(handle.get(), words.vertices.data(),
                                                words.vertices.size()));
    expect_ok(handle, deburr_geometric_edges(handle.get(), words.edges.data(), words.edges.size()));
    expect_ok(handle, deburr_geometric_facing(handle.get(), faces, words.facing.data(),
                                              words.facing.size()));
    expect_rejected(handle, "the frame has no depth: call deburr_frame_depth",
                    deburr_frame_process(handle.get()));
    expect_ok(handle,
              deburr_frame_depth(handle.get(), frame.depths.data(), frame.depths.size(), 0));
    expect_ok(handle, deburr_frame_process(handle.get()));
    EXPECT_EQ(plane_of(handle.get(), "pixels", 4), bytes_of(golden.pixels()));
    EXPECT_EQ(plane_of(handle.get(), "weights", 0), bytes_of(golden.weights()));
    std::vector<std::uint8_t> classes(frame.edges.size());
    expect_ok(handle, deburr_geometric_classes(handle.get(), classes.data(), classes.size()));
    for (std::size_t e = 0; e < classes.size(); ++e)
      EXPECT_EQ(classes[e], static_cast<std::uint8_t>(golden.classes()[e]));
    expect_rejected(handle, "classes_size is 299, but there are 300 edges",
                    deburr_geometric_classes(handle.get(), classes.data(), classes.size() - 1));
    EXPECT_EQ(counter_of(handle.get(), "edges"), golden.work().edges);
    expect_rejected(handle, "unknown region of memory 'texels'",
                    deburr_geometric_base(handle.get(), "texels", 0));
    expect_rejected(handle, "is not a multiple of 64",
                    deburr_geometric_base(handle.get(), "depth", 4));
    expect_ok(handle, deburr_geometric_base(handle.get(), "depth", input.bases.depth));
    expect_ok(handle, deburr_geometric_base(handle.get(), "colour", input.bases.colour));
    expect_ok(handle, deburr_error_lines(handle.get(), lines.data(), lines.size()));
    expect_ok(handle, deburr_frame_process(handle.get()));
    EXPECT_EQ(plane_of(handle.get(), "weights", 0), bytes_of(failing.weights()));
    expect_ok(handle, deburr_error_lines(handle.get(), nullptr, 0));
    expect_ok(handle, deburr_frame_process(handle.get()));
    EXPECT_EQ(plane_of(handle.get(), "weights", 0), bytes_of(golden.weights()));
    EXPECT_EQ(counter_of(handle.get(), "kept_edges"), golden.work().kept_edges);
    EXPECT_EQ(counter_of(handle.get(), "candidates"), golden.work().candidates);
    EXPECT_EQ(counter_of(handle.get(), "blended_pixels"), golden.work().blended_pixels);
    // A new frame starts without depth; depth_test = off does not need it.
    expect_ok(handle, deburr_frame_begin(handle.get(), 8, 8));
    expect_rejected(handle, "the frame has no depth", deburr_frame_process(handle.get()));
    expect_ok(handle, deburr_set(handle.get(), "depth_test", "off"));
    expect_ok(handle, deburr_frame_process(handle.get()));
  }
}

// A line between two rows at the depth of the frame, 1: its 16 pixels pass if no bit is lost.
TEST(Geometric, DepthKeepsLowestBit) {
  const Handle handle(deburr_geometric_new());
  const std::vector<std::uint32_t> depth(256, 1), edge = {0, 1, 1u << 24, 0};
  const std::vector<std::uint32_t> vertices = {0,        8 * 256 - 64, 1, 1,  //
                                               16 * 256, 8 * 256 - 64, 1, 1};
  expect_ok(handle, deburr_frame_begin(handle.get(), 16, 16));
  expect_ok(handle, deburr_frame_depth(handle.get(), depth.data(), depth.size(), 0));
  expect_ok(handle, deburr_geometric_vertices(handle.get(), vertices.data(), vertices.size()));
  expect_ok(handle, deburr_geometric_edges(handle.get(), edge.data(), edge.size()));
  expect_ok(handle,
            deburr_geometric_facing(handle.get(), 8, std::array<std::uint8_t, 1>{1}.data(), 1));
  expect_ok(handle, deburr_frame_process(handle.get()));
  EXPECT_EQ(counter_of(handle.get(), "blended_pixels"), 16u);
}

// ---- both engines -------------------------------------------------------------------------------

TEST(BadCalls, ReturnErrorWithoutSideEffects) {
  for (const golden::c::MakeHandle make : {deburr_morphological_new, deburr_geometric_new}) {
    const Handle handle(make());
    deburr_golden* const golden = handle.get();
    const auto rejected = [&](const std::string& words, int status,
                              int expected = DEBURR_ARGUMENT) {
      expect_rejected(golden, words, status, expected);
    };
    const auto ok = [&](int status) { expect_ok(golden, status); };
    std::vector<std::uint8_t> bytes(64, 1);
    const std::vector<std::uint32_t> words(16, 1);
    std::uint32_t number = 77;
    rejected("no frame was begun: call deburr_frame_begin",
             deburr_frame_pixels(golden, bytes.data(), 64, 0));
    rejected("no frame was begun", deburr_frame_depth(golden, words.data(), 16, 0));
    rejected("no frame was begun", deburr_frame_put(golden, 0, 0, 0, 0));
    rejected("no frame was begun", deburr_frame_process(golden));
    rejected("no frame has been smoothed", deburr_plane(golden, "pixels", bytes.data(), 64, 0));
    for (const auto& [width, height] :
         {std::pair{0u, 1u}, {1u, 0u}, {8193u, 1u}, {1u, 8193u}, {~0u, ~0u}})
      rejected("width and height must be 1..8192", deburr_frame_begin(golden, width, height));
    ok(deburr_frame_begin(golden, 4, 4));
    rejected("pixels is NULL", deburr_frame_pixels(golden, nullptr, 64, 0));
    rejected("pixels_size is 63; 4 rows need 64", deburr_frame_pixels(golden, bytes.data(), 63, 0));
    rejected("pixels_size is 0; 4 rows need 64", deburr_frame_pixels(golden, nullptr, 0, 0));
    rejected("pixels_size is 64; 4 rows need 67",
             deburr_frame_pixels(golden, bytes.data(), 64, 17));
    rejected("stride 15 is shorter than a row of pixels, 16",
             deburr_frame_pixels(golden, bytes.data(), 64, 15));
    rejected("pixels_size is 64; 4 rows need 12884901901",
             deburr_frame_pixels(golden, bytes.data(), 64, ~0u));
    rejected("depth_size is 15; 4 rows need 16", deburr_frame_depth(golden, words.data(), 15, 0));
    rejected("depth is NULL", deburr_frame_depth(golden, nullptr, 16, 0));
    rejected("x 4 is outside 0..3", deburr_frame_put(golden, 4, 0, 0, 0));
    rejected("y 4 is outside 0..3", deburr_frame_put(golden, 0, 4, 0, 0));
    std::vector<std::uint32_t> wide(words);
    wide[6] = wide[9] = 1u << 24;  // one more than the largest depth
    expect_rejected(golden,
                    "depth: 2 of 16 values lie outside 0..16777215, the first at (2, 1): "
                    "a depth has 24 bits",
                    deburr_frame_depth(golden, wide.data(), 16, 0));
    rejected("depth 16777216 is outside 0..16777215", deburr_frame_put(golden, 0, 0, 0, 1u << 24));
    rejected("everything is 2; it must be 0 or 1", deburr_frame_detail(golden, 2));
    // Rejected calls changed nothing: the frame is still opaque black.
    ok(deburr_frame_put(golden, 1, 0, 0xFF332211, 5));
    ok(deburr_set(golden, "line_pixels", "64"));
    ok(deburr_frame_process(golden));
    const auto expect_previous_result = [&] {
      ok(deburr_plane_pixel(golden, "pixels", 1, 0, &number));
      EXPECT_NE(number, 0xFF000000);
      ok(deburr_plane_pixel(golden, "pixels", 3, 3, &number));
      EXPECT_EQ(number, 0xFF000000);
    };
    expect_previous_result();
    rejected("unknown plane 'pixel'; known: pixels, ",
             deburr_plane(golden, "pixel", bytes.data(), 64, 0));
    rejected("plane is NULL", deburr_plane(golden, nullptr, bytes.data(), 64, 0));
    rejected("values_size is 63; 4 rows need 64",
             deburr_plane(golden, "pixels", bytes.data(), 63, 0));
    rejected("values is NULL", deburr_plane(golden, "pixels", nullptr, 64, 0));
    rejected("x 4 is outside 0..3", deburr_plane_pixel(golden, "pixels", 4, 0, &number));
    EXPECT_EQ(deburr_plane_pixel(golden, "pixels", 0, 0, nullptr), DEBURR_ARGUMENT);
    EXPECT_EQ(deburr_plane_shape(golden, "pixels", nullptr, &number, &number), DEBURR_ARGUMENT);
    EXPECT_EQ(deburr_plane_shape(golden, "pixels", &number, nullptr, &number), DEBURR_ARGUMENT);
    EXPECT_EQ(deburr_plane_shape(golden, "pixels", &number, &number, nullptr), DEBURR_ARGUMENT);
    EXPECT_EQ(bytes, std::vector<std::uint8_t>(64, 1));
    // The engine rejects this frame, with the existing model and with a rebuilt one.
    ok(deburr_frame_begin(golden, 65, 1));
    ok(deburr_frame_put(golden, 0, 0, 0, 0));
    for (int i = 0; i < 2; ++i) {
      rejected("raise line_pixels", deburr_frame_process(golden), DEBURR_CONFIGURATION);
      expect_previous_result();
      ok(deburr_set(golden, "linear_light", "false"));
    }
    ok(deburr_set(golden, "line_pixels", "65"));
    ok(deburr_frame_process(golden));
    rejected("y 3 is outside 0..0", deburr_plane_pixel(golden, "pixels", 3, 3, &number));
    ok(deburr_reset(golden));
    rejected("no frame has been smoothed", deburr_plane_pixel(golden, "pixels", 0, 0, &number));
    rejected("no frame was begun", deburr_frame_process(golden));
    EXPECT_EQ(counter_of(golden, "blended_pixels"), 0u);
    EXPECT_EQ(tb::c::value_of(golden, "line_pixels"), "65");
  }
}

TEST(Frames, AcceptLargestSize) {
  for (const golden::c::MakeHandle make : {deburr_morphological_new, deburr_geometric_new}) {
    const Handle handle(make());
    expect_ok(handle, deburr_frame_begin(handle.get(), 8192, 1));
    expect_ok(handle, deburr_frame_begin(handle.get(), 1, 8192));
  }
}

// The part of a golden model that FrameModel needs; counts constructions.
struct CountedGolden {
  enum class Detail { kPixels, kEverything };
  static inline int made = 0;
  CountedGolden(int, Detail) { ++made; }
};
using CountedModel = golden::c::FrameModel<CountedGolden, int>;

TEST(FrameModel, RebuiltOnlyAfterParameterChange) {
  CountedModel model;
  int frames = 0;
  const auto process = [&] { model.process(0, false, [&](CountedGolden&) { ++frames; }); };
  const int before = CountedGolden::made;
  for (int i = 0; i < 3; ++i) process();
  EXPECT_EQ(CountedGolden::made, before + 1);
  model.mark_stale();
  for (int i = 0; i < 3; ++i) process();
  EXPECT_EQ(CountedGolden::made, before + 2);
  EXPECT_EQ(frames, 6);
}

// docs/reference/c_interface.md, "Errors", with and without changed parameters.
TEST(FrameModel, FaultDiscardsResultsButRejectionKeepsThem) {
  for (const bool changed : {false, true}) {
    CountedModel model;
    model.process(0, false, [](CountedGolden&) {});
    if (changed) model.mark_stale();
    const auto rejected = [](CountedGolden&) { throw spec::ConfigError("too large"); };
    EXPECT_THROW(model.process(0, false, rejected), spec::ConfigError);
    EXPECT_NE(model.get(), nullptr) << changed;
    const auto no_memory = [](CountedGolden&) { throw std::bad_alloc(); };
    EXPECT_THROW(model.process(0, false, no_memory), std::bad_alloc);
    EXPECT_EQ(model.get(), nullptr) << changed;
  }
}

TEST(Detail, AppliesFromNextFrame) {
  const Handle morphological(deburr_morphological_new()), geometric(deburr_geometric_new());
  std::uint32_t value = 0;
  std::uint8_t classes = 77;
  const std::vector<std::uint32_t> edge(4, 0);
  expect_ok(geometric, deburr_geometric_edges(geometric.get(), edge.data(), edge.size()));
  for (const bool detail : {false, true, false}) {
    for (deburr_golden* const golden : {morphological.get(), geometric.get()}) {
      expect_ok(golden, deburr_frame_detail(golden, detail ? 1 : 0));
      expect_ok(golden, deburr_frame_begin(golden, 2, 2));
      expect_ok(golden, deburr_frame_put(golden, 0, 0, 0xFFFFFFFF, 1));
      expect_ok(golden, deburr_frame_process(golden));
    }
    for (const char* plane : {"pixels", "edges", "weights"})
      expect_ok(morphological, deburr_plane_pixel(morphological.get(), plane, 0, 0, &value));
    for (const char* plane : {"pixels", "weights"})
      expect_ok(geometric, deburr_plane_pixel(geometric.get(), plane, 0, 0, &value));
    const int status = detail ? DEBURR_OK : DEBURR_ARGUMENT;
    for (const char* plane : {"probes", "decisions"})
      EXPECT_EQ(deburr_plane_pixel(morphological.get(), plane, 0, 0, &value), status);
    EXPECT_EQ(deburr_geometric_classes(geometric.get(), &classes, 1), status);
  }
  EXPECT_EQ(classes, 0);
}

TEST(BadCalls, EngineSpecificCallsReturnErrors) {
  const Handle morphological(deburr_morphological_new());
  std::vector<std::uint8_t> edges(4, 0);
  const auto give_edges = [&](std::size_t size) {
    return deburr_morphological_edges(morphological.get(), edges.data(), size, 0);
  };
  expect_rejected(morphological, "no frame was begun", give_edges(4));
  expect_ok(morphological, deburr_frame_begin(morphological.get(), 2, 2));
  expect_rejected(morphological, "edges_size is 3; 2 rows need 4", give_edges(3));
  for (const auto& [i, bits] : {std::pair{0, 1}, {0, 2}, {1, 2}, {2, 1}, {3, 4}, {3, 255}}) {
    edges.assign(4, 0);
    edges[static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(bits);
    expect_rejected(morphological, "have a neighbour in the frame", give_edges(4));
  }
  edges = {0, 1, 2, 3};
  expect_ok(morphological, give_edges(4));
  expect_ok(morphological, deburr_frame_process(morphological.get()));
  expect_rejected(morphological, "the plane 'probes' was not kept: call deburr_frame_detail with 1",
                  deburr_plane(morphological.get(), "probes", edges.data(), 4, 0));

  const Handle geometric(deburr_geometric_new());
  const std::vector<std::uint32_t> words(8, 0);
  const std::vector<std::uint8_t> bits(2, 0);
  std::uint8_t classes = 0;
  expect_rejected(geometric, "words_size is 7; vertices have four words each",
                  deburr_geometric_vertices(geometric.get(), words.data(), 7));
  expect_rejected(geometric, "words_size is 5; edges have four words each",
                  deburr_geometric_edges(geometric.get(), words.data(), 5));
  expect_rejected(geometric, "words is NULL", deburr_geometric_edges(geometric.get(), nullptr, 4));
  expect_rejected(
      geometric, "16777217 edges; the limit is 2^24",
      deburr_geometric_edges(geometric.get(), words.data(), (std::size_t{1} << 26) + 4));
  expect_rejected(geometric, "the bits of 17 faces need 3 bytes",
                  deburr_geometric_facing(geometric.get(), 17, bits.data(), 2));
  expect_rejected(geometric, "bits is NULL",
                  deburr_geometric_facing(geometric.get(), 1, nullptr, 1));
  expect_rejected(geometric, "classes were not kept",
                  deburr_geometric_classes(geometric.get(), &classes, 1));
  // The engine, not the interface, checks vertex and face numbers of edges.
  expect_ok(geometric, deburr_geometric_edges(geometric.get(), words.data(), 8));
  expect_ok(geometric, deburr_frame_begin(geometric.get(), 2, 2));
  expect_ok(geometric, deburr_frame_put(geometric.get(), 0, 0, 0, 0));
  expect_ok(geometric, deburr_frame_process(geometric.get()));
  EXPECT_EQ(counter_of(geometric.get(), "invalid_edges"), 2u);
  expect_rejected(geometric, "need 536870912 bytes",
                  deburr_geometric_facing(geometric.get(), ~0u, bits.data(), 2));
}

}  // namespace
}  // namespace deburr::frames_test
