// SPDX-License-Identifier: MIT
// The posteriser on one picture, or on the picture of a composition.
//
//   picture -> Driver -> Posteriser -> Sink -> pixels: compared with the golden picture
//                            └ registers <- RegisterHost: the counters at the end
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "rtl_model/platform/posteriser_driver.h"
#include "rtl_model/platform/register_host.h"
#include "rtl_model/posteriser/posteriser.h"
#include "spec/posteriser/packets.h"
#include "spec/posteriser/parameters.h"
#include "tb/env/environment.h"
#include "tb/env/meter.h"
#include "tb/env/raster_scoreboard.h"
#include "tb/harness/driver.h"
#include "tb/scene/image.h"

namespace deburr::tb {

// Descriptions of its figures.
class PosteriserMeter final : public Meter {
 public:
  explicit PosteriserMeter(std::string name) : Meter(std::move(name)) {}
  void collect(Result& result, const rtl::Engine& engine) const;
  void collect_headline(Result& result, std::uint64_t delivered, int link_depth) const;
  void show(Observer& observer, const rtl::Engine& engine, const rtl::LinkBase& in,
            const rtl::LinkBase& out) const;
};

class PosteriserEnvironment final : public Environment {
 public:
  // The picture, which must outlive the environment, is the input of the golden model. With a name
  // the environment is part of a composition, which puts the picture into `tones_in`.
  PosteriserEnvironment(Simulation& simulation, const Image& picture,
                        const spec::posteriser::Parameters& parameters, std::string name = {});

  void configure() override;
  bool begin(std::size_t piece) override;
  bool done() const override;
  void end() override {}
  void restart() override;
  void finish() override;
  void reject_memory_errors() override {}
  void reject_unused_errors() const override {}
  Amount amount() const override { return {came_, came_, expected_.size(), "pixel"}; }
  bool memory_at_rest() const override { return true; }
  Boards outputs() const override { return {&board_}; }
  Boards traffic() const override { return {}; }
  Boards counters() const override { return {&register_board_.board()}; }
  void collect(Result& result) const override;
  void show_parts(Observer& observer) const override;
  std::vector<PictureMap> maps() const override;
  Coverage coverage() const override;
  void collect_headline(Result& result) const override;

  const Image& frame() const { return frame_; }
  Image golden_frame() const;
  std::size_t delivered() const { return came_; }
  static Coverage declared_coverage();

  rtl::Link<spec::posteriser::Tone> tones_in;

 private:
  spec::posteriser::Parameters as_built() const;

  const Image& picture_;
  spec::posteriser::Parameters parameters_;
  std::vector<spec::posteriser::Tone> tones_, expected_;
  rtl::Link<spec::posteriser::Tone> tones_out_;
  std::unique_ptr<Driver<spec::posteriser::Tone>> source_;  // outside a composition
  rtl::posteriser::Posteriser engine_;
  Sink<spec::posteriser::Tone> sink_;
  platform::RegisterHost host_;
  platform::PosteriserDriver driver_{host_};
  PosteriserMeter meter_;
  RasterScoreboard<spec::posteriser::Tone> board_;
  RegisterScoreboard register_board_;
  Image frame_;
  std::size_t came_ = 0;
};

}  // namespace deburr::tb
