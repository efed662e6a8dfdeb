// SPDX-License-Identifier: MIT
#include "studies/training/training_frames.h"

#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <fstream>
#include <utility>

#include "spec/error.h"
#include "studies/training/stand_ins.h"
#include "studies/training/training_scenes.h"
#include "tb/base/random.h"
#include "tb/scene/exact_math.h"
#include "tb/scene/image_io.h"
#include "tb/scene/label.h"
#include "tb/scene/reference.h"

namespace deburr::studies::training {

using tb::Rgba8;

namespace {

template <class Pixel>
void put(std::ofstream& file, const tb::ImageOf<Pixel>& image) {
  file.write(reinterpret_cast<const char*>(image.pixels.data()),
             static_cast<std::streamsize>(image.pixels.size() * sizeof(Pixel)));
}
template <class Pixel>
bool get(std::ifstream& file, tb::ImageOf<Pixel>& image) {
  return static_cast<bool>(
      file.read(reinterpret_cast<char*>(image.pixels.data()),
                static_cast<std::streamsize>(image.pixels.size() * sizeof(Pixel))));
}

// Frames of scenes, rendered or read from the cache.
class Renderer {
 public:
  explicit Renderer(const FrameOptions& options) : options_(options) {}

  // The reference smooths edges and textures, or only edges.
  enum class Reference : std::uint8_t { kAll, kEdges };

  FrameSource source(const std::string& name, const std::string& group,
                     const std::function<tb::Scene()>& make,
                     Reference reference = Reference::kAll) const {
    return {name, group,
            [options = options_, name, group, make, reference] {
              return rendered(options, name, group, make, reference);
            },
            [make] { return make().mesh; }};
  }

  // The same scene from `views` cameras; the first is its own.
  template <class MakeScene>
  void add(std::vector<FrameSource>& frames, const std::string& group, int views,
           const MakeScene& make) const {
    for (int view = 0; view < views; ++view) {
      const std::string name = fmt::format("{}_{}x{}{}", group, options_.size, options_.size,
                                           view == 0 ? std::string() : fmt::format("_{}", view));
      frames.push_back(source(name, group, [make, view] {
        tb::Scene scene = make(view);
        turn(scene.camera, view);
        return scene;
      }));
    }
  }

 private:
  static ReferenceFrame rendered(const FrameOptions& options, const std::string& name,
                                 const std::string& group, const std::function<tb::Scene()>& make,
                                 Reference reference) {
    const std::filesystem::path kept =
        options.cache / fmt::format("{}_{}.frames", name, options.samples);
    const int size = options.size;
    ReferenceFrame frame{name, group, tb::Image(size, size), tb::Image(size, size),
                         tb::DepthImage(size, size)};
    if (read(options, kept, frame)) return frame;
    const tb::Scene scene = make();
    tb::LitFrames lit = tb::render_lit_frames(scene, size, size,
                                              reference == Reference::kAll ? options.samples : 1);
    frame.reference = reference == Reference::kAll
                          ? std::move(lit.reference)
                          : tb::render_covered(scene, size, size, options.samples);
    frame.frame = std::move(lit.noaa);
    frame.depth = std::move(lit.depth);
    write(options, kept, frame);
    return frame;
  }
  // Turns about the vertical axis through the target, and moves slightly closer.
  static void turn(tb::Camera& camera, int view) {
    if (view == 0) return;
    const tb::SinCos angle = tb::sin_cos(1.1 * view);
    const double near = view % 2 != 0 ? 0.7 : 0.9;
    const Imath::V3d from = (camera.eye - camera.target) * near;
    camera.eye = camera.target + Imath::V3d(from.x * angle.cos + from.z * angle.sin, from.y,
                                            from.z * angle.cos - from.x * angle.sin);
  }
  static bool read(const FrameOptions& options, const std::filesystem::path& kept,
                   ReferenceFrame& frame) {
    if (options.cache.empty()) return false;
    std::ifstream file(kept, std::ios::binary);
    return file && get(file, frame.frame) && get(file, frame.reference) && get(file, frame.depth);
  }
  static void write(const FrameOptions& options, const std::filesystem::path& kept,
                    const ReferenceFrame& frame) {
    if (options.cache.empty()) return;
    std::filesystem::create_directories(options.cache);
    std::ofstream file(kept, std::ios::binary);
    put(file, frame.frame);
    put(file, frame.reference);
    put(file, frame.depth);
  }

  FrameOptions options_;
};

void add_meshes(std::vector<FrameSource>& frames, const FrameOptions& options,
                const std::vector<std::string>& meshes, int views) {
  const Renderer renderer(options);
  for (const std::string& mesh : meshes) {
    const std::filesystem::path path = options.data / mesh;
    if (!std::filesystem::exists(path))
      throw spec::FileError(fmt::format(
          "mesh '{}' not found: give the folder that has it with --data", path.string()));
    // The first view matches the other tables, with a checkerboard if the mesh lacks a texture.
    renderer.add(frames, path.filename().string(), views, [path](int view) {
      tb::SceneOptions plain;
      plain.plain = view != 0;
      return tb::import_scene(path, plain);
    });
  }
}

// Procedural meshes, first with a checkerboard and then in their own colours.
void add_stand_ins(std::vector<FrameSource>& frames, const FrameOptions& options,
                   const std::vector<std::uint64_t>& seeds, int views) {
  const Renderer renderer(options);
  for (const char* kind : {"street", "vehicle", "forest"}) {
    for (const std::uint64_t seed : seeds) {
      const std::string group = fmt::format("{}{}", kind, seed);
      renderer.add(frames, group, views, [kind, seed, group](int view) {
        const std::filesystem::path folder =
            std::filesystem::temp_directory_path() /
            fmt::format("deburr_training_{}_{}", group, ::getpid());
        std::filesystem::create_directories(folder);
        tb::SceneOptions plain;
        plain.plain = view != 0;
        tb::Scene made = tb::import_scene(write_stand_in(folder, kind, seed), plain);
        std::filesystem::remove_all(folder);
        return made;
      });
    }
  }
}

void add_shapes(std::vector<FrameSource>& frames, const FrameOptions& options,
                std::uint64_t first_seed, int number) {
  for (int i = 0; i < number; ++i) {
    const std::uint64_t seed = first_seed + static_cast<std::uint64_t>(i);
    const std::string name = fmt::format("shapes{}", seed);
    frames.push_back({name, name, [size = options.size, samples = options.samples, seed] {
                        return shapes_frame(size, size, samples, seed);
                      }});
  }
}

// Some scenes with textures also get a reference with unfiltered textures, which teaches the
// weights not to blend them.
void add_training_scenes(std::vector<FrameSource>& frames, const FrameOptions& options,
                         std::uint64_t first_seed, int seeds, int views, int kept_textures) {
  const Renderer renderer(options);
  for (const std::string_view kind : training_scene_kinds()) {
    for (int i = 0; i < seeds; ++i) {
      const std::uint64_t seed = first_seed + static_cast<std::uint64_t>(i);
      const std::string group = fmt::format("{}{}", kind, seed);
      for (int view = 0; view < views; ++view) {
        const auto make = [kind, seed, view] { return training_scene(kind, seed, view); };
        const std::string name = fmt::format("{}_{}", group, view);
        frames.push_back(renderer.source(name, group, make));
        if (i < kept_textures && (kind == "room" || kind == "signs"))
          frames.push_back(
              renderer.source(name + "_edges", group, make, Renderer::Reference::kEdges));
      }
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
  return v <= 0.04045 ? v / 12.92 : tb::power((v + 0.055) / 1.055, 2.4);
}
std::uint8_t encoded(double l) {
  const double v = l <= 0.0031308 ? 12.92 * l : 1.055 * tb::power(l, 1 / 2.4) - 0.055;
  return static_cast<std::uint8_t>(std::floor(255 * v + 0.5));
}

}  // namespace

ReferenceFrame shapes_frame(int width, int height, int samples, std::uint64_t seed) {
  tb::Random random(seed, "shapes");
  const auto colour = [&] {
    Rgba8 c{0, 0, 0, 255};
    for (std::size_t i = 0; i < 3; ++i) c[i] = static_cast<std::uint8_t>(random.below(256));
    return c;
  };
  const Rgba8 ground = colour();
  std::vector<Shape> shapes;
  for (int i = 0; i < 60; ++i) {
    const double angle = random.uniform(0, 2 * tb::kPi);
    const double size =
        tb::exponential(random.uniform(tb::logarithm(3.0), tb::logarithm(0.3 * width)));
    const auto kind = static_cast<Shape::Kind>(random.below(3));
    const double x = random.uniform(0, width), y = random.uniform(0, height);
    const double thin = random.uniform(0.02, 1);
    const tb::SinCos turn = tb::sin_cos(angle);
    shapes.push_back({kind, x, y, size, std::max(0.6, size * thin), turn.cos, turn.sin, colour()});
  }
  const auto at = [&](double x, double y) -> const Rgba8& {
    for (auto shape = shapes.rbegin(); shape != shapes.rend(); ++shape)
      if (shape->covers(x, y)) return shape->colour;
    return ground;
  };
  ReferenceFrame result;
  result.group = result.name = fmt::format("shapes{}", seed);
  result.frame = result.reference = tb::Image(width, height);
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
        result.reference.at(x, y)[k] = encoded(sum[k] / (samples * samples));
      result.reference.at(x, y)[3] = 255;
    }
  }
  return result;
}

Overlaid overlaid(const ReferenceFrame& frame) {
  Overlaid result{frame, tb::Mask(frame.frame.width, frame.frame.height)};
  result.frame.name += "_text";
  tb::Random random(3, frame.name);
  constexpr Rgba8 kInk{255, 255, 255, 255}, kPaper{0, 0, 0, 0};
  for (int y = 6; y < frame.frame.height;) {
    const int scale = random.between(1, 3);
    const tb::Image line =
        tb::label("speed 184.5 lap 3 of 12 - fuel 62 - frame time 16.7 ms", scale, kInk, kPaper);
    const int x0 = random.between(0, 40);
    const auto code = [&] { return static_cast<std::uint8_t>(random.below(256)); };
    const Rgba8 colour = random.chance(500) ? kInk : Rgba8{code(), code(), code(), 255};
    for (int j = 0; j < line.height && y + j < frame.frame.height; ++j) {
      for (int i = 0; i < line.width && x0 + i < frame.frame.width; ++i) {
        if (line.at(i, j) != kInk) continue;
        result.frame.frame.at(x0 + i, y + j) = result.frame.reference.at(x0 + i, y + j) = colour;
        result.ink.at(x0 + i, y + j) = 1;
      }
    }
    y += line.height + 30;
  }
  return result;
}

std::vector<FrameSource> training_set(const FrameOptions& options) {
  std::vector<FrameSource> frames;
  const Renderer renderer(options);
  for (const tb::SceneName& scene : tb::scene_names()) {
    const std::string name(scene.name);
    renderer.add(frames, name, 1, [name](int) { return tb::make_scene(name); });
  }
  add_stand_ins(frames, options, {11, 12}, 2);
  add_shapes(frames, options, 100, 6);
  add_training_scenes(frames, options, 1, 4, 3, 2);
  return frames;
}

std::vector<FrameSource> mesh_set(const FrameOptions& options) {
  std::vector<FrameSource> frames;
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
      5);
  return frames;
}

std::vector<FrameSource> held_out_set(const FrameOptions& options) {
  std::vector<FrameSource> frames;
  add_stand_ins(frames, options, {1}, 1);
  add_shapes(frames, options, 1, 3);
  add_training_scenes(frames, options, 901, 1, 1, 0);
  if (options.data.empty()) return frames;
  const auto add_track = [&](const std::string& size, const char* reference, bool depth) {
    const auto file = [folder = options.data / "frames", size](const std::string& what) {
      std::filesystem::path path = folder / fmt::format("track_{}_{}.png", size, what);
      if (!std::filesystem::exists(path))
        throw spec::FileError(fmt::format(
            "frame '{}' not found: give the folder that has it with --data", path.string()));
      return path;
    };
    const std::filesystem::path noaa = file("noaa"), ssaa = file(reference),
                                depths = depth ? file("depth24") : std::filesystem::path();
    const std::string name = "track_" + size;
    frames.push_back({name, "track",
                      [name, noaa, ssaa, depths] {
                        return ReferenceFrame{
                            name, "track", tb::read_image(noaa), tb::read_image(ssaa),
                            depths.empty() ? tb::DepthImage() : tb::read_depth(depths)};
                      },
                      nullptr});
  };
  add_track("720p", "ssaa256", true);
  add_track("1080p", "ssaa64", false);
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

}  // namespace deburr::studies::training
