// SPDX-License-Identifier: MIT
#include "tb/engines/texture/texture_environment.h"

#include <fmt/format.h>

#include <array>
#include <utility>

#include "spec/error.h"
#include "spec/texture/registers.h"

namespace deburr::tb {
namespace {

constexpr std::size_t kLineBytes = 64;  // size of the line that is read twice

}  // namespace

// ---- construction -------------------------------------------------------------------------------

TextureEnvironment::TextureEnvironment(Simulation& simulation, const TextureScene& scene,
                                       const TextureSetup& setup, std::string name)
    : Environment(simulation, std::move(name)),
      colours("colours", 2, rtl::texture::colours_shape(setup.texture)),
      scene_(scene),
      setup_(setup),
      faults_(simulation.faults(), this->name(), setup_),
      quad_driver_("driver", simulation.clock()),
      unit_("texture", simulation.clock(), faults_.as_built(), memory_cycles(setup_),
            setup_.stand_ins),
      memory_("memory", simulation.clock().period(),
              memory_model_parameters(setup.memory, scene.memory().bytes().size(),
                                      simulation.options().seed)),
      host_("texture_host"),
      driver_(host_, memory_),
      meter_(this->name(), unit_, memory_, scene.memory()),
      extra_initiator_("stranger"),
      checks_(scene_, setup_, sent_, golden()) {
  know(faults_.list(scene.memory()));
  faults_.inject(unit_);
  let_blind(
      {&checks_.colours, &checks_.fills, &checks_.registers.board(), &checks_.figures.board()});
  let_miscount(checks_.figures);
  namespace reg = spec::texture::reg;
  let_miscount(checks_.registers,
               std::array{reg::kFragments, reg::kBilinears, reg::kLineFills, reg::kClamped,
                          reg::kSaturated, reg::kMemoryErrors, reg::kInvalidFragments});
  const auto of_first = [](std::uint32_t offset) { return reg::kTextureBase + offset; };
  let_misdecode(unit_.control,
                std::array{of_first(reg::kSize), of_first(reg::kMode), of_first(reg::kLodBias),
                           of_first(reg::kLodClamp)},
                "");
  quad_driver_.beats_out(quads_);
  unit_.quads_in(quads_);
  unit_.colours_out(colours);
  if (setup_.connect)
    setup_.connect(unit_, memory_);
  else
    unit_.memory()->bind(memory_.ports);
  host_.bus.bind(unit_.registers);
  extra_initiator_.memory.bind(memory_.ports);
  if (this->name().empty()) {
    sink_ = std::make_unique<Sink<spec::texture::ColourGroup>>("sink", simulation.clock());
    sink_->beats_in(colours);
    sink_->keep(false);
    sink_->on_beat = [this](rtl::Cycle cycle, const spec::texture::ColourGroup& group) {
      check_output(cycle, group);
    };
  }
  if (simulation.options().coverage) coverage_.emplace(setup.texture);
  if (simulation.options().maps)
    maps_ = std::make_unique<TextureMaps>(simulation.clock(), unit_, quads_, colours, sent_,
                                          scene.stream().width, scene.stream().height);
  if (const std::optional<PixelAddress>& pixel = simulation.options().pixel) {
    reject_outside(*pixel, scene.stream().width, scene.stream().height);
    DEBURR_CHECK(!setup.expectation, "a pixel is followed through a golden model of its own");
    history_ = std::make_unique<TextureHistory>(simulation.clock(), unit_, quads_, colours, *pixel);
  }
  inject_in(memory_, setup.memory);
  fetch_again_ = faults_.fetches_again();
  faults_.load(driver_, scene.memory());

  quad_driver_.send([this](std::uint64_t, spec::texture::Quad& quad) {
    if (!source_(quad_)) return false;
    quad = quad_.quad;
    sent_.add(quad_);
    if (setup_.observer) setup_.observer(quad_);
    if (coverage_) coverage_->see(checks_.golden_model(), quad);
    if (history_) followed_ = history_->send(quad_);
    return true;
  });
  if (golden())
    quad_driver_.on_send = [this](rtl::Cycle, const spec::texture::Quad&) {
      checks_.expect(quad_, quad_driver_.sent() - 1, followed_ ? history_.get() : nullptr);
    };
  clear_outputs();
}

traces::QuadSource TextureEnvironment::open() const {
  if (setup_.foreign.open) return setup_.foreign.open();
  return [&stream = scene_.stream(), index = std::size_t{0}](traces::TracedQuad& quad) mutable {
    if (index == stream.quads.size()) return false;
    quad = {stream.quads[index], stream.visible[index], true};
    ++index;
    return true;
  };
}

std::uint64_t TextureEnvironment::fragments() const {
  return setup_.foreign.open ? setup_.foreign.fragments : scene_.stream().counts.fragments;
}

void TextureEnvironment::clear_outputs() {
  frame_ = FrameAssembler(scene_.stream(), scene_.scene()).frame();
  source_ = open();
  sent_ = {};
  checks_.begin(frame_);
  delivered_ = 0;
  ended_ = false;
  hash_ = {};
  if (maps_) maps_->clear();
  if (history_) history_->clear();
  if (coverage_) coverage_->clear();
  received_.assign(frame_.pixels.size(), 0);
}

// ---- simulation ---------------------------------------------------------------------------------

void TextureEnvironment::configure() {
  driver_.identify();
  int handle = 0;
  for (const spec::texture::Descriptor& descriptor : scene_.memory().descriptors())
    driver_.set_texture(handle++, descriptor);
}

void TextureEnvironment::watch() {
  if (fetch_again_ && memory_.lines_read().size() > kFaultyRequest) fetch_again();
  if (!memory_.lines_read().empty())  // usually empty
    checks_.check_traffic(memory_, simulation().clock().cycle(), !fetch_again_);
}

bool TextureEnvironment::done() const {
  return quad_driver_.done() && unit_.idle() && quads_.empty() && colours.empty();
}

void TextureEnvironment::restart() {
  memory_.clear_statistics();
  checks_.restart();
  clear_outputs();
}

void TextureEnvironment::finish() {
  checks_.finish(fragments(), memory_, host_);
  checks_.check_figures(unit_, memory_);
}

void TextureEnvironment::reject_memory_errors() {
  if (const std::uint32_t errors = driver_.memory_errors(); errors != 0)
    throw spec::SimulationError(
        fmt::format("memory answered {} line fills with an error, which read as zero: look at "
                    "memory.error_address, or at the addresses in the texture descriptors",
                    errors));
}

void TextureEnvironment::reject_unused_errors() const { reject_untouched(memory_, setup_.memory); }

Amount TextureEnvironment::amount() const {
  return {delivered_, unit_.address.derivative.fragments.value(), fragments(), "fragment"};
}

// ---- checking -----------------------------------------------------------------------------------

void TextureEnvironment::check_output(rtl::Cycle cycle, const spec::texture::ColourGroup& group) {
  for (const spec::texture::Colour& colour : group) check_colour(cycle, colour);
}

void TextureEnvironment::check_colour(rtl::Cycle cycle, const spec::texture::Colour& colour) {
  ++delivered_;
  hash_.add(colour.tag);
  hash_.add(static_cast<std::uint64_t>(colour.lane) << 1 | (colour.last ? 1 : 0));
  for (const std::uint8_t channel : colour.rgba) hash_.add(channel);
  // After a mismatch tags and lanes may be wrong; the picture then shows only colours with a known
  // pixel.
  const bool trusted = checks_.got(colour, cycle);
  const traces::TracedQuad* quad = sent_.take(colour, trusted);
  if (!quad || !quad->shows(colour.lane)) return;
  tb::show(*quad, colour, frame_);
  received_[frame_.index(quad->x(colour.lane), quad->y(colour.lane))] = 1;
}

void TextureEnvironment::fetch_again() {
  fetch_again_ = false;
  std::array<unsigned char, kLineBytes> data{};
  tlm::tlm_generic_payload payload;
  payload.set_command(tlm::TLM_READ_COMMAND);
  payload.set_address(memory_.lines_read()[kFaultyRequest]);
  payload.set_data_ptr(data.data());
  payload.set_data_length(static_cast<unsigned>(data.size()));
  payload.set_streaming_width(static_cast<unsigned>(data.size()));
  sc_core::sc_time delay = sc_core::SC_ZERO_TIME;
  extra_initiator_.memory->b_transport(payload, delay);
}

// ---- results ------------------------------------------------------------------------------------

std::vector<PictureMap> TextureEnvironment::maps() const {
  return maps_ ? meter_.named(maps_->maps()) : std::vector<PictureMap>();
}

std::optional<PixelHistory> TextureEnvironment::pixel_history() const {
  if (!history_) return std::nullopt;
  PixelHistory all = history_->history(ended_, quad_driver_.done());
  if (!name().empty())
    for (PixelStep& step : all.steps) step.part = name() + " " + step.part;
  return all;
}

Coverage TextureEnvironment::coverage() const {
  return coverage_ ? coverage_->bins(unit_) : TextureCoverage::declared();
}

// Defined here, because inlined copies can keep the compiler from optimising the units.
TextureEnvironment::~TextureEnvironment() = default;

}  // namespace deburr::tb
