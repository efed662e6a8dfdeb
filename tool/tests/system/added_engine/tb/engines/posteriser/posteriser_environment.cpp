// SPDX-License-Identifier: MIT
#include "tb/engines/posteriser/posteriser_environment.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "golden/posteriser/posteriser_golden.h"
#include "spec/posteriser/registers.h"
#include "tb/env/collect.h"

namespace deburr::tb {
namespace {

using spec::posteriser::Tone;
namespace reg = spec::posteriser::reg;

std::string describe_tone(const Tone& t) {
  return fmt::format("RGB ({}, {}, {}){}", t.colour[0], t.colour[1], t.colour[2],
                     t.last ? ", the last" : "");
}

Rgba8 colour_of(const Tone& t) { return {t.colour[0], t.colour[1], t.colour[2], 255}; }

}  // namespace

void PosteriserMeter::collect(Result& result, const rtl::Engine& engine) const {
  add_parts(result, engine, 0);
  add_counters(result, engine);
}

void PosteriserMeter::show(Observer& observer, const rtl::Engine& engine, const rtl::LinkBase& in,
                           const rtl::LinkBase& out) const {
  Meter::show(observer, "pixels_in", in);
  Meter::show(observer, engine);
  Meter::show(observer, "pixels_out", out);
  observer.see({"Pixels delivered", figure("levels_pixels"), "pixel/clk", 1});
}

void PosteriserMeter::collect_headline(Result& result, std::uint64_t delivered,
                                       int link_depth) const {
  result.throughput = ratio(number(delivered), number(result.cycles));
  result.throughput_unit = "pixel/clk";
  result.throughput_bound = link_depth > 1 ? 1 : 0.5;
  result.throughput_bound_meaning = "One pixel per cycle; half of it with links of depth 1.";
  result.bottleneck = find_bottleneck(result.units, figure("levels"));
}

PosteriserEnvironment::PosteriserEnvironment(Simulation& simulation, const Image& picture,
                                             const spec::posteriser::Parameters& parameters,
                                             std::string name)
    : Environment(simulation, std::move(name)),
      tones_in("tones_in", static_cast<std::uint32_t>(parameters.link_depth)),
      picture_(picture),
      parameters_(parameters),
      tones_out_("tones_out", static_cast<std::uint32_t>(parameters.link_depth)),
      source_(this->name().empty() ? std::make_unique<Driver<Tone>>("source", simulation.clock())
                                   : nullptr),
      engine_("posteriser", simulation.clock(), as_built()),
      sink_("sink", simulation.clock()),
      host_("posteriser_host"),
      meter_(this->name()),
      board_("pixels", describe_tone),
      register_board_(spec::posteriser::kRegisters),
      frame_(picture.width, picture.height) {
  know({{"flip-bit", "Flips a bit of output pixel 10.", "flip:tones_out:10:colour.r.6"},
        {"wrong-rule", "The posteriser has a level less than was ordered.", "",
         parameters.bits > 1 ? "" : "posteriser.bits of at least 2"}});
  let_blind({&board_, &register_board_.board()});
  let_miscount(register_board_, std::array{reg::kPixels, reg::kChanged});
  if (source_) source_->beats_out(tones_in);
  engine_.tones_in(tones_in);
  engine_.tones_out(tones_out_);
  sink_.beats_in(tones_out_);
  host_.bus.bind(engine_.registers);
  sink_.keep(false);
  sink_.on_beat = [this](rtl::Cycle cycle, const Tone& tone) {
    if (golden()) board_.got(tone, cycle);
    if (came_ < frame_.pixels.size()) frame_.pixels[came_] = colour_of(tone);
    ++came_;
  };
}

spec::posteriser::Parameters PosteriserEnvironment::as_built() const {
  spec::posteriser::Parameters p = parameters_;
  if (injected("wrong-rule")) p.bits = std::max(1, p.bits - 1);
  return p;
}

void PosteriserEnvironment::configure() { driver_.identify(); }

bool PosteriserEnvironment::begin(std::size_t piece) {
  if (piece > 0) return false;
  tones_.clear();
  for (const Rgba8& p : picture_.pixels) tones_.push_back({{p[0], p[1], p[2]}, false});
  tones_.back().last = true;
  expected_ = golden::posteriser::posterised(parameters_, tones_);
  if (golden()) board_.expect(expected_, picture_.width);
  if (source_) source_->send(tones_);
  return true;
}

bool PosteriserEnvironment::done() const {
  return (!source_ || source_->done()) && tones_in.empty() && tones_out_.empty();
}

void PosteriserEnvironment::restart() {
  came_ = 0;
  board_.restart();
}

void PosteriserEnvironment::finish() {
  if (!golden()) return;
  board_.require(expected_.size());
  std::uint64_t changed = 0;
  for (std::size_t i = 0; i < tones_.size(); ++i) changed += tones_[i] == expected_[i] ? 0 : 1;
  register_board_.check(host_, std::array<std::pair<std::uint32_t, std::uint64_t>, 2>{
                                   {{reg::kPixels, expected_.size()}, {reg::kChanged, changed}}});
}

void PosteriserEnvironment::collect(Result& result) const { meter_.collect(result, engine_); }

void PosteriserEnvironment::show_parts(Observer& observer) const {
  meter_.show(observer, engine_, tones_in, tones_out_);
}

std::vector<PictureMap> PosteriserEnvironment::maps() const {
  if (!simulation().options().maps) return {};
  PictureMap map("level", "Level of red", "", "Level that the red of each pixel has now.",
                 picture_.width, picture_.height);
  for (std::size_t i = 0; i < std::min(came_, frame_.pixels.size()); ++i)
    map.values[i] =
        static_cast<float>(golden::posteriser::level_of(parameters_, frame_.pixels[i][0]));
  return meter_.named({map});
}

Coverage PosteriserEnvironment::declared_coverage() {
  Coverage coverage;
  for (const char* const bin : {"up", "down", "same"})
    coverage.declare(fmt::format("posteriser/red/{}", bin));
  return coverage;
}

Coverage PosteriserEnvironment::coverage() const {
  Coverage coverage = declared_coverage();
  for (std::size_t i = 0; i < expected_.size(); ++i) {
    const int before = tones_[i].colour[0], after = expected_[i].colour[0];
    coverage.hit(fmt::format("posteriser/red/{}", after > before   ? "up"
                                                  : after < before ? "down"
                                                                   : "same"));
  }
  return coverage;
}

void PosteriserEnvironment::collect_headline(Result& result) const {
  meter_.collect_headline(result, came_, parameters_.link_depth);
}

Image PosteriserEnvironment::golden_frame() const {
  Image image(picture_.width, picture_.height);
  std::transform(expected_.begin(), expected_.end(), image.pixels.begin(), colour_of);
  return image;
}

}  // namespace deburr::tb
