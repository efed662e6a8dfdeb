// SPDX-License-Identifier: MIT
// Helpers that simulate the texture unit against its golden model.
#pragma once

#include <algorithm>
#include <cstdint>
#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

#include "golden/texture/cycle_predictor.h"
#include "golden/texture/texture_golden.h"
#include "tb/engines/texture/texture_counterparts.h"
#include "tb/engines/texture/texture_environment.h"
#include "tb/engines/texture/texture_scene.h"
#include "tb/stimuli/texture_quads.h"

namespace deburr::tb {

// Results of a run for comparison with another run.
struct TextureOutcome {
  std::uint64_t cycles = 0, colour_hash = 0, colours = 0, bilinears = 0, samples = 0, fills = 0;
  std::uint64_t activations = 0;
  std::uint64_t comparisons = 0, mismatches = 0, traffic_comparisons = 0, traffic_mismatches = 0;
  golden::texture::Slots slots{};  // at widths above 1
  std::uint64_t all_slots = 0, output_slots = 0;
};

inline void add_slots(const rtl::texture::TextureUnit& unit, TextureOutcome& outcome) {
  if (!unit.cache.wide) return;
  const rtl::texture::GroupFormer& former = unit.cache.wide->group_former;
  outcome.slots = {former.requests.value(),
                   former.lookups.value(),
                   former.banks.value(),
                   former.set.value(),
                   former.decoders ? former.decoders->value() : 0,
                   former.partial_quad.value(),
                   former.starved.value(),
                   former.allocate.value(),
                   former.miss_queue.value(),
                   former.wait_fill.value(),
                   former.write_fill.value(),
                   former.bank_pass.value()};
  outcome.all_slots = former.slots.value();
  outcome.output_slots = former.output.value();
}

// A square picture of `side` pixels of a named scene with a 1024 x 1024 texture.
inline SceneParameters picture(const std::string& source, int side) {
  SceneParameters scene;
  scene.source = source;
  scene.width = scene.height = side;
  return scene;
}

// Options of the simulation and the texture unit.
struct TextureRunOptions : SimulationOptions, TextureSetup {};

// Options with the paper's configuration.
inline TextureRunOptions paper_options() {
  TextureRunOptions options;
  options.texture = stimuli::paper_configuration();
  return options;
}

// The suites run a second time with the RTL counterparts of hdl/ in place of SystemC units, where
// the build has their configuration (tb/hdl/suites_with_counterparts_test.cpp).
inline bool& counterparts_do_the_work() {
  static bool they_do = false;
  return they_do;
}
inline rtl::texture::TextureUnit::StandIns stand_ins_of_suite(
    const spec::texture::Parameters& parameters, const rtl::MemoryCycles& memory,
    std::uint64_t seed) {
  if (!counterparts_do_the_work()) return {};
  return available_texture_counterparts(as_built(parameters, memory), seed);
}
// Units that may stay SystemC in the running suite, because the build lacks some of its
// configurations.
inline std::vector<std::string> (*not_all_built)() = nullptr;
// After a run: throws if an RTL counterpart that should take part has moved no beat.
inline void expect_counterparts_of_suite(const rtl::texture::TextureUnit& unit) {
  if (!counterparts_do_the_work()) return;
  const std::vector<std::string> may_be =
      not_all_built ? not_all_built() : std::vector<std::string>();
  for (const std::string& idle : idle_counterparts(unit))
    if (std::find(may_be.begin(), may_be.end(), idle) == may_be.end())
      throw std::runtime_error("the unit " + idle + " in SystemVerilog has moved no beat");
}

// Simulates and checks: throws as Simulation::run() does, and Mismatch.
inline TextureOutcome simulate(const SceneParameters& scene, const SamplerParameters& sampler,
                               TextureRunOptions options) {
  options.stand_ins = stand_ins_of_suite(options.texture, memory_cycles(options), options.seed);
  constexpr std::uint32_t kTextureSeed =
      1;  // the options' seed is for the weather, not the picture
  const TextureScene built(scene, sampler, kTextureSeed);
  Simulation simulation(options);
  TextureEnvironment environment(simulation, built, options);
  simulation.elaborate(environment);
  try {
    simulation.run();
    environment.check();
    expect_counterparts_of_suite(environment.unit());
  } catch (...) {
    if (counterparts_do_the_work())
      std::cerr << "seed of the run and of the units in SystemVerilog: " << options.seed << "\n";
    throw;
  }
  Result result;
  simulation.collect(result);
  const golden::texture::TextureWork& work = environment.golden_work();
  TextureOutcome outcome = {simulation.cycles(),
                            environment.colour_hash(),
                            environment.delivered(),
                            work.bilinears,
                            work.samples,
                            work.line_fills,
                            simulation.activations(),
                            result.comparisons,
                            result.mismatches,
                            result.traffic_comparisons,
                            result.traffic_mismatches};
  add_slots(environment.unit(), outcome);
  return outcome;
}

}  // namespace deburr::tb
