// SPDX-License-Identifier: MIT
// Messages of the geometric engine about parameters without an effect, meshes that are too large,
// and dropped edges.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "spec/error.h"
#include "spec/geometric/check_build.h"
#include "spec/geometric/registers.h"
#include "tb/engines/geometric/geometric_unprogrammed.h"
#include "tb/run/parameter_set.h"
#include "tool/engines/geometric/geometric_configuration.h"
#include "tool/tests/engines/complaint.h"

namespace deburr::tool::configuration_test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

std::string complaint(const Settings& settings) {
  return tool::complaint<spec::geometric::Parameters>(
      "geometric", settings, [](const tb::ParameterSet& set, const auto& values) {
        reject_unused_configuration(set, values);
      });
}

TEST(GeometricConfiguration, RejectsParametersWithoutEffect) {
  struct Row {
    Settings settings;
    std::string said;
  };
  const std::string depth = "geometric.depth_test = off reads no depth";
  const std::string outermost =
      "without geometric.depth_test = farther no pixel is known to be nearer than its neighbour, "
      "so outermost equals max";
  for (const Row& row : std::vector<Row>{
           {{}, ""},
           {{{"select", "all"}, {"crease", "off"}},
            "geometric.select = all draws every edge, whether it is a crease or not"},
           {{{"select", "all"}, {"crease_depth", "3"}}, "geometric.select = all has no creases"},
           {{{"select", "all"}, {"cull", "none"}},
            "geometric.select = all draws every edge, whichever way its faces are turned"},
           {{{"select", "all"}, {"face_limit", "16384"}},
            "geometric.select = all reads no facing bits"},
           {{{"select", "mesh"}, {"cull", "none"}},
            "geometric.select = mesh ignores which way faces are turned"},
           {{{"select", "mesh"}, {"face_limit", "16384"}},
            "geometric.select = mesh reads no facing bits"},
           {{{"select", "edges"}, {"cull", "none"}, {"face_limit", "16384"}}, ""},
           {{{"crease", "off"}, {"crease_depth", "3"}}, "geometric.crease = off has no creases"},
           {{{"depth_test", "off"}, {"depth_bias", "1"}, {"combine", "max"}}, depth},
           {{{"depth_test", "off"}, {"crease_depth", "1"}, {"combine", "max"}}, depth},
           {{{"depth_test", "off"}, {"depth_lines", "16"}, {"combine", "max"}}, depth},
           {{{"depth_test", "off"}, {"combine", "outermost"}}, outermost},
           {{{"depth_test", "farther"}, {"combine", "outermost"}}, ""},
           {{{"frame_copy", "false"}, {"copy_lines", "8"}},
            "geometric.frame_copy = false copies nothing"},
           {{{"frame_copy", "true"}, {"copy_lines", "8"}}, ""},
           {{{"pipelined", "true"}, {"dividers", "1"}, {"reciprocal_table", "0"}},
            "geometric.pipelined = true accepts a line every cycle with one divider"},
           {{{"pipelined", "true"}, {"reciprocal_table", "0"}},
            "geometric.pipelined = true accepts a line every cycle without one"},
           {{{"pipelined", "false"}, {"dividers", "2"}}, ""}})
    EXPECT_EQ(complaint(row.settings), row.said)
        << (row.settings.empty() ? "" : row.settings.back().first + row.settings[0].second);
}

TEST(GeometricConfiguration, ChecksFaceCountAgainstLimits) {
  const auto said = [](std::size_t faces, spec::geometric::Select select, std::int32_t limit) {
    tb::Scene scene;
    scene.name = "many";
    scene.mesh.triangles.resize(faces);
    spec::geometric::Parameters p;
    p.select = select;
    p.face_limit = limit;
    try {
      reject_too_many_faces(scene, p);
    } catch (const spec::ConfigError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  using spec::geometric::Select;
  constexpr std::uint64_t kStep = spec::geometric::kFacesInLine;
  EXPECT_EQ(said(1000, Select::kEdges, 1000), "");
  EXPECT_EQ(said(kStep + 1, Select::kEdges, kStep),
            fmt::format("the mesh 'many' has {} faces, the hardware has facing bits for {}: raise "
                        "the limit (--set geometric.face_limit={}) or simplify the mesh",
                        kStep + 1, kStep, 2 * kStep));
  EXPECT_EQ(said(2 * kStep, Select::kEdges, kStep).find("face_limit=" + std::to_string(3 * kStep)),
            std::string::npos);
  EXPECT_EQ(said(1001, Select::kMesh, 1000), "");
  EXPECT_EQ(said(1001, Select::kAll, 1000), "");
}

TEST(GeometricConfiguration, NotesThatAllEdgesWereDropped) {
  spec::geometric::Work work;
  EXPECT_THAT(dropped_notes(work), IsEmpty()) << "there were none";
  work.edges = 12345;
  work.back_edges = 1;
  work.flat_edges = 2;
  work.outside_edges = 3;
  work.empty_edges = 4;
  work.degenerate_edges = 5;
  work.invalid_edges = 6000;
  EXPECT_THAT(
      dropped_notes(work),
      ElementsAre(
          "all 12,345 edges were dropped (1 turned away from the eye, 2 no crease, 3 behind the "
          "eye or outside the guard band, 4 outside the frame, 5 without length, 6,000 with an "
          "index out of range): nothing was smoothed; for a camera inside the mesh, or a mesh with "
          "the opposite winding order, set geometric.cull = none"));
  work = {};
  work.edges = work.flat_edges = 7;
  EXPECT_THAT(dropped_notes(work),
              ElementsAre("all 7 edges were dropped (7 no crease): nothing was smoothed"));
  work.lines = 1;
  EXPECT_THAT(dropped_notes(work), IsEmpty());
}

TEST(GeometricConfiguration, NotesLatencyFifoBelowTheFills) {
  spec::geometric::Parameters p;
  p.fills = 8;
  p.latency_fifo = 8;
  EXPECT_THAT(build_notes(p), IsEmpty());
  p.latency_fifo = 7;
  EXPECT_THAT(build_notes(p), ElementsAre("geometric.latency_fifo = 7 is below geometric.fills = "
                                          "8: lookups stall before all fills are outstanding"));
}

// So that a run reveals each field that is not programmed.
TEST(UnprogrammedGeometricEngine, EveryFieldHasAnotherValue) {
  using namespace spec::geometric;  // NOLINT: parameters and registers
  for (const PresetRow& preset : kPresets)
    for (const DepthTest test : {DepthTest::kOff, DepthTest::kOwn, DepthTest::kFarther})
      for (const CoarseLines coarse : {CoarseLines::kNone, CoarseLines::k4}) {
        Parameters p = preset_parameters(preset.preset);
        p.depth_test = test;
        p.coarse_lines = test == DepthTest::kOff ? CoarseLines::kNone : coarse;
        const Parameters other = tb::unprogrammed(p);
        EXPECT_NO_THROW(check_build(other));
        for (const spec::Field& field : spec::geometric::reg::configuration::kFields)
          EXPECT_NE(field.of(configuration_word(p)), field.of(configuration_word(other)))
              << field.name;
      }
}

}  // namespace
}  // namespace deburr::tool::configuration_test
