// SPDX-License-Identifier: MIT
// A user platform around two engines of Deburr:
//
//   Software --------- b_transport ---------+                +--- memory
//                                           |                +--- registers of the texture unit
//   TextureUnit.memory -- nb_transport -----+--- Router -----+--- registers of the smoother
//                                           |                +--- register of the painter
//   MorphologicalEngine.memory -- nb_t. ----+
//
//   Painter -> TextureUnit -> Painter -> Crossing -> MorphologicalEngine -> Display    (links)
//   core clock, core reset ------------------> | <- pixel clock, pixel reset
//
// A checker of the base protocol sits between every initiator and every target. Software resets
// each clock domain in the middle of a frame, draws a whole frame, waits for the smoother's
// interrupt, and compares the picture with the result of the golden models.
//
//   platform [--out FILE.ppm] [--quantum NS] [--plant VIOLATION] [--violations]
//
// Exit code: 0 passed, 1 a wrong picture or a violation of the protocol, 2 wrong command line.
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <functional>
#include <memory>
#include <systemc>
#include <tlm>
#include <utility>

#include "crossing.h"
#include "expected.h"
#include "memory_map.h"
#include "painter.h"
#include "protocol_checker.h"
#include "router.h"
#include "rtl_model/fabric/clock_domain.h"
#include "rtl_model/fabric/clock_input.h"
#include "rtl_model/morphological/morphological_engine.h"
#include "rtl_model/platform/memory_model.h"
#include "rtl_model/texture/texture_unit.h"
#include "software.h"
#include "spec/error.h"
#include "violator.h"

namespace platform {
namespace {

const sc_core::sc_time kPeriod(2, sc_core::SC_NS), kPixelPeriod(4, sc_core::SC_NS);
constexpr std::uint64_t kMostCycles = 1'000'000;

deburr::spec::texture::Parameters texture_parameters() {
  auto parameters =
      deburr::spec::texture::preset_parameters(deburr::spec::texture::Preset::kDeburr);
  parameters.cache_fifo_depth = 64;
  return parameters;
}

deburr::spec::morphological::Parameters smoother_parameters() {
  auto parameters = deburr::spec::morphological::preset_parameters(
      deburr::spec::morphological::Preset::kDeburrLine);
  parameters.line_pixels = kWidth;
  parameters.storage = deburr::spec::morphological::Storage::kMemory;
  return parameters;
}

deburr::platform::MemoryModelParameters memory_parameters() {
  deburr::platform::MemoryModelParameters parameters;
  parameters.bytes = kMemoryBytes;
  parameters.latency_min = 20;
  parameters.latency_max = 40;  // responses overtake each other
  return parameters;
}

// A checker between an initiator and a target. An injected violation is placed on the violating
// side.
struct Hop {
  ProtocolChecker checker;
  std::unique_ptr<Violator> violator;

  template <class Initiator, class Target>
  Hop(const char* name, Initiator& initiator, Target& target,
      const ViolationInfo* injected = nullptr)
      : checker(name) {
    if (injected)
      violator =
          std::make_unique<Violator>(sc_core::sc_gen_unique_name("violator"), injected->violation);
    if (!injected) {
      initiator.bind(checker.from_initiator);
      checker.to_target.bind(target);
    } else if (injected->by_target) {
      initiator.bind(checker.from_initiator);
      checker.to_target.bind(violator->from_initiator);
      violator->to_target.bind(target);
    } else {
      initiator.bind(violator->from_initiator);
      violator->to_target.bind(checker.from_initiator);
      checker.to_target.bind(target);
    }
  }
};

// Ends the run when the frame is done, or too late.
class End final : public deburr::rtl::Clocked {
 public:
  End(deburr::rtl::ClockDomain& clock, std::function<bool()> done)
      : clock_(clock), done_(std::move(done)) {
    clock.add_after(*this);
  }
  deburr::rtl::Activity tick(deburr::rtl::Cycle cycle) override {
    if (done_() || cycle == kMostCycles) clock_.request_stop();
    return deburr::rtl::kIdle;
  }
  void reset() override {}

 private:
  deburr::rtl::ClockDomain& clock_;
  std::function<bool()> done_;
};

class Platform {
 public:
  explicit Platform(const ViolationInfo* injected) {
    const auto by = [&](bool software) {
      return injected && injected->by_software == software ? injected : nullptr;
    };
    hops_.emplace_back("software_bus", software_.bus, router_.initiators, by(true));
    hops_.emplace_back("texture_bus", *texture_.memory(), router_.initiators, by(false));
    hops_.emplace_back("smoother_bus", *smoother_.memory(), router_.initiators);
    router_.map(kMemory, kMemoryBytes);
    hops_.emplace_back("memory_port", router_.targets, memory_.ports);
    router_.map(kTextureUnit, kRegisterBytes);
    hops_.emplace_back("texture_registers", router_.targets, texture_.registers);
    router_.map(kSmoother, kRegisterBytes);
    hops_.emplace_back("smoother_registers", router_.targets, smoother_.registers);
    router_.map(kPainter, kRegisterBytes);
    hops_.emplace_back("painter_registers", router_.targets, painter_.registers.bus);

    software_.texture_interrupt(texture_.interrupt);
    software_.smoother_interrupt(smoother_.interrupt);
    software_.on_end = [this] { ended_ = true; };
    core_input_.clock(core_clock_);
    core_input_.reset_n(core_reset_n_);
    pixel_input_.clock(pixel_clock_);
    pixel_input_.reset_n(pixel_reset_n_);
    software_.core_reset_n(core_reset_n_);
    software_.pixel_reset_n(pixel_reset_n_);
    // One engine ends its responses with a call, the other in the return value.
    texture_.end_responses(deburr::rtl::ResponseEnd::kCall);

    painter_.quads_out(quads_);
    texture_.quads_in(quads_);
    texture_.colours_out(colours_);
    painter_.colours_in(colours_);
    painter_.pixels_out(painted_);
    crossing_.writer.beats_in(painted_);
    crossing_.reader.beats_out(pixels_);
    smoother_.pixels_in(pixels_);
    smoother_.pixels_out(blended_);
    display_.pixels_in(blended_);
  }

  void run() {
    clock_.run_free();
    if (!done())
      throw deburr::spec::SimulationError("the frame was not done in " +
                                          std::to_string(kMostCycles) + " cycles of the core");
    for (const Hop& hop : hops_) hop.checker.check_finished();
  }

  void report() const {
    std::printf("%-20s %9s %13s %9s %11s\n", "port", "blocking", "non-blocking", "bytes",
                "in flight");
    for (const Hop& hop : hops_)
      std::printf("%-20s %9llu %13llu %9llu %11llu\n", hop.checker.name(),
                  static_cast<unsigned long long>(hop.checker.blocking()),
                  static_cast<unsigned long long>(hop.checker.non_blocking()),
                  static_cast<unsigned long long>(hop.checker.bytes()),
                  static_cast<unsigned long long>(hop.checker.most_in_flight()));
    std::printf(
        "core cycles %llu, since its reset in mid-frame %llu; pixel cycles %llu and %llu, of them "
        "the smoother's frame %u; %u bilinear samples, %u pixels blended\n",
        static_cast<unsigned long long>(clock_.cycle()),
        static_cast<unsigned long long>(clock_.cycles_since_reset()),
        static_cast<unsigned long long>(pixels_clock_.cycle()),
        static_cast<unsigned long long>(pixels_clock_.cycles_since_reset()),
        software_.frame_cycles(), software_.bilinears(), software_.blended_pixels());
  }

  const Frame& picture() const { return display_.frame(); }
  Frame expected_picture() {
    return expected(texture_parameters(), smoother_parameters(), memory_.dump(0, kMemoryBytes));
  }
  bool failed() const { return software_.texture_failed(); }

 private:
  bool done() const { return ended_ && display_.complete(); }

  sc_core::sc_clock core_clock_{"core_clock", kPeriod}, pixel_clock_{"pixel_clock", kPixelPeriod};
  sc_core::sc_signal<bool> core_reset_n_{"core_reset_n"}, pixel_reset_n_{"pixel_reset_n"};
  deburr::rtl::ClockDomain clock_{"clock", kPeriod}, pixels_clock_{"pixels_clock", kPixelPeriod};
  deburr::rtl::ClockInput core_input_{"core_input", clock_},
      pixel_input_{"pixel_input", pixels_clock_};
  deburr::rtl::texture::TextureUnit texture_{"texture", clock_, texture_parameters()};
  deburr::rtl::morphological::MorphologicalEngine smoother_{"smoother", pixels_clock_,
                                                            smoother_parameters()};
  Painter painter_{"painter", clock_};
  Crossing<deburr::spec::morphological::PixelBeat> crossing_{"crossing", clock_, pixels_clock_};
  Display display_{"display", pixels_clock_};
  End end_{clock_, [this] { return done(); }};
  deburr::rtl::Link<deburr::spec::texture::Quad> quads_{"quads"};
  deburr::rtl::Link<deburr::spec::texture::ColourGroup> colours_{"colours"};
  deburr::rtl::Link<deburr::spec::morphological::PixelBeat> painted_{"painted"};
  deburr::rtl::Link<deburr::spec::morphological::PixelBeat> pixels_{"pixels"};
  deburr::rtl::Link<deburr::spec::morphological::BlendedBeat> blended_{"blended"};
  deburr::platform::MemoryModel memory_{"memory", kPeriod, memory_parameters()};
  Router router_{"router"};
  Software software_{"software"};
  std::deque<Hop> hops_;
  bool ended_ = false;
};

struct Options {
  const char* out = nullptr;
  const ViolationInfo* injected = nullptr;
  long quantum = 1000;  // ns
};

int usage(const char* what) {
  std::fprintf(stderr,
               "platform: %s\nusage: platform [--out FILE.ppm] [--quantum NS] [--plant VIOLATION] "
               "[--violations]\n",
               what);
  return 2;
}

int run(const Options& options) {
  tlm::tlm_global_quantum::instance().set(
      sc_core::sc_time(static_cast<double>(options.quantum), sc_core::SC_NS));
  Platform platform(options.injected);
  try {
    platform.run();
  } catch (const std::exception& error) {
    std::printf("FAIL %s\n", error.what());
    return 1;
  }
  platform.report();
  if (options.out && !platform.picture().write_ppm(options.out))
    return usage("the picture cannot be written");
  const Frame expected = platform.expected_picture();
  int differing = 0;
  for (std::size_t i = 0; i < expected.pixels.size(); ++i)
    differing += platform.picture().pixels[i] != expected.pixels[i];
  const bool right = differing == 0 && !platform.failed();
  std::printf("%s picture %08X, expected %08X: %d of %zu pixels differ%s\n",
              right ? "PASS" : "FAIL", platform.picture().hash(), expected.hash(), differing,
              expected.pixels.size(),
              platform.failed() ? "; the texture unit interrupts with an error" : "");
  return right ? 0 : 1;
}

}  // namespace
}  // namespace platform

int sc_main(int argc, char** argv) {
  platform::Options options;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--violations") {
      for (const platform::ViolationInfo& each : platform::violations())
        std::printf("%s: %s\n", each.name, each.rule);
      return 0;
    }
    if (i + 1 == argc) return platform::usage(("unknown option, or no value: " + word).c_str());
    const char* const value = argv[++i];
    if (word == "--out") {
      options.out = value;
    } else if (word == "--quantum") {
      char* end = nullptr;
      options.quantum = std::strtol(value, &end, 10);
      if (*end || options.quantum < 0)
        return platform::usage("--quantum needs a number of nanoseconds");
    } else if (word == "--plant") {
      for (const platform::ViolationInfo& each : platform::violations())
        if (std::strcmp(each.name, value) == 0) options.injected = &each;
      if (!options.injected) return platform::usage("unknown violation (see --violations)");
    } else {
      return platform::usage(("unknown option, or no value: " + word).c_str());
    }
  }
  return platform::run(options);
}
