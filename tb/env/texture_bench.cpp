// SPDX-License-Identifier: MIT
#include "tb/env/texture_bench.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <ctime>
#include <utility>

#include "spec/error.h"
#include "tb/env/collect.h"
#include "tb/results/progress.h"

namespace deburr::tb {
namespace {

using golden::texture::TextureGolden;
namespace reg = spec::texture::reg;

constexpr std::uint64_t kMemoryGrain = 64;  // longer reads are recorded in parts of this size
constexpr rtl::Cycle kProgressPeriod = 4096;

// name -> fault of the harness; faults of the memory are planted in TextureBench itself.
struct NamedFault {
  PlantedFault fault;
  std::string_view link_fault;
};
constexpr std::array kFaults = {
    NamedFault{{"flip-bit", "Flips a bit of the red channel of colour 100."},
               "flip:colours:100:52"},
    NamedFault{{"drop-colour", "Drops colour 100."}, "drop:colours:100"},
    NamedFault{{"duplicate-colour", "Delivers colour 100 twice."}, "duplicate:colours:100"},
    NamedFault{{"drop-quad", "Drops quad 50 on its way into the unit."}, "drop:quads:50"},
    NamedFault{
        {"duplicate-fetch", "Line fill 20 is read from memory twice; the picture stays perfect."},
        ""},
    NamedFault{{"duplicate-request", "The cache's request for line fill 20 is answered twice."},
               "duplicate:texture.cache.memory_requests:20"},
    NamedFault{{"stuck-ready", "Holds back the texel addresses from cycle 500 on."},
               "stuck_ready:texture.texels:500"},
    NamedFault{{"lost-response", "Memory never answers request 20."}, ""},
    NamedFault{{"memory-error", "Memory answers request 20 with an error."}, ""},
    NamedFault{{"wrong-texel", "The texture in memory is not what the golden model reads."}, ""},
    NamedFault{{"wrong-replacement", "The cache replaces by FIFO where LRU was ordered."}, ""},
};
constexpr std::uint64_t kFaultyRequest = 20;

bool planted(const TextureBenchOptions& options, std::string_view fault) {
  return std::find(options.faults.begin(), options.faults.end(), fault) != options.faults.end();
}

// What the hardware is built with; the golden model always gets what was ordered.
spec::texture::Parameters hardware_parameters(const TextureBenchOptions& options) {
  spec::texture::Parameters p = options.texture;
  if (planted(options, "wrong-replacement"))
    p.cache_replacement = spec::texture::Replacement::kFifo;
  return p;
}

std::vector<std::string> link_faults(const std::vector<std::string>& names) {
  std::vector<std::string> faults;
  for (const std::string& name : names) {
    const auto found = std::find_if(kFaults.begin(), kFaults.end(),
                                    [&](const NamedFault& f) { return f.fault.name == name; });
    if (found == kFaults.end()) {
      if (name.find(':') == std::string::npos) {
        std::string known;
        for (const NamedFault& f : kFaults) known += fmt::format(" {}", f.fault.name);
        throw spec::ConfigError(
            fmt::format("no fault '{}': known are{}, and LINK faults such as "
                        "drop:colours:100",
                        name, known));
      }
      faults.push_back(name);
    } else if (!found->link_fault.empty()) {
      faults.emplace_back(found->link_fault);
    }
  }
  return faults;
}

std::string_view register_name(std::uint32_t offset) {
  for (const spec::RegisterInfo& info : spec::texture::kRegisters)
    if (info.offset == offset) return info.name;
  return "?";
}

// "texture.cache.tag_stage" -> "tag_stage" (parts = 1), "texture.cache.tag_stage.hits" ->
// "tag_stage_hits" (parts = 2): what is unique within the texture unit and still says what it is.
std::string short_name(const sc_core::sc_object& object, int parts) {
  std::string name = object.name();
  std::size_t from = name.size();
  for (int i = 0; i < parts && from != std::string::npos && from > 0; ++i)
    from = name.rfind('.', from - 1);
  if (from != std::string::npos) name = name.substr(from + 1);
  std::replace(name.begin(), name.end(), '.', '_');
  return name;
}

}  // namespace

std::span<const PlantedFault> planted_faults() {
  static const auto faults = [] {
    std::array<PlantedFault, kFaults.size()> list;
    for (std::size_t i = 0; i < kFaults.size(); ++i) list[i] = kFaults[i].fault;
    return list;
  }();
  return faults;
}

TextureBench::TextureBench(const TextureScene& scene, const TextureBenchOptions& options)
    : scene_(scene),
      options_(options),
      clock_("clock", clock_period(options.clock_mhz)),
      driver_("driver", clock_),
      unit_("texture", clock_, hardware_parameters(options)),
      sink_("sink", clock_),
      memory_("memory", clock_.period(),
              memory_model_parameters(options.memory, scene.memory().bytes().size(), options.seed)),
      host_("host"),
      stranger_("stranger"),
      golden_(make_golden(
          scene, options.texture,
          options.golden ? TextureGolden::Traffic::kPredict : TextureGolden::Traffic::kIgnore)),
      colour_board_("colours", 0, [this](const spec::texture::Colour& c) { return describe(c); }),
      fill_board_("line fills", 0,
                  [](const Fill& f) { return fmt::format("read of address {:#x}", f.address); }),
      register_board_(
          "status registers", 0,
          [](const Status& s) { return fmt::format("{} = {}", register_name(s.offset), s.value); }),
      frame_(scene.stream(), scene.scene()),
      golden_frame_(scene.stream(), scene.scene()) {
  const std::vector<std::string> faults = link_faults(options.faults);
  driver_.beats_out(quads_);
  unit_.quads_in(quads_);
  unit_.colours_out(colours_);
  sink_.beats_in(colours_);
  unit_.memory()->bind(memory_.ports);
  host_.bus.bind(unit_.registers);
  stranger_.memory.bind(memory_.ports);
  fetch_again_ = planted(options, "duplicate-fetch");

  BenchOptions bench = bench_options(options, faults);
  bench.at_limit = [this] {
    return out_of_cycles(options_.max_cycles, sink_.received(), scene_.stream().counts.fragments,
                         "fragment");
  };
  bench_ = std::make_unique<Bench>(clock_, bench);

  std::vector<std::uint8_t> contents = scene.memory().bytes();
  if (planted(options, "lost-response")) memory_.lose_request(kFaultyRequest);
  if (planted(options, "memory-error")) memory_.fail_request(kFaultyRequest);
  if (planted(options, "wrong-texel"))
    for (std::uint8_t& byte : contents) byte ^= 0x10;
  memory_.preload(0, contents);
  if (options.memory.error_address >= 0) {
    const auto from = static_cast<std::uint64_t>(options.memory.error_address);
    memory_.fail_range(from, from + static_cast<std::uint64_t>(options.memory.error_bytes));
  }

  prepare_golden();
  sink_.keep(false);
  const std::vector<spec::texture::Quad>& quads = scene.stream().quads;
  driver_.send([&quads](std::uint64_t index, spec::texture::Quad& quad) {
    if (index >= quads.size()) return false;
    quad = quads[index];
    return true;
  });
  if (options_.golden)
    driver_.on_send = [this](rtl::Cycle, const spec::texture::Quad& quad) { expect(quad); };
  sink_.on_beat = [this](rtl::Cycle cycle, const spec::texture::Colour& colour) {
    judge(cycle, colour);
  };
}

// The wave is closed before anything that it shows is gone.
TextureBench::~TextureBench() { bench_.reset(); }

void TextureBench::prepare_golden() {
  if (!options_.golden) return;
  const std::uint64_t line_bytes = golden_.cache().line_bytes();
  golden_.set_fill_sink([this, line_bytes](std::uint32_t line) {
    const std::uint64_t begin = line * line_bytes;
    for (std::uint64_t a = begin; a < begin + line_bytes; a += kMemoryGrain)
      fill_board_.expect({a});
  });
  if (options_.memory.error_address >= 0) {
    const auto from = static_cast<std::uint64_t>(options_.memory.error_address);
    const std::uint64_t to = from + static_cast<std::uint64_t>(options_.memory.error_bytes);
    golden_.set_error_lines([from, to, line_bytes](std::uint32_t line) {
      const std::uint64_t begin = line * line_bytes;
      return begin < to && begin + line_bytes > from;
    });
  }
}

void TextureBench::expect(const spec::texture::Quad& quad) {
  golden_.process(quad, [this](const spec::texture::Colour& colour) {
    colour_board_.expect(colour);
    golden_frame_.put(colour);
  });
}

void TextureBench::judge(rtl::Cycle cycle, const spec::texture::Colour& colour) {
  constexpr std::uint64_t kPrime = 0x100000001B3ULL;  // FNV-1a
  const auto mix = [&](std::uint64_t value) { colour_hash_ = (colour_hash_ ^ value) * kPrime; };
  mix(colour.tag);
  mix(static_cast<std::uint64_t>(colour.lane) << 1 | (colour.last ? 1 : 0));
  for (const std::uint8_t channel : colour.rgba) mix(channel);
  const std::uint64_t before = colour_board_.mismatches();
  if (options_.golden) colour_board_.got(colour, fmt::format("cycle {}", cycle));
  // After a mismatch tags and lanes may be anything; the picture then shows what can be placed.
  const bool trusted = !options_.golden || colour_board_.mismatches() == before;
  const auto& quads = scene_.stream().quads;
  if (trusted) {
    frame_.put(colour);
  } else if (colour.tag < quads.size() && colour.lane < 4 &&
             (quads[colour.tag].coverage >> colour.lane & 1)) {
    try {
      frame_.put(colour);
    } catch (const spec::CheckFailed&) {  // a second colour for the same pixel: counted already
    }
  }
}

void TextureBench::judge_fills() {
  if (fetch_again_ && memory_.lines_read().size() > kFaultyRequest) fetch_again();
  const std::vector<std::uint64_t>& lines = memory_.lines_read();
  for (; fills_judged_ < lines.size(); ++fills_judged_)
    fill_board_.got({lines[fills_judged_]}, fmt::format("fill {}", fills_judged_));
}

void TextureBench::fetch_again() {
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

std::string TextureBench::describe(const spec::texture::Colour& c) const {
  std::string where = "no pixel";
  if (c.tag < scene_.stream().quads.size() && c.lane < 4) {
    const FragmentStream::Pixel p = scene_.stream().pixel(c.tag, c.lane);
    where = fmt::format("pixel ({}, {})", p.x, p.y);
  }
  return fmt::format("{} tag {} lane {}{} RGBA ({}, {}, {}, {})", where, c.tag, c.lane,
                     c.last ? " last" : "", c.rgba[0], c.rgba[1], c.rgba[2], c.rgba[3]);
}

void TextureBench::run(const Progress& progress) {
  constexpr rtl::Cycle kResetCycles = 4;
  clock_.set_reset_n(false);
  clock_.run(kResetCycles);
  clock_.set_reset_n(true);
  if (const std::uint32_t id = host_.read(reg::kId); id != reg::kIdValue)
    throw spec::SimulationError(
        fmt::format("the ID register reads {:#x}, expected {:#x}", id, reg::kIdValue));
  int handle = 0;
  for (const spec::texture::Descriptor& descriptor : scene_.memory().descriptors())
    for (const auto& [offset, value] : descriptor_registers(handle++, descriptor))
      host_.write(offset, value);

  const rtl::Cycle limit = options_.cycle_limit();
  rtl::Cycle next_progress = 0;
  bool stopped = false;
  const auto done = [&] {
    judge_fills();
    if (progress && clock_.cycle() >= next_progress) {
      next_progress = clock_.cycle() + kProgressPeriod;
      if (!progress(sink_.received(), unit_.address.derivative.fragments.value()))
        return stopped = true;
    }
    return driver_.done() && unit_.idle() && quads_.empty() && colours_.empty();
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
    bench_->run(done, limit, false);
  } catch (...) {
    stop_clock();
    throw;
  }
  stop_clock();
  if (stopped) return;
  if (bench_->links()) bench_->links()->check_empty();
  judge_fills();
  judge_registers();
  complete_ = true;
  check_memory_errors();
}

// The unit's own counters, read as a driver would, against the golden model's.
void TextureBench::judge_registers() {
  if (!options_.golden) return;
  const golden::texture::TextureWork& work = golden_.work();
  const std::pair<std::uint32_t, std::uint64_t> expected[] = {
      {reg::kFragments, work.fragments},
      {reg::kBilinears, work.bilinears},
      {reg::kLineFills, work.line_fills},
      {reg::kClamped, work.clamped},
      {reg::kSaturated, work.saturated},
      {reg::kMemoryErrors, work.memory_errors},
      {reg::kInvalidFragments, work.invalid_fragments}};
  for (const auto& [offset, value] : expected) {
    register_board_.expect({offset, static_cast<std::uint32_t>(value)});
    register_board_.got({offset, host_.read(offset)}, std::string(register_name(offset)));
  }
}

void TextureBench::check_memory_errors() {
  const std::uint32_t errors = host_.read(reg::kMemoryErrors);
  if (errors == 0) return;
  throw spec::SimulationError(
      fmt::format("memory answered {} line fills with an error, which read as zero: look at "
                  "memory.error_address, or at the addresses in the texture descriptors",
                  errors));
}

void TextureBench::check() const {
  if (!options_.golden) return;
  colour_board_.check();
  fill_board_.check();
  register_board_.check();
}

void TextureBench::collect(Result& result) const {
  auto& unit = const_cast<rtl::texture::TextureUnit&>(unit_);
  result.cycles = running_ ? clock_.cycle() - started_ : cycles_;
  result.host_seconds = host_seconds_;
  result.host_cpu_seconds = cpu_seconds_;
  result.comparisons = colour_board_.comparisons() + register_board_.comparisons();
  result.mismatches = colour_board_.mismatches() + register_board_.mismatches();
  result.traffic_comparisons = options_.golden ? fill_board_.comparisons() : 0;
  result.traffic_mismatches = options_.golden ? fill_board_.mismatches() : 0;
  if (complete_) {  // what never came differs too
    result.mismatches += colour_board_.leftovers();
    result.traffic_mismatches += fill_board_.leftovers();
  }
  result.bytes_read = memory_.bytes_read();
  result.bytes_written = memory_.bytes_written();
  result.lines_filled = unit.cache.miss_queue.line_fills.value();

  for (const rtl::Unit* u : unit.units())
    result.units.push_back(unit_cycles(short_name(*u, 1), *u));
  for (const rtl::MemoryBase* storage : unit.memories())
    result.sram.push_back(
        {short_name(*storage, 2), storage->ports(), storage->bits(), storage->bits()});
  result.latency = latency_of(unit.fragment_latency);

  const std::uint64_t bilinears = unit.address.addresser.bilinears.value();
  const std::uint64_t fragments = unit.filter.fragments.value();
  const auto ratio = [](double a, double b) { return b > 0 ? a / b : 0.0; };
  result.throughput = ratio(static_cast<double>(bilinears), static_cast<double>(result.cycles));
  result.throughput_unit = "bilinear/clk";
  result.throughput_bound = 1;
  result.throughput_bound_meaning = "One bilinear request a clock.";

  const auto add = [&](std::string name, nlohmann::ordered_json value, std::string units,
                       std::string meaning) {
    result.work.push_back(
        {std::move(name), std::move(value), std::move(units), std::move(meaning)});
  };
  const double lines = static_cast<double>(result.lines_filled);
  const double line_bytes = static_cast<double>(options_.texture.cache_line_bytes);
  double texel_bytes = 4;
  if (!scene_.memory().descriptors().empty())
    texel_bytes = spec::texture::kFormatBytes[static_cast<std::size_t>(
        scene_.memory().descriptors()[0].format)];
  add("fragments", fragments, "fragment", "Colours delivered.");
  add("bilinears", bilinears, "request", "Bilinear requests, one a sample and level.");
  add("bilinears_per_fragment",
      ratio(static_cast<double>(bilinears), static_cast<double>(fragments)), "request/fragment",
      "Cost of a fragment in clocks while nothing stalls.");
  add("misses_per_texel", ratio(lines, 4 * static_cast<double>(bilinears)), "line/texel",
      "Line fills over texels asked for.");
  add("texels_fetched_per_fragment",
      ratio(lines * line_bytes / texel_bytes, static_cast<double>(fragments)), "texel/fragment",
      "Texels of all lines fetched over fragments.");
  for (const rtl::Counter* counter : unit.counters())
    add(short_name(*counter, 2), counter->value(), counter->unit(), sentence(counter->meaning()));
  result.figures = {{"Fragments", "work.fragments"},
                    {"Bilinear requests of a fragment", "work.bilinears_per_fragment"},
                    {"Line fills of a texel", "work.misses_per_texel"},
                    {"Texels fetched for a fragment", "work.texels_fetched_per_fragment"}};
  result.bottleneck = find_bottleneck(result.units, "filter");
}

}  // namespace deburr::tb
