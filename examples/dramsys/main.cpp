// SPDX-License-Identifier: MIT
// A frame of the texture unit with DRAMSys as its memory:
//
//   Quads -> TextureUnit -> Quads          (links)
//   TextureUnit.memory -> Recorder -> DRAMSys
//
// The recorder holds the data, so that DRAMSys only times the requests, and measures the latency of
// each from its acceptance. Every colour is compared with that of the golden model.
//
//   dramsys_frame CONFIG.json FRAGMENTS.trace [--fifo N] [--outstanding N] [--texture N] [--mhz N]
//                 [--layout tiled|linear] [--latencies FILE]
//
// FRAGMENTS.trace is a binary fragment trace of one texture (docs/reference/traces.md); the texture
// is noise of N x N texels. FILE is for memory.latency_file.
// Exit code: 0 passed, 1 a wrong colour or an error, 2 wrong command line.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <span>
#include <stdexcept>
#include <string>
#include <systemc>
#include <tlm>
#include <unordered_map>
#include <vector>
#if __has_include(<DRAMSys/simulation/DRAMSys.h>)  // 5.1
#include <DRAMSys/config/DRAMSysConfiguration.h>
#include <DRAMSys/simulation/DRAMSys.h>
#else
#include <DRAMSys/DRAMSys.h>
#endif
#include <tlm_utils/simple_initiator_socket.h>
#include <tlm_utils/simple_target_socket.h>

#include "golden/texture/texture_golden.h"
#include "rtl_model/fabric/clock_domain.h"
#include "rtl_model/fabric/unit.h"
#include "rtl_model/platform/register_host.h"
#include "rtl_model/platform/texture_driver.h"
#include "rtl_model/platform/texture_memory.h"
#include "rtl_model/texture/texture_unit.h"

namespace {

using deburr::spec::texture::Colour;
using deburr::spec::texture::ColourGroup;
using deburr::spec::texture::Quad;

struct Options {
  std::string config, fragments, latencies;
  int fifo = 48, outstanding = 64, texture = 1024;
  double mhz = 1000;
  bool linear = false;
};

std::vector<Quad> read_quads(const std::string& name) {
  constexpr std::size_t kHeader = 64, kRecord = 80;
  std::ifstream file(name, std::ios::binary);
  std::array<char, kRecord> record{};
  if (!file.read(record.data(), kHeader) || std::memcmp(record.data(), "DEBURRFT\1", 9) != 0)
    throw std::runtime_error(name + " is not a binary fragment trace");
  std::vector<Quad> quads;
  while (file.read(record.data(), kRecord)) {
    if (record[8] != 0 || record[9] != 0)
      throw std::runtime_error(name + " has single fragments or several textures");
    Quad quad;
    quad.tag = static_cast<std::uint32_t>(quads.size());
    quad.coverage = static_cast<std::uint8_t>(record[10]);
    std::array<double, 8> coordinates{};
    std::memcpy(coordinates.data(), record.data() + 16, sizeof coordinates);
    const auto fixed = [&](std::size_t i) {
      return static_cast<std::int32_t>(
          std::floor(coordinates[i] * deburr::spec::texture::kCoordinateOne + 0.5));
    };
    for (std::size_t lane = 0; lane < 4; ++lane) {
      quad.s[lane] = fixed(2 * lane);
      quad.t[lane] = fixed(2 * lane + 1);
    }
    quads.push_back(quad);
  }
  return quads;
}

// A mip chain of noise.
deburr::platform::TextureMemory noise(int size, bool linear) {
  std::vector<std::vector<deburr::platform::Texel>> texels;
  std::vector<deburr::platform::TextureLevel> levels;
  std::uint32_t state = 1;
  for (int side = size; side > 0; side /= 2) {
    texels.emplace_back(static_cast<std::size_t>(side * side));
    for (auto& texel : texels.back())
      for (std::uint8_t& channel : texel)
        channel = static_cast<std::uint8_t>((state = state * 1664525 + 1013904223) >> 24);
    levels.push_back({side, side, texels.back()});
  }
  deburr::spec::texture::Descriptor sampler;
  sampler.layout =
      linear ? deburr::spec::texture::Layout::kLinear : deburr::spec::texture::Layout::kTiled;
  sampler.min_filter = deburr::spec::texture::MinFilter::kLinearMipmapLinear;
  sampler.max_anisotropy_log2 = 4;
  deburr::platform::TextureMemory memory;
  memory.add(levels, sampler);
  return memory;
}

// Between the unit and DRAMSys: the contents of memory, and the latency of each read.
class Recorder final : public sc_core::sc_module, public deburr::platform::HostMemory {
 public:
  tlm_utils::simple_target_socket<Recorder> from_unit{"from_unit"};
  tlm_utils::simple_initiator_socket<Recorder> to_dram{"to_dram"};

  Recorder(const sc_core::sc_module_name& name, std::size_t bytes, const sc_core::sc_time& period)
      : sc_module(name), contents_(bytes), period_(period) {
    from_unit.register_nb_transport_fw(this, &Recorder::forward);
    to_dram.register_nb_transport_bw(this, &Recorder::backward);
  }

  void write(std::uint64_t address, std::span<const std::uint8_t> data) override {
    std::copy(data.begin(), data.end(), contents_.begin() + static_cast<std::ptrdiff_t>(address));
  }
  std::vector<std::uint8_t> read(std::uint64_t address, std::uint64_t bytes) override {
    const auto begin = contents_.begin() + static_cast<std::ptrdiff_t>(address);
    return {begin, begin + static_cast<std::ptrdiff_t>(bytes)};
  }
  std::uint64_t size() const override { return contents_.size(); }

  // From END_REQ to BEGIN_RESP, in cycles of the unit's clock, in the order of requests.
  const std::vector<std::uint64_t>& latencies() const { return latencies_; }
  std::uint64_t bytes() const { return bytes_; }
  std::uint64_t most_accepted() const { return most_; }  // at once

 private:
  struct Begun {
    std::size_t number;
    sc_core::sc_time time;
  };

  tlm::tlm_sync_enum forward(tlm::tlm_generic_payload& payload, tlm::tlm_phase& phase,
                             sc_core::sc_time& delay) {
    if (phase == tlm::BEGIN_REQ) {
      begun_[&payload] = {latencies_.size(), {}};
      latencies_.push_back(0);
      bytes_ += payload.get_data_length();
    }
    return to_dram->nb_transport_fw(payload, phase, delay);
  }

  tlm::tlm_sync_enum backward(tlm::tlm_generic_payload& payload, tlm::tlm_phase& phase,
                              sc_core::sc_time& delay) {
    const sc_core::sc_time now = sc_core::sc_time_stamp() + delay;
    if (phase == tlm::END_REQ) {
      begun_[&payload].time = now;
      most_ = std::max(most_, ++accepted_);
    }
    if (phase == tlm::BEGIN_RESP) {
      --accepted_;
      const auto found = begun_.find(&payload);
      // Rounded down: the unit sees a response at the first edge after its arrival.
      latencies_[found->second.number] =
          std::max<std::uint64_t>(1, (now - found->second.time).value() / period_.value());
      begun_.erase(found);
      const auto from = contents_.begin() + static_cast<std::ptrdiff_t>(payload.get_address());
      std::copy_n(from, payload.get_data_length(), payload.get_data_ptr());
      payload.set_response_status(tlm::TLM_OK_RESPONSE);
    }
    return from_unit->nb_transport_bw(payload, phase, delay);
  }

  std::vector<std::uint8_t> contents_;
  sc_core::sc_time period_;
  std::unordered_map<tlm::tlm_generic_payload*, Begun> begun_;
  std::vector<std::uint64_t> latencies_;
  std::uint64_t bytes_ = 0, accepted_ = 0, most_ = 0;
};

// Sends the quads and takes the colours, as fast as the unit does.
class Quads final : public deburr::rtl::Unit {
 public:
  deburr::rtl::Out<Quad> quads_out{"quads_out"};
  deburr::rtl::In<ColourGroup> colours_in{"colours_in"};

  Quads(const sc_core::sc_module_name& name, deburr::rtl::ClockDomain& clock,
        const std::vector<Quad>& quads)
      : Unit(name, clock), quads_(quads) {}
  deburr::rtl::Activity tick(deburr::rtl::Cycle cycle) override {
    const bool sends = next_ < quads_.size() && quads_out.can_push(cycle);
    if (sends) quads_out.push(cycle, quads_[next_++]);
    const bool takes = colours_in.can_pop(cycle);
    if (takes)
      for (const Colour& colour : colours_in.take(cycle)) colours_.push_back(colour);
    return sends || takes ? deburr::rtl::kBusy : deburr::rtl::kIdle;
  }
  void reset() override { next_ = 0; }

  bool sent() const { return next_ == quads_.size(); }
  const std::vector<Colour>& colours() const { return colours_; }

 private:
  const std::vector<Quad>& quads_;
  std::vector<Colour> colours_;
  std::size_t next_ = 0;
};

int run(const Options& options) {
  const std::vector<Quad> quads = read_quads(options.fragments);
  const deburr::platform::TextureMemory textures = noise(options.texture, options.linear);
  auto parameters =
      deburr::spec::texture::preset_parameters(deburr::spec::texture::Preset::kDeburr);
  parameters.cache_fifo_depth = options.fifo;
  parameters.cache_outstanding = options.outstanding;
  deburr::golden::texture::TextureGolden golden(parameters, textures.bytes());
  golden.set_texture(0, textures.descriptors()[0]);
  std::vector<Colour> expected;
  for (const Quad& quad : quads)
    for (const Colour& colour : golden.process(quad)) expected.push_back(colour);

  const auto period = sc_core::sc_time(1000 / options.mhz, sc_core::SC_NS);
  deburr::rtl::ClockDomain clock("clock", period);
  deburr::rtl::texture::TextureUnit unit("texture", clock, parameters);
  Quads source("source", clock, quads);
  deburr::rtl::Link<Quad> quads_link("quads");
  deburr::rtl::Link<ColourGroup> colours_link("colours");
  deburr::platform::RegisterHost host("host");
  Recorder recorder("recorder", textures.bytes().size(), period);
  DRAMSys::DRAMSys dram("dram", DRAMSys::Config::from_path(options.config));
  source.quads_out(quads_link);
  unit.quads_in(quads_link);
  unit.colours_out(colours_link);
  source.colours_in(colours_link);
  host.bus.bind(unit.registers);
  unit.memory()->bind(recorder.from_unit);
  recorder.to_dram.bind(dram.tSocket);

  deburr::platform::TextureDriver driver(host, recorder);
  clock.set_reset_n(false);
  clock.run(1);
  clock.set_reset_n(true);
  driver.load(textures.bytes());
  driver.set_texture(0, textures.descriptors()[0]);
  const deburr::rtl::Cycle begin = clock.cycle();
  constexpr deburr::rtl::Cycle kMostCycles = 100'000'000;
  const bool done = clock.run_until(
      [&] { return source.sent() && source.colours().size() >= expected.size(); }, kMostCycles);
  const auto cycles = static_cast<double>(clock.cycle() - begin);
  sc_core::sc_stop();  // DRAMSys writes its database

  const std::vector<std::uint64_t>& latencies = recorder.latencies();
  std::uint64_t sum = 0;
  for (const std::uint64_t latency : latencies) sum += latency;
  if (!options.latencies.empty()) {
    std::ofstream file(options.latencies);
    for (const std::uint64_t latency : latencies) file << latency << '\n';
    if (!file.flush()) throw std::runtime_error("cannot write " + options.latencies);
  }
  const auto lines = static_cast<double>(std::max<std::size_t>(1, latencies.size()));
  std::printf(
      "cycles %.0f, lines %zu, GB/s %.2f, accepted at once %llu, latency %.1f on average\n", cycles,
      latencies.size(), static_cast<double>(recorder.bytes()) * options.mhz / 1000 / cycles,
      static_cast<unsigned long long>(recorder.most_accepted()), static_cast<double>(sum) / lines);
  const bool right = done && source.colours() == expected;
  std::printf("%s %zu of %zu colours\n", right ? "PASS" : "FAIL", source.colours().size(),
              expected.size());
  return right ? 0 : 1;
}

int usage(const std::string& what) {
  std::fprintf(stderr,
               "dramsys_frame: %s\nusage: dramsys_frame CONFIG.json FRAGMENTS.trace [--fifo N] "
               "[--outstanding N] [--texture N] [--mhz N] [--layout tiled|linear] [--latencies "
               "FILE]\n",
               what.c_str());
  return 2;
}

}  // namespace

int sc_main(int argc, char** argv) {
  Options options;
  if (argc < 3 || argc % 2 == 0) return usage("a file or a value is missing");
  options.config = argv[1];
  options.fragments = argv[2];
  for (int i = 3; i < argc; i += 2) {
    const std::string name = argv[i], value = argv[i + 1];
    const int number = std::atoi(value.c_str());
    if (name == "--fifo")
      options.fifo = number;
    else if (name == "--outstanding")
      options.outstanding = number;
    else if (name == "--texture")
      options.texture = number;
    else if (name == "--mhz")
      options.mhz = number;
    else if (name == "--layout" && (value == "tiled" || value == "linear"))
      options.linear = value == "linear";
    else if (name == "--latencies")
      options.latencies = value;
    else
      return usage("unknown option or value " + name + " " + value);
  }
  if (options.mhz < 1) return usage("--mhz needs a number of MHz");
  try {
    return run(options);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "dramsys_frame: %s\n", error.what());
    return 1;
  }
}
