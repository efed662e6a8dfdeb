// SPDX-License-Identifier: MIT
#include "tb/scene/reference.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <vector>

#include "spec/error.h"
#include "tb/base/interrupt.h"
#include "tb/scene/exact_math.h"
#include "tb/scene/setup.h"
#include "tb/scene/textures.h"

namespace deburr::tb {
namespace {

using Imath::V3d;

constexpr int kMaxSamples = 32;
constexpr double kGamma = 2.2;

// The transfer function with which stored bytes are decoded for averaging.
enum class Transfer : std::uint8_t { kStored, kSrgb, kGamma22 };

class Transport {
 public:
  std::array<float, 256> decode{};

  explicit Transport(Transfer transfer) {
    const auto decoded = [&](double x) {
      return transfer == Transfer::kStored ? x
             : transfer == Transfer::kSrgb ? srgb_to_linear(x)
                                           : power(x, kGamma);
    };
    for (std::size_t v = 0; v < 256; ++v)
      decode[v] = static_cast<float>(decoded(static_cast<double>(v) / 255.0));
    for (std::size_t v = 0; v < 255; ++v)
      next_[v] = decoded((static_cast<double>(v) + 0.5) / 255.0);
  }
  // The nearest byte; halves are rounded up.
  std::uint8_t encode(double value) const {
    return static_cast<std::uint8_t>(std::upper_bound(next_.begin(), next_.end(), value) -
                                     next_.begin());
  }

 private:
  std::array<double, 255> next_{};  // lower bound of byte v + 1
};

using Colour = std::array<float, 4>;

// floor() without a library call, saturating; NaN gives the lower limit.
int floor_to_int(double value) {
  constexpr double kLimit = 1 << 30;
  const double limited = value > -kLimit ? (value < kLimit ? value : kLimit) : -kLimit;
  const int truncated = static_cast<int>(limited);
  return truncated - (limited < truncated ? 1 : 0);
}

int wrap_texel(int i, int size, spec::texture::Wrap wrap) {
  if (wrap == spec::texture::Wrap::kClampToEdge) return std::clamp(i, 0, size - 1);
  if (wrap == spec::texture::Wrap::kRepeat) {
    if (static_cast<unsigned>(i) < static_cast<unsigned>(size)) return i;
    const int r = i % size;
    return r < 0 ? r + size : r;
  }
  const int period = 2 * size;
  int r = i % period;
  if (r < 0) r += period;
  return r < size ? r : period - 1 - r;
}

class TextureReader {
 public:
  TextureReader(const Texture& texture, const Transport& transport, bool mipmaps)
      : transport_(transport), wrap_s_(texture.wrap_s), wrap_t_(texture.wrap_t) {
    if (mipmaps)
      levels_ = mip_chain(texture.image, MipSpace::kSrgb);
    else
      levels_.push_back(texture.image);
    const Rgba8& first = levels_[0].pixels[0];
    plain_ = std::all_of(levels_.begin(), levels_.end(), [&](const Image& level) {
      return std::all_of(level.pixels.begin(), level.pixels.end(),
                         [&](const Rgba8& texel) { return texel == first; });
    });
  }
  // All texels are equal, so every filter returns them.
  bool plain() const { return plain_; }
  int width() const { return levels_[0].width; }
  int height() const { return levels_[0].height; }

  Colour nearest(double s, double t) const {
    const Image& image = levels_[0];
    return decode(image, floor_to_int(s * image.width), floor_to_int(t * image.height));
  }

  Colour bilinear(double s, double t, std::size_t level = 0) const {
    const Image& image = levels_[level];
    const double u = s * image.width - 0.5, v = t * image.height - 0.5;
    const int i = floor_to_int(u), j = floor_to_int(v);
    const auto a = static_cast<float>(u - i), b = static_cast<float>(v - j);
    const Colour c00 = decode(image, i, j), c10 = decode(image, i + 1, j);
    const Colour c01 = decode(image, i, j + 1), c11 = decode(image, i + 1, j + 1);
    Colour result;
    for (std::size_t c = 0; c < 4; ++c) {
      const float top = c00[c] + (c10[c] - c00[c]) * a, bottom = c01[c] + (c11[c] - c01[c]) * a;
      result[c] = top + (bottom - top) * b;
    }
    return result;
  }

  Colour trilinear(double s, double t, double lod) const {
    const double limit = static_cast<double>(levels_.size() - 1);
    lod = std::clamp(lod, 0.0, limit);
    const auto level = static_cast<std::size_t>(lod);
    const auto fraction = static_cast<float>(lod - static_cast<double>(level));
    Colour result = bilinear(s, t, level);
    if (fraction == 0.0f) return result;
    const Colour coarse = bilinear(s, t, level + 1);
    for (std::size_t c = 0; c < 4; ++c) result[c] += (coarse[c] - result[c]) * fraction;
    return result;
  }

 private:
  Colour decode(const Image& image, int i, int j) const {
    const Rgba8& texel =
        image.at(wrap_texel(i, image.width, wrap_s_), wrap_texel(j, image.height, wrap_t_));
    return {transport_.decode[texel[0]], transport_.decode[texel[1]], transport_.decode[texel[2]],
            static_cast<float>(texel[3]) * (1.0f / 255.0f)};
  }

  const Transport& transport_;
  spec::texture::Wrap wrap_s_, wrap_t_;
  std::vector<Image> levels_;
  bool plain_ = false;
};

// Per-triangle data for shading its samples.
struct ShadedSurface {
  V3d s, t;                   // at the corners
  V3d light;                  // at the corners, relative to white
  std::array<V3d, 3> normal;  // at the corners, x of all three first
  V3d colour;                 // of the material
  int texture = -1;
};

double light_on(const Lighting& lighting, const V3d& normal) {
  const double key = std::max(0.0, normal.dot(lighting.key_direction.normalized()));
  const double fill = std::max(0.0, normal.dot(lighting.fill_direction.normalized()));
  return lighting.ambient + lighting.key * key + lighting.fill * fill;
}

ShadedSurface make_surface(const Scene& scene, const Triangle& triangle) {
  const Mesh& mesh = scene.mesh;
  const std::array<const Vertex*, 3> v{&mesh.vertices[triangle.vertex[0]],
                                       &mesh.vertices[triangle.vertex[1]],
                                       &mesh.vertices[triangle.vertex[2]]};
  ShadedSurface surface;
  surface.s = {v[0]->uv.x, v[1]->uv.x, v[2]->uv.x};
  surface.t = {v[0]->uv.y, v[1]->uv.y, v[2]->uv.y};
  surface.colour = mesh.materials[triangle.material].colour;
  surface.texture = mesh.materials[triangle.material].texture;
  V3d face = (v[1]->position - v[0]->position).cross(v[2]->position - v[0]->position).normalized();
  // Surfaces are lit from both sides: normals face the eye, decided once per triangle.
  const double side = face.dot(scene.camera.eye - v[0]->position) < 0.0 ? -1.0 : 1.0;
  for (int i = 0; i < 3; ++i) {
    const V3d& normal = v[static_cast<std::size_t>(i)]->normal;
    const bool smooth = scene.lighting.smooth && normal.length2() > 0.0;
    // A vertex normal points to the side that the modeller intended as the outside.
    const double outside = smooth && normal.dot(face) < 0.0 ? -side : side;
    const V3d turned = smooth ? normal * outside : face * side;
    surface.light[i] = light_on(scene.lighting, turned);
    for (int axis = 0; axis < 3; ++axis)
      surface.normal[static_cast<std::size_t>(axis)][i] = turned[axis];
  }
  return surface;
}

// Colours of the samples in a section of a tile row, by channel.
using ColourRow = std::array<std::array<float, kMaxTile>, 4>;

using NormalRow = std::array<std::array<float, 3>, kMaxTile>;

Colour colour_at(const ColourRow& row, std::size_t k) {
  return {row[0][k], row[1][k], row[2][k], row[3][k]};
}

// Phong's model: diffuse, ambient and specular light from two directional lights, without shadows.
// Deferred and direct lighting both use it. The exponent is a power of two, so multiplications
// suffice, and these give the same bits on every machine.
class Phong {
 public:
  explicit Phong(const Scene& scene) : lighting_(scene.lighting) {
    key_ = lighting_.key_direction.normalized();
    fill_ = lighting_.fill_direction.normalized();
  }
  // In: albedo; out: light towards the eye. `normal` as in a G-buffer; `ray` from the eye.
  void shade(const std::array<float, 3>& normal, const V3d& ray, float& r, float& g,
             float& b) const {
    const V3d n(static_cast<double>(normal[0]), static_cast<double>(normal[1]),
                static_cast<double>(normal[2]));
    const V3d to_eye = -ray.normalized();
    double diffuse = lighting_.ambient, specular = 0.0;
    add(n, to_eye, key_, lighting_.key, diffuse, specular);
    add(n, to_eye, fill_, lighting_.fill, diffuse, specular);
    for (float* const channel : {&r, &g, &b})
      *channel = std::clamp(static_cast<float>(static_cast<double>(*channel) * diffuse + specular),
                            0.0f, 1.0f);
  }

 private:
  void add(const V3d& n, const V3d& to_eye, const V3d& towards, double strength, double& diffuse,
           double& specular) const {
    const double cosine = n.dot(towards);
    if (!(cosine > 0.0)) return;
    diffuse += strength * cosine;
    double mirrored = (n * (2.0 * cosine) - towards).dot(to_eye);
    if (!(mirrored > 0.0)) return;
    for (int doubling = 0; doubling < 5; ++doubling) mirrored *= mirrored;  // ^ 32
    specular += strength * lighting_.specular * mirrored;
  }
  Lighting lighting_;
  V3d key_, fill_;
};

// Shades one primitive, in the space of the transfer function. Samples are shaded in runs, by
// branch-free loops that the compiler can vectorise. The operations for a sample and their order do
// not depend on the run.
class Shader {
 public:
  Shader(const Scene& scene, const std::vector<Primitive>& primitives, const View& view,
         const RenderOptions& options, const Transport& transport)
      : primitives_(primitives), view_(view), options_(options), phong_(scene) {
    for (const Triangle& triangle : scene.mesh.triangles)
      surfaces_.push_back(make_surface(scene, triangle));
    const bool lit = options.shading != Shading::kTexture;
    for (const Texture& texture : scene.mesh.textures)
      readers_.emplace_back(texture, transport, lit);
  }

  // Shades the centres of `count` cells, from (x, y) to the right, and writes them from
  // row[.][first] on. `cells` is the width of a pixel in cells. With `normals` (kPhong) colours are
  // unlit, and normals are written to `normals`.
  void shade(std::int32_t owner, int x, int y, int cells, int count, ColourRow& row,
             std::size_t first = 0, NormalRow* normals = nullptr) const {
    const Primitive& primitive = primitives_[static_cast<std::size_t>(owner)];
    const ShadedSurface& surface = surfaces_[primitive.triangle];
    const auto samples = static_cast<std::size_t>(count);
    const Samples at = locate(primitive, x, y, count);
    const TextureReader* reader =
        surface.texture < 0 ? nullptr : &readers_[static_cast<std::size_t>(surface.texture)];
    CellRow s, t;
    if (reader != nullptr) {
      at.interpolate(surface.s, samples, s);
      at.interpolate(surface.t, samples, t);
    }
    if (options_.shading == Shading::kTexture) {
      for (std::size_t k = 0; k < samples; ++k)
        put(reader == nullptr                         ? Colour{1, 1, 1, 1}
            : options_.sampling == Sampling::kNearest ? reader->nearest(s[k], t[k])
                                                      : reader->bilinear(s[k], t[k]),
            row, first + k);
      return;
    }
    if (reader == nullptr || reader->plain()) {
      const Colour base = reader == nullptr ? Colour{1, 1, 1, 1} : reader->nearest(0.0, 0.0);
      for (std::size_t c = 0; c < 4; ++c) std::fill_n(&row[c][first], samples, base[c]);
    } else {
      const Footprint footprint(primitive, surface, *reader, cells);
      for (std::size_t k = 0; k < samples; ++k)
        put(reader->trilinear(s[k], t[k], footprint.level(s[k], t[k], at.w[k])), row, first + k);
    }
    std::fill_n(&row[3][first], samples, 1.0f);
    if (options_.shading == Shading::kPhong) {
      for (std::size_t c = 0; c < 3; ++c)
        for (std::size_t k = first; k < first + samples; ++k)
          row[c][k] *= static_cast<float>(surface.colour[static_cast<int>(c)]);
      if (normals != nullptr) {
        normals_of(surface, at, samples, *normals, first);
        return;
      }
      NormalRow turned;
      normals_of(surface, at, samples, turned, 0);
      for (std::size_t k = 0; k < samples; ++k)
        phong_.shade(turned[k], view_.ray(x + static_cast<int>(k) + 0.5, y + 0.5),
                     row[0][first + k], row[1][first + k], row[2][first + k]);
      return;
    }
    CellRow light;
    at.interpolate(surface.light, samples, light);
    // The centre of a multi-sampled pixel can be outside the triangle; light is then extrapolated.
    for (std::size_t c = 0; c < 3; ++c) {
      const double colour = surface.colour[static_cast<int>(c)];
      float* const channel = &row[c][first];
      for (std::size_t k = 0; k < samples; ++k)
        channel[k] = std::clamp(channel[k] * static_cast<float>(light[k] * colour), 0.0f, 1.0f);
    }
  }

 private:
  static void put(const Colour& colour, ColourRow& row, std::size_t k) {
    for (std::size_t c = 0; c < 4; ++c) row[c][k] = colour[c];
  }

  // Weights of the triangle's corners, each divided by w, and w.
  struct Samples {
    CellRow x, y, z, w;
    void interpolate(const V3d& corners, std::size_t count, CellRow& value) const {
      for (std::size_t k = 0; k < count; ++k)
        value[k] = (x[k] * corners.x + y[k] * corners.y + z[k] * corners.z) * w[k];
    }
  };
  static void normals_of(const ShadedSurface& surface, const Samples& at, std::size_t count,
                         NormalRow& normals, std::size_t first) {
    CellRow nx, ny, nz;
    at.interpolate(surface.normal[0], count, nx);
    at.interpolate(surface.normal[1], count, ny);
    at.interpolate(surface.normal[2], count, nz);
    for (std::size_t k = 0; k < count; ++k) {
      const double length = std::sqrt(nx[k] * nx[k] + ny[k] * ny[k] + nz[k] * nz[k]);
      const double scale = length > 0.0 ? 1.0 / length : 0.0;
      normals[first + k] = {static_cast<float>(nx[k] * scale), static_cast<float>(ny[k] * scale),
                            static_cast<float>(nz[k] * scale)};
    }
  }
  static Samples locate(const Primitive& p, int x, int y, int count) {
    EdgeRow e;
    p.edges_of_row(p.edges(cell_centre(x), cell_centre(y)), count, e);
    Samples at;
    const auto sum = [&](std::size_t k, double w0, double w1, double w2) {
      return w0 * e[0][k] + w1 * e[1][k] + w2 * e[2][k];
    };
    for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k) {
      at.x[k] = sum(k, p.weight[0].x, p.weight[1].x, p.weight[2].x);
      at.y[k] = sum(k, p.weight[0].y, p.weight[1].y, p.weight[2].y);
      at.z[k] = sum(k, p.weight[0].z, p.weight[1].z, p.weight[2].z);
      at.w[k] = 1.0 / (at.x[k] + at.y[k] + at.z[k]);
    }
    return at;
  }

  // The texture footprint of a whole pixel. Frames with one or many samples per pixel use it, so
  // that they filter textures in the same way and differ only at edges.
  class Footprint {
   public:
    Footprint(const Primitive& p, const ShadedSurface& surface, const TextureReader& reader,
              int cells)
        : width_(reader.width()), height_(reader.height()) {
      const double step = static_cast<double>(kSubpixelOne) * cells;
      V3d dx(0, 0, 0), dy(0, 0, 0);
      for (std::size_t i = 0; i < 3; ++i) {
        dx += p.weight[i] * (static_cast<double>(p.a[i]) * step);
        dy += p.weight[i] * (static_cast<double>(p.b[i]) * step);
      }
      x_ = {dx.dot(surface.s), dx.dot(surface.t), dx.x + dx.y + dx.z};
      y_ = {dy.dot(surface.s), dy.dot(surface.t), dy.x + dy.y + dy.z};
    }
    // Base-2 logarithm of the longer side.
    double level(double s, double t, double w) const {
      const double sx = (x_.s - s * x_.sum) * w * width_, tx = (x_.t - t * x_.sum) * w * height_;
      const double sy = (y_.s - s * y_.sum) * w * width_, ty = (y_.t - t * y_.sum) * w * height_;
      const double longest = std::max(sx * sx + tx * tx, sy * sy + ty * ty);
      return longest > 0.0 ? 0.5 * std::numbers::log2e * logarithm(longest) : 0.0;
    }

   private:
    struct Step {
      double s, t, sum;  // numerators, and sum of the weights
    };
    double width_, height_;
    Step x_, y_;
  };

  const std::vector<Primitive>& primitives_;
  const View& view_;
  RenderOptions options_;
  Phong phong_;
  std::vector<ShadedSurface> surfaces_;
  std::vector<TextureReader> readers_;
};

Transport transport_of(Shading shading, Averaging averaging) {
  if (shading != Shading::kTexture) return Transport(Transfer::kGamma22);
  return Transport(averaging == Averaging::kLinear ? Transfer::kSrgb : Transfer::kStored);
}

// Sum of a pixel's samples.
struct Sum {
  std::array<double, 4> value{};
  void add(const Colour& colour) {
    for (std::size_t c = 0; c < 4; ++c) value[c] += static_cast<double>(colour[c]);
  }
};

Rgba8 finish(const Sum& sum, int samples, const Transport& transport) {
  Rgba8 pixel;
  for (std::size_t c = 0; c < 3; ++c) pixel[c] = transport.encode(sum.value[c] / samples);
  pixel[3] =
      static_cast<std::uint8_t>(std::lround(std::clamp(sum.value[3] / samples, 0.0, 1.0) * 255.0));
  return pixel;
}

Colour sky_colour(const Scene& scene, int y, int height, const Transport& transport) {
  const Rgba8 stored = sky(scene, y + 0.5, height);
  return {transport.decode[stored[0]], transport.decode[stored[1]], transport.decode[stored[2]],
          1.0f};
}

}  // namespace

Image render(const Scene& scene, const RenderOptions& options) {
  const int n = options.samples;
  if (n < 1 || n > kMaxSamples)
    throw spec::ConfigError(fmt::format(
        "{0} x {0} samples per pixel requested; expected 1 x 1 to {1} x {1}", n, kMaxSamples));
  const View view(scene.camera, options.width, options.height, n);
  const std::vector<Primitive> primitives = set_up(scene.mesh, view);
  const Transport transport = transport_of(options.shading, options.averaging);
  // Lit colours are in linear light. To average them as stored, each sample is encoded first.
  const bool encode_samples =
      options.shading != Shading::kTexture && options.averaging == Averaging::kStored;
  const Transport stored(Transfer::kStored);
  const Shader shader(scene, primitives, view, options, transport);

  const auto encoded = [&](Colour colour) {
    for (std::size_t c = 0; c < 3; ++c)
      colour[c] = stored.decode[transport.encode(static_cast<double>(colour[c]))];
    return colour;
  };
  const auto finished = [&](const Sum& sum) {
    return finish(sum, n * n, encode_samples ? stored : transport);
  };

  const int tile_pixels = std::max(1, kMaxTile / n), tile = tile_pixels * n;
  const Occlusion occlusion(primitives, view.width(), view.height(), tile);
  std::vector<std::int32_t> owners;
  std::vector<double> depths;
  ColourRow colours;
  std::vector<Sum> sums;
  Image image(options.width, options.height);
  for (int row = 0; row < occlusion.rows(); ++row) {
    if (options.interrupted && options.interrupted()) throw Interrupted();
    const int y_begin = row * tile_pixels;
    const int y_end = std::min(options.height, y_begin + tile_pixels);
    for (int y = y_begin; y < y_end; ++y) {
      Sum sum;
      Colour background = sky_colour(scene, y, options.height, transport);
      if (encode_samples) background = encoded(background);
      for (int k = 0; k < n * n; ++k) sum.add(background);
      std::fill_n(&image.at(0, y), options.width, finished(sum));
    }
    for (int column = 0; column < occlusion.columns(); ++column) {
      if (!occlusion.occupied(column, row)) continue;
      occlusion.resolve(column, row, 0, 0, owners, depths);
      const int x_begin = column * tile_pixels;
      const int pixels = std::min(options.width - x_begin, tile_pixels);
      for (int y = y_begin; y < y_end; ++y) {
        const auto samples = owners.begin() + std::ptrdiff_t{y - y_begin} * n * tile;
        if (std::all_of(samples, samples + std::ptrdiff_t{n} * tile,
                        [](std::int32_t owner) { return owner == kNobody; }))
          continue;
        const auto background = sky_colour(scene, y, options.height, transport);
        sums.assign(static_cast<std::size_t>(pixels), Sum());
        for (int j = y * n; j < (y + 1) * n; ++j) {
          const std::int32_t* const line = &owners[0] + std::ptrdiff_t{j - row * tile} * tile;
          for (int i = 0, end = 0; i < pixels * n; i = end) {
            while (end < pixels * n && line[end] == line[i]) ++end;
            if (line[i] == kNobody)
              for (std::size_t c = 0; c < 4; ++c)
                std::fill(&colours[c][static_cast<std::size_t>(i)], &colours[c][0] + end,
                          background[c]);
            else
              shader.shade(line[i], column * tile + i, j, n, end - i, colours,
                           static_cast<std::size_t>(i));
          }
          for (std::size_t x = 0, k = 0; x < sums.size(); ++x)
            for (const std::size_t last = k + static_cast<std::size_t>(n); k < last; ++k)
              sums[x].add(encode_samples ? encoded(colour_at(colours, k)) : colour_at(colours, k));
        }
        for (int x = 0; x < pixels; ++x)
          image.at(x_begin + x, y) = finished(sums[static_cast<std::size_t>(x)]);
      }
    }
  }
  return image;
}

namespace {

// Offset from the pixel centre in 1/256 of a pixel.
struct SampleOffset {
  int x, y;
};

Image multi_sampled(const Scene& scene, int width, int height, Shading shading,
                    std::span<const SampleOffset> offsets) {
  constexpr int kTileCells = 32;
  RenderOptions options;
  options.shading = shading;
  const View view(scene.camera, width, height, 1);
  const std::vector<Primitive> primitives = set_up(scene.mesh, view);
  const Transport transport(Transfer::kGamma22);
  const Shader shader(scene, primitives, view, options, transport);
  const Occlusion occlusion(primitives, width, height, kTileCells);
  ColourRow one;
  std::vector<std::vector<std::int32_t>> owners(offsets.size());
  std::vector<double> depths;
  Image image(width, height);
  for (int row = 0; row < occlusion.rows(); ++row) {
    for (int column = 0; column < occlusion.columns(); ++column) {
      for (std::size_t k = 0; k < offsets.size(); ++k)
        occlusion.resolve(column, row, offsets[k].x, offsets[k].y, owners[k], depths);
      for (int y = row * kTileCells; y < std::min(height, (row + 1) * kTileCells); ++y) {
        const Colour background = sky_colour(scene, y, height, transport);
        for (int x = column * kTileCells; x < std::min(width, (column + 1) * kTileCells); ++x) {
          const auto at = static_cast<std::size_t>((y - row * kTileCells) * kTileCells + x -
                                                   column * kTileCells);
          Sum sum;
          std::int32_t shaded = kNobody;
          Colour colour = background;
          for (std::size_t k = 0; k < offsets.size(); ++k) {
            const std::int32_t owner = owners[k][at];
            if (owner != shaded) {
              shaded = owner;
              if (owner != kNobody) shader.shade(owner, x, y, 1, 1, one);
              colour = owner == kNobody ? background : colour_at(one, 0);
            }
            sum.add(colour);
          }
          image.at(x, y) = finish(sum, static_cast<int>(offsets.size()), transport);
        }
      }
    }
  }
  return image;
}

}  // namespace

Image render_msaa4(const Scene& scene, int width, int height, Shading shading) {
  constexpr std::array<SampleOffset, 4> kRotatedGrid{{{-32, -96}, {96, -32}, {-96, 32}, {32, 96}}};
  return multi_sampled(scene, width, height, shading, kRotatedGrid);
}

Image render_covered(const Scene& scene, int width, int height, int samples, Shading shading) {
  constexpr int kMaxCoverage = 8;
  if (samples < 1 || samples > kMaxCoverage)
    throw spec::ConfigError(
        fmt::format("{0} x {0} coverage samples per pixel requested; expected 1 x 1 to {1} x {1}",
                    samples, kMaxCoverage));
  std::vector<SampleOffset> grid;
  const auto offset = [&](int i) { return 128 * (2 * i + 1) / samples - 128; };
  for (int y = 0; y < samples; ++y)
    for (int x = 0; x < samples; ++x) grid.push_back({offset(x), offset(y)});
  return multi_sampled(scene, width, height, shading, grid);
}

DepthImage render_depth(const Scene& scene, int width, int height) {
  const View view(scene.camera, width, height, 1);
  DepthImage depth(width, height);
  for_each_resolved_pixel(
      set_up(scene.mesh, view), view, [&](int x, int y, std::int32_t, double inverse_w) {
        depth.at(x, y) = static_cast<float>(scene.camera.near_plane * inverse_w);
      });
  return depth;
}

GBuffer render_gbuffer(const Scene& scene, int width, int height) {
  RenderOptions options;
  options.shading = Shading::kPhong;
  const View view(scene.camera, width, height, 1);
  const std::vector<Primitive> primitives = set_up(scene.mesh, view);
  const Transport transport(Transfer::kGamma22);
  const Shader shader(scene, primitives, view, options, transport);
  GBuffer buffer{ImageOf<std::array<float, 3>>(width, height), FloatImage(width, height),
                 DepthImage(width, height)};
  ColourRow one;
  NormalRow normal;
  for_each_resolved_pixel(
      primitives, view, [&](int x, int y, std::int32_t owner, double inverse_w) {
        shader.shade(owner, x, y, 1, 1, one, 0, &normal);
        buffer.normal.at(x, y) = normal[0];
        buffer.albedo.at(x, y) = colour_at(one, 0);
        buffer.depth.at(x, y) = static_cast<float>(scene.camera.near_plane * inverse_w);
      });
  return buffer;
}

Image light(const Scene& scene, const GBuffer& buffer) {
  const int width = buffer.depth.width, height = buffer.depth.height;
  const View view(scene.camera, width, height, 1);
  const Phong phong(scene);
  const Transport transport(Transfer::kGamma22);
  Image image(width, height);
  const auto finished = [&](const Colour& colour) {
    Sum sum;
    sum.add(colour);
    return finish(sum, 1, transport);
  };
  for (int y = 0; y < height; ++y) {
    std::fill_n(&image.at(0, y), width, finished(sky_colour(scene, y, height, transport)));
    for (int x = 0; x < width; ++x) {
      if (!(buffer.depth.at(x, y) > 0.0f)) continue;
      Colour colour = buffer.albedo.at(x, y);
      phong.shade(buffer.normal.at(x, y), view.ray(x + 0.5, y + 0.5), colour[0], colour[1],
                  colour[2]);
      image.at(x, y) = finished(colour);
    }
  }
  return image;
}

LitFrames render_lit_frames(const Scene& scene, int width, int height, int samples,
                            const std::function<bool()>& interrupted, Shading shading) {
  RenderOptions options;
  options.interrupted = interrupted;
  options.width = width;
  options.height = height;
  options.shading = shading;
  options.averaging = Averaging::kLinear;
  LitFrames frames;
  frames.noaa = render(scene, options);
  options.samples = samples;
  frames.reference = render(scene, options);
  frames.depth = render_depth(scene, width, height);
  return frames;
}

}  // namespace deburr::tb
