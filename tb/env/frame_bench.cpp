// SPDX-License-Identifier: MIT
#include "tb/env/frame_bench.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <ctime>
#include <utility>

#include "golden/morphological/configuration.h"
#include "golden/morphological/traffic.h"
#include "spec/error.h"
#include "tb/env/collect.h"
#include "tb/env/morphological_bench.h"
#include "tb/env/morphological_frames.h"
#include "tb/results/progress.h"
#include "tb/results/report.h"

namespace deburr::tb {
namespace {

using golden::texture::TextureGolden;

constexpr rtl::Cycle kProgressPeriod = 4096;
constexpr std::uint64_t kMemoryGrain = 64;
constexpr std::uint64_t kFaultyRequest = 20;

constexpr std::array kFaults = {
    FrameFault{"flip-bit", "Flips a bit of the red channel of output beat 100.",
               "flip:blended:100:4"},
    FrameFault{"drop-pixel", "Drops output beat 100.", "drop:blended:100"},
    FrameFault{"duplicate-pixel", "Delivers output beat 100 twice.", "duplicate:blended:100"},
    FrameFault{"flip-colour", "Flips a bit of texture colour 100, in front of the frame buffer.",
               "flip:colours:100:52"},
    FrameFault{"drop-colour", "Drops texture colour 100: its row is never complete.",
               "drop:colours:100"},
    FrameFault{"stuck-ready", "Holds back the slots of the luma unit from cycle 500 on.",
               "stuck_ready:morphological.slots:500"},
    FrameFault{"lost-response", "Texture memory never answers request 20.", ""},
    FrameFault{"memory-error", "Texture memory answers request 20 with an error.", ""}};

std::vector<std::string> link_faults(const std::vector<std::string>& names) {
  std::vector<std::string> faults;
  for (const std::string& name : names) {
    if (name.find(':') != std::string::npos) {
      faults.push_back(name);
      continue;
    }
    const auto found = std::find_if(kFaults.begin(), kFaults.end(),
                                    [&](const FrameFault& f) { return f.name == name; });
    if (found == kFaults.end()) {
      std::string known;
      for (const FrameFault& f : kFaults) known += fmt::format(" {}", f.name);
      throw spec::ConfigError(fmt::format(
          "no fault '{}': known are{}, and LINK faults such as drop:blended:100", name, known));
    }
    if (!found->link_fault.empty()) faults.emplace_back(found->link_fault);
  }
  return faults;
}

bool planted(const FrameBenchOptions& options, std::string_view fault) {
  return std::find(options.faults.begin(), options.faults.end(), fault) != options.faults.end();
}

int lanes_of(const spec::morphological::Parameters& p) {
  return spec::morphological::kLaneCount[static_cast<std::size_t>(p.lanes)];
}

double number(std::uint64_t value) { return static_cast<double>(value); }
double ratio(double a, double b) { return b > 0 ? a / b : 0.0; }

}  // namespace

std::span<const FrameFault> frame_faults() { return kFaults; }

// ---- the frame buffer ---------------------------------------------------------------------------

FrameBuffer::FrameBuffer(const sc_core::sc_module_name& name, rtl::ClockDomain& clock,
                         const TextureScene& scene, int lanes)
    : Unit(name, clock),
      scene_(scene),
      lanes_(lanes),
      waiting_(declare_stall("texture", "the next row still lacks fragments")),
      sky_(FrameAssembler(scene.stream(), scene.scene()).frame()) {
  input_.depth = depth_codes(scene.stream().depth);
  reset();
}

void FrameBuffer::reset() {
  const FragmentStream& stream = scene_.stream();
  input_.image = sky_;
  missing_.assign(static_cast<std::size_t>(stream.height), 0);
  for (const spec::texture::Quad& quad : stream.quads)
    for (int lane = 0; lane < 4; ++lane)
      if (quad.coverage >> lane & 1)
        ++missing_[static_cast<std::size_t>(stream.pixel(quad.tag, lane).y)];
  x_ = y_ = 0;
  last_colour_ = first_beat_ = 0;
}

// Fragments of one pixel come in the order of their triangles; only the nearest one is shown.
void FrameBuffer::store(rtl::Cycle cycle, const spec::texture::Colour& colour) {
  const FragmentStream& stream = scene_.stream();
  last_colour_ = cycle;
  bytes_written += spec::morphological::kFramePixelBytes;
  if (colour.tag >= stream.quads.size() || colour.lane >= 4) return;  // counted by the scoreboard
  const FragmentStream::Pixel p = stream.pixel(colour.tag, colour.lane);
  if (p.x >= stream.width || p.y >= stream.height) return;
  if (stream.visible[colour.tag] >> colour.lane & 1) input_.image.at(p.x, p.y) = colour.rgba;
  std::uint32_t& missing = missing_[static_cast<std::size_t>(p.y)];
  if (missing > 0) --missing;
}

rtl::Activity FrameBuffer::tick(rtl::Cycle cycle) {
  bool worked = false;
  rtl::Activity activity = rtl::kIdle;
  if (!done()) {
    if (missing_[static_cast<std::size_t>(y_)] != 0) {
      activity = waiting_;
    } else if (!pixels_out.can_push(cycle)) {
      activity = rtl::kStalledDownstream;
    } else {
      if (x_ == 0 && y_ == 0) first_beat_ = cycle;
      const spec::morphological::PixelBeat beat = pixel_beat(input_, x_, y_, lanes_);
      bytes_read += static_cast<std::uint64_t>(spec::morphological::kFramePixelBytes) * beat.count;
      pixels_out.push(cycle, beat);
      x_ += lanes_;
      if (x_ >= input_.image.width) x_ = 0, ++y_;
      worked = true;
    }
  }
  if (colours_in.can_pop(cycle)) {
    const spec::texture::Colour colour = colours_in.take(cycle);
    store(cycle, colour);
    if (on_colour) on_colour(cycle, colour);
    worked = true;
  }
  return worked ? rtl::kBusy : activity;
}

// ---- the bench ----------------------------------------------------------------------------------

FrameBench::FrameBench(const TextureScene& scene, const FrameBenchOptions& options)
    : scene_(scene),
      options_(options),
      clock_("clock", clock_period(options.clock_mhz)),
      driver_("driver", clock_),
      texture_("texture", clock_, options.texture),
      buffer_("frame_buffer", clock_, scene, lanes_of(options.morphological)),
      engine_("morphological", clock_, options.morphological),
      sink_("sink", clock_),
      memory_("memory", clock_.period(),
              memory_model_parameters(options.memory, scene.memory().bytes().size(), options.seed)),
      texture_golden_(make_golden(
          scene, options.texture,
          options.golden ? TextureGolden::Traffic::kPredict : TextureGolden::Traffic::kIgnore)),
      smoothing_golden_(options.morphological),
      colour_board_("colours", 0,
                    [](const spec::texture::Colour& c) {
                      return fmt::format("tag {} lane {} RGBA ({}, {}, {}, {})", c.tag, c.lane,
                                         c.rgba[0], c.rgba[1], c.rgba[2], c.rgba[3]);
                    }),
      fill_board_("line fills", 0,
                  [](const Fill& f) { return fmt::format("read of {:#x}", f.address); }),
      pixel_board_("pixels",
                   [](const spec::morphological::Rgba8& p) {
                     return fmt::format("RGBA ({}, {}, {}, {})", p[0], p[1], p[2], p[3]);
                   }),
      tap_board_("taps",
                 [](const spec::morphological::BlendTap& t) {
                   return fmt::format("{} shares {} {}, edges {}",
                                      t.horizontal ? "left/right" : "up/down", t.first, t.second,
                                      t.edges);
                 }),
      traffic_board_("memory lines", 0,
                     [](const spec::morphological::FrameAccess& a) {
                       return fmt::format("{} of address {:#x}", a.write ? "write" : "read",
                                          a.address);
                     }),
      frame_(scene.stream().width, scene.stream().height),
      taps_(frame_.pixels.size()) {
  golden::morphological::check_frame(options.morphological, frame_.width, frame_.height);
  driver_.beats_out(quads_);
  texture_.quads_in(quads_);
  texture_.colours_out(colours_);
  buffer_.colours_in(colours_);
  buffer_.pixels_out(pixels_);
  engine_.pixels_in(pixels_);
  engine_.pixels_out(blended_);
  sink_.beats_in(blended_);
  texture_.memory()->bind(memory_.ports);
  texture_host_.bus.bind(texture_.registers);
  engine_host_.bus.bind(engine_.registers);
  if (engine_.memory() != nullptr) {
    MemoryModelParameters m =
        memory_model_parameters(options.frame_memory,
                                std::uint64_t{golden::morphological::frame_stride(frame_.width)} *
                                    static_cast<std::uint64_t>(frame_.height),
                                options.seed);
    m.record_writes = true;
    frame_memory_ = std::make_unique<MemoryModel>("frame_memory", clock_.period(), m);
    engine_.memory()->bind(frame_memory_->ports);
  }
  memory_.preload(0, scene.memory().bytes());
  if (planted(options, "lost-response")) memory_.lose_request(kFaultyRequest);
  if (planted(options, "memory-error")) memory_.fail_request(kFaultyRequest);

  BenchOptions bench = bench_options(options, link_faults(options.faults));
  bench.at_limit = [this] {
    return out_of_cycles(options_.max_cycles, position_, frame_.pixels.size(), "pixel");
  };
  bench_ = std::make_unique<Bench>(clock_, bench);

  sink_.keep(false);
  sink_.on_beat = [this](rtl::Cycle cycle, const spec::morphological::BlendedBeat& beat) {
    judge(cycle, beat);
  };
  const std::vector<spec::texture::Quad>& quads = scene.stream().quads;
  driver_.send([&quads](std::uint64_t index, spec::texture::Quad& quad) {
    if (index >= quads.size()) return false;
    quad = quads[index];
    return true;
  });
  if (!options.golden) return;
  const std::uint64_t line_bytes = texture_golden_.cache().line_bytes();
  texture_golden_.set_fill_sink([this, line_bytes](std::uint32_t line) {
    const std::uint64_t begin = line * line_bytes;
    for (std::uint64_t a = begin; a < begin + line_bytes; a += kMemoryGrain)
      fill_board_.expect({a});
  });
  driver_.on_send = [this](rtl::Cycle, const spec::texture::Quad& quad) {
    texture_golden_.process(quad,
                            [this](const spec::texture::Colour& c) { colour_board_.expect(c); });
  };
  buffer_.on_colour = [this](rtl::Cycle cycle, const spec::texture::Colour& c) {
    colour_board_.got(c, fmt::format("cycle {}", cycle));
  };
  golden_textured_ = golden_frame(scene, options.texture).image;
  const std::vector<std::uint32_t> depth = depth_codes(scene.stream().depth);
  smoothing_golden_.process({golden_textured_.pixels, frame_.width, frame_.height},
                            {depth, frame_.width, frame_.height});
  pixel_board_.expect(smoothing_golden_.pixels(), frame_.width);
  tap_board_.expect(smoothing_golden_.taps(), frame_.width);
}

// The wave is closed before anything that it shows is gone.
FrameBench::~FrameBench() { bench_.reset(); }

void FrameBench::judge(rtl::Cycle cycle, const spec::morphological::BlendedBeat& beat) {
  for (std::size_t i = 0; i < std::min<std::size_t>(beat.count, spec::morphological::kMaxLanes);
       ++i) {
    if (options_.golden) {
      pixel_board_.got(beat.pixel[i], cycle);
      tap_board_.got(beat.tap[i], cycle);
    }
    if (position_ < frame_.pixels.size()) {
      frame_.pixels[position_] = beat.pixel[i];
      taps_[position_] = beat.tap[i];
    }
    ++position_;
  }
}

void FrameBench::run(const Progress& progress) {
  constexpr rtl::Cycle kResetCycles = 4;
  clock_.set_reset_n(false);
  clock_.run(kResetCycles);
  clock_.set_reset_n(true);
  int handle = 0;
  for (const spec::texture::Descriptor& descriptor : scene_.memory().descriptors())
    for (const auto& [offset, value] : descriptor_registers(handle++, descriptor))
      texture_host_.write(offset, value);
  engine_host_.write(
      spec::morphological::reg::kSize,
      static_cast<std::uint32_t>(frame_.width) | static_cast<std::uint32_t>(frame_.height) << 16);

  rtl::Cycle next_progress = 0;
  bool stopped = false;
  const auto judge_fills = [&] {
    const std::vector<std::uint64_t>& lines = memory_.lines_read();
    for (; options_.golden && fills_judged_ < lines.size(); ++fills_judged_)
      fill_board_.got({lines[fills_judged_]}, fmt::format("fill {}", fills_judged_));
  };
  const auto done = [&] {
    judge_fills();
    if (progress && clock_.cycle() >= next_progress) {
      next_progress = clock_.cycle() + kProgressPeriod;
      const std::uint64_t taken =
          buffer_.bytes_read.value() / spec::morphological::kFramePixelBytes;
      if (!progress(position_, taken)) return stopped = true;
    }
    return buffer_.done() && driver_.done() && texture_.idle() && engine_.idle() &&
           quads_.empty() && colours_.empty() && pixels_.empty() && blended_.empty();
  };
  started_ = clock_.cycle();
  running_ = true;
  const auto begin = std::chrono::steady_clock::now();
  const std::clock_t cpu_begin = std::clock();
  const auto stop_clock = [&] {
    host_seconds_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    cpu_seconds_ = static_cast<double>(std::clock() - cpu_begin) / CLOCKS_PER_SEC;
    cycles_ = clock_.cycle() - started_;
    running_ = false;
  };
  try {
    bench_->run(done, options_.cycle_limit(), false);
  } catch (...) {
    stop_clock();
    throw;
  }
  stop_clock();
  if (stopped) return;
  if (bench_->links()) bench_->links()->check_empty();
  judge_fills();
  if (options_.golden && frame_memory_) {
    for (const spec::morphological::FrameAccess& access : smoothing_golden_.traffic())
      traffic_board_.expect(access);
    for (const std::uint64_t a : frame_memory_->lines_written())
      traffic_board_.got({static_cast<std::uint32_t>(a), true});
    for (const std::uint64_t a : frame_memory_->lines_read())
      traffic_board_.got({static_cast<std::uint32_t>(a), false});
  }
  complete_ = true;
  if (const std::uint64_t errors = texture_.cache.miss_queue.memory_errors.value(); errors != 0)
    throw spec::SimulationError(
        fmt::format("memory answered {} line fills with an error, which read as zero: look at the "
                    "addresses in the texture descriptors",
                    errors));
}

void FrameBench::check() const {
  if (!options_.golden) return;
  colour_board_.check();
  fill_board_.check();
  pixel_board_.check();
  tap_board_.check();
  traffic_board_.check();
}

void FrameBench::collect(Result& result) const {
  auto& texture = const_cast<rtl::texture::TextureUnit&>(texture_);
  auto& engine = const_cast<rtl::morphological::MorphologicalEngine&>(engine_);
  result.cycles = running_ ? clock_.cycle() - started_ : cycles_;
  result.host_seconds = host_seconds_;
  result.host_cpu_seconds = cpu_seconds_;
  result.comparisons = result.mismatches = 0;
  for (const ScoreboardBase* board :
       std::initializer_list<const ScoreboardBase*>{&colour_board_, &pixel_board_, &tap_board_}) {
    result.comparisons += board->comparisons();
    result.mismatches += board->mismatches() + (complete_ ? board->leftovers() : 0);
  }
  result.traffic_comparisons = fill_board_.comparisons() + traffic_board_.comparisons();
  result.traffic_mismatches =
      fill_board_.mismatches() + traffic_board_.mismatches() +
      (complete_ ? fill_board_.leftovers() + traffic_board_.leftovers() : 0);
  result.bytes_read = memory_.bytes_read() + (frame_memory_ ? frame_memory_->bytes_read() : 0);
  result.bytes_written = frame_memory_ ? frame_memory_->bytes_written() : 0;
  result.lines_filled =
      texture.cache.miss_queue.line_fills.value() + (frame_memory_ ? frame_memory_->reads() : 0);

  for (const rtl::Unit* unit : texture.units())
    result.units.push_back(unit_cycles("texture_" + name_within(texture, *unit), *unit));
  result.units.push_back(unit_cycles("frame_buffer", buffer_));
  for (const rtl::MemoryBase* storage : texture.memories())
    result.sram.push_back({"texture_" + name_within(texture, *storage), storage->ports(),
                           storage->bits(), storage->bits()});

  const auto add = [&](std::string name, nlohmann::ordered_json value, std::string unit,
                       std::string meaning) {
    result.work.push_back({std::move(name), std::move(value), std::move(unit), std::move(meaning)});
  };
  result.latency = latency_of(engine.beat_latency);
  const std::uint64_t bilinears = texture.address.addresser.bilinears.value();
  const std::uint64_t raster =
      frame_clocks_by_formula(options_.morphological, frame_.width, frame_.height);
  const auto since_start = [&](rtl::Cycle cycle) {
    return cycle > started_ ? cycle - started_ : 0;
  };
  const std::uint64_t texturing = since_start(buffer_.last_colour());
  const std::uint64_t smoothing =
      result.cycles - std::min(result.cycles, since_start(buffer_.first_beat()));
  add("texturing_clocks", texturing, "clk", "From the first quad to the last colour.");
  add("smoothing_clocks", smoothing, "clk",
      "From the first row out of the frame buffer to the last pixel.");
  add("overlapped_clocks", texturing + smoothing - std::min(texturing + smoothing, result.cycles),
      "clk", "Clocks in which both engines were at this frame.");
  add("smoothing_clocks_by_formula", raster, "clk",
      "Of the morphological engine alone, if nothing stalls.");
  add("bilinears", bilinears, "request", "Bilinear requests; one a clock at most.");
  add("fragment_latency_p50", texture.fragment_latency.percentile(50), "clk",
      "Of the texture unit.");
  add("fragment_latency_max", texture.fragment_latency.max(), "clk", "Of the texture unit.");
  add("frame_buffer_bytes_written", buffer_.bytes_written.value(), "byte",
      "Colours, 4 bytes each.");
  add("frame_buffer_bytes_read", buffer_.bytes_read.value(), "byte", "Pixels, 4 bytes each.");
  for (const rtl::Counter* counter : texture.counters())
    add("texture_" + name_within(texture, *counter), counter->value(), counter->unit(),
        sentence(counter->meaning()));
  const std::uint64_t slower = std::max(bilinears, raster);
  add("slower_engine_clocks", slower, "clk",
      "Of the slower engine alone if nothing stalls: the texture unit's bilinears, one a clock, or "
      "smoothing_clocks_by_formula.");
  add("frame_buffer_bytes",
      std::uint64_t{spec::morphological::kFramePixelBytes} * frame_.pixels.size(), "byte",
      "Size of the frame buffer, which is not among the SRAM: its memory is not modelled in time.");
  result.figures.clear();
  if (complete_)
    result.figures = {
        {"Frame", "cycles", "slower engine alone", "work.slower_engine_clocks", true},
        {"Texturing", "work.texturing_clocks", "bilinears", "work.bilinears"},
        {"Smoothing", "work.smoothing_clocks", "formula", "work.smoothing_clocks_by_formula"},
        {"Both at once", "work.overlapped_clocks"}};
  for (const Figure& figure : std::initializer_list<Figure>{
           {"Latency of a texture fragment, median", "work.fragment_latency_p50"},
           {"Frame buffer, outside the SRAM", "work.frame_buffer_bytes"},
           {"Written to the frame buffer", "work.frame_buffer_bytes_written"},
           {"Read from the frame buffer", "work.frame_buffer_bytes_read"}})
    result.figures.push_back(figure);
  collect_morphological(engine, frame_.width, "morphological_", result);

  result.throughput = ratio(number(position_), number(result.cycles));
  result.throughput_unit = "pixel/clk";
  result.throughput_bound = ratio(number(frame_.pixels.size()), number(slower));
  result.throughput_bound_meaning = fmt::format(
      "Pixels of the frame over the clocks of the slower engine alone ({}), the other one hidden "
      "behind it: texturing takes {} clocks at least, smoothing {}.",
      raster >= bilinears ? "smoothing" : "texturing", grouped(bilinears), grouped(raster));
  result.bottleneck = find_bottleneck(result.units, "morphological_blender");
}

}  // namespace deburr::tb
