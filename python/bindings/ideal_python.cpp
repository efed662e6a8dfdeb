// SPDX-License-Identifier: MIT
// Reference filters and references in real arithmetic: implements deburr.ideal.
#include <pybind11/stl.h>

#include <algorithm>
#include <utility>

#include "golden/c/texture_handle.h"
#include "golden/ideal/box.h"
#include "golden/ideal/cmaa2.h"
#include "golden/ideal/colour_frame.h"
#include "golden/ideal/coverage.h"
#include "golden/ideal/ellipse.h"
#include "golden/ideal/ewa.h"
#include "golden/ideal/footprint.h"
#include "golden/ideal/fxaa.h"
#include "golden/ideal/geometric.h"
#include "golden/ideal/smaa.h"
#include "golden/ideal/texture_image.h"
#include "python/bindings/arrays.h"
#include "python/bindings/frames.h"
#include "python/bindings/module.h"
#include "spec/poll.h"
#include "spec/texture/packets.h"

namespace deburr::golden::ideal {

template <class Visit>
void record_fields(const PixelFootprint& footprint, Visit& visit) {
  visit("s", footprint.s);
  visit("t", footprint.t);
  visit("s_x", footprint.s_x);
  visit("t_x", footprint.t_x);
  visit("s_y", footprint.s_y);
  visit("t_y", footprint.t_y);
}
template <class Visit>
void record_fields(const ScreenPoint& point, Visit& visit) {
  visit("x", point.x);
  visit("y", point.y);
  visit("depth", point.depth);
}
template <class Visit>
void record_fields(const ScreenLine& line, Visit& visit) {
  visit("p", line.p);
  visit("q", line.q);
  visit("crease", line.crease);
}

}  // namespace deburr::golden::ideal

namespace deburr::python {
namespace {

namespace ideal = golden::ideal;
using golden::c::require;

ideal::ColourFrame colour_frame(const py::object& pixels) {
  const FramePixels given = frame_pixels(pixels);
  ideal::ColourFrame frame;
  frame.width = given.view.width;
  frame.height = given.view.height;
  frame.pixels.reserve(static_cast<std::size_t>(frame.width) *
                       static_cast<std::size_t>(frame.height));
  for (int y = 0; y < frame.height; ++y)
    frame.pixels.insert(frame.pixels.end(), given.view.row(y), given.view.row(y) + frame.width);
  return frame;
}

// Returns filter(frame); the GIL is released meanwhile.
template <class Filter>
py::array filtered(const py::object& pixels, Filter&& filter) {
  const ideal::ColourFrame frame = colour_frame(pixels);
  std::vector<Rgba8> result;
  {
    const WithoutGil others_run;
    result = filter(frame);
  }
  return owned(std::move(result), {frame.height, frame.width});
}

void require_share(double value, const char* name) {
  require(value >= 0 && value <= 1,
          std::string(name) + " = " + std::to_string(value) + " is outside 0..1");
}

py::array fxaa(const py::object& pixels, double threshold, double least_threshold, double subpixel,
               int steps, bool linear_light) {
  require_share(threshold, "threshold");
  require_share(least_threshold, "least_threshold");
  require_share(subpixel, "subpixel");
  ideal::FxaaSettings settings;
  settings.threshold = threshold;
  settings.least_threshold = least_threshold;
  settings.subpixel = subpixel;
  settings.linear_light = linear_light;
  if (steps == 12) {
    settings.steps = ideal::kFxaaSteps12;
  } else if (steps == 39) {
    settings.steps = ideal::kFxaaSteps39;
  } else {
    require(steps == 29, "steps = " + std::to_string(steps) + " must be 12, 29 or 39");
    settings.steps = ideal::kFxaaSteps29;
  }
  return filtered(pixels,
                  [&](const ideal::ColourFrame& frame) { return ideal::fxaa(frame, settings); });
}

ideal::Cmaa2Settings cmaa2_settings(double threshold, double contrast_adaptation, double symmetry,
                                    bool linear_light) {
  require_share(threshold, "threshold");
  require_share(contrast_adaptation, "contrast_adaptation");
  ideal::Cmaa2Settings settings;
  settings.threshold = threshold;
  settings.contrast_adaptation = contrast_adaptation;
  settings.symmetry = symmetry;
  settings.linear_light = linear_light;
  return settings;
}

ideal::SmaaEdges smaa_edges_of(const py::object& edges) {
  const py::array bits =
      checked(edges, "edges", py::dtype::of<std::uint8_t>(), 2, "uint8 of (height, width)");
  const int height = static_cast<int>(bits.shape(0)), width = static_cast<int>(bits.shape(1));
  const auto* const values = static_cast<const std::uint8_t*>(bits.data());
  ideal::SmaaEdges all(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const unsigned pixel = values[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                                    static_cast<std::size_t>(x)];
      all.set_left(x, y, (pixel & 1) != 0);
      all.set_top(x, y, (pixel & 2) != 0);
    }
  }
  return all;
}

py::array smaa_edges(const py::object& luma, double threshold) {
  const py::array values =
      checked(luma, "luma", py::dtype::of<double>(), 2, "float64 of (height, width), 0..1");
  ideal::SmaaLuma frame;
  frame.height = static_cast<int>(values.shape(0));
  frame.width = static_cast<int>(values.shape(1));
  const auto* const first = static_cast<const double*>(values.data());
  frame.values.assign(first, first + values.size());
  const ideal::SmaaEdges edges = ideal::smaa_edges(frame, threshold);
  std::vector<std::uint8_t> bits;
  for (int y = 0; y < frame.height; ++y)
    for (int x = 0; x < frame.width; ++x)
      bits.push_back(
          static_cast<std::uint8_t>((edges.left(x, y) ? 1 : 0) | (edges.top(x, y) ? 2 : 0)));
  return owned(std::move(bits), {frame.height, frame.width});
}

py::array smaa_weights(const py::object& edges, int search_steps, int diagonal_steps,
                       std::optional<double> corner_keeps) {
  ideal::SmaaSettings settings;
  settings.search_steps = search_steps;
  settings.diagonal_steps = diagonal_steps;
  settings.corner_keeps = corner_keeps;
  const ideal::SmaaEdges all = smaa_edges_of(edges);
  std::vector<std::array<double, 4>> weights;
  {
    const WithoutGil others_run;
    for (int y = 0; y < all.height(); ++y) {
      spec::poll();
      for (int x = 0; x < all.width(); ++x) {
        const ideal::SmaaPixelWeights pixel = ideal::smaa_weights(all, settings, x, y);
        weights.push_back({pixel.top.first, pixel.top.second, pixel.left.first, pixel.left.second});
      }
    }
  }
  return owned(std::move(weights), {all.height(), all.width()});
}

// ---- coverage -----------------------------------------------------------------------------------

template <class Shape>
py::array coverage_plane(const Shape& shape, int width, int height,
                         double (*coverage)(const Shape&, double, double)) {
  require(width >= 1 && height >= 1 && width <= 8192 && height <= 8192,
          "a frame of " + std::to_string(width) + " x " + std::to_string(height) +
              " pixels; width and height must be 1..8192");
  std::vector<double> values;
  values.reserve(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  {
    const WithoutGil others_run;
    for (int y = 0; y < height; ++y) {
      spec::poll();
      for (int x = 0; x < width; ++x) values.push_back(coverage(shape, x, y));
    }
  }
  return owned(std::move(values), {height, width});
}

// ---- textures -----------------------------------------------------------------------------------

template <std::size_t N>
std::size_t code_named(const char* name, const std::string& text,
                       const std::array<std::string_view, N>& names) {
  return golden::c::code_of(name, text, names);
}

struct TextureImage {
  TextureImage(const py::object& texels, const std::string& wrap_s, const std::string& wrap_t,
               bool srgb)
      : image(made(texels, wrap_s, wrap_t, srgb)) {}
  ideal::TextureImage image;

 private:
  static ideal::TextureImage made(const py::object& texels, const std::string& wrap_s,
                                  const std::string& wrap_t, bool srgb) {
    const FramePixels given = frame_pixels(texels);
    const py::array array = py::array::ensure(given.array, py::array::c_style);
    const auto wrap = [](const char* name, const std::string& text) {
      return static_cast<spec::texture::Wrap>(code_named(name, text, spec::texture::kWrapNames));
    };
    return {
        given.view.width,
        given.view.height,
        {static_cast<const std::uint8_t*>(array.data()), static_cast<std::size_t>(array.size())},
        wrap("wrap_s", wrap_s),
        wrap("wrap_t", wrap_t),
        srgb};
  }
};

constexpr std::size_t kFootprintsAtATime = 256;

// Returns one colour per footprint; Ctrl-C is checked between two parts.
template <class Filter>
py::array colours(const py::object& footprints, Filter&& filter) {
  const py::array array = checked_list<ideal::PixelFootprint>(footprints, "footprints",
                                                              "an array of FOOTPRINT of (n,)");
  auto left = elements<ideal::PixelFootprint>(array);
  std::vector<ideal::Colour> all;
  all.reserve(left.size());
  while (!left.empty()) {
    const auto part = left.first(std::min(left.size(), kFootprintsAtATime));
    {
      const WithoutGil others_run;
      const std::vector<ideal::Colour> made = filter(part);
      all.insert(all.end(), made.begin(), made.end());
    }
    left = left.subspan(part.size());
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  }
  return owned(std::move(all));
}

py::array pixel_footprints(const py::object& quads, int width, int height) {
  const py::array array =
      checked_list<spec::texture::Quad>(quads, "quads", "an array of QUAD of (n,)");
  require(width >= 1 && height >= 1, "a texture of " + std::to_string(width) + " x " +
                                         std::to_string(height) + " texels has no footprints");
  return owned(ideal::pixel_footprints(elements<spec::texture::Quad>(array), width, height));
}

double psnr(const py::object& reference, const py::object& pixels) {
  const py::array colours =
      checked(reference, "reference", py::dtype::of<double>(), 2, "float64 of (n, 4), 0..255");
  const py::array bytes =
      checked(pixels, "pixels", py::dtype::of<std::uint8_t>(), 2, "uint8 of (n, 4)");
  if (colours.shape(1) != 4) reject_array("reference", "float64 of (n, 4), 0..255", reference);
  if (bytes.shape(1) != 4 || bytes.shape(0) != colours.shape(0))
    reject_array("pixels", "uint8 of (n, 4) with the n of the reference", pixels);
  return ideal::psnr(
      {static_cast<const ideal::Colour*>(colours.data()),
       static_cast<std::size_t>(colours.shape(0))},
      {static_cast<const std::uint8_t*>(bytes.data()), static_cast<std::size_t>(bytes.size())});
}

// ---- the geometric engine's equations -----------------------------------------------------------

py::array geometric_weights(const py::object& lines, const py::object& depth,
                            const ideal::GpaaOptions& options) {
  const py::array all =
      checked_list<ideal::ScreenLine>(lines, "lines", "an array of SCREEN_LINE of (n,)");
  const py::array depths =
      checked(depth, "depth", py::dtype::of<double>(), 2, "float64 of (height, width), near / w");
  const int height = static_cast<int>(depths.shape(0)), width = static_cast<int>(depths.shape(1));
  const std::span<const double> values(static_cast<const double*>(depths.data()),
                                       static_cast<std::size_t>(depths.size()));
  std::vector<ideal::SideWeights> weights;
  {
    const WithoutGil others_run;
    weights = ideal::side_weights(elements<ideal::ScreenLine>(all), values, width, height, options);
  }
  return owned(std::move(weights), {height, width});
}

py::array geometric_blend(const py::object& light, const py::object& weights) {
  const py::array frame =
      checked(light, "light", py::dtype::of<double>(), 3, "float64 of (height, width, 3)");
  const py::array sides =
      checked(weights, "weights", py::dtype::of<double>(), 3, "float64 of (height, width, 4)");
  if (frame.shape(2) != 3) reject_array("light", "float64 of (height, width, 3)", light);
  if (sides.shape(2) != 4 || sides.shape(0) != frame.shape(0) || sides.shape(1) != frame.shape(1))
    reject_array("weights", "float64 of the light's size and 4", weights);
  const int height = static_cast<int>(frame.shape(0)), width = static_cast<int>(frame.shape(1));
  const auto count = static_cast<std::size_t>(height) * static_cast<std::size_t>(width);
  std::vector<ideal::Light> result;
  {
    const WithoutGil others_run;
    result = ideal::blended({static_cast<const ideal::Light*>(frame.data()), count},
                            {static_cast<const ideal::SideWeights*>(sides.data()), count}, width,
                            height);
  }
  return owned(std::move(result), {height, width});
}

void add_filters(py::module_& module) {
  const ideal::FxaaSettings f;
  module.def("fxaa", &fxaa,
             "FXAA 3.11, quality variant, of uint8 pixels of (height, width, 4). `steps` is the "
             "number of the published preset: 12, 29, 39.",
             py::arg("pixels"), py::arg("threshold") = f.threshold,
             py::arg("least_threshold") = f.least_threshold, py::arg("subpixel") = f.subpixel,
             py::arg("steps") = 29, py::arg("linear_light") = f.linear_light);
  const ideal::Cmaa2Settings m;
  module.def(
      "cmaa2",
      [](const py::object& pixels, double threshold, double contrast_adaptation, double symmetry,
         bool linear_light) {
        const auto settings =
            cmaa2_settings(threshold, contrast_adaptation, symmetry, linear_light);
        return filtered(
            pixels, [&](const ideal::ColourFrame& frame) { return ideal::cmaa2(frame, settings); });
      },
      "Conservative morphological anti-aliasing 2 of uint8 pixels of (height, width, 4).",
      py::arg("pixels"), py::arg("threshold") = m.threshold,
      py::arg("contrast_adaptation") = m.contrast_adaptation, py::arg("symmetry") = m.symmetry,
      py::arg("linear_light") = m.linear_light);
  const ideal::SmaaSettings s;
  module.def("smaa_edges", &smaa_edges,
             "Edges of SMAA 1x by luma, float64 of (height, width): uint8 of the same size, bit 0 "
             "left, bit 1 above.",
             py::arg("luma"), py::arg("threshold") = s.threshold);
  module.def("smaa_weights", &smaa_weights,
             "SMAA's weights of every edge: float64 of (height, width, 4), blend weights at the "
             "upper edge for the upper pixel and for this one, then at the left edge likewise.",
             py::arg("edges"), py::arg("search_steps") = s.search_steps,
             py::arg("diagonal_steps") = s.diagonal_steps,
             py::arg("corner_keeps") = s.corner_keeps);
}

void add_coverage(py::module_& module) {
  module.def(
      "half_plane",
      [](double a, double b, double c, int width, int height) {
        return coverage_plane<ideal::HalfPlane>({a, b, c}, width, height, &ideal::coverage);
      },
      "Share of each pixel that lies where a x + b y + c > 0: float64 of (height, width), exact.",
      py::arg("a"), py::arg("b"), py::arg("c"), py::arg("width"), py::arg("height"));
  module.def(
      "disc",
      [](double x, double y, double radius, int width, int height) {
        return coverage_plane<ideal::Disc>({x, y, radius}, width, height, &ideal::disc_coverage);
      },
      "Share of each pixel that lies in a disc: float64 of (height, width), exact.", py::arg("x"),
      py::arg("y"), py::arg("radius"), py::arg("width"), py::arg("height"));
}

void add_textures(py::module_& module) {
  py::class_<TextureImage>(module, "TextureImage",
                           "A texture in real numbers, of uint8 texels of (height, width, 4).")
      .def(py::init<const py::object&, const std::string&, const std::string&, bool>(),
           py::arg("texels"), py::arg("wrap_s") = "repeat", py::arg("wrap_t") = "repeat",
           py::arg("srgb") = false)
      .def_property_readonly("width", [](const TextureImage& t) { return t.image.width(); })
      .def_property_readonly("height", [](const TextureImage& t) { return t.image.height(); });
  module.def("pixel_footprints", &pixel_footprints,
             "Footprint of each covered lane of quads on a texture of width x height texels: an "
             "array of FOOTPRINT, in the order of colours.",
             py::arg("quads"), py::arg("width"), py::arg("height"));
  module.def(
      "box",
      [](const TextureImage& texture, const py::object& footprints, int n, bool bilinear) {
        require(n >= 1 && n <= 1024, "n = " + std::to_string(n) + " is outside 1..1024");
        return colours(footprints, [&](std::span<const ideal::PixelFootprint> part) {
          return ideal::box_image(texture.image, part, n,
                                  bilinear ? ideal::Tap::kBilinear : ideal::Tap::kPoint);
        });
      },
      "Each footprint's parallelogram averaged with equal weights over n x n points: float64 of "
      "(n, 4), 0..255.",
      py::arg("texture"), py::arg("footprints"), py::arg("n") = 32, py::arg("bilinear") = true);
  const ideal::EwaOptions e;
  module.def(
      "ewa",
      [](const TextureImage& texture, const py::object& footprints, double alpha, double radius,
         bool taper, double reconstruction, double most_texels) {
        const ideal::EwaOptions options{alpha, radius, taper, reconstruction, most_texels};
        require(alpha > 0 && radius > 0 && reconstruction >= 0 && most_texels >= 1,
                "alpha, radius and most_texels must be above 0, and reconstruction not below");
        return colours(footprints, [&](std::span<const ideal::PixelFootprint> part) {
          return ideal::ewa_image(texture.image, part, options);
        });
      },
      "Elliptical weighted average with a Gaussian: float64 of (n, 4), 0..255.", py::arg("texture"),
      py::arg("footprints"), py::arg("alpha") = e.alpha, py::arg("radius") = e.radius,
      py::arg("taper") = e.taper, py::arg("reconstruction") = e.reconstruction,
      py::arg("most_texels") = e.most_texels);
  module.def("psnr", &psnr,
             "Peak signal-to-noise ratio in dB over R, G and B of float64 colours of (n, 4) and "
             "uint8 pixels of (n, 4); infinite where they are equal.",
             py::arg("reference"), py::arg("pixels"));
  module.attr("FOOTPRINT") = dtype_of<ideal::PixelFootprint>();
}

void add_equations(py::module_& module) {
  const ideal::GpaaOptions g;
  module.def(
      "line_weights",
      [](const py::object& lines, const py::object& depth, bool last_wins, bool outermost,
         bool area, double depth_bias, double crease_depth) {
        return geometric_weights(lines, depth,
                                 {.last_wins = last_wins,
                                  .outermost = outermost,
                                  .area = area,
                                  .depth_bias = depth_bias,
                                  .crease_depth = crease_depth});
      },
      "Weights of the neighbours up, down, left and right of each pixel after all lines: "
      "float64 of (height, width, 4).",
      py::arg("lines"), py::arg("depth"), py::arg("last_wins") = g.last_wins,
      py::arg("outermost") = g.outermost, py::arg("area") = g.area,
      py::arg("depth_bias") = g.depth_bias, py::arg("crease_depth") = g.crease_depth);
  module.def("line_blend", &geometric_blend,
             "A frame of light, float64 of (height, width, 3), blended by such weights.",
             py::arg("light"), py::arg("weights"));
  module.attr("SCREEN_LINE") = dtype_of<ideal::ScreenLine>();
}

}  // namespace

void add_ideal(py::module_& module) {
  py::module_ part = module.def_submodule("ideal");
  add_filters(part);
  add_coverage(part);
  add_textures(part);
  add_equations(part);
}

}  // namespace deburr::python
