// SPDX-License-Identifier: MIT
#include "tb/env/texture_environment.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "spec/error.h"
#include "spec/texture/registers.h"
#include "tb/env/collect.h"

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

std::int32_t fifo_depth(const TextureSetup& setup) {
  if (setup.texture.cache_fifo_depth != 0) return setup.texture.cache_fifo_depth;
  constexpr std::int32_t kMost = 4096;
  const std::int32_t bytes = setup.memory.bytes_per_clock, line = setup.texture.cache_line_bytes;
  const std::int32_t transfer = bytes == 0 ? 1 : std::max(1, line / bytes);
  const std::int32_t latency = std::max(setup.memory.latency, setup.memory.latency_max);
  return std::min(rtl::texture::LatencyFifo::depth_for(latency, transfer), kMost);
}

// ---- building -----------------------------------------------------------------------------------

std::vector<PlantedFault> TextureEnvironment::faults() {
  std::vector<PlantedFault> list = {
      {"flip-bit", "Flips a bit of the red channel of colour 100.", "flip:colours:100:rgba.r.4"},
      {"drop-colour", "Drops colour 100.", "drop:colours:100"},
      {"duplicate-colour", "Delivers colour 100 twice.", "duplicate:colours:100"},
      {"drop-quad", "Drops quad 50 on its way into the unit.", "drop:quads:50"},
      {"duplicate-fetch", "Line fill 20 is read from memory twice; the picture stays perfect."},
      {"duplicate-request", "The cache's request for line fill 20 is answered twice.",
       "duplicate:texture.cache.memory_requests:20"},
      {"stuck-ready", "Holds back the texel addresses from cycle 500 on.",
       "stuck_ready:texture.texels:500"},
      {"wrong-texel", "The texture in memory is not what the golden model reads."},
      {"wrong-axis", "Flips a bit of fragment 100's major axis.",
       "flip:texture.address.footprints:100:axis_s.22"},
      {"wrong-ratio", "Flips a bit of what gives fragment 100's ratio of sides.",
       "flip:texture.address.footprints:100:minor.24"},
      {"wrong-count", "Flips a bit of fragment 100's number of samples.",
       "flip:texture.address.levels:100:last_index.0"},
      {"wrong-sample", "Gives request 401 the weight of another number of samples.",
       "flip:texture.texel_quads:401:control.last_index.2"},
      {"wrong-replacement", "The cache replaces by FIFO where LRU was ordered."}};
  for (PlantedFault& fault : memory_faults()) list.push_back(std::move(fault));
  return list;
}

// The golden model always gets what was ordered.
spec::texture::Parameters TextureEnvironment::as_built() const {
  spec::texture::Parameters p = setup_.texture;
  p.cache_fifo_depth = fifo_depth(setup_);
  if (planted("wrong-replacement")) p.cache_replacement = spec::texture::Replacement::kFifo;
  return p;
}

TextureEnvironment::TextureEnvironment(Simulation& simulation, const TextureScene& scene,
                                       const TextureSetup& setup, std::string name)
    : Environment(simulation, std::move(name)),
      scene_(scene),
      setup_(setup),
      driver_("driver", simulation.clock()),
      unit_("texture", simulation.clock(), as_built()),
      memory_("memory", simulation.clock().period(),
              memory_model_parameters(setup.memory, scene.memory().bytes().size(),
                                      simulation.options().seed)),
      host_("texture_host"),
      stranger_("stranger"),
      golden_(golden_model(scene, setup, golden())),
      colour_board_("colours", 0, [this](const spec::texture::Colour& c) { return describe(c); }),
      fill_board_("line fills", 0,
                  [](const Fill& f) { return fmt::format("read of address {:#x}", f.address); }),
      register_board_(spec::texture::kRegisters) {
  know(faults());
  let_blind({&colour_board_, &fill_board_, &register_board_.board()});
  namespace reg = spec::texture::reg;
  let_miscount(register_board_,
               std::array{reg::kFragments, reg::kBilinears, reg::kLineFills, reg::kClamped,
                          reg::kSaturated, reg::kMemoryErrors, reg::kInvalidFragments});
  colour_board_.call_items([this](const spec::texture::Colour& c) { return place(c); });
  driver_.beats_out(quads_);
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
  fetch_again_ = planted("duplicate-fetch");
  std::vector<std::uint8_t> contents = scene.memory().bytes();
  if (planted("wrong-texel"))
    for (std::uint8_t& byte : contents) byte ^= 0x10;
  memory_.preload(0, contents);

  driver_.send([this](std::uint64_t, spec::texture::Quad& quad) {
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
    driver_.on_send = [this, expect_colour](rtl::Cycle, const spec::texture::Quad&) {
      const TextureExpectation& all = *setup_.expectation;
      const std::uint64_t quad = driver_.sent() - 1;
      const TextureExpectation::Behind from = quad > 0 ? all.behind[quad - 1]
                                                       : TextureExpectation::Behind(),
                                       to = all.behind[quad];
      for (std::size_t i = from.fills; i < to.fills; ++i) expect_line(all.fills[i]);
      for (std::size_t i = from.colours; i < to.colours; ++i) expect_colour(all.colours[i]);
    };
    return;
  }
  golden_.set_fill_sink([this](std::uint32_t line) { expect_line(line); });
  driver_.on_send = [this, expect_colour](rtl::Cycle, const spec::texture::Quad& quad) {
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
  require_id(host_, spec::texture::reg::kId, spec::texture::reg::kIdValue);
  int handle = 0;
  for (const spec::texture::Descriptor& descriptor : scene_.memory().descriptors())
    for (const auto& [offset, value] : descriptor_registers(handle++, descriptor))
      host_.write(offset, value);
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
  return driver_.done() && unit_.idle() && quads_.empty() && colours.empty();
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
  if (const std::uint32_t errors = host_.read(spec::texture::reg::kMemoryErrors); errors != 0)
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

void TextureEnvironment::collect(Result& result) const {
  for (const rtl::Unit* unit : unit_.units()) add(result, name_within(unit_, *unit), *unit);
  for (const rtl::MemoryBase* memory : unit_.memories())
    add(result, name_within(unit_, *memory), *memory, 0);
  add(result, memory_);
  const std::uint64_t lines = unit_.cache.miss_queue.line_fills.value();
  result.lines_filled += lines;

  const std::uint64_t bilinears = unit_.address.addresser.bilinears.value();
  const std::uint64_t fragments = unit_.filter.fragments.value();
  double texel_bytes = 4;
  if (!scene_.memory().descriptors().empty())
    texel_bytes = spec::texture::kFormatBytes[static_cast<std::size_t>(
        scene_.memory().descriptors()[0].format)];
  add(result, "fragments", fragments, "fragment", "Colours delivered.");
  add(result, "bilinears", bilinears, "request", "Bilinear requests, one a sample and level.");
  add(result, "bilinears_per_fragment", ratio(bilinears, fragments), "request/fragment",
      "Cost of a fragment in clocks while nothing stalls.");
  add(result, "misses_per_texel", ratio(number(lines), 4 * number(bilinears)), "line/texel",
      "Line fills over texels asked for.");
  add(result, "texels_fetched_per_fragment",
      ratio(number(lines) * setup_.texture.cache_line_bytes / texel_bytes, number(fragments)),
      "texel/fragment", "Texels of all lines fetched over fragments.");
  add(result, "fifo_depth", static_cast<std::uint64_t>(unit_.parameters().cache_fifo_depth),
      "request", "Entries of the latency FIFO, as ordered or as the latency of memory asks for.");
  for (const rtl::Counter* counter : unit_.counters())
    add(result, name_within(unit_, *counter), *counter);
}

void TextureEnvironment::show_parts(Observer& observer) const {
  show(observer, "quads_in", quads_);
  show(observer, unit_);
  show(observer, "colours_out", colours);
  observer.see({"Bilinear requests", figure("addresser_bilinears"), "bilinear/clk", 1});
}

std::vector<PictureMap> TextureEnvironment::maps() const {
  return maps_ ? named(maps_->maps()) : std::vector<PictureMap>();
}

Coverage TextureEnvironment::coverage() const {
  return coverage_ ? coverage_->bins(unit_) : TextureCoverage::declared();
}

void TextureEnvironment::collect_headline(Result& result) const {
  result.latency = latency_of(unit_.fragment_latency);
  result.throughput = ratio(unit_.address.addresser.bilinears.value(), result.cycles);
  result.throughput_unit = "bilinear/clk";
  result.throughput_bound = 1;
  result.throughput_bound_meaning = "One bilinear request a clock.";
  result.figures = {{"Fragments", key("fragments")},
                    {"Bilinear requests of a fragment", key("bilinears_per_fragment")},
                    {"Line fills of a texel", key("misses_per_texel")},
                    {"Texels fetched for a fragment", key("texels_fetched_per_fragment")}};
  result.bottleneck = find_bottleneck(result.units, figure("filter"));
}

}  // namespace deburr::tb
