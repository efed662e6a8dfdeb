// SPDX-License-Identifier: MIT
// The supersampled image is a valid reference: analytic coverage, analytic depth, and the frames
// that another program rendered from the same scene.
#include "tb/scene/reference.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>

#include "tb/scene/image_io.h"
#include "tb/scene/quality.h"
#include "tb/scene/rasteriser.h"
#include "tb/scene/textures.h"
#include "tb/unit/scene/fixtures.h"

namespace deburr::tb::reference_test {
namespace {

using test::FlatScreen;
using test::fnv;

RenderOptions texture_options(int size, int samples) {
  RenderOptions options;
  options.width = options.height = size;
  options.samples = samples;
  return options;
}

// White on black: a pixel's value is its coverage.
double coverage(const Image& image, int x, int y) { return image.at(x, y)[0] / 255.0; }

TEST(Reference, StraightEdgesHaveExactCoverage) {
  FlatScreen screen(32);
  screen.rectangle(4.25, 3, 20, 18.5);
  const Image image = render(screen.scene(), texture_options(32, 8));
  EXPECT_NEAR(coverage(image, 4, 10), 0.75, 0.002);
  EXPECT_NEAR(coverage(image, 12, 18), 0.5, 0.003);
  EXPECT_NEAR(coverage(image, 4, 18), 0.375, 0.003);
  EXPECT_EQ(coverage(image, 19, 10), 1.0);
  EXPECT_EQ(coverage(image, 20, 10), 0.0);

  // A half-plane of slope 1/7: the covered part of a column of pixels is exact.
  FlatScreen slope(32);
  const auto a = slope.vertex(-7, 9), b = slope.vertex(42, 16), c = slope.vertex(42, 60),
             d = slope.vertex(-7, 60);
  slope.triangle(a, b, c);
  slope.triangle(a, c, d);
  const Image tilted = render(slope.scene(), texture_options(32, 16));
  for (int x = 0; x < 32; ++x) {
    double sum = 0.0;
    for (int y = 0; y < 32; ++y) sum += coverage(tilted, x, y);
    EXPECT_NEAR(sum, 32 - (10 + (x + 0.5) / 7.0), 0.01) << x;
  }
}

TEST(Reference, LinearAveragingIsBrighter) {
  FlatScreen screen(16);
  screen.rectangle(4.5, -1, 40, 40);
  RenderOptions options = texture_options(16, 4);
  EXPECT_EQ(render(screen.scene(), options).at(4, 8)[0], 128);
  options.averaging = Averaging::kLinear;
  EXPECT_EQ(render(screen.scene(), options).at(4, 8)[0], 188);  // sRGB of one half
}

TEST(Reference, OneSampleEqualsTheFragment) {
  const Scene scene = make_scene("quad", {.texture = "noise", .texture_size = 64});
  RenderOptions options = texture_options(128, 1);
  options.sampling = Sampling::kNearest;
  const Image image = render(scene, options);
  const FragmentStream stream = rasterise(scene, {128, 128});
  FrameAssembler frame(stream, scene);
  const Image& texture = scene.mesh.textures[0].image;
  for (const spec::texture::Quad& quad : stream.quads)
    for (std::uint8_t lane = 0; lane < 4; ++lane)
      if ((quad.coverage >> lane & 1) != 0)
        frame.put({.tag = quad.tag,
                   .lane = lane,
                   .rgba = texture.at((quad.s[lane] >> 18) & 63, (quad.t[lane] >> 18) & 63)});
  EXPECT_LE(count_different(frame.frame(), image),
            2);  // a coordinate on a texel's border may round across it
}

TEST(Reference, BilinearReachesTexelValuesAtCentres) {
  // One texel covers four pixels: its centre lies between pixels 1 and 2, an eighth of a texel from
  // each.
  FlatScreen screen(32);
  screen.rectangle(0, 0, 32, 32);
  screen.scene().mesh.textures[0].image = Image(8, 8, {0, 0, 0, 255});
  screen.scene().mesh.textures[0].image.at(3, 5) = {255, 255, 255, 255};
  const Image image = render(screen.scene(), texture_options(32, 1));
  const double near = 7.0 / 8, far = 3.0 / 8;  // weights of the texel along one axis
  const std::array<double, 8> weight{1.0 / 8, far, 5.0 / 8, near, near, 5.0 / 8, far, 1.0 / 8};
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 32; ++x) {
      const int i = x - 10, j = y - 18;  // the texel reaches two pixels beyond its own four
      const bool inside = i >= 0 && i < 8 && j >= 0 && j < 8;
      const double want =
          inside ? weight[static_cast<std::size_t>(i)] * weight[static_cast<std::size_t>(j)] : 0;
      EXPECT_NEAR(coverage(image, x, y), want, 0.5 / 255 + 1e-6) << x << "," << y;
    }
  }
  RenderOptions nearest = texture_options(32, 1);
  nearest.sampling = Sampling::kNearest;
  const Image blocks = render(screen.scene(), nearest);
  EXPECT_EQ(blocks.at(12, 20)[0], 255);
  EXPECT_EQ(blocks.at(15, 23)[0], 255);
  EXPECT_EQ(blocks.at(11, 20)[0], 0);
  EXPECT_EQ(blocks.at(16, 20)[0], 0);
}

// For a texture that is eight times as wide as high, with a wrap mode per axis: transposed, and
// sampled with s and t exchanged, it gives the same pixels. The plane recedes, so that every level
// is read.
TEST(Reference, TransposingTextureAndCoordinatesKeepsImage) {
  Scene scene = make_scene("plane", {.texture_size = 16});
  Texture& texture = scene.mesh.textures[0];
  const Image square = noise(64, 64);
  Image wide(64, 8), high(8, 64);
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 64; ++x) wide.at(x, y) = high.at(y, x) = square.at(x, y);
  // Rotated and stretched so that either side of a footprint is the longer one somewhere.
  for (Vertex& vertex : scene.mesh.vertices)
    vertex.uv = {3.2 * vertex.uv.x - 0.6 * vertex.uv.y, 2.4 * vertex.uv.x + 0.8 * vertex.uv.y};
  texture.wrap_t = spec::texture::Wrap::kMirroredRepeat;
  texture.image = wide;
  RenderOptions options = texture_options(64, 2);
  options.shading = Shading::kLit;  // this mode reads mip levels
  const Image one = render(scene, options);
  for (Vertex& vertex : scene.mesh.vertices) std::swap(vertex.uv.x, vertex.uv.y);
  std::swap(texture.wrap_s, texture.wrap_t);
  texture.image = high;
  const Image other = render(scene, options);
  for (std::size_t i = 0; i < one.pixels.size(); ++i)
    for (std::size_t c = 0; c < 4; ++c) ASSERT_NEAR(one.pixels[i][c], other.pixels[i][c], 1) << i;
}

TEST(Reference, ConvergesAndKeepsFlatTexture) {
  Scene scene = make_scene("plane", {.texture_size = 256});
  const Image fine = render(scene, texture_options(64, 16));
  const double coarse = psnr(render(scene, texture_options(64, 2)), fine);
  const double better = psnr(render(scene, texture_options(64, 8)), fine);
  EXPECT_GT(better, coarse + 6.0);
  EXPECT_GT(better, 28.0);
  scene.mesh.textures[0].image = Image(8, 8, {200, 100, 50, 255});
  for (const Averaging averaging : {Averaging::kStored, Averaging::kLinear}) {
    RenderOptions options = texture_options(32, 5);
    options.averaging = averaging;
    EXPECT_EQ(render(scene, options), Image(32, 32, {200, 100, 50, 255}));
  }
}

TEST(Reference, RotatedGridHasFourLevelsInBothDirections) {
  // A vertical and a horizontal edge moved in eighths of a pixel: each crosses the samples one by
  // one.
  for (const bool vertical : {true, false}) {
    std::set<int> levels;
    for (int eighth = 0; eighth <= 8; ++eighth) {
      FlatScreen screen(16);
      const double at = 5 + eighth / 8.0;
      screen.rectangle(vertical ? at : -1, vertical ? -1 : at, 40, 40);
      screen.scene().lighting = {.key = 0, .fill = 0, .ambient = 1};
      const Image image = render_msaa4(screen.scene(), 16, 16);
      levels.insert(vertical ? image.at(5, 8)[0] : image.at(8, 5)[0]);
      EXPECT_EQ(vertical ? image.at(7, 8)[0] : image.at(8, 7)[0], 255);
    }
    EXPECT_EQ(levels.size(), 5u);
    EXPECT_EQ(*levels.begin(), 0);
    EXPECT_TRUE(levels.count(255));
    EXPECT_TRUE(levels.count(186));  // gamma 2.2 of one half
  }
}

TEST(Reference, MultisamplingLiesBetweenOneSampleAndReference) {
  const Scene scene = make_scene("cylinders");
  const LitFrames frames = render_lit_frames(scene, 256, 192, 8);
  const Image msaa = render_msaa4(scene, 256, 192);
  EXPECT_GT(psnr(msaa, frames.reference), psnr(frames.noaa, frames.reference) + 4.0);
  const Mask edges = edge_mask(frames.reference, frames.noaa);
  const Mask silhouettes = silhouette_mask(edges, frames.depth);
  EXPECT_GT(count(silhouettes), 500);
  EXPECT_LE(count(silhouettes), count(edges));
  EXPECT_LT(count(edges), 256 * 192 / 10);  // elsewhere, frames with one and many samples agree
}

TEST(Reference, DepthOfPlaneIsAnalytic) {
  const Scene scene = make_scene("plane", {.texture_size = 16});
  const DepthImage depth = render_depth(scene, 64, 64);
  const double pitch = std::atan2(1.0 - 0.704, 1.0), slope = std::tan(0.25);
  for (int y = 0; y < 64; ++y) {
    const double v = (32 - (y + 0.5)) / 32 * slope;  // tangent above the view direction
    // The ray falls by sin(pitch) - v cos(pitch) per unit of w, and the eye is one unit high.
    const double inverse_w = std::sin(pitch) - v * std::cos(pitch);
    for (int x = 0; x < 64; x += 9) EXPECT_NEAR(depth.at(x, y), 0.1 * inverse_w, 2e-6);
  }
}

// Optimisations must not change a bit. An odd size leaves partial tiles on two sides.
TEST(Reference, ImageHashesMatchRecordedOnes) {
  struct Recorded {
    const char* scene;
    std::uint64_t lit, lit_as_stored, stored, linear, msaa, depth;
  };
  constexpr int kWidth = 197, kHeight = 131;
  for (const Recorded& r :
       {Recorded{"plane", 0xEEAA09786C12455Cu, 0xA82241085E133829u, 0xDF046A4273E84B11u,
                 0xC8F62743D9539F91u, 0xD167B3BBF4810200u, 0x84D9309EA865A712u},
        Recorded{"quad", 0xB6CC5DC396AA890Cu, 0xA97B555AF21508C8u, 0x8137D860B4AAF6C6u,
                 0x33E6F5F361715D6Bu, 0x5B15E107CA506E21u, 0xEB4924658BD8715Au},
        Recorded{"tunnel", 0x58B3114FFC9D0287u, 0x797769CC03AFA4C6u, 0xDBC2E284A980CFFCu,
                 0x6A281AE7239DFA3Cu, 0x27825C5DF11FD8CEu, 0x4CB3191B0449584Eu},
        Recorded{"object", 0x6784F3FA96E8CBF6u, 0xB8F0FBACDDD566EAu, 0x6219E6FA879FBA55u,
                 0xF06A2F2F8456DA5Cu, 0xA0F6FC541955C84Au, 0xB1CC656378FACB46u},
        Recorded{"road", 0x5317753AC3771054u, 0xFFA803615C75441Cu, 0x2E12A510A305357Au,
                 0x1E461510E2432EA0u, 0xAA285B2AFCCC128Du, 0xECD6B2216D95B4E8u},
        Recorded{"cylinders", 0x3593AE2E9162B2C5u, 0x63F7B513E1D2E547u, 0xFB72F9D14CC2F2D4u,
                 0x68FFA7A0E9855A23u, 0x3EA64DB0DF704E2Fu, 0xD1278006E47DE111u}}) {
    const Scene scene = make_scene(r.scene, {.texture_size = 64});
    const auto hash = [&](int samples, Shading shading, Sampling sampling, Averaging averaging) {
      return fnv(render(scene, {kWidth, kHeight, samples, shading, sampling, averaging}));
    };
    EXPECT_EQ(hash(8, Shading::kLit, Sampling::kBilinear, Averaging::kLinear), r.lit) << r.scene;
    EXPECT_EQ(hash(3, Shading::kLit, Sampling::kBilinear, Averaging::kStored), r.lit_as_stored)
        << r.scene;
    EXPECT_EQ(hash(1, Shading::kTexture, Sampling::kNearest, Averaging::kStored), r.stored)
        << r.scene;
    EXPECT_EQ(hash(5, Shading::kTexture, Sampling::kBilinear, Averaging::kLinear), r.linear)
        << r.scene;
    EXPECT_EQ(fnv(render_msaa4(scene, kWidth, kHeight)), r.msaa) << r.scene;
    EXPECT_EQ(fnv(render_depth(scene, kWidth, kHeight)), r.depth) << r.scene;
  }
}

// A square one unit in front of the eye and facing it. The pixel right of and below the
// middle is 1/16 off the axis in both directions.
class LitSquare : public testing::Test {
 protected:
  LitSquare() {
    screen_.rectangle(2, 2, 14, 14);
    Scene& scene = screen_.scene();
    scene.mesh.materials[0].colour = {0.5, 0.25, 0.0625};
    scene.lighting = {.key_direction = {0, 0, 2},
                      .fill_direction = {0, 3, 4},
                      .key = 0.5,
                      .fill = 0.25,
                      .ambient = 0.125,
                      .specular = 0.25};
    scene.sky_top = {0, 100, 200, 255};
    scene.sky_bottom = {160, 100, 40, 255};
  }
  Image picture(Shading shading) const {
    return render(scene_of(), {.width = 16,
                               .height = 16,
                               .samples = 1,
                               .shading = shading,
                               .averaging = Averaging::kLinear});
  }
  const Scene& scene_of() const { return const_cast<FlatScreen&>(screen_).scene(); }
  static Rgba8 coded(double red, double green, double blue) {
    Rgba8 colour = {0, 0, 0, 255};
    std::size_t c = 0;
    for (const double light : {red, green, blue})
      colour[c++] = static_cast<std::uint8_t>(std::lround(255 * std::pow(light, 1 / 2.2)));
    return colour;
  }
  // All of the key light, 0.8 of the second one.
  static constexpr double kDiffuse = 0.125 + 0.5 + 0.25 * 0.8;
  FlatScreen screen_{16};
};

TEST_F(LitSquare, ReceivesLightOfBothLamps) {
  const Rgba8 expected = coded(0.5 * kDiffuse, 0.25 * kDiffuse, 0.0625 * kDiffuse);
  const Image image = picture(Shading::kLit);
  EXPECT_EQ(image.at(8, 8), expected);
  EXPECT_EQ(image.at(2, 2), expected);
  // Row by row from one colour to the other: at (y + 0.5) / 16.
  EXPECT_EQ(image.at(0, 0), (Rgba8{5, 100, 195, 255}));
  EXPECT_EQ(image.at(15, 7), (Rgba8{75, 100, 125, 255}));
  EXPECT_EQ(image.at(1, 15), (Rgba8{155, 100, 45, 255}));
  // Its back is lit as well: the normals turn to the eye.
  for (Vertex& vertex : screen_.scene().mesh.vertices) vertex.normal = {0, 0, -1};
  EXPECT_EQ(picture(Shading::kLit).at(8, 8), expected);
  for (Triangle& triangle : screen_.scene().mesh.triangles)
    std::swap(triangle.vertex[0], triangle.vertex[1]);
  EXPECT_EQ(picture(Shading::kLit).at(8, 8), expected);
  // In a smooth scene the vertex normals are used.
  for (Vertex& vertex : screen_.scene().mesh.vertices) vertex.normal = {0.6, 0, -0.8};
  screen_.scene().lighting.smooth = false;
  EXPECT_EQ(picture(Shading::kLit).at(8, 8), expected);
  screen_.scene().lighting.smooth = true;
  const double tilted = 0.125 + 0.5 * 0.8 + 0.25 * 0.64;
  EXPECT_EQ(picture(Shading::kLit).at(8, 8), coded(0.5 * tilted, 0.25 * tilted, 0.0625 * tilted));
}

TEST_F(LitSquare, ShowsPhongHighlight) {
  const auto shines = [](double x, double y) {  // towards the eye from that position
    const double length = std::sqrt(x * x + y * y + 1), key = 1 / length,
                 fill = (-0.6 * y + 0.8) / length;
    return 0.25 * (0.5 * std::pow(key, 32) + 0.25 * std::pow(fill, 32));
  };
  const auto expected = [&](double x, double y) {
    const double s = shines(x, y);
    return coded(0.5 * kDiffuse + s, 0.25 * kDiffuse + s, 0.0625 * kDiffuse + s);
  };
  const Image image = picture(Shading::kPhong);
  EXPECT_EQ(image.at(8, 8), expected(-0.0625, 0.0625));
  EXPECT_EQ(image.at(10, 11), expected(-0.3125, 0.4375));
  EXPECT_EQ(image.at(3, 3), expected(0.5625, -0.5625));
  const GBuffer buffer = render_gbuffer(scene_of(), 16, 16);
  EXPECT_EQ(buffer.normal.at(5, 9), (std::array<float, 3>{0, 0, 1}));
  EXPECT_EQ(buffer.albedo.at(5, 9), (std::array<float, 4>{0.5F, 0.25F, 0.0625F, 1}));
  EXPECT_EQ(buffer.depth.at(5, 9), 0.01F);
  EXPECT_EQ(buffer.depth.at(1, 9), 0.0F);
  EXPECT_EQ(light(scene_of(), buffer), image);
}

TEST(Reference, DeferredLightEqualsLightOfTheFrame) {
  const Scene scene = make_scene("object", {.texture_size = 64});
  const Image image = render(scene, {.width = 97,
                                     .height = 61,
                                     .samples = 1,
                                     .shading = Shading::kPhong,
                                     .averaging = Averaging::kLinear});
  EXPECT_EQ(light(scene, render_gbuffer(scene, 97, 61)), image);
  EXPECT_EQ(render_covered(scene, 97, 61, 1, Shading::kPhong), image);
  const LitFrames frames = render_lit_frames(scene, 33, 31, 3, {}, Shading::kPhong);
  EXPECT_EQ(frames.reference, render(scene, {.width = 33,
                                             .height = 31,
                                             .samples = 3,
                                             .shading = Shading::kPhong,
                                             .averaging = Averaging::kLinear}));
  EXPECT_EQ(frames.noaa, render_covered(scene, 33, 31, 1, Shading::kPhong));
}

// Coverage samples lie at the centres of equal parts of the pixel.
TEST(Covered, CountsItsSamples) {
  for (const int samples : {1, 2, 3, 8}) {
    FlatScreen screen(16);
    const double at = 5 + 1.0 / 3;
    screen.rectangle(at, -1, 40, 40);
    screen.scene().lighting = {.key = 0, .fill = 0, .ambient = 1};
    int inside = 0;
    for (int i = 0; i < samples; ++i) inside += (2 * i + 1.0) / (2 * samples) > 1.0 / 3 ? 1 : 0;
    EXPECT_EQ(render_covered(screen.scene(), 16, 16, samples).at(5, 8)[0],
              std::lround(255 * std::pow(inside / double(samples), 1 / 2.2)))
        << samples;
  }
  EXPECT_THROW(render_covered(FlatScreen(16).scene(), 16, 16, 0), spec::ConfigError);
}

TEST(Reference, RejectsInvalidRequests) {
  const Scene scene = make_scene("quad", {.texture_size = 16});
  EXPECT_THROW(render(scene, texture_options(16, 0)), spec::ConfigError);
  EXPECT_THROW(render(scene, texture_options(16, 33)), spec::ConfigError);
  EXPECT_THROW(render(scene, texture_options(9000, 1)), spec::ConfigError);
}

// ---- Comparison with another program -----------------------------------------------------------

Scene track(const std::filesystem::path& data) {
  SceneOptions options;
  options.camera = Camera{{4.6, 2.6, 12.5}, {-0.6, 0.4, -4}, {0, 1, 0}, 1.0, 0.1};
  return import_scene(data / "meshes" / "scene_track.obj", options);
}

TEST(Data, TrackDepthMatchesOtherRenderer) {
  DEBURR_REQUIRE_DATA(data);
  const DepthImage theirs = read_depth(data / "frames" / "track_720p_depth24.png");
  Scene scene = track(data);
  const DepthImage ours = render_depth(scene, theirs.width, theirs.height);
  std::int64_t close = 0, far = 0;
  for (std::size_t i = 0; i < ours.pixels.size(); ++i) {
    const double difference = std::abs(ours.pixels[i] - theirs.pixels[i]);
    close += difference < 2e-7 ? 1 : 0;  // three steps of 2^-24
    far += difference > 1e-3 ? 1 : 0;
  }
  const auto pixels = static_cast<double>(ours.pixels.size());
  RecordProperty("close_percent", std::to_string(100.0 * static_cast<double>(close) / pixels));
  EXPECT_GT(static_cast<double>(close), 0.999 * pixels);
  EXPECT_LT(static_cast<double>(far), 0.001 * pixels);
  // The injected fault: a camera moved by a centimetre is detected.
  scene.camera.eye.x += 0.01;
  const DepthImage moved = render_depth(scene, theirs.width, theirs.height);
  close = 0;
  for (std::size_t i = 0; i < moved.pixels.size(); ++i)
    close += std::abs(moved.pixels[i] - theirs.pixels[i]) < 2e-7 ? 1 : 0;
  EXPECT_LT(static_cast<double>(close), 0.9 * pixels);
}

TEST(Data, FramesOfTrackMatchOtherRenderer) {
  DEBURR_REQUIRE_DATA(data);
  const Image theirs = read_image(data / "frames" / "track_720p_noaa.png");
  RenderOptions options;
  options.width = theirs.width;
  options.height = theirs.height;
  options.shading = Shading::kLit;
  options.averaging = Averaging::kLinear;
  EXPECT_GT(psnr(render(track(data), options), theirs), 26.0);  // the lights differ
}

// Only edges are smoothed: elsewhere a pixel equals that of one sample, including textures.
TEST(Covered, EqualsOneSampleExceptAtEdges) {
  SceneOptions options;
  options.texture_size = 256;
  const Scene scene = make_scene("object", options);
  const LitFrames lit = render_lit_frames(scene, 160, 120, 8);
  EXPECT_EQ(render_covered(scene, 160, 120, 1), lit.noaa);
  const Image covered = render_covered(scene, 160, 120, 8);
  const Mask edges = edge_mask(covered, lit.noaa);
  EXPECT_GT(count(edges), 300);
  EXPECT_LT(count(edges), 160 * 120 / 8);
  // Supersampling also blurs the texture.
  EXPECT_GT(count(edge_mask(lit.reference, lit.noaa)), 2 * count(edges));
  // Both have the same coverage.
  EXPECT_GT(psnr(covered, lit.reference, edges), psnr(lit.noaa, lit.reference, edges) + 4.0);
  EXPECT_THROW(render_covered(scene, 8, 8, 9), spec::ConfigError);
}

}  // namespace
}  // namespace deburr::tb::reference_test
