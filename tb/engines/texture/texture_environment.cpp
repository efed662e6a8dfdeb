// SPDX-License-Identifier: MIT
#include "tb/engines/texture/texture_environment.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "spec/error.h"
#include "spec/texture/registers.h"

namespace deburr::tb {
namespace {

using golden::texture::TextureGolden;

constexpr std::uint64_t kMemoryGrain = 64;  // longer reads are recorded in parts of this size

TextureGolden golden_model(const TextureScene& scene, const TextureSetup& setup, bool used) {
  return make_golden(scene, setup.texture,
                     used ? TextureGolden::Traffic::kPredict : TextureGolden::Traffic::kIgnore,
                     error_range(setup.memory));
}

}  // namespace

// ---- building -----------------------------------------------------------------------------------

TextureEnvironment::TextureEnvironment(Simulation& simulation, const TextureScene& scene,
                                       const TextureSetup& setup, std::string name)
    : Environment(simulation, std::move(name)),
      scene_(scene),
      setup_(setup),
      faults_(simulation.faults(), this->name(), setup_),
      quad_driver_("driver", simulation.clock()),
      unit_("texture", simulation.clock(), faults_.as_built(), memory_clocks(setup_)),
      memory_("memory", simulation.clock().period(),
              memory_model_parameters(setup.memory, scene.memory().bytes().size(),
                                      simulation.options().seed)),
      host_("texture_host"),
      driver_(host_, memory_),
      meter_(this->name(), unit_, memory_, scene.memory()),
      stranger_("stranger"),
      golden_(golden_model(scene, setup, golden())),
      colour_board_("colours", 0, [this](const spec::texture::Colour& c) { return describe(c); }),
      fill_board_("line fills", 0,
                  [](const Fill& f) { return fmt::format("read of address {:#x}", f.address); }),
      register_board_(spec::texture::kRegisters) {
  know(TextureFaults::list());
  let_blind({&colour_board_, &fill_board_, &register_board_.board()});
  namespace reg = spec::texture::reg;
  let_miscount(register_board_,
               std::array{reg::kFragments, reg::kBilinears, reg::kLineFills, reg::kClamped,
                          reg::kSaturated, reg::kMemoryErrors, reg::kInvalidFragments});
  colour_board_.call_items([this](const spec::texture::Colour& c) { return place(c); });
  quad_driver_.beats_out(quads_);
  unit_.quads_in(quads_);
  unit_.colours_out(colours);
  if (setup_.connect)
    setup_.connect(unit_, memory_);
  else
    unit_.memory()->bind(memory_.ports);
  host_.bus.bind(unit_.registers);
  stranger_.memory.bind(memory_.ports);
  if (this->name().empty()) {
    sink_ = std::make_unique<Sink<spec::texture::Colour>>("sink", simulation.clock());
    sink_->beats_in(colours);
    sink_->keep(false);
    sink_->on_beat = [this](rtl::Cycle cycle, const spec::texture::Colour& colour) {
      judge(cycle, colour);
    };
  }
  if (simulation.options().coverage) coverage_.emplace(setup.texture);
  if (simulation.options().maps)
    maps_ =
        std::make_unique<TextureMaps>(simulation.clock(), unit_, quads_, colours, scene.stream());
  plant_in(memory_, setup.memory);
  fetch_again_ = faults_.fetches_again();
  driver_.load(faults_.contents(scene.memory()));

  quad_driver_.send([this](std::uint64_t, spec::texture::Quad& quad) {
    if (!source_(quad_)) return false;
    quad = quad_.quad;
    sent_.add(quad_);
    if (setup_.observer) setup_.observer(quad_);
    if (coverage_) coverage_->see(golden_, quad);
    return true;
  });
  clear_outputs();
  expect_from_golden();
}

QuadSource TextureEnvironment::open() const {
  if (setup_.foreign.open) return setup_.foreign.open();
  return [&stream = scene_.stream(), index = std::size_t{0}](TracedQuad& quad) mutable {
    if (index == stream.quads.size()) return false;
    quad = {stream.quads[index], stream.visible[index], true};
    ++index;
    return true;
  };
}

std::uint64_t TextureEnvironment::fragments() const {
  return setup_.foreign.open ? setup_.foreign.fragments : scene_.stream().counts.fragments;
}

void TextureEnvironment::expect_line(std::uint32_t line) {
  const std::uint64_t line_bytes = golden_.cache().line_bytes(), begin = line * line_bytes;
  for (std::uint64_t a = begin; a < begin + line_bytes; a += kMemoryGrain) fill_board_.expect({a});
}

void TextureEnvironment::expect_from_golden() {
  if (!golden()) return;
  const auto expect_colour = [this](const spec::texture::Colour& colour) {
    colour_board_.expect(colour);
    tb::show(quad_, colour, golden_frame_);
  };
  if (setup_.expectation) {
    quad_driver_.on_send = [this, expect_colour](rtl::Cycle, const spec::texture::Quad&) {
      const TextureExpectation& all = *setup_.expectation;
      const std::uint64_t quad = quad_driver_.sent() - 1;
      const TextureExpectation::Behind from = quad > 0 ? all.behind[quad - 1]
                                                       : TextureExpectation::Behind(),
                                       to = all.behind[quad];
      for (std::size_t i = from.fills; i < to.fills; ++i) expect_line(all.fills[i]);
      for (std::size_t i = from.colours; i < to.colours; ++i) expect_colour(all.colours[i]);
    };
    return;
  }
  golden_.set_fill_sink([this](std::uint32_t line) { expect_line(line); });
  quad_driver_.on_send = [this, expect_colour](rtl::Cycle, const spec::texture::Quad& quad) {
    golden_.process(quad, expect_colour);
  };
}

void TextureEnvironment::clear_outputs() {
  frame_ = golden_frame_ = FrameAssembler(scene_.stream(), scene_.scene()).frame();
  source_ = open();
  sent_ = {};
  fills_judged_ = 0;
  delivered_ = 0;
  hash_ = {};
  if (maps_) maps_->clear();
  if (coverage_) coverage_->clear();
  came_.assign(frame_.pixels.size(), 0);
}

// ---- running ------------------------------------------------------------------------------------

void TextureEnvironment::configure() {
  driver_.identify();
  int handle = 0;
  for (const spec::texture::Descriptor& descriptor : scene_.memory().descriptors())
    driver_.set_texture(handle++, descriptor);
}

void TextureEnvironment::watch() {
  if (fetch_again_ && memory_.lines_read().size() > kFaultyRequest) fetch_again();
  if (golden())
    for (; fills_judged_ < memory_.lines_read().size(); ++fills_judged_)
      fill_board_.got({memory_.lines_read()[fills_judged_]}, simulation().clock().cycle());
  if (fetch_again_) return;
  memory_.forget_lines();
  fills_judged_ = 0;
}

bool TextureEnvironment::done() const {
  return quad_driver_.done() && unit_.idle() && quads_.empty() && colours.empty();
}

void TextureEnvironment::restart() {
  memory_.clear_statistics();
  colour_board_.restart();
  fill_board_.restart();
  clear_outputs();
  golden_ = golden_model(scene_, setup_, golden());
  expect_from_golden();
}

void TextureEnvironment::finish() {
  if (!golden()) return;
  namespace reg = spec::texture::reg;
  colour_board_.require(fragments());
  fill_board_.require(std::max<std::uint64_t>(1, memory_.bytes_read() / kMemoryGrain));
  const golden::texture::TextureWork& work = golden_work();
  const std::pair<std::uint32_t, std::uint64_t> expected[] = {
      {reg::kFragments, work.fragments},
      {reg::kBilinears, work.bilinears},
      {reg::kLineFills, work.line_fills},
      {reg::kClamped, work.clamped},
      {reg::kSaturated, work.saturated},
      {reg::kMemoryErrors, work.memory_errors},
      {reg::kInvalidFragments, work.invalid_fragments}};
  register_board_.judge(host_, expected);
}

void TextureEnvironment::refuse_memory_errors() {
  if (const std::uint32_t errors = driver_.memory_errors(); errors != 0)
    throw spec::SimulationError(
        fmt::format("memory answered {} line fills with an error, which read as zero: look at "
                    "memory.error_address, or at the addresses in the texture descriptors",
                    errors));
}

void TextureEnvironment::refuse_unused_errors() const { refuse_untouched(memory_, setup_.memory); }

Amount TextureEnvironment::amount() const {
  return {delivered_, unit_.address.derivative.fragments.value(), fragments(), "fragment"};
}

// ---- judging ------------------------------------------------------------------------------------

void TextureEnvironment::judge(rtl::Cycle cycle, const spec::texture::Colour& colour) {
  ++delivered_;
  hash_.add(colour.tag);
  hash_.add(static_cast<std::uint64_t>(colour.lane) << 1 | (colour.last ? 1 : 0));
  for (const std::uint8_t channel : colour.rgba) hash_.add(channel);
  const std::uint64_t before = colour_board_.mismatches();
  if (golden()) colour_board_.got(colour, cycle);
  // After a mismatch tags and lanes may be anything; the picture then shows what can be placed.
  const bool trusted = !golden() || colour_board_.mismatches() == before;
  const TracedQuad* quad = sent_.take(colour, trusted);
  if (!quad || !quad->shows(colour.lane)) return;
  tb::show(*quad, colour, frame_);
  came_[frame_.index(quad->x(colour.lane), quad->y(colour.lane))] = 1;
}

void TextureEnvironment::fetch_again() {
  fetch_again_ = false;
  std::array<unsigned char, kMemoryGrain> data{};
  tlm::tlm_generic_payload payload;
  payload.set_command(tlm::TLM_READ_COMMAND);
  payload.set_address(memory_.lines_read()[kFaultyRequest]);
  payload.set_data_ptr(data.data());
  payload.set_data_length(static_cast<unsigned>(data.size()));
  payload.set_streaming_width(static_cast<unsigned>(data.size()));
  sc_core::sc_time delay = sc_core::SC_ZERO_TIME;
  stranger_.memory->b_transport(payload, delay);
}

std::string TextureEnvironment::place(const spec::texture::Colour& c) const {
  const TracedQuad* quad = sent_.find(c.tag);
  if (!quad || !quad->placed || c.lane >= 4) return "no pixel";
  return fmt::format("pixel ({}, {})", quad->x(c.lane), quad->y(c.lane));
}

std::string TextureEnvironment::describe(const spec::texture::Colour& c) const {
  return fmt::format("tag {} lane {}{} RGBA ({}, {}, {}, {})", c.tag, c.lane, c.last ? " last" : "",
                     c.rgba[0], c.rgba[1], c.rgba[2], c.rgba[3]);
}

// ---- results ------------------------------------------------------------------------------------

std::vector<PictureMap> TextureEnvironment::maps() const {
  return maps_ ? meter_.named(maps_->maps()) : std::vector<PictureMap>();
}

Coverage TextureEnvironment::coverage() const {
  return coverage_ ? coverage_->bins(unit_) : TextureCoverage::declared();
}

}  // namespace deburr::tb
