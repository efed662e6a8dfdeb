// SPDX-License-Identifier: MIT
// Environment of the texture unit for a scene.
//
//   TextureScene ─► Driver ─► TextureUnit ─► Sink ─► scoreboard, frame
//                     │        │      └ registers ◄─ RegisterHost
//                     ▼      MemoryModel ─► scoreboard of line fills
//                   golden model (expected colours, expected fills)
//
// The golden model processes each quad when the driver sends it, so only expectations of quads in
// flight are kept. Every output is checked as it appears.
#pragma once

#include <tlm_utils/simple_initiator_socket.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <systemc>
#include <vector>

#include "golden/texture/texture_golden.h"
#include "rtl_model/platform/memory_model.h"
#include "rtl_model/platform/register_host.h"
#include "rtl_model/platform/texture_driver.h"
#include "rtl_model/texture/texture_unit.h"
#include "spec/texture/packets.h"
#include "spec/texture/parameters.h"
#include "tb/engines/texture/sent_quads.h"
#include "tb/engines/texture/texture_checks.h"
#include "tb/engines/texture/texture_coverage.h"
#include "tb/engines/texture/texture_faults.h"
#include "tb/engines/texture/texture_history.h"
#include "tb/engines/texture/texture_maps.h"
#include "tb/engines/texture/texture_meter.h"
#include "tb/engines/texture/texture_scene.h"
#include "tb/engines/texture/texture_setup.h"
#include "tb/env/environment.h"
#include "tb/harness/driver.h"
#include "tb/scene/rasteriser.h"
#include "tb/traces/fragment_trace.h"

namespace deburr::tb {

class TextureEnvironment final : public Environment {
 public:
  // `scene` must outlive the environment. With a name it is part of a composition, which takes the
  // colours from `colours` and passes them to check_output(). Throws ConfigError for invalid
  // parameters.
  TextureEnvironment(Simulation& simulation, const TextureScene& scene, const TextureSetup& setup,
                     std::string name = {});
  ~TextureEnvironment() override;

  void configure() override;
  bool begin(std::size_t piece) override { return piece == 0; }
  void watch() override;
  bool done() const override;
  void end() override {
    watch();
    ended_ = true;
  }
  void restart() override;
  void finish() override;
  void reject_memory_errors() override;
  void reject_unused_errors() const override;
  Amount amount() const override;
  bool memory_at_rest() const override { return memory_.at_rest(); }
  Boards outputs() const override { return {&checks_.colours}; }
  Boards traffic() const override { return {&checks_.fills}; }
  Boards counters() const override {
    return {&checks_.registers.board(), &checks_.figures.board()};
  }
  void collect(Result& result) const override { meter_.collect(result); }
  void show_parts(Observer& observer) const override {
    meter_.show_parts(observer, quads_, colours);
  }
  std::vector<PictureMap> maps() const override;
  std::optional<PixelHistory> pixel_history() const override;
  Coverage coverage() const override;
  void collect_headline(Result& result) const override { meter_.collect_headline(result); }

  rtl::Link<spec::texture::ColourGroup> colours;
  void check_output(rtl::Cycle cycle, const spec::texture::ColourGroup& group);
  bool sent() const { return quad_driver_.done(); }  // all quads

  const Image& frame() const { return frame_; }
  // Per pixel, whether a colour has been received.
  const std::vector<std::uint8_t>& received() const { return received_; }
  // The golden model's picture of the same fragments; empty if SimulationOptions::golden is false.
  const Image& golden_frame() const { return checks_.golden_frame(); }
  const golden::texture::TextureWork& golden_work() const { return checks_.work(); }
  std::uint64_t delivered() const { return delivered_; }
  // Hash of all colours and tags in order.
  std::uint64_t colour_hash() const { return hash_.value(); }

  const rtl::texture::TextureUnit& unit() const { return unit_; }
  platform::MemoryModel& memory() { return memory_; }
  platform::RegisterHost& host() { return host_; }

 private:
  // Additional initiator for the fault of an unrequested fetch.
  struct ExtraInitiator : sc_core::sc_module {
    explicit ExtraInitiator(const sc_core::sc_module_name& name) : sc_module(name) {}
    tlm_utils::simple_initiator_socket<ExtraInitiator> memory{"memory"};
  };

  traces::QuadSource open() const;
  std::uint64_t fragments() const;
  void clear_outputs();
  void check_colour(rtl::Cycle cycle, const spec::texture::Colour& colour);
  void fetch_again();

  const TextureScene& scene_;
  TextureSetup setup_;
  TextureFaults faults_;
  rtl::Link<spec::texture::Quad> quads_{"quads"};
  Driver<spec::texture::Quad> quad_driver_;
  rtl::texture::TextureUnit unit_;
  std::unique_ptr<Sink<spec::texture::ColourGroup>> sink_;  // null in a composition
  platform::MemoryModel memory_;
  platform::RegisterHost host_;
  platform::TextureDriver driver_;
  TextureMeter meter_;
  ExtraInitiator extra_initiator_;

  traces::QuadSource source_;
  traces::TracedQuad quad_;  // currently sent
  SentQuads sent_;
  TextureChecks checks_;
  Image frame_;
  std::vector<std::uint8_t> received_;
  std::unique_ptr<TextureMaps> maps_;
  std::unique_ptr<TextureHistory> history_;
  bool ended_ = false;     // the frame is done
  bool followed_ = false;  // the quad being sent covers the recorded pixel
  std::optional<TextureCoverage> coverage_;
  std::uint64_t delivered_ = 0;
  OutputHash hash_;
  bool fetch_again_ = false;
};

}  // namespace deburr::tb
