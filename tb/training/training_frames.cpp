// SPDX-License-Identifier: MIT
#include "tb/training/training_frames.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <fstream>
#include <numbers>
#include <utility>

#include "tb/base/random.h"
#include "tb/scene/image_io.h"
#include "tb/scene/label.h"
#include "tb/scene/truth.h"
#include "tb/training/stand_ins.h"

namespace deburr::tb::training {
namespace {

template <class Pixel>
void put(std::ofstream& file, const ImageOf<Pixel>& image) {
  file.write(reinterpret_cast<const char*>(image.pixels.data()),
             static_cast<std::streamsize>(image.pixels.size() * sizeof(Pixel)));
}
template <class Pixel>
bool get(std::ifstream& file, ImageOf<Pixel>& image) {
  return static_cast<bool>(
      file.read(reinterpret_cast<char*>(image.pixels.data()),
                static_cast<std::streamsize>(image.pixels.size() * sizeof(Pixel))));
}

class Renderer {
 public:
  explicit Renderer(const FrameOptions& options) : options_(options) {}

  // The same scene from `views` sides, the first one its own.
  template <class MakeScene>
  void add(std::vector<TruthFrame>& frames, const std::string& group, int views, int width,
           int height, const MakeScene& make) const {
    for (int view = 0; view < views; ++view) {
      TruthFrame frame;
      frame.name = fmt::format("{}_{}x{}{}", group, width, height,
                               view == 0 ? std::string() : fmt::format("_{}", view));
      frame.group = group;
      if (options_.progress) options_.progress(frame.name);
      const std::filesystem::path kept =
          options_.cache / fmt::format("{}_{}.frames", frame.name, options_.samples);
      frame.frame = frame.truth = Image(width, height);
      frame.depth = DepthImage(width, height);
      if (!read(kept, frame)) {
        Scene scene = make(view);
        turn(scene.camera, view);
        LitFrames lit = render_lit_frames(scene, width, height, options_.samples);
        frame.frame = std::move(lit.noaa);
        frame.truth = std::move(lit.truth);
        frame.depth = std::move(lit.depth);
        write(kept, frame);
      }
      frames.push_back(std::move(frame));
    }
  }

 private:
  // About the upright axis through the target, and a little nearer.
  static void turn(Camera& camera, int view) {
    if (view == 0) return;
    const double angle = 1.1 * view, near = view % 2 != 0 ? 0.7 : 0.9;
    const Imath::V3d from = (camera.eye - camera.target) * near;
    camera.eye =
        camera.target + Imath::V3d(from.x * std::cos(angle) + from.z * std::sin(angle), from.y,
                                   from.z * std::cos(angle) - from.x * std::sin(angle));
  }
  bool read(const std::filesystem::path& kept, TruthFrame& frame) const {
    if (options_.cache.empty()) return false;
    std::ifstream file(kept, std::ios::binary);
    return file && get(file, frame.frame) && get(file, frame.truth) && get(file, frame.depth);
  }
  void write(const std::filesystem::path& kept, const TruthFrame& frame) const {
    if (options_.cache.empty()) return;
    std::filesystem::create_directories(options_.cache);
    std::ofstream file(kept, std::ios::binary);
    put(file, frame.frame);
    put(file, frame.truth);
    put(file, frame.depth);
  }

  const FrameOptions& options_;
};

// Adds those of the meshes that the data folder has.
void add_meshes(std::vector<TruthFrame>& frames, const FrameOptions& options,
                const std::vector<std::string>& meshes, int views) {
  const Renderer renderer(options);
  for (const std::string& mesh : meshes) {
    const std::filesystem::path path = options.data / mesh;
    if (options.data.empty() || !std::filesystem::exists(path)) continue;
    // The first one as other tables show it, with a checkerboard where the mesh has no texture.
    renderer.add(frames, path.filename().string(), views, options.size, options.size,
                 [&](int view) {
                   SceneOptions plain;
                   plain.plain = view != 0;
                   return import_scene(path, plain);
                 });
  }
}

// Meshes made by formula, seen with a checkerboard first and then in their own colours.
void add_stand_ins(std::vector<TruthFrame>& frames, const FrameOptions& options,
                   const std::vector<std::uint64_t>& seeds, int views) {
  const Renderer renderer(options);
  for (const char* kind : {"street", "vehicle", "forest"}) {
    for (const std::uint64_t seed : seeds) {
      const std::string group = fmt::format("{}{}", kind, seed);
      renderer.add(frames, group, views, options.size, options.size, [&](int view) {
        const std::filesystem::path folder =
            std::filesystem::temp_directory_path() / fmt::format("deburr_training_{}", group);
        std::filesystem::create_directories(folder);
        SceneOptions plain;
        plain.plain = view != 0;
        Scene made = import_scene(write_stand_in(folder, kind, seed), plain);
        std::filesystem::remove_all(folder);
        return made;
      });
    }
  }
}

struct Shape {
  enum class Kind : std::uint8_t { kDisc, kBar, kTriangle } kind;
  double x, y, size, width, cosine, sine;
  Rgba8 colour;
  bool covers(double px, double py) const {
    const double u = (px - x) * cosine + (py - y) * sine, v = (py - y) * cosine - (px - x) * sine;
    switch (kind) {
      case Kind::kDisc:
        return u * u + v * v < size * size;
      case Kind::kBar:
        return std::abs(u) < size && std::abs(v) < width;
      case Kind::kTriangle:
        break;
    }
    return u > -size && std::abs(v) < (size - u) * width / size;
  }
};

double decoded(std::uint8_t code) {
  const double v = code / 255.0;
  return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}
std::uint8_t encoded(double l) {
  const double v = l <= 0.0031308 ? 12.92 * l : 1.055 * std::pow(l, 1 / 2.4) - 0.055;
  return static_cast<std::uint8_t>(std::floor(255 * v + 0.5));
}

}  // namespace

TruthFrame shapes_frame(int width, int height, int samples, std::uint64_t seed) {
  Random random(seed, "shapes");
  const auto colour = [&] {
    Rgba8 c{0, 0, 0, 255};
    for (std::size_t i = 0; i < 3; ++i) c[i] = static_cast<std::uint8_t>(random.below(256));
    return c;
  };
  const Rgba8 ground = colour();
  std::vector<Shape> shapes;
  for (int i = 0; i < 60; ++i) {
    const double angle = random.uniform(0, 2 * std::numbers::pi);
    const double size = std::exp(random.uniform(std::log(3.0), std::log(0.3 * width)));
    const auto kind = static_cast<Shape::Kind>(random.below(3));
    const double x = random.uniform(0, width), y = random.uniform(0, height);
    const double thin = random.uniform(0.02, 1);
    shapes.push_back(
        {kind, x, y, size, std::max(0.6, size * thin), std::cos(angle), std::sin(angle), colour()});
  }
  const auto at = [&](double x, double y) -> const Rgba8& {
    for (auto shape = shapes.rbegin(); shape != shapes.rend(); ++shape)
      if (shape->covers(x, y)) return shape->colour;
    return ground;
  };
  TruthFrame result;
  result.group = result.name = fmt::format("shapes{}", seed);
  result.frame = result.truth = Image(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      result.frame.at(x, y) = at(x + 0.5, y + 0.5);
      std::array<double, 3> sum{};
      for (int j = 0; j < samples; ++j) {
        for (int i = 0; i < samples; ++i) {
          const Rgba8& c = at(x + (i + 0.5) / samples, y + (j + 0.5) / samples);
          for (std::size_t k = 0; k < 3; ++k) sum[k] += decoded(c[k]);
        }
      }
      for (std::size_t k = 0; k < 3; ++k)
        result.truth.at(x, y)[k] = encoded(sum[k] / (samples * samples));
      result.truth.at(x, y)[3] = 255;
    }
  }
  return result;
}

Overlaid overlaid(const TruthFrame& frame) {
  Overlaid result{frame, Mask(frame.frame.width, frame.frame.height)};
  result.frame.name += "_text";
  Random random(3, frame.name);
  constexpr Rgba8 kInk{255, 255, 255, 255}, kPaper{0, 0, 0, 0};
  for (int y = 6; y < frame.frame.height;) {
    const int scale = random.between(1, 3);
    const Image line =
        label("speed 184.5 lap 3 of 12 - fuel 62 - frame time 16.7 ms", scale, kInk, kPaper);
    const int x0 = random.between(0, 40);
    const auto code = [&] { return static_cast<std::uint8_t>(random.below(256)); };
    const Rgba8 colour = random.chance(500) ? kInk : Rgba8{code(), code(), code(), 255};
    for (int j = 0; j < line.height && y + j < frame.frame.height; ++j) {
      for (int i = 0; i < line.width && x0 + i < frame.frame.width; ++i) {
        if (line.at(i, j) != kInk) continue;
        result.frame.frame.at(x0 + i, y + j) = result.frame.truth.at(x0 + i, y + j) = colour;
        result.ink.at(x0 + i, y + j) = 1;
      }
    }
    y += line.height + 30;
  }
  return result;
}

std::vector<TruthFrame> own_frames(const FrameOptions& options) {
  const Renderer renderer(options);
  std::vector<TruthFrame> frames;
  const int size = options.size;
  for (const SceneName& scene : scene_names()) {
    const std::string name(scene.name);
    // Those of the quality matrix, in its size; the others from two sides.
    renderer.add(frames, name, 1, size, size, [&](int) { return make_scene(name); });
  }
  add_stand_ins(frames, options, {11, 12}, 2);
  for (int i = 0; i < options.shapes; ++i)
    frames.push_back(
        shapes_frame(size, size, options.samples, 100 + static_cast<std::uint64_t>(i)));
  return frames;
}

std::vector<TruthFrame> mesh_frames(const FrameOptions& options) {
  std::vector<TruthFrame> frames;
  add_meshes(
      frames, options,
      {"meshes/teapot.obj", "meshes/spot.obj", "meshes/kenney_truck.obj", "meshes/WusonOBJ.obj",
       "meshes/wing.obj", "meshes/wheelcover.obj", "meshes/canopy_open.obj",
       "meshes/terrain_open.obj", "kenney/city/models/building-garage.glb",
       "kenney/city/models/building-small-a.glb", "kenney/city/models/building-small-c.glb",
       "kenney/city/models/road-straight-lightposts.glb",
       "kenney/city/models/pavement-fountain.glb", "kenney/city/models/grass-trees-tall.glb",
       "kenney/racing/models/vehicle-truck-red.glb", "kenney/racing/models/vehicle-motorcycle.glb",
       "kenney/racing/models/track-finish.glb", "kenney/racing/models/decoration-tents.glb",
       "kenney/racing/models/decoration-forest.glb"},
      options.views);
  return frames;
}

std::vector<TruthFrame> held_out_frames(const FrameOptions& options) {
  std::vector<TruthFrame> frames;
  add_stand_ins(frames, options, {1}, 1);
  for (const std::uint64_t seed : {1, 2, 3})
    frames.push_back(shapes_frame(options.size, options.size, options.samples, seed));
  const std::filesystem::path folder = options.data / "frames";
  if (!options.data.empty() && std::filesystem::exists(folder / "track_720p_noaa.png")) {
    frames.push_back({"track_720p", "track", read_image(folder / "track_720p_noaa.png"),
                      read_image(folder / "track_720p_ssaa256.png"),
                      read_depth(folder / "track_720p_depth24.png")});
    frames.push_back({"track_1080p",
                      "track",
                      read_image(folder / "track_1080p_noaa.png"),
                      read_image(folder / "track_1080p_ssaa64.png"),
                      {}});
  }
  add_meshes(
      frames, options,
      {"kenney/city/models/building-small-b.glb", "kenney/city/models/building-small-d.glb",
       "kenney/city/models/grass-trees.glb", "kenney/city/models/grass.glb",
       "kenney/city/models/pavement.glb", "kenney/city/models/road-split.glb",
       "kenney/city/models/road-straight.glb", "kenney/city/models/road-corner.glb",
       "kenney/city/models/road-intersection.glb", "kenney/racing/models/track-corner.glb",
       "kenney/racing/models/track-bump.glb", "kenney/racing/models/track-straight.glb",
       "kenney/racing/models/track-tents.glb", "kenney/racing/models/vehicle-truck-purple.glb",
       "kenney/racing/models/vehicle-truck-yellow.glb",
       "kenney/racing/models/vehicle-truck-green.glb", "kenney/racing/models/decoration-empty.glb"},
      1);
  return frames;
}

}  // namespace deburr::tb::training
