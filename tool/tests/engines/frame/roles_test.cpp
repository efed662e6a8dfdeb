// SPDX-License-Identifier: MIT
// Compositions of engines that declare only a role.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "spec/error.h"
#include "tool/engines/frame/frame_roles.h"

namespace deburr::tool::roles_test {

using tb::DrawnScene;
using tb::ParameterSet;

namespace {

using testing::ElementsAre;

struct Configuration {
  std::int32_t told = 0;
};

template <class Visitor>
void describe(Configuration& p, Visitor& v) {
  v.integer("told", p.told, 0, 9, "", "What it was told.");
}

// Common part of every role in these tests.
template <class Role>
class Plain : public Role {
 public:
  Plain(std::string name, HandedOn needs, HandedOn hands_on)
      : name_(std::move(name)), needs_(std::move(needs)), hands_on_(std::move(hands_on)) {}
  std::string_view name() const override { return name_; }
  std::string_view title() const override { return name_; }
  HandedOn needs() const override { return needs_; }
  HandedOn hands_on() const override { return hands_on_; }
  void add_parameters(ParameterSet& set) override {
    set.add(name_, tb::ParameterKind::kRule, configuration_);
  }
  std::vector<std::string> prefixes() const override { return {name_ + "."}; }
  void apply_preset(ParameterSet&) override {}
  void resolve(ParameterSet&) override {}
  std::string label() const override { return ""; }
  std::vector<Shorthand> shorthands() const override {
    return {{"--told", name_ + ".told", "Of " + name_}};
  }
  void check(const DrawnScene&) const override {}

 protected:
  void tell(ParameterSet& set, std::string_view what, std::string_view why) {
    set.imply(name_ + ".told", what, why);
  }
  std::string name_;
  Configuration configuration_;

 private:
  HandedOn needs_, hands_on_;
};

class Drawer final : public Plain<PictureDrawer> {
 public:
  explicit Drawer(HandedOn hands_on) : Plain("drawer", {}, std::move(hands_on)) {}
  void add_scene(ParameterSet&) override {}
  DrawingWords words() const override { return {}; }
  std::string_view caption() const override { return ""; }
  const std::string& source() const override { return name_; }
  std::vector<std::filesystem::path> input_files(tb::MeshFiles&) const override { return {}; }
  std::shared_ptr<const DrawnScene> load(std::uint32_t, const RunContext&) const override {
    return nullptr;
  }
  std::shared_ptr<const DrawnScene> smallest() const override { return nullptr; }
  std::string reference_caption() const override { return ""; }
  void prepare_reference(const DrawnScene&, const tb::RenderOptions&,
                         const RunContext&) const override {}
  tb::Image compare_with_reference(const DrawnScene&, const tb::RenderOptions&, const tb::Image&,
                                   const tb::Image&, tb::Result&,
                                   const RunContext&) const override {
    return {};
  }
  std::unique_ptr<DrawingStage> build(tb::Simulation&, const DrawnScene&) const override {
    return nullptr;
  }
};

class Mesh final : public Plain<MeshSmoother> {
 public:
  using Plain::Plain;
  bool linear_light() const override { return false; }
  void mark(ParameterSet& set, std::string_view why) override { tell(set, "1", why); }
  std::unique_ptr<MeshStage> build(tb::Simulation&, const DrawnScene&, tb::Image) const override {
    return nullptr;
  }
};

class Rows final : public Plain<RowSmoother> {
 public:
  Rows(std::string name, HandedOn needs, bool looks)
      : Plain(std::move(name), std::move(needs), {}), looks_(looks) {}
  bool linear_light() const override { return false; }
  bool looks_at_marks() const override { return looks_; }
  void follow(ParameterSet& set, std::string_view why) override { tell(set, "2", why); }
  std::unique_ptr<RowsPort> rows_port(const char*, const DrawnScene&) const override {
    return nullptr;
  }
  std::unique_ptr<RowStage> build(tb::Simulation&, const DrawnScene&, tb::Image,
                                  RowsPort&) const override {
    return nullptr;
  }

 private:
  bool looks_;
};

std::vector<std::unique_ptr<CompositionRole>> roles(bool with_depth = true) {
  using enum Handed;
  std::vector<std::unique_ptr<CompositionRole>> all;
  all.push_back(std::make_unique<Rows>("calm", HandedOn{}, true));
  all.push_back(std::make_unique<Mesh>("marker", HandedOn{kMeshEdges}, HandedOn{kMarkedPixels}));
  all.push_back(
      std::make_unique<Drawer>(with_depth ? HandedOn{kDepth, kMeshEdges} : HandedOn{kMeshEdges}));
  all.push_back(std::make_unique<Rows>("blind", HandedOn{kDepth}, false));
  all.push_back(std::make_unique<Mesh>("plain", HandedOn{}, HandedOn{}));
  return all;
}

std::vector<std::string> names(const FrameRoles& roles) {
  std::vector<std::string> all;
  for (const Smoothing& smoothing : roles.smoothings()) all.push_back(smoothing.name);
  return all;
}

TEST(FrameRoles, ListsSingleSmoothersAndRowsAfterEdges) {
  EXPECT_THAT(names(FrameRoles(roles())),
              ElementsAre("calm", "marker", "blind", "plain", "marker-calm", "marker-blind",
                          "plain-calm", "plain-blind"));
}

TEST(FrameRoles, OmitsSmootherWithUnmetNeeds) {
  EXPECT_THAT(names(FrameRoles(roles(false))),
              ElementsAre("calm", "marker", "plain", "marker-calm", "plain-calm"));
}

TEST(FrameRoles, RejectsEmptyComposition) {
  EXPECT_THROW(FrameRoles(std::vector<std::unique_ptr<CompositionRole>>()), spec::CheckFailed);
}

TEST(FrameRoles, ListsCompositionNamesAsValuesAndHelp) {
  FrameRoles made(roles(false));
  ParameterSet set;
  made.add_parameters(set);
  EXPECT_EQ(set.find("frame.smoothing")->range, "calm | marker | plain | marker-calm | plain-calm");
  EXPECT_EQ(made.shorthands().back().help,
            "calm (default), marker, plain, marker-calm or plain-calm");
  // The first engine with an option owns it for all.
  ASSERT_EQ(made.shorthands().size(), 2u);
  EXPECT_EQ(made.shorthands().front().parameter, "drawer.told");
}

// The value that the composition sets in the engine, and its origin.
std::string told(const std::string& smoothing, const std::string& engine) {
  FrameRoles made(roles());
  ParameterSet set;
  made.add_parameters(set);
  set.set("frame.smoothing", smoothing, "test");
  made.resolve(set);
  const tb::Parameter* parameter = set.find(engine + ".told");
  return parameter->text() + parameter->implied_by;
}

TEST(FrameRoles, MarkReaderFollowsMarker) {
  EXPECT_EQ(told("marker-calm", "marker"), "1frame.smoothing = marker-calm");
  EXPECT_EQ(told("marker-calm", "calm"), "2frame.smoothing = marker-calm");
  for (const std::string nobody : {"marker", "calm", "marker-blind", "plain-calm", "plain-blind"})
    for (const std::string engine : {"marker", "calm", "blind", "plain"})
      EXPECT_EQ(told(nobody, engine), "0") << nobody << ' ' << engine;
}

TEST(FrameRoles, RejectsParametersOfUnusedEngine) {
  for (const auto& [smoothing, engine, taken] :
       {std::tuple{"calm", "calm", true}, std::tuple{"calm", "marker", false},
        std::tuple{"marker-calm", "marker", true}, std::tuple{"marker-calm", "blind", false}}) {
    FrameRoles made(roles());
    ParameterSet set;
    made.add_parameters(set);
    set.set("frame.smoothing", smoothing, "test");
    set.set(std::string(engine) + ".told", "3", "test");
    if (taken) {
      EXPECT_NO_THROW(made.resolve(set)) << smoothing << engine;
    } else {
      EXPECT_THROW(made.resolve(set), spec::ConfigError) << smoothing << engine;
    }
  }
}

}  // namespace
}  // namespace deburr::tool::roles_test
