// SPDX-License-Identifier: MIT
#include "tb/engines/geometric/geometric_stimuli.h"

#include <cmath>

#include "tb/scene/depth_codes.h"

namespace deburr::tb::geometric {

golden::geometric::FrameInput Frame::input(const golden::geometric::Bases& bases) const {
  return {{image.pixels, image.width, image.height},
          {depths, image.width, image.height},
          screen.edges,
          screen.vertices,
          {screen.facing, screen.faces},
          bases};
}

Frame make_frame(const Scene& scene, int width, int height, const EdgeTableOptions& options) {
  Frame frame;
  const GBuffer buffer = render_gbuffer(scene, width, height);
  frame.image = light(scene, buffer);
  frame.depth = buffer.depth;
  frame.depths = depth_codes(buffer.depth);
  frame.table = build_edge_table(scene.mesh, options);
  frame.screen = project_edges(frame.table, scene.camera, width, height);
  return frame;
}

Checker::Checker(const Scene& scene, int width, int height, int samples,
                 const std::function<bool()>& interrupted, const EdgeTableOptions& edges_of)
    : frame(make_frame(scene, width, height, edges_of)) {
  RenderOptions options;
  options.width = width;
  options.height = height;
  options.samples = samples;
  options.shading = Shading::kPhong;
  options.averaging = Averaging::kLinear;
  options.interrupted = interrupted;
  reference = render(scene, options);
  msaa = render_msaa4(scene, width, height, Shading::kPhong);
  edges = edge_mask(reference, frame.image);
  silhouettes = silhouette_mask(edges, frame.depth);
}

double Checker::edge_rmse(const Image& image) const {
  return std::sqrt(mean_squared_error(image, reference, edges));
}
double Checker::silhouette_rmse(const Image& image) const {
  return std::sqrt(mean_squared_error(image, reference, silhouettes));
}
double Checker::edge_psnr(const Image& image) const { return psnr(image, reference, edges); }
double Checker::silhouette_psnr(const Image& image) const {
  return psnr(image, reference, silhouettes);
}

Smoothed smoothed(const Frame& frame, const spec::geometric::Parameters& parameters) {
  golden::geometric::GeometricGolden golden(parameters,
                                            golden::geometric::GeometricGolden::Detail::kPixels);
  Smoothed result;
  result.image = Image(frame.image.width, frame.image.height);
  result.image.pixels = golden.process(frame.input());
  result.work = golden.work();
  return result;
}

}  // namespace deburr::tb::geometric
