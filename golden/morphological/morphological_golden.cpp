// SPDX-License-Identifier: MIT
#include "golden/morphological/morphological_golden.h"

#include <algorithm>
#include <bit>
#include <string>
#include <utility>

#include "golden/morphological/area_table.h"
#include "golden/morphological/corners.h"
#include "golden/morphological/diagonals.h"
#include "golden/morphological/edges.h"
#include "golden/morphological/line.h"
#include "golden/morphological/runs.h"
#include "golden/morphological/traffic.h"
#include "spec/error.h"
#include "spec/morphological/check_build.h"
#include "spec/poll.h"

namespace deburr::golden::morphological {
namespace {

std::uint64_t bits_of(std::uint64_t word) {
  return static_cast<std::uint64_t>(std::popcount(word));
}

bool from_table(const spec::morphological::Parameters& parameters) {
  return parameters.area != spec::morphological::AreaSource::kAnalytic &&
         parameters.area != spec::morphological::AreaSource::kLearned;
}

// A descriptor whose weights come from the ROMs.
spec::morphological::LineDescriptor without_line(const AxisEdges& edges,
                                                 const spec::morphological::RunDescriptor& run,
                                                 int search_range) {
  using spec::morphological::RunPart;
  spec::morphological::LineDescriptor descriptor;
  descriptor.run = run;
  descriptor.learned = true;
  descriptor.scale = 0;
  const int room = run.part == RunPart::kWhole ? search_range - run.length : 0;
  if (run.part != RunPart::kTail)
    descriptor.start_class = static_cast<std::uint8_t>(crossing_class(edges, run, false, room));
  if (run.part != RunPart::kHead)
    descriptor.end_class = static_cast<std::uint8_t>(crossing_class(edges, run, true, room));
  return descriptor;
}

template <class Pixel>
void check_view(const ViewOf<Pixel>& view, const char* what) {
  const auto width = static_cast<std::size_t>(view.width);
  const auto rows = static_cast<std::size_t>(view.height);
  DEBURR_CHECK(view.stride >= width && view.pixels.size() >= (rows - 1) * view.stride + width,
               std::string(what) + " of " + std::to_string(view.width) + " x " +
                   std::to_string(view.height) + " pixels, stride " + std::to_string(view.stride) +
                   ", in a span of " + std::to_string(view.pixels.size()));
}

}  // namespace

void MorphologicalGolden::AxisWeights::count_edges() {
  edges_before.clear();
  std::uint32_t count = 0;
  for (int line = 0; line < edges.along.height(); ++line) {
    for (int i = 0; i < edges.along.words(); ++i) {
      edges_before.push_back(count);
      count += static_cast<std::uint32_t>(bits_of(edges.along.row(line)[i]));
    }
  }
  weights.clear();
  weights.reserve(count);
}

std::size_t MorphologicalGolden::AxisWeights::index(int position, int line) const {
  const int word = position >> 6, bit = position & 63;
  const std::uint64_t earlier = edges.along.row(line)[word] & ((std::uint64_t{1} << bit) - 1);
  const std::size_t base =
      edges_before[static_cast<std::size_t>(line) * static_cast<std::size_t>(edges.along.words()) +
                   static_cast<std::size_t>(word)];
  return base + bits_of(earlier);
}

MorphologicalGolden::Weight MorphologicalGolden::AxisWeights::at(int position, int line) const {
  return edges.along.at(position, line) ? weights[index(position, line)] : Weight{};
}

MorphologicalGolden::MorphologicalGolden(const spec::morphological::Parameters& parameters,
                                         Detail detail)
    : parameters_(parameters), everything_(detail == Detail::kEverything) {
  check_build(parameters);
}

const std::vector<spec::morphological::Rgba8>& MorphologicalGolden::process(
    const ImageView& image, const DepthView& depth) {
  check_frame(parameters_, image.width, image.height);
  check_view(image, "a frame");
  if (!depth.empty()) {
    DEBURR_CHECK(depth.width == image.width && depth.height == image.height,
                 "depth and image differ in size");
    check_view(depth, "depth");
  }
  edges_ = find_edges(parameters_, image, depth);
  if (everything_) count_thresholds(image);
  smooth(image);
  return pixels_;
}

const std::vector<spec::morphological::Rgba8>& MorphologicalGolden::process(
    const ImageView& image, const EdgePlanes& edges) {
  check_frame(parameters_, image.width, image.height);
  check_view(image, "a frame");
  for (const BitPlane* plane : {&edges.left, &edges.top}) {
    DEBURR_CHECK(plane->width() == image.width && plane->height() == image.height,
                 "edges and image differ in size");
  }
  edges_ = edges;
  smooth(image);
  return pixels_;
}

// All blocks after edge detection.
void MorphologicalGolden::smooth(const ImageView& image) {
  work_ = {};
  runs_.clear();
  const std::size_t pixels =
      static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  work_.pixels = pixels;
  // Every pixel is written below. Copying any pixels allocates five times faster than clearing.
  if (pixels_.size() != pixels) pixels_.assign(image.pixels.data(), image.pixels.data() + pixels);
  if (everything_) {
    probes_.assign(pixels, {});
    decisions_.assign(pixels, Decision::kNone);
  }

  horizontal_.edges = AxisEdges::horizontal(edges_, parameters_.border);
  vertical_.edges = AxisEdges::vertical(edges_, parameters_.border);
  process_axis(horizontal_);
  const std::size_t first_vertical = runs_.size();
  process_axis(vertical_);
  put_runs_in_order(first_vertical);
  if (parameters_.diagonals) process_diagonals();

  if (parameters_.text_guard) {
    guard_ = TextGuard(image);
    if (everything_) guard_coverage_.count_frame(guard_, image.width, image.height);
  }
  memory_errors_ = 0;
  const ImageView source = as_read_back(image);
  for (int y = 0; y < image.height; ++y) {
    spec::poll();
    blend_row(source, y);
  }
  if (everything_) {
    coverage_.count_pixels(Decision::kNone, pixels - work_.blended_pixels - work_.bypassed_pixels);
  }
}

void MorphologicalGolden::process_axis(AxisWeights& axis) {
  axis.count_edges();
  std::uint64_t& runs = axis.edges.axis == spec::morphological::Axis::kHorizontal
                            ? work_.horizontal_runs
                            : work_.vertical_runs;
  for (int line = 0; line < axis.edges.along.height(); ++line) {
    spec::poll();
    for_each_run(axis.edges, parameters_.ends, line, [&](int first, int end) {
      ++runs;
      const RunParts parts = descriptors_of(parameters_, axis.edges, line, first, end);
      process_descriptor(axis, parts.descriptor[0]);
      if (parts.count == 1) return;
      ++work_.long_runs;
      const spec::morphological::RunDescriptor& tail = parts.descriptor[1];
      const int between = tail.start - (first + parts.descriptor[0].length);
      weight_gap(axis, between);
      process_descriptor(axis, tail);
    });
  }
}

void MorphologicalGolden::process_descriptor(AxisWeights& axis,
                                             const spec::morphological::RunDescriptor& run) {
  const Prediction prediction = predict(parameters_, axis.edges, run);
  const bool learned = is_learned(run, prediction);
  const spec::morphological::LineDescriptor line =
      learned ? without_line(axis.edges, run, search_range(parameters_, run.axis))
              : line_through(parameters_, run, prediction);
  const int steps = prediction.left.steps + prediction.right.steps;
  if (run.part == spec::morphological::RunPart::kWhole &&
      spec::morphological::kRunShapes[run.shape].clean_z)
    ++work_.z_runs;
  if (steps > 0) ++work_.extended_runs;
  work_.steps += static_cast<std::uint64_t>(steps);
  work_.probes += static_cast<std::uint64_t>(prediction.probes);
  if (learned) {
    weight_learned(axis, line);
  } else if (line.before != spec::morphological::Side::kNone ||
             line.after != spec::morphological::Side::kNone) {
    ++work_.divides;
    weight(axis, line);
  } else {
    axis.weights.resize(axis.weights.size() + run.length);
  }
  if (!everything_) return;
  if (learned) learned_coverage_.count_descriptor(line);
  count_searches(line, axis.edges.along.width());
  coverage_.count_run(run, prediction, axis.edges.along.width(), axis.edges.along.height());
  runs_.push_back({line, static_cast<std::int16_t>(prediction.left.end),
                   static_cast<std::int16_t>(prediction.right.end),
                   static_cast<std::uint16_t>(prediction.probes),
                   static_cast<std::uint8_t>(prediction.iterations), prediction.left.outcome,
                   prediction.right.outcome, prediction.left.why, prediction.right.why});
}

bool MorphologicalGolden::is_learned(const spec::morphological::RunDescriptor& run,
                                     const Prediction& prediction) const {
  if (parameters_.area != spec::morphological::AreaSource::kLearned) return false;
  if (run.part != spec::morphological::RunPart::kWhole ||
      !spec::morphological::kRunShapes[run.shape].clean_z)
    return true;
  return prediction.left.steps + prediction.right.steps == 0 &&
         run.length < spec::morphological::kLongZ;
}

void MorphologicalGolden::weight_learned(AxisWeights& axis,
                                         const spec::morphological::LineDescriptor& line) {
  const LearnedEnds first(line, spec::morphological::Side::kFirst);
  const LearnedEnds second(line, spec::morphological::Side::kSecond);
  const auto look_up = [&](const WeightIndices& i) {
    if (everything_) learned_coverage_.count_weight(i);
    return static_cast<std::uint8_t>(learned_weight(tables_, i));
  };
  for (int k = 0; k < line.run.length; ++k)
    axis.weights.push_back({look_up(first.of_pixel(k)), look_up(second.of_pixel(k)), 0});
}

// At least one edge between the head and the tail of a long run.
void MorphologicalGolden::weight_gap(AxisWeights& axis, int edges) {
  Weight weight;
  if (parameters_.area == spec::morphological::AreaSource::kLearned) {
    weight.first = weight.second = static_cast<std::uint8_t>(learned_weight(tables_, kGapIndices));
    if (everything_) learned_coverage_.count_weight(kGapIndices);
  }
  axis.weights.resize(axis.weights.size() + static_cast<std::size_t>(edges), weight);
}

void MorphologicalGolden::weight(AxisWeights& axis,
                                 const spec::morphological::LineDescriptor& line) const {
  const auto put = [&](const EdgeWeights& s) {
    axis.weights.push_back({s.first, s.second, line.span});
  };
  const auto rounded = [&](const EdgeWeights& s, int far, int before, int after) {
    return far == 0 ? s : rounded_at_corners(s, far, parameters_.corner_rounding, before, after);
  };
  if (from_table(parameters_)) {
    const LineEnds ends = line_ends(line);
    for (int k = 0; k < line.run.length; ++k) {
      const TableAddress address = table_address(line, ends, parameters_.search_steps, k);
      put(rounded(table_weights(address, parameters_.area_values), address.far_seen(line.run.far),
                  address.before, address.after));
    }
    return;
  }
  // The other end of a long run counts as one search range away.
  using spec::morphological::RunPart;
  const int rest = search_range(parameters_, line.run.axis) - line.run.length;
  const int start = line.run.part == RunPart::kTail ? rest : 0,
            end = line.run.length + (line.run.part == RunPart::kHead ? rest : 0);
  for (int k = 0; k < line.run.length; ++k)
    put(rounded(weights(line, k), line.run.far, k + start, end - 1 - k));
}

// Called for every descriptor, with or without sides.
void MorphologicalGolden::count_searches(const spec::morphological::LineDescriptor& line,
                                         int extent) {
  if (!from_table(parameters_)) return;
  if (parameters_.border == spec::morphological::Border::kClamp)
    smaa_coverage_.count_descriptor(line.run, extent);
  const LineEnds ends = line_ends(line);
  for (int k = 0; k < line.run.length; ++k) {
    const TableAddress address = table_address(line, ends, parameters_.search_steps, k);
    smaa_coverage_.count_pixel(line.run.axis, address);
    if (line.run.far != 0) smaa_coverage_.count_corner(line.run.axis, address, line.run.far);
  }
}

void MorphologicalGolden::count_thresholds(const ImageView& image) {
  if (parameters_.edge_source != spec::morphological::EdgeSource::kLuma) return;
  if (parameters_.threshold_mode == spec::morphological::ThresholdMode::kFixed) {
    if (from_table(parameters_) || parameters_.diagonals)
      smaa_coverage_.count_fixed(edges_.left.count() + edges_.top.count());
    return;
  }
  const auto count = [&](bool edge, int x, int y, int from_x, int from_y) {
    if (!edge) return;
    const PixelPair pair{luma(image.at(x, y)), luma(image.at(from_x, from_y))};
    smaa_coverage_.count_threshold(parameters_.dynamic_luma, floor_decides(parameters_, pair));
  };
  for (int y = 0; y < image.height; ++y) {
    spec::poll();
    for (int x = 0; x < image.width; ++x) {
      count(edges_.left.at(x, y), x, y, x - 1, y);
      count(edges_.top.at(x, y), x, y, x, y - 1);
    }
  }
}

void MorphologicalGolden::process_diagonals() {
  const int most = parameters_.blend == spec::morphological::BlendRule::kStrongest
                       ? spec::morphological::kMaxDiagonalWeight
                       : spec::morphological::kMaxWeight;
  for (int y = 0; y < edges_.top.height(); ++y) {
    spec::poll();
    for (int i = 0; i < edges_.top.words(); ++i) {
      for (std::uint64_t rest = edges_.top.row(y)[i]; rest != 0; rest &= rest - 1) {
        const int x = 64 * i + std::countr_zero(rest);
        const DiagonalEnds rising =
            rising_diagonal(edges_, parameters_.diagonal_steps, x, y, parameters_.border);
        const DiagonalEnds falling =
            falling_diagonal(edges_, parameters_.diagonal_steps, x, y, parameters_.border);
        if (everything_) {
          const int width = edges_.top.width(), height = edges_.top.height();
          smaa_coverage_.count_diagonal(true, rising,
                                        y + rising.d1 >= height || x + rising.d2 >= width);
          smaa_coverage_.count_diagonal(false, falling,
                                        y + falling.d2 >= height || x + falling.d2 >= width);
        }
        const DiagonalWeights found = diagonal_weights(rising, falling, parameters_.area_values);
        if (!found.taken()) continue;
        ++work_.diagonal_pixels;
        horizontal_.weights[horizontal_.index(x, y)] = {
            static_cast<std::uint8_t>(std::min(most, found.first)),
            static_cast<std::uint8_t>(std::min(most, found.second)),
            static_cast<std::uint16_t>(found.span)};
        if (edges_.left.at(x, y)) vertical_.weights[vertical_.index(y, x)] = {};
      }
    }
  }
}

// Vertical descriptors were found column by column.
void MorphologicalGolden::put_runs_in_order(std::size_t first_vertical) {
  std::stable_sort(runs_.begin() + static_cast<std::ptrdiff_t>(first_vertical), runs_.end(),
                   [](const PredictedRun& a, const PredictedRun& b) {
                     return a.line.run.start < b.line.run.start;
                   });
}

PixelWeights MorphologicalGolden::gather(int x, int y) const {
  const Weight up = horizontal_.at(x, y), down = horizontal_.at(x, y + 1);
  const Weight left = vertical_.at(y, x), right = vertical_.at(y, x + 1);
  PixelWeights s{up.second, down.first, left.second, right.first, 0, 0};
  s.span_horizontal = std::max(s.up != 0 ? up.span : 0, s.down != 0 ? down.span : 0);
  s.span_vertical = std::max(s.left != 0 ? left.span : 0, s.right != 0 ? right.span : 0);
  return s;
}

// Applies the text guard and `bypass` to a pixel with a weight.
spec::morphological::BlendProbe MorphologicalGolden::remaining_probe(
    const ImageView& image, int x, int y, const spec::morphological::BlendProbe& probe) {
  const Marks marks = marks_of(parameters_.bypass, image, x, y);
  if (parameters_.text_guard && guard_.at(x, y).guarded()) {
    if (everything_) guard_coverage_.count_kept(is_bypassed(parameters_.bypass, marks));
    return {};
  }
  if (everything_) bypass_coverage_.count_pixel(parameters_.bypass, marks, probe, image, x, y);
  return remaining(parameters_.bypass, marks, probe);
}

// Only pixels next to an edge can change; they are found one word of bits at a time.
void MorphologicalGolden::blend_row(const ImageView& image, int y) {
  const auto row_start = pixels_.begin() + static_cast<std::ptrdiff_t>(y) * image.width;
  std::copy_n(image.row(y), image.width, row_start);
  const std::uint64_t* top = edges_.top.row(y);
  const std::uint64_t* below = y + 1 < image.height ? edges_.top.row(y + 1) : nullptr;
  const std::uint64_t* left = edges_.left.row(y);
  const int words = edges_.left.words();
  for (int i = 0; i < words; ++i) {
    const std::uint64_t next = i + 1 < words ? left[i + 1] : 0;
    const std::uint64_t own = top[i] | left[i];
    work_.edge_pixels += bits_of(own);
    const std::uint64_t beside =
        own | (below != nullptr ? below[i] : 0) | left[i] >> 1 | next << 63;
    for (std::uint64_t rest = beside; rest != 0; rest &= rest - 1) {
      blend_pixel(image, 64 * i + std::countr_zero(rest), y);
    }
  }
  if (parameters_.bypass != spec::morphological::Bypass::kNone) {
    std::for_each_n(row_start, image.width, [](spec::morphological::Rgba8& pixel) {
      pixel[3] = static_cast<std::uint8_t>(pixel[3] | 1);
    });
  }
}

void MorphologicalGolden::blend_pixel(const ImageView& image, int x, int y) {
  const PixelWeights weights = gather(x, y);
  const bool strongest = parameters_.blend == spec::morphological::BlendRule::kStrongest;
  const Decision decision = strongest ? decide_by_strength(weights) : decide_by_length(weights);
  spec::morphological::BlendProbe probe = probe_of(weights, decision);
  if (decision != Decision::kNone) probe = remaining_probe(image, x, y, probe);
  const bool left = (probe.first | probe.second) == 0;
  const std::size_t index = static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                            static_cast<std::size_t>(x);
  if (everything_) {
    probe.edges =
        static_cast<std::uint8_t>((edges_.left.at(x, y) ? 1 : 0) | (edges_.top.at(x, y) ? 2 : 0));
    probes_[index] = probe;
    decisions_[index] = decision;
  }
  if (decision == Decision::kNone) return;
  if (everything_) coverage_.count_pixel(decision);
  ++(left ? work_.bypassed_pixels : work_.blended_pixels);
  if (left) return;
  // A neighbour without a weight may lie outside the frame; the pixel is used in its place.
  const spec::morphological::Rgba8& pixel = image.at(x, y);
  const int dx = probe.horizontal ? 1 : 0, dy = probe.horizontal ? 0 : 1;
  const spec::morphological::Rgba8& first = probe.first != 0 ? image.at(x - dx, y - dy) : pixel;
  const spec::morphological::Rgba8& second = probe.second != 0 ? image.at(x + dx, y + dy) : pixel;
  pixels_[index] = blend(parameters_.linear_light, pixel, first, second,
                         strongest ? mixed_by_squares(probe) : unmixed(probe));
}

std::vector<spec::morphological::FrameAccess> MorphologicalGolden::traffic(
    std::uint32_t pixel_base) const {
  if (parameters_.storage != spec::morphological::Storage::kMemory) return {};
  return frame_traffic(pixel_base, width(), height());
}

void MorphologicalGolden::set_read_errors(LinePredicate error, std::uint32_t pixel_base) {
  error_ = std::move(error);
  pixel_base_ = pixel_base;
}

// The frame as read back in the second pass: lines with read errors are zeros.
ImageView MorphologicalGolden::as_read_back(const ImageView& image) {
  if (!error_ || parameters_.storage != spec::morphological::Storage::kMemory) return image;
  constexpr int kPixels =
      spec::morphological::kFrameLineBytes / spec::morphological::kFramePixelBytes;
  read_back_.clear();
  for (int y = 0; y < image.height; ++y) {
    spec::poll();
    const std::uint32_t row =
        pixel_base_ + static_cast<std::uint32_t>(y) * frame_stride(image.width);
    for (int x = 0; x < image.width; x += kPixels) {
      const int count = std::min(kPixels, image.width - x);
      if (error_(row + static_cast<std::uint32_t>(x * spec::morphological::kFramePixelBytes))) {
        ++memory_errors_;
        read_back_.resize(read_back_.size() + static_cast<std::size_t>(count));
      } else {
        read_back_.insert(read_back_.end(), image.row(y) + x, image.row(y) + x + count);
      }
    }
  }
  return {read_back_, image.width, image.height};
}

}  // namespace deburr::golden::morphological
