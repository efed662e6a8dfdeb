// SPDX-License-Identifier: MIT
#include "tb/app/morphological_engine.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <utility>

#include "golden/morphological/configuration.h"
#include "spec/error.h"
#include "tb/app/interrupt.h"
#include "tb/app/morphological_bench.h"
#include "tb/app/morphological_frames.h"
#include "tb/app/progress.h"
#include "tb/scene/compose.h"
#include "tb/scene/quality.h"

namespace deburr::tb {
namespace {

template <class Enum, std::size_t N>
std::string_view name_of(Enum value, const std::array<std::string_view, N>& names) {
  return names[static_cast<std::size_t>(value)];
}

class MorphologicalCommand final : public Engine {
 public:
  std::string_view name() const override { return "morphological"; }
  std::string_view summary() const override {
    return "An image or a scene through the morphological engine, checked pixel by pixel";
  }

  void add_parameters(ParameterSet& set) override {
    set.add("frame", frame_);
    set.add("morphological", parameters_);
    set.add("memory", memory_);
  }

  void resolve(const ParameterSet& set) override { apply_preset(set, parameters_); }

  std::vector<Shorthand> shorthands() const override {
    return {
        {"--in", "frame.source", "Image file of any format that OpenImageIO reads, or a mesh file"},
        {"--scene", "frame.source", "Scene instead of a file: cylinders (default), road, ..."},
        {"--truth", "frame.truth", "Anti-aliased picture to judge by"},
        {"--depth", "frame.depth", "Depth of the image: silhouettes are judged too"},
        {"--size", "frame.width", "Size of a rendered scene, WxH", "frame.height"},
        {"--preset", "morphological.preset", "mlaa, mlaa-slope, deburr"},
        {"--lanes", "morphological.lanes", "Pixels a clock: 1, 2 or 4"},
        {"--storage", "morphological.storage", "line_buffers or memory"}};
  }

  void run(const RunParameters& run, RunContext& context, Result& result) override {
    golden::morphological::check_parameters(parameters_);
    const LoadedFrame loaded = load_frame(frame_, static_cast<std::uint32_t>(run.seed));
    if (run.truth && !loaded.truth)
      throw spec::ConfigError(
          "run.truth: this image comes without a truth; name one with --truth FILE");
    const Image& before = loaded.input.image;
    golden::morphological::check_frame(parameters_, before.width, before.height);
    for (const auto& input : loaded.inputs) context.add_input(input);
    context.set_title(
        "Morphological engine: " + std::filesystem::path(frame_.source).filename().string(),
        summary_line(loaded));
    for (const std::string& conversion : loaded.conversions) context.add_note(conversion);
    context.set_bottleneck("luma");
    const std::vector<MorphologicalInput> frames(static_cast<std::size_t>(frame_.count),
                                                 loaded.input);
    context.claim();
    MorphologicalBench bench(frames, options(run, context));
    context.begin();
    try {
      Progress progress("morphological", frames.size() * before.pixels.size(), "pixel");
      bench.run([&](std::uint64_t pixels) {
        progress.update(pixels);
        return !interrupted();
      });
    } catch (const spec::FileError&) {  // a wave that could not be written: nothing stays
      throw;
    } catch (...) {
      bench.collect(result);
      add_pictures(run, context, loaded, bench, result);
      throw;
    }
    bench.collect(result);
    result.interrupted = !bench.complete();
    add_pictures(run, context, loaded, bench, result);
    if (bench.complete()) bench.check();
  }

  void describe_statistics(Result& result) override {
    const std::vector<MorphologicalInput> frames = {{Image(2, 2), {}}};
    MorphologicalBench(frames, MorphologicalBenchOptions{}).collect(result);
  }

 private:
  MorphologicalBenchOptions options(const RunParameters& run, const RunContext& context) const {
    MorphologicalBenchOptions o;
    o.morphological = parameters_;
    o.memory = memory_;
    o.clock_mhz = run.clock_mhz;
    o.seed = static_cast<std::uint64_t>(run.seed);
    o.stall_permille = static_cast<std::uint32_t>(std::lround(run.stalls * 1000));
    o.golden = run.check == CheckMode::kGolden;
    o.shuffle = run.shuffle;
    o.fast_path = run.fast_path;
    o.check_links = run.check_links;
    o.max_cycles = static_cast<rtl::Cycle>(run.max_cycles);
    o.patience = static_cast<rtl::Cycle>(run.watchdog_cycles);
    if (!run.fault.empty()) o.faults = {run.fault};
    o.trace_scope = run.trace;
    o.trace_file = context.trace_file().string();
    o.trace_from = static_cast<rtl::Cycle>(run.trace_from);
    o.trace_to = static_cast<rtl::Cycle>(run.trace_to);
    return o;
  }

  std::string summary_line(const LoadedFrame& loaded) const {
    const spec::MorphologicalParameters& p = parameters_;
    std::string text = fmt::format(
        "{} x {} pixels, preset {}: edges from {} at T = {}/65536, local contrast {}, predictor {} "
        "with N = {}{}{}{}, {} light; {} pixels a clock, {} window rows, {}",
        loaded.input.image.width, loaded.input.image.height,
        name_of(p.preset, spec::kMorphologicalPresetNames),
        name_of(p.edge_source, spec::kEdgeSourceNames), p.threshold,
        name_of(p.local_contrast, spec::kLocalContrastNames),
        name_of(p.predictor, spec::kPredictorNames), p.steps, p.contiguous ? ", contiguous" : "",
        p.safe ? ", safe" : "", p.trim ? ", trim" : "", p.linear_light ? "linear" : "stored",
        name_of(p.lanes, spec::kLanesNames), p.window_rows,
        name_of(p.storage, spec::kStorageNames));
    return text;
  }

  void add_pictures(const RunParameters& run, RunContext& context, const LoadedFrame& loaded,
                    const MorphologicalBench& bench, Result& result) const {
    const Image& before = loaded.input.image;
    const Image& after = bench.frame();
    if (after.pixels.size() != before.pixels.size()) return;  // no frame was begun
    context.add_image("before", before, "Before", "the frame as it came");
    context.add_image("after", after, "After", "the pixels that the hardware model delivered");
    if (loaded.truth) {
      context.add_image("truth", *loaded.truth, "Truth", loaded.truth_name);
      context.add_image("error", difference(after, *loaded.truth, 4), "Error",
                        "after against truth, 4 times");
      if (!result.interrupted) judge(loaded, after, result);
    }
    context.add_image("difference", difference(after, before, 4), "Difference",
                      "after against before, 4 times");
    context.add_image("edges", edge_picture(before, bench.taps()), "Edges",
                      "left edges red, top edges green");
    context.add_image("weights", weight_picture(before.width, before.height, bench.taps()),
                      "Weights",
                      "share of the upper or left neighbour red, of the lower or right one green, "
                      "blue where the two are left and right");
    if (run.check == CheckMode::kGolden && bench.golden().pixels().size() == after.pixels.size()) {
      Image expected(after.width, after.height);
      expected.pixels = bench.golden().pixels();
      context.add_image("golden", expected, "Golden model", "the same frame by the golden model");
    }
  }

  static void judge(const LoadedFrame& loaded, const Image& after, Result& result) {
    const Image& before = loaded.input.image;
    const Mask edges = edge_mask(*loaded.truth, before);
    Quality quality;
    quality.reference = loaded.truth_name;
    quality.psnr_db = psnr(after, *loaded.truth);
    quality.psnr_edge_db = psnr(after, *loaded.truth, edges);
    const auto add = [&](const char* name, double value, const char* meaning) {
      if (std::isfinite(value)) result.work.push_back({name, value, "dB", meaning});
    };
    add("psnr_before_db", psnr(before, *loaded.truth), "PSNR of the frame as it came.");
    add("psnr_edge_before_db", psnr(before, *loaded.truth, edges),
        "The same over edge pixels: where truth and frame differ by more than 2/255.");
    if (loaded.depth) {
      const Mask silhouettes = silhouette_mask(edges, *loaded.depth);
      quality.psnr_silhouette_db = psnr(after, *loaded.truth, silhouettes);
      add("psnr_silhouette_before_db", psnr(before, *loaded.truth, silhouettes),
          "The same over edge pixels with a depth step of 5 % to a neighbour.");
    }
    result.quality = quality;
  }

  FrameParameters frame_;
  spec::MorphologicalParameters parameters_;
  MemoryParameters memory_;
};

}  // namespace

std::unique_ptr<Engine> make_morphological_engine() {
  return std::make_unique<MorphologicalCommand>();
}

void apply_preset(const ParameterSet& set, spec::MorphologicalParameters& values) {
  const spec::MorphologicalParameters rules =
      golden::morphological::preset_parameters(values.preset);
  const auto take = [&](std::string_view name, auto member) {
    if (!set.given(fmt::format("morphological.{}", name))) values.*member = rules.*member;
  };
  using P = spec::MorphologicalParameters;
  take("edges.threshold_mode", &P::threshold_mode);
  take("edges.dynamic_luma", &P::dynamic_luma);
  take("edges.threshold", &P::threshold);
  take("edges.local_contrast", &P::local_contrast);
  take("predictor", &P::predictor);
  take("steps", &P::steps);
  take("contiguous", &P::contiguous);
  take("safe", &P::safe);
  take("trim", &P::trim);
  take("area", &P::area);
  take("diagonals", &P::diagonals);
}

Image edge_picture(const Image& frame, const std::vector<spec::BlendTap>& taps) {
  constexpr int kDim = 3;
  Image picture(frame.width, frame.height);
  for (std::size_t i = 0; i < taps.size(); ++i) {
    const Rgba8& p = frame.pixels[i];
    const auto grey = static_cast<std::uint8_t>((p[0] + 2 * p[1] + p[2]) / 4 / kDim);
    picture.pixels[i] = {taps[i].edges & 1 ? std::uint8_t{255} : grey,
                         taps[i].edges & 2 ? std::uint8_t{255} : grey, grey, 255};
  }
  return picture;
}

Image weight_picture(int width, int height, const std::vector<spec::BlendTap>& taps) {
  const auto bright = [](int share) { return static_cast<std::uint8_t>(std::min(255, 2 * share)); };
  Image picture(width, height);
  for (std::size_t i = 0; i < taps.size(); ++i)
    picture.pixels[i] = {bright(taps[i].first), bright(taps[i].second),
                         static_cast<std::uint8_t>(taps[i].horizontal ? 160 : 0), 255};
  return picture;
}

}  // namespace deburr::tb
