// SPDX-License-Identifier: MIT
#include "tb/env/morphological_environment.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <tuple>
#include <utility>

#include "golden/morphological/configuration.h"
#include "golden/morphological/traffic.h"
#include "spec/error.h"
#include "spec/morphological/registers.h"
#include "tb/env/collect.h"

namespace deburr::tb {
namespace {

using golden::morphological::DepthView;
using golden::morphological::frame_stride;
using golden::morphological::ImageView;
namespace reg = spec::morphological::reg;

constexpr double kPixelClock1080p60 = 148.5;  // MHz

constexpr std::uint32_t kLinkDepth = 2;

constexpr std::int32_t kMostThreshold = 65535;  // of T and of the floor, U0.16

// Lanes that are not built have no wires.
rtl::PayloadShape shape_of(const spec::morphological::Parameters& p) {
  return {static_cast<std::uint32_t>(lanes_of(p)), {}};
}

std::uint64_t memory_bytes(std::span<const MorphologicalInput> frames, std::uint32_t base) {
  std::uint64_t bytes = 0;
  for (const MorphologicalInput& frame : frames)
    bytes = std::max(bytes, std::uint64_t{frame_stride(frame.image.width)} *
                                static_cast<std::uint64_t>(frame.image.height));
  return base + bytes;
}

std::string describe_pixel(const spec::morphological::Rgba8& p) {
  return fmt::format("RGBA ({}, {}, {}, {})", p[0], p[1], p[2], p[3]);
}
std::string describe_tap(const spec::morphological::BlendTap& t) {
  return fmt::format("{} shares {} {}, edges{}{}", t.horizontal ? "left/right" : "up/down", t.first,
                     t.second, t.edges & 1 ? " left" : "", t.edges & 2 ? " top" : "");
}
std::string describe_run(const spec::morphological::RunRecord& r) {
  constexpr std::array<std::string_view, 3> kParts = {"", " head", " tail"};
  return fmt::format("{} run{} line {} start {} length {} {}",
                     r.axis == spec::morphological::Axis::kHorizontal ? "horizontal" : "vertical",
                     kParts[static_cast<std::size_t>(r.part)], r.line, r.start, r.length,
                     spec::morphological::kRunShapes[r.shape & 15].name);
}
std::string describe_line(const spec::morphological::LineRecord& l) {
  return fmt::format("{}: steps {} {}, scale {} offset {} shift {} slope {} inverse {} span {}",
                     describe_run(l.run), l.left_steps, l.right_steps, l.scale, l.offset, l.shift,
                     l.slope, l.inverse, l.span);
}

// Any order that both sides can be brought into.
auto order_of(const spec::morphological::RunRecord& r) {
  return std::tuple(r.axis, r.line, r.start, r.part);
}

// Clocks of 1/60 s that a frame may take, in MHz.
double clock_for_60(std::uint64_t frame_clocks) { return number(frame_clocks) * 60 / 1e6; }

}  // namespace

int lanes_of(const spec::morphological::Parameters& p) {
  return spec::morphological::kLaneCount[static_cast<std::size_t>(p.lanes)];
}

std::uint64_t latency_by_formula(const spec::morphological::Parameters& p, int width) {
  const auto reach = static_cast<std::uint64_t>(p.window_rows / 2 - 1);
  return (reach + spec::morphological::kRowLag) * beats_a_row(width, lanes_of(p)) +
         spec::morphological::kPipelineLatency;
}

std::uint64_t frame_clocks_by_formula(const spec::morphological::Parameters& p, int width,
                                      int height) {
  return latency_by_formula(p, width) +
         static_cast<std::uint64_t>(height) * beats_a_row(width, lanes_of(p));
}

// ---- building -----------------------------------------------------------------------------------

std::vector<PlantedFault> MorphologicalEnvironment::faults() const {
  const int width = frames_.empty() ? 1 : frames_.front().image.width;
  const std::uint64_t row = beats_a_row(width, lanes());
  const std::string memory = in_memory() ? "" : "morphological.storage = memory";
  std::vector<PlantedFault> list = {
      {"flip-bit", "Flips a bit of the red channel of output beat 100.",
       "flip:blended:100:pixel.0.r.4"},
      {"drop-pixel", "Drops output beat 100.", "drop:blended:100"},
      {"duplicate-pixel", "Delivers output beat 100 twice.", "duplicate:blended:100"},
      {"drop-input", "Drops input beat 50 on its way into the engine.", "drop:pixels:50"},
      {"wrong-edge", "Flips the left edge of a pixel in row 1, behind the edge detector.",
       fmt::format("flip:morphological.edge_bits:{}:left", 2 * row + row / 2)},
      {"wrong-rule", "The engine tries one step less than was ordered.", "",
       setup_.morphological.steps > 0 ? "" : "morphological.steps of at least 1"},
      {"stuck-ready", "Holds back the slots of the luma unit from cycle 500 on.",
       "stuck_ready:morphological.slots:500"},
      {"duplicate-fetch", "Sends memory request 20 twice.",
       fmt::format("duplicate:morphological.requests:{}", kFaultyRequest), memory}};
  for (PlantedFault& fault : memory_faults(memory)) list.push_back(std::move(fault));
  for (PlantedFault& fault : smaa_faults()) list.push_back(std::move(fault));
  for (PlantedFault& fault : shares_faults()) list.push_back(std::move(fault));
  return list;
}

// Of edges from colour and learned shares.
std::vector<PlantedFault> MorphologicalEnvironment::shares_faults() const {
  const spec::morphological::Parameters& p = setup_.morphological;
  const std::string needs =
      p.area == spec::morphological::AreaSource::kLearned ? "" : "morphological.area = learned";
  return {
      {"wrong-colour", "Edges come from luma.", "",
       p.edge_source == spec::morphological::EdgeSource::kColour
           ? ""
           : "morphological.edges.source = colour"},
      {"wrong-share",
       "Flips a bit of the word of shares_a for a single pixel between crossings on its side.", "",
       needs},
      {"wrong-near", "Flips a bit of the words of shares_b for crossings that go on.", "", needs},
      {"wrong-far", "Flips a bit of the words of shares_c for crossings that go on.", "", needs},
      {"wrong-sum", "Flips a bit of the word of share_rom for a sum of -2.0.", "", needs},
      {"wrong-class", "Flips a bit of the class of the crossing at the end of a vertical run.",
       "flip:morphological.lines_v0:20:line.end_class.1", needs},
      {"wrong-code", "Flips a bit of the codes of the ends of a horizontal run.",
       "flip:morphological.lines_h0:20:line.run.shape.0", needs},
      {"wrong-axis", "The line of a horizontal run that has none counts as the longest one.",
       "flip:morphological.lines_h0:20:line.span.11", needs},
      {"drop-line", "Drops a record behind the dividers of horizontal runs.",
       "drop:morphological.lines_h0:20", needs}};
}

// Of SMAA's blocks. Those without a link are planted by as_built() and plant_in_roms().
std::vector<PlantedFault> MorphologicalEnvironment::smaa_faults() const {
  const spec::morphological::Parameters& p = setup_.morphological;
  const auto unless = [](bool built, std::string needs) {
    return built ? std::string() : "morphological." + std::move(needs);
  };
  const bool luma = p.edge_source == spec::morphological::EdgeSource::kLuma;
  const bool dynamic = p.threshold_mode == spec::morphological::ThresholdMode::kDynamic;
  const bool contrast = p.local_contrast == spec::morphological::LocalContrast::kSmaa ||
                        p.local_contrast == spec::morphological::LocalContrast::kPaper;
  const bool table = p.area != spec::morphological::AreaSource::kAnalytic &&
                     p.area != spec::morphological::AreaSource::kLearned;
  const std::string for_table = unless(table, "area = table_full, table_merged or table_minimal"),
                    for_diagonals = unless(p.diagonals, "diagonals = true");
  return {
      {"wrong-threshold",
       "The threshold errs where it is just reached: T a unit higher, or alpha a unit lower.", "",
       unless(luma && (dynamic ? p.alpha > 0 : p.threshold < kMostThreshold),
              "edges.source = luma, alpha of at least 1, T of at most 65534")},
      {"wrong-floor", "The floor of a dynamic threshold is a unit higher.", "",
       unless(luma && dynamic && p.floor < kMostThreshold,
              "edges.threshold_mode = dynamic, floor of at most 65534")},
      {"wrong-contrast",
       "An edge of exactly half the contrast beside it is dropped for kept, kept for dropped.", "",
       unless(luma && contrast, "edges.local_contrast = smaa or paper")},
      {"wrong-area", "Flips a bit of the word of area_rom0 that runs of one pixel read.", "",
       for_table},
      {"wrong-root", "Flips a bit of the word of sqrt_rom for two pixels.", "", for_table},
      {"wrong-decode", "Patterns 6, 7 and 14 of the merged table read the tile of 9.", "",
       unless(p.area == spec::morphological::AreaSource::kTableMerged, "area = table_merged")},
      {"wrong-search", "Searches along runs end a step early.", "",
       unless(table && p.search_steps > 1, "area = table_*, search_steps of at least 2")},
      {"wrong-entry", "A vertical record is stored in the other entry of its column.",
       "flip:morphological.lines_v0:20:entry",
       unless(p.ends == spec::morphological::Ends::kCrossings, "ends = crossings")},
      {"wrong-diagonal", "Searches along diagonals end a step early.", "",
       unless(p.diagonals && p.diagonal_steps > 1,
              "diagonals = true, diagonal_steps of at least 2")},
      {"wrong-diagonal-area",
       "Flips a bit of the words of diagonal_rom for two pixels to either end.", "", for_diagonals},
      {"drop-diagonals", "Drops the shares of the diagonals of beat 200.",
       "drop:morphological.diagonals.diagonal_shares_entries:200", for_diagonals},
      {"wrong-corner", "Sharp corners keep 1/256 less of a weight.", "",
       unless(p.round_corners && p.corner_rounding > 0,
              "round_corners = true, corner_rounding of at least 1")},
      {"wrong-mix", "Flips a bit of the word of mix_rom for shares that sum up to 64.", "",
       unless(p.blend == spec::morphological::BlendRule::kStrongest, "blend = strongest")}};
}

// The golden model always gets what was ordered.
spec::morphological::Parameters MorphologicalEnvironment::as_built() const {
  spec::morphological::Parameters p = setup_.morphological;
  // A fault that would change nothing is refused by what it needs.
  if (planted("wrong-rule")) p.steps = std::max(0, p.steps - 1);
  if (planted("wrong-threshold")) {
    if (p.threshold_mode == spec::morphological::ThresholdMode::kDynamic)
      p.alpha = std::max(0, p.alpha - 1);
    else
      p.threshold = std::min(kMostThreshold, p.threshold + 1);
  }
  if (planted("wrong-floor")) p.floor = std::min(kMostThreshold, p.floor + 1);
  if (planted("wrong-contrast"))
    p.local_contrast = p.local_contrast == spec::morphological::LocalContrast::kSmaa
                           ? spec::morphological::LocalContrast::kPaper
                           : spec::morphological::LocalContrast::kSmaa;
  if (planted("wrong-search")) p.search_steps = std::max(1, p.search_steps - 1);
  if (planted("wrong-diagonal")) p.diagonal_steps = std::max(1, p.diagonal_steps - 1);
  if (planted("wrong-colour")) p.edge_source = spec::morphological::EdgeSource::kLuma;
  if (planted("wrong-corner")) p.corner_rounding = std::max(0, p.corner_rounding - 1);
  return p;
}

void MorphologicalEnvironment::plant_in_roms() {
  const auto in_rom = [&]<class Word>(const char* name, Word, auto&& change) {
    rtl::for_each<rtl::MemoryBase>(engine_, [&](rtl::MemoryBase& memory) {
      if (memory.basename() != std::string_view(name)) return;
      auto* const rom = dynamic_cast<rtl::Memory<Word>*>(&memory);
      DEBURR_CHECK(rom != nullptr, std::string(name) + " has other words");
      change(*rom);
    });
  };
  constexpr std::uint16_t kHalf = 0;
  constexpr std::uint32_t kWord = 0;
  // Tiles as the layout stores them, a parity of 64 words each.
  using spec::morphological::AreaSource;
  const AreaSource layout = setup_.morphological.area;
  const std::uint64_t tile_of_6 = layout == AreaSource::kTableFull     ? 6
                                  : layout == AreaSource::kTableMerged ? 4
                                                                       : 0;
  constexpr std::uint64_t kTileWords = 64, kMergedTileOf9 = 6;
  if (planted("wrong-area"))
    in_rom("area_rom0", kHalf, [&](auto& rom) { rom.backdoor(tile_of_6 * kTileWords) ^= 1u << 5; });
  if (planted("wrong-root"))
    in_rom("sqrt_rom", kHalf, [](auto& rom) { rom.backdoor(2) ^= 1u << 6; });
  if (planted("wrong-decode"))
    for (const char* const name : {"area_rom0", "area_rom1", "area_rom2", "area_rom3"})
      in_rom(name, kHalf, [&](auto& rom) {
        for (std::uint64_t i = 0; i < kTileWords; ++i)
          rom.backdoor(tile_of_6 * kTileWords + i) = rom.backdoor(kMergedTileOf9 * kTileWords + i);
      });
  if (planted("wrong-diagonal-area"))
    in_rom("diagonal_rom", kHalf, [](auto& rom) {
      constexpr std::uint64_t kDistances = spec::morphological::kDiagonalDistances;
      for (std::uint64_t codes = 0; codes < 16; ++codes)
        rom.backdoor((codes * kDistances + 2) * kDistances + 2) ^= 1u << 4;
    });
  constexpr std::int8_t kEntry = 0;
  constexpr std::uint8_t kShare = 0;
  if (planted("wrong-share"))
    in_rom("shares_a", kEntry, [](auto& rom) {
      // Codes 1 and 1, at distances 0 and 0.
      rom.backdoor(5 * 64) = static_cast<std::int8_t>(rom.backdoor(5 * 64) ^ 1 << 4);
    });
  for (const auto& [fault, name] :
       {std::pair{"wrong-near", "shares_b"}, std::pair{"wrong-far", "shares_c"}})
    if (planted(fault))
      in_rom(name, kEntry, [](auto& rom) {
        constexpr std::uint64_t kGoesOn = 4, kWords = 32;  // class 2 of code 1
        for (std::uint64_t i = kGoesOn * kWords; i < (kGoesOn + 1) * kWords; ++i)
          rom.backdoor(i) = static_cast<std::int8_t>(rom.backdoor(i) ^ 1 << 4);
      });
  if (planted("wrong-sum"))
    in_rom("share_rom", kShare, [](auto& rom) { rom.backdoor(128 - 32) ^= 1u << 2; });
  if (planted("wrong-mix"))
    in_rom("mix_rom", kWord, [](auto& rom) { rom.backdoor(64) ^= 1u << 9; });
}

MorphologicalEnvironment::MorphologicalEnvironment(Simulation& simulation,
                                                   std::span<const MorphologicalInput> frames,
                                                   const MorphologicalSetup& setup,
                                                   std::string name)
    : Environment(simulation, std::move(name)),
      pixels("pixels", kLinkDepth, shape_of(setup.morphological)),
      frames_(frames),
      setup_(setup),
      blended_("blended", kLinkDepth, shape_of(setup.morphological)),
      source_(this->name().empty()
                  ? std::make_unique<FrameSource>("source", simulation.clock(), lanes())
                  : nullptr),
      engine_("morphological", simulation.clock(), as_built()),
      sink_("sink", simulation.clock()),
      host_("morphological_host"),
      golden_(setup.morphological),
      pixel_board_("pixels", describe_pixel),
      tap_board_("taps", describe_tap),
      run_board_("runs", 0, describe_run),
      line_board_("lines", 0, describe_line),
      traffic_board_(
          "memory lines", 0,
          [](const spec::morphological::FrameAccess& a) {
            return fmt::format("{} of address {:#x}", a.write ? "write" : "read", a.address);
          },
          [](const spec::morphological::FrameAccess& a) { return a.write ? 1u : 0u; }),
      register_board_(spec::morphological::kRegisters) {
  for (const MorphologicalInput& frame : frames)
    golden::morphological::check_frame(setup.morphological, frame.image.width, frame.image.height);
  know(faults());
  plant_in_roms();
  let_blind({&pixel_board_, &tap_board_, &register_board_.board()});
  std::vector<std::uint32_t> judged;
  for (const spec::morphological::WorkCount& each : spec::morphological::kWorkCounts)
    judged.push_back(each.offset);
  judged.insert(judged.end(), {reg::kFrameCycles, reg::kMemoryErrors});
  let_miscount(register_board_, judged);
  if (setup.records) let_blind({&run_board_, &line_board_});
  if (in_memory()) let_blind({&traffic_board_});
  if (source_) source_->pixels_out(pixels);
  engine_.pixels_in(pixels);
  engine_.pixels_out(blended_);
  sink_.beats_in(blended_);
  host_.bus.bind(engine_.registers);
  if (engine_.memory() != nullptr) {
    MemoryModelParameters m = memory_model_parameters(
        setup.memory, memory_bytes(frames, setup.pixel_base), simulation.options().seed);
    m.record_writes = true;
    memory_ = std::make_unique<MemoryModel>(memory_name().c_str(), simulation.clock().period(), m);
    engine_.memory()->bind(memory_->ports);
    plant_in(*memory_, setup.memory);
    if (const auto range = error_range(setup.memory))
      golden_.set_read_errors(
          [range = *range](std::uint32_t line) {
            return range.touches(line, spec::morphological::kFrameLineBytes);
          },
          setup.pixel_base);
  }
  sink_.keep(false);
  sink_.on_beat = [this](rtl::Cycle cycle, const spec::morphological::BlendedBeat& beat) {
    judge(cycle, beat);
  };
  if (simulation.options().maps) maps_.emplace();
  const bool records = golden() && setup.records;
  if (!records && !maps_) return;
  engine_.observe_runs([this, records](const spec::morphological::RunRecord& run) {
    if (records) runs_.push_back(run);
    if (maps_) maps_->see(run);
  });
  engine_.observe_lines([this, records](const spec::morphological::LineRecord& line) {
    if (records) lines_.push_back(line);
    if (maps_) maps_->see(line);
  });
}

// ---- running ------------------------------------------------------------------------------------

void MorphologicalEnvironment::configure() {
  require_id(host_, reg::kId, reg::kIdValue);
  golden_work_ = {};
  unreadable_lines_ = 0;
}

bool MorphologicalEnvironment::begin(std::size_t piece) {
  if (piece >= frames_.size()) return false;
  current_ = piece;
  expect();
  start();
  return true;
}

void MorphologicalEnvironment::expect() {
  const MorphologicalInput& frame = frames_[current_];
  const Image& image = frame.image;
  frame_ = Image(image.width, image.height);
  taps_.assign(frame_.pixels.size(), {});
  position_ = 0;
  runs_.clear();
  lines_.clear();
  if (!golden()) return;
  expect_traffic();
  const DepthView depth =
      frame.depth.empty() ? DepthView() : DepthView(frame.depth, image.width, image.height);
  if (!setup_.expectation)
    golden_.process(ImageView(image.pixels, image.width, image.height), depth);
  pixel_board_.expect(golden_model().pixels(), image.width);
  tap_board_.expect(golden_model().taps(), image.width);
}

void MorphologicalEnvironment::start() {
  const Image& image = frames_[current_].image;
  host_.write(reg::kSize, static_cast<std::uint32_t>(image.width) |
                              static_cast<std::uint32_t>(image.height) << 16);
  if (in_memory()) host_.write(reg::kPixelBase, setup_.pixel_base);
  if (source_) source_->start(frames_[current_]);
  if (maps_) maps_->begin(image.width, image.height);
  taken_before_ = pixels.pops();
}

// All writes ascending, all reads ascending; how they interleave is timing.
void MorphologicalEnvironment::expect_traffic() {
  if (!in_memory()) return;
  const Image& image = frames_[current_].image;
  for (const spec::morphological::FrameAccess& access :
       golden::morphological::frame_traffic(setup_.pixel_base, image.width, image.height))
    traffic_board_.expect(access);
}

void MorphologicalEnvironment::watch() {
  if (pixels.pops() == taken_before_ + 1) first_taken_ = pixels.last_pop();
  if (in_memory()) judge_traffic();
}

void MorphologicalEnvironment::restart() {
  if (memory_) {
    // What was asked of memory before is still on its way; it goes by before the frame begins. In a
    // composition frames begin by themselves, so it has seen to that during reset.
    if (source_) drain_memory();
    memory_->clear_statistics();
  }
  position_ = 0;
  runs_.clear();
  lines_.clear();
  all_delivered_ = 0;
  pixel_board_.restart();
  tap_board_.restart();
  traffic_board_.restart();
  if (golden()) expect_traffic();
  hash_ = {};
  start();
}

bool MorphologicalEnvironment::done() const {
  return (!source_ || source_->done()) && engine_.idle() && pixels.empty() && blended_.empty();
}

void MorphologicalEnvironment::end() {
  watch();
  judge_records();
}

void MorphologicalEnvironment::finish() {
  if (!golden()) return;
  require_comparisons();
  std::vector<std::pair<std::uint32_t, std::uint64_t>> expected;
  for (const spec::morphological::WorkCount& each : spec::morphological::kWorkCounts)
    expected.emplace_back(each.offset, golden_work_.*each.count);
  expected.emplace_back(reg::kFrameCycles, blended_.last_push() + 1 - first_taken_);
  // What cannot be read could not be written before.
  expected.emplace_back(reg::kMemoryErrors, 2 * unreadable_lines_);
  register_board_.judge(host_, expected);
}

// As much as the frames have; of runs and lines as many as the engine counted, since a frame may
// have none.
void MorphologicalEnvironment::require_comparisons() {
  std::uint64_t area = 0, lines = 0;
  for (const MorphologicalInput& frame : frames_) {
    area += frame.image.pixels.size();
    lines += frame_stride(frame.image.width) / spec::morphological::kFrameLineBytes *
             static_cast<std::uint64_t>(frame.image.height);
  }
  pixel_board_.require(area);
  tap_board_.require(area);
  if (in_memory()) traffic_board_.require(2 * lines);
  if (!setup_.records) return;
  run_board_.require(engine_.work().horizontal_runs + engine_.work().vertical_runs);
  line_board_.require(engine_.work().z_runs);
}

void MorphologicalEnvironment::refuse_memory_errors() {
  if (const std::uint32_t errors = host_.read(reg::kMemoryErrors); errors != 0)
    throw spec::SimulationError(
        fmt::format("memory answered {} lines with an error, which read as zero: look at "
                    "{}.error_address and at PIXEL_BASE",
                    errors, memory_name()));
}

void MorphologicalEnvironment::refuse_unused_errors() const {
  if (memory_) refuse_untouched(*memory_, setup_.memory);
}

Amount MorphologicalEnvironment::amount() const {
  std::uint64_t all = 0;
  for (const MorphologicalInput& frame : frames_) all += frame.image.pixels.size();
  return {all_delivered_, engine_.sequencer.beats.value() * static_cast<std::uint64_t>(lanes()),
          all, "pixel"};
}

// ---- judging ------------------------------------------------------------------------------------

Environment::Boards MorphologicalEnvironment::outputs() const {
  Boards boards = {&pixel_board_, &tap_board_};
  if (setup_.records) boards.insert(boards.end(), {&run_board_, &line_board_});
  return boards;
}

Environment::Boards MorphologicalEnvironment::traffic() const {
  return in_memory() ? Boards{&traffic_board_} : Boards{};
}

void MorphologicalEnvironment::judge(rtl::Cycle cycle,
                                     const spec::morphological::BlendedBeat& beat) {
  const auto width = static_cast<std::size_t>(frame_.width);
  const std::size_t x = position_ % width;
  const std::size_t left = position_ < frame_.pixels.size() ? width - x : 0;
  const bool framed =
      beat.count == std::min<std::size_t>(left, static_cast<std::size_t>(lanes())) &&
      beat.start_of_frame == (position_ == 0) && beat.end_of_row == (beat.count == left);
  if (golden() && !framed)
    pixel_board_.complain(cycle, position_, "frame",
                          fmt::format("{} pixels at most, start of frame {}, end of row {}", left,
                                      position_ == 0, beat.count == left),
                          fmt::format("{} pixels, start of frame {}, end of row {}", beat.count,
                                      beat.start_of_frame, beat.end_of_row));
  for (std::size_t i = 0; i < std::min<std::size_t>(beat.count, spec::morphological::kMaxLanes);
       ++i) {
    const spec::morphological::Rgba8& p = beat.pixel[i];
    const spec::morphological::BlendTap& t = beat.tap[i];
    const std::uint64_t word = std::uint64_t{p[0]} | std::uint64_t{p[1]} << 8 |
                               std::uint64_t{p[2]} << 16 | std::uint64_t{p[3]} << 24 |
                               std::uint64_t{t.first} << 32 | std::uint64_t{t.second} << 40 |
                               std::uint64_t{t.edges} << 48 | std::uint64_t{t.horizontal} << 56;
    hash_.add(word);
    if (golden()) {
      pixel_board_.got(p, cycle);
      tap_board_.got(t, cycle);
    }
    if (position_ < frame_.pixels.size()) {
      frame_.pixels[position_] = p;
      taps_[position_] = t;
    }
    if (maps_) maps_->see(position_, t);
    ++position_;
    ++all_delivered_;
  }
  if (beat.end_of_row && position_ % width != 0) go_on_at_row((position_ + width / 2) / width);
}

// A row that came too short or too long spoils no other one.
void MorphologicalEnvironment::go_on_at_row(std::size_t row) {
  position_ = row * static_cast<std::size_t>(frame_.width);
  pixel_board_.go_on_at(position_);
  tap_board_.go_on_at(position_);
}

void MorphologicalEnvironment::judge_records() {
  if (!golden()) return;
  for (const spec::morphological::WorkCount& each : spec::morphological::kWorkCounts)
    golden_work_.*each.count += golden_model().work().*each.count;
  unreadable_lines_ += golden_model().memory_errors();
  if (!setup_.records) return;
  std::vector<spec::morphological::RunRecord> runs;
  std::vector<spec::morphological::LineRecord> lines;
  for (const golden::morphological::PredictedRun& run : golden_model().runs()) {
    runs.push_back(run.line.run);
    const spec::morphological::RunShape& shape =
        spec::morphological::kRunShapes[run.line.run.shape];
    if (run.line.learned || shape.before != spec::morphological::Side::kNone ||
        shape.after != spec::morphological::Side::kNone)
      lines.push_back(run.line);
  }
  const auto by_run = [](const spec::morphological::RunRecord& a,
                         const spec::morphological::RunRecord& b) {
    return order_of(a) < order_of(b);
  };
  const auto by_line = [&](const spec::morphological::LineRecord& a,
                           const spec::morphological::LineRecord& b) {
    return by_run(a.run, b.run);
  };
  for (auto* list : {&runs, &runs_}) std::sort(list->begin(), list->end(), by_run);
  for (auto* list : {&lines, &lines_}) std::sort(list->begin(), list->end(), by_line);
  for (const spec::morphological::RunRecord& run : runs) run_board_.expect(run);
  for (const spec::morphological::LineRecord& line : lines) line_board_.expect(line);
  // In the order of the frame, which is not that of clocks.
  const std::string where =
      fmt::format("cycle {}, the end of frame {}", simulation().clock().cycle(), current_);
  for (const spec::morphological::RunRecord& run : runs_) run_board_.got(run, where);
  for (const spec::morphological::LineRecord& line : lines_) line_board_.got(line, where);
}

void MorphologicalEnvironment::judge_traffic() {
  if (golden()) {
    const auto judge_lines = [&](const std::vector<std::uint64_t>& lines, bool write) {
      for (const std::uint64_t line : lines)
        traffic_board_.got({static_cast<std::uint32_t>(line), write}, simulation().clock().cycle());
    };
    judge_lines(memory_->lines_written(), true);
    judge_lines(memory_->lines_read(), false);
  }
  memory_->forget_lines();
}

// ---- results ------------------------------------------------------------------------------------

void MorphologicalEnvironment::collect(Result& result) const {
  const rtl::morphological::MorphologicalEngine& engine = engine_;
  for (const rtl::Unit* unit : engine.units()) add(result, name_within(engine, *unit), *unit);
  for (const rtl::MemoryBase* memory : engine.memories())
    add(result, name_within(engine, *memory), *memory, width());
  if (memory_) {
    add(result, *memory_);
    result.lines_filled += memory_->reads();
  }
  const spec::morphological::Work work = engine.work();
  add(result, "edge_pixels_percent", 100 * ratio(work.edge_pixels, work.pixels), "%",
      "Pixels with a left or a top edge.");
  add(result, "blended_pixels_percent", 100 * ratio(work.blended_pixels, work.pixels), "%",
      "Pixels that took a share of a neighbour.");
  for (const auto* divider : {&engine.divider_h, &engine.divider_v}) {
    const double clocks =
        number(divider->busy_cycles() + divider->idle_cycles() + divider->stalled_cycles());
    add(result, name_within(engine, *divider) + "_occupancy_percent",
        100 * ratio(number(divider->occupancy.value()), lanes() * clocks), "%",
        "Occupancy: divisions x divider.interval over clocks x lanes, the clocks in which a "
        "divider could not start another; at 100 % it is the limit. The unit is busy for longer, "
        "while a division is under way.");
  }
  for (const rtl::Counter* counter : engine.counters())
    add(result, name_within(engine, *counter), *counter);
}

void MorphologicalEnvironment::show_parts(Observer& observer) const {
  show(observer, "pixels_in", pixels);
  show(observer, engine_);
  show(observer, "pixels_out", blended_);
  observer.see(
      {"Pixels delivered", figure("blender_pixels"), "pixel/clk", static_cast<double>(lanes())});
}

std::vector<PictureMap> MorphologicalEnvironment::maps() const {
  return maps_ ? named(maps_->maps(engine_, frames_.size() == 1)) : std::vector<PictureMap>();
}

std::vector<Figure> MorphologicalEnvironment::work_figures() const {
  constexpr const char* kOccupancy = "divisions x interval, of clocks x lanes";
  return {{"Divider occupancy, horizontal runs", key("divider_h_occupancy_percent"), kOccupancy},
          {"Divider occupancy, vertical runs", key("divider_v_occupancy_percent"), kOccupancy},
          {"Pixels on edges", key("edge_pixels_percent")},
          {"Pixels blended", key("blended_pixels_percent")}};
}

void MorphologicalEnvironment::collect_headline(Result& result) const {
  const spec::morphological::Parameters& p = setup_.morphological;
  result.latency = latency_of(engine_.beat_latency);

  result.throughput = ratio(number(all_delivered_), number(result.cycles));
  result.throughput_unit = "pixel/clk";
  result.throughput_bound = lanes();
  result.throughput_bound_meaning =
      "A beat a clock, a pixel a lane; filling and flushing the window not counted.";

  const int width = std::max(1, frame_.width), height = std::max(1, frame_.height);
  const std::uint64_t frame_clocks = engine_.sequencer.frame_cycles.value();
  const std::uint64_t by_formula = frame_clocks_by_formula(p, width, height);
  add(result, "frame_clocks", frame_clocks, "clk",
      "Of the last frame, from its first input beat to its last output beat.");
  add(result, "frame_clocks_by_formula", by_formula, "clk", "The same if nothing stalls.");
  add(result, "latency_by_formula", latency_by_formula(p, width), "clk",
      "From a pixel going in to it coming out if nothing stalls: (R + 5) rows and the clocks of "
      "the pipe.");
  add(result, "input_pixels_per_clock",
      source_->done()
          ? ratio(number(static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height)),
                  number(input_clocks()))
          : 0.0,
      "pixel/clk", "Pixels of the last frame over clocks from its first to its last input beat.");
  add(result, "memory_bytes_per_pixel",
      ratio(number(result.bytes_read + result.bytes_written), number(all_delivered_)), "byte/pixel",
      "Written and read again; 0 with line buffers.");
  add(result, "frame_rate",
      frame_clocks ? simulation().options().clock_mhz * 1e6 / number(frame_clocks) : 0.0, "frame/s",
      "Frames of this size a second at the stated clock.");
  // As slow for its clocks as this frame was, if that was slower than the formula; unknown before
  // the first frame is through.
  const double slowness = std::max(1.0, ratio(number(frame_clocks), number(by_formula)));
  const double hd = slowness * clock_for_60(frame_clocks_by_formula(p, 1920, 1080));
  add(result, "clock_for_1080p60", frame_clocks ? WorkValue(hd) : WorkValue(), "MHz",
      "Clock that 60 frames of 1920 x 1080 need, stalls of this run in proportion.");
  add(result, "pixel_clock_of_1080p60", kPixelClock1080p60, "MHz",
      "Of the standard, blanking included.");
  add(result, "fits_1080p60", frame_clocks ? WorkValue(hd <= kPixelClock1080p60) : WorkValue(), "",
      "Whether clock_for_1080p60 is at most the pixel clock of 1080p60, 148.5 MHz.");

  result.figures.clear();
  if (frame_clocks)
    result.figures = {
        {"Frame", "work.frame_clocks", "formula", "work.frame_clocks_by_formula", true},
        {"Clock for 1080p60", "work.clock_for_1080p60", "pixel clock",
         "work.pixel_clock_of_1080p60", true},
        {"Fits 1080p60", "work.fits_1080p60"},
        {"Frames of this size", "work.frame_rate"}};
  if (engine_.beat_latency.count() > 0)
    result.figures.push_back(
        {"Latency of a pixel", "latency.max", "formula", "work.latency_by_formula", true});
  if (source_->done() && frame_clocks)
    result.figures.push_back(
        {"Input rate", "work.input_pixels_per_clock", "lanes", "throughput.bound"});
  if (memory_)
    result.figures.push_back({"Memory traffic", "work.memory_bytes_per_pixel", "", "", true});
  for (Figure& figure : work_figures()) result.figures.push_back(std::move(figure));
  result.bottleneck = find_bottleneck(result.units, figure("blender"));
}

}  // namespace deburr::tb
