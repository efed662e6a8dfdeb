// SPDX-License-Identifier: MIT
// Messages of the morphological engine about parameters without an effect, and about thresholds
// that are probably a mistake.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "spec/error.h"
#include "spec/morphological/check_build.h"
#include "spec/morphological/registers.h"
#include "tb/engines/morphological/morphological_unprogrammed.h"
#include "tb/run/parameter_set.h"
#include "tool/engines/morphological/morphological_configuration.h"
#include "tool/tests/engines/complaint.h"

namespace deburr::tool::configuration_test {
namespace {

using spec::morphological::EdgeSource;
using spec::morphological::kOneCode;
using spec::morphological::ThresholdMode;
using testing::ElementsAre;
using testing::IsEmpty;

std::string complaint(const Settings& settings) {
  return tool::complaint<spec::morphological::Parameters>(
      "morphological", settings, [](const tb::ParameterSet& set, const auto& values) {
        reject_unused_configuration(set, values, "memory");
      });
}

TEST(MorphologicalConfiguration, RejectsParametersWithoutEffect) {
  struct Row {
    Settings settings;
    std::string said;
  };
  const std::string of_depth =
      "morphological.edges.source = depth compares depths, by edges.depth_threshold";
  const std::string own =
      "morphological.edges.source is neither luma nor colour and has thresholds of its own";
  const std::string dynamic = "it is only used with morphological.edges.threshold_mode = dynamic";
  const std::string none = "morphological.predictor = none extends no run";
  const std::string depths =
      "it is only used with morphological.edges.source = depth or predicated";
  const std::string predicated = "it is only used with morphological.edges.source = predicated";
  for (const Row& row : std::vector<Row>{
           {{}, ""},
           {{{"edges.source", "depth"}, {"edges.local_contrast", "off"}}, of_depth},
           {{{"edges.source", "depth"}, {"edges.threshold_mode", "fixed"}}, of_depth},
           {{{"edges.source", "depth"}, {"edges.threshold", "5"}}, own},
           {{{"edges.source", "predicated"}, {"edges.threshold", "5"}}, own},
           {{{"edges.source", "depth"}, {"edges.alpha", "5"}}, dynamic},
           {{{"edges.source", "depth"}, {"edges.depth_threshold", "5"}}, ""},
           {{{"edges.source", "luma"}, {"edges.threshold_mode", "fixed"}, {"edges.floor", "5"}},
            dynamic},
           {{{"edges.source", "luma"},
             {"edges.threshold_mode", "fixed"},
             {"edges.dynamic_luma", "max"}},
            dynamic},
           {{{"edges.source", "luma"}, {"edges.threshold_mode", "fixed"}, {"edges.threshold", "5"}},
            ""},
           {{{"edges.source", "luma"},
             {"edges.threshold_mode", "dynamic"},
             {"edges.threshold", "5"}},
            "morphological.edges.threshold_mode = dynamic computes the threshold"},
           {{{"edges.source", "luma"}, {"edges.depth_threshold", "5"}}, depths},
           {{{"edges.source", "luma"}, {"edges.threshold_on_depth_edge", "5"}}, predicated},
           {{{"edges.source", "depth"}, {"edges.threshold_off_depth_edge", "5"}}, predicated},
           {{{"edges.source", "predicated"}, {"edges.threshold_off_depth_edge", "5"}}, ""},
           {{{"predictor", "none"}, {"steps", "2"}}, none},
           {{{"predictor", "none"}, {"contiguous", "true"}}, none},
           {{{"predictor", "none"}, {"safe", "true"}}, none},
           {{{"predictor", "none"}, {"trim", "true"}}, none},
           {{{"preset", "mlaa"}, {"quality", "high"}},
            "it is only used with morphological.preset = smaa or smaa-dynamic"},
           {{{"preset", "smaa"}, {"quality", "high"}}, ""},
           {{{"area", "analytic"}, {"search_steps", "8"}},
            "morphological.area = analytic and learned search nothing"},
           {{{"area", "learned"}, {"search_steps", "8"}},
            "morphological.area = analytic and learned search nothing"},
           {{{"diagonals", "false"}, {"diagonal_steps", "8"}},
            "it is only used with morphological.diagonals = true"},
           {{{"diagonals", "true"}, {"diagonal_steps", "8"}}, ""},
           {{{"round_corners", "false"}, {"corner_rounding", "8"}},
            "it is only used with morphological.round_corners = true"},
           {{{"round_corners", "true"}, {"corner_rounding", "8"}}, ""},
           {{{"storage", "line_buffers"}, {"memory.outstanding", "8"}},
            "morphological.storage = line_buffers uses no memory"},
           {{{"storage", "memory"}, {"memory.outstanding", "8"}}, ""}})
    EXPECT_EQ(complaint(row.settings), row.said)
        << (row.settings.empty() ? "" : row.settings[0].second + " " + row.settings.back().first);
}

TEST(MorphologicalConfiguration, NotesThresholdsBelowOneCode) {
  spec::morphological::Parameters p;
  p.trial_cycles = 4;
  p.edge_source = EdgeSource::kLuma;
  p.threshold_mode = ThresholdMode::kFixed;
  const auto note = [](const std::string& name, int value) {
    return fmt::format(
        "morphological.{} = {} is {:.5f} of a code, so noise makes edges: its unit is code / {}; "
        "multiply values for versions before 0.3.0 by 255",
        name, value, double(value) / kOneCode, kOneCode);
  };
  const int low = kOneCode - 1;
  p.threshold = kOneCode;
  EXPECT_THAT(build_notes(p), IsEmpty());
  p.threshold = low;
  EXPECT_THAT(build_notes(p), ElementsAre(note("edges.threshold", low)));
  p.edge_source = EdgeSource::kDepth;
  EXPECT_THAT(build_notes(p), IsEmpty());
  p.edge_source = EdgeSource::kPredicated;
  p.threshold_on_depth_edge = p.threshold_off_depth_edge = kOneCode;
  EXPECT_THAT(build_notes(p), IsEmpty());
  p.threshold_on_depth_edge = low;
  EXPECT_THAT(build_notes(p), ElementsAre(note("edges.threshold_on_depth_edge", low)));
  p.threshold_on_depth_edge = kOneCode;
  p.threshold_off_depth_edge = low;
  EXPECT_THAT(build_notes(p), ElementsAre(note("edges.threshold_off_depth_edge", low)));
  p.edge_source = EdgeSource::kColour;
  p.threshold_mode = ThresholdMode::kDynamic;
  p.floor = low;
  p.alpha = 0;
  EXPECT_THAT(build_notes(p), ElementsAre(note("edges.floor", low)));
  const int least = ((1 << 24) + 254) / 255;
  p.floor = kOneCode;
  p.alpha = least;
  EXPECT_THAT(build_notes(p), IsEmpty());
  p.alpha = least - 1;
  const auto alpha = [&](const std::string& floor) {
    return fmt::format(
        "morphological.edges.alpha = {} is {:.5f}, below one code even for white{}: its unit is 1 "
        "/ "
        "16777216; multiply values for versions before 0.3.0 by 256",
        least - 1, double(least - 1) / (1 << 24), floor);
  };
  EXPECT_THAT(build_notes(p), ElementsAre(alpha(", so edges.floor alone decides")));
  p.floor = low;
  EXPECT_THAT(build_notes(p), ElementsAre(note("edges.floor", low), alpha("")));
  p.floor = kOneCode;
  p.alpha = least;
  p.trial_cycles = 3;
  EXPECT_THAT(
      build_notes(p),
      ElementsAre(
          "morphological.trial_cycles = 3: a trial weight needs more than one step per cycle, "
          "which does not reach 250 MHz (docs/reference/morphological/hardware.md, Trials)"));
}

// Fields with the same value in both words.
std::vector<std::string> same_fields(std::span<const spec::Field> fields, std::uint32_t one,
                                     std::uint32_t other) {
  std::vector<std::string> names;
  for (const spec::Field& field : fields)
    if (field.of(one) == field.of(other)) names.emplace_back(field.name);
  return names;
}

// So that a run reveals each field that is not programmed. Fields that describe build parameters
// keep their values.
TEST(UnprogrammedMorphologicalEngine, EveryProgrammableFieldHasAnotherValue) {
  using namespace spec::morphological;  // NOLINT: parameters and registers
  for (const PresetRow& preset : kPresets)
    for (const QualityRow& quality : kQualities)
      for (const EdgeSource source :
           {EdgeSource::kLuma, EdgeSource::kDepth, EdgeSource::kPredicated, EdgeSource::kColour}) {
        Parameters p = preset_parameters(preset.preset, quality.quality);
        p.edge_source = source;
        const bool no_luma = source == EdgeSource::kPredicated || source == EdgeSource::kColour;
        if (no_luma) p.threshold_mode = ThresholdMode::kFixed;
        const Parameters other = tb::unprogrammed(p);
        EXPECT_NO_THROW(check_build(other));
        std::vector<std::string> built = {"contiguous", "ends",          "area_table",
                                          "diagonals",  "round_corners", "area_learned",
                                          "border",     "text_guard"};
        // From luma or depth to a source without a dynamic threshold.
        if (!no_luma && p.threshold_mode == ThresholdMode::kFixed)
          built.insert(built.begin(), "threshold_mode");
        EXPECT_THAT(same_fields(spec::morphological::reg::configuration::kFields,
                                configuration_word(p), configuration_word(other)),
                    testing::ElementsAreArray(built));
        EXPECT_THAT(
            same_fields(spec::morphological::reg::smaa::kFields, smaa_word(p), smaa_word(other)),
            ElementsAre("diagonal_steps"));
        for (const auto threshold :
             {&Configuration::threshold, &Configuration::threshold_on_depth_edge,
              &Configuration::threshold_off_depth_edge, &Configuration::alpha,
              &Configuration::floor, &Configuration::depth_threshold})
          EXPECT_NE(p.*threshold, other.*threshold);
      }
}

}  // namespace
}  // namespace deburr::tool::configuration_test
