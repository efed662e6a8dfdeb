// SPDX-License-Identifier: MIT
// Hardware that an engine cannot be built with is rejected in the same way at every entry point:
// the constructor, a resolved configuration (`run`, `--show-config`), the plan of a sweep, and a
// search.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <systemc>
#include <utility>
#include <vector>

#include "rtl_model/fabric/clock_domain.h"
#include "spec/check_build.h"
#include "spec/error.h"
#include "tb/base/forked.h"
#include "tb/base/headline.h"
#include "tb/base/random.h"
#include "tool/run/run_once.h"
#include "tool/sweep/definition.h"
#include "tool/sweep/plan.h"
#include "tool/sweep/search.h"

namespace deburr::tool {

// Settings of a user that differ from the defaults, and the rule that they break: its first
// parameter and part of its message.
struct Unbuildable {
  std::vector<std::pair<std::string, std::string>> settings;  // names without the engine's prefix
  std::string about, words;
};

inline std::string text_of_error(const std::function<void()>& work) {
  try {
    work();
  } catch (const spec::ConfigError& error) {
    return error.what();
  }
  return "taken";
}

// A visitor that sets one integer to an end of its range, or to the next value outside it.
class EndSetter {
 public:
  EndSetter(std::size_t number, bool above, bool beside)
      : left_(number), above_(above), beside_(beside ? 1 : 0) {}
  void integer(std::string_view name, std::int32_t& value, std::int32_t min, std::int32_t max,
               std::string_view, std::string_view) {
    if (left_-- != 0) return;
    value = above_ ? max + beside_ : min - beside_;
    name_ = name;
    range_ = std::to_string(min) + ".." + std::to_string(max);
    value_ = value;
  }
  template <class Enum, std::size_t N>
  void choice(std::string_view, Enum&, const std::array<std::string_view, N>&, std::string_view) {}
  void boolean(std::string_view, bool&, std::string_view) {}

  const std::string& name() const { return name_; }  // empty: there are fewer integers
  const std::string& range() const { return range_; }
  std::int32_t value() const { return value_; }

 private:
  std::size_t left_;
  bool above_;
  std::int32_t beside_;
  std::string name_, range_;
  std::int32_t value_ = 0;
};

// Any value of each parameter: ends of its range, powers of two, random values.
class AnyValue {
 public:
  explicit AnyValue(tb::Random& random) : random_(random) {}
  void integer(std::string_view, std::int32_t& value, std::int32_t min, std::int32_t max,
               std::string_view, std::string_view) {
    const auto anything = [&] {
      return static_cast<std::int32_t>(
          min + static_cast<std::int64_t>(random_.next() %
                                          static_cast<std::uint64_t>(std::int64_t{max} - min + 1)));
    };
    switch (random_.below(9)) {
      case 0:
        value = min;
        break;
      case 1:
        value = max;
        break;
      case 2:
        value = std::clamp(1 << random_.below(21), min, max);
        break;
      case 3:
        value = anything();
        break;
      default:
        break;  // its default
    }
  }
  template <class Enum, std::size_t N>
  void choice(std::string_view, Enum& value, const std::array<std::string_view, N>&,
              std::string_view) {
    if (random_.below(2) == 0) value = static_cast<Enum>(random_.below(std::uint32_t{N}));
  }
  void boolean(std::string_view, bool& value, std::string_view) {
    if (random_.below(2) == 0) value = random_.below(2) == 0;
  }

 private:
  tb::Random& random_;
};

template <class Parameters, class Hardware>
class BuildChecks {
 public:
  BuildChecks(std::string engine, std::vector<Unbuildable> table)
      : engine_(std::move(engine)), table_(std::move(table)) {}

  // Every rule has a row of the table that breaks only this rule.
  void expect_a_row_a_rule() const {
    std::vector<std::string> missing;
    for (const spec::BuildRule<Parameters>& rule : build_rules(Parameters()))
      if (std::none_of(table_.begin(), table_.end(),
                       [&](const Unbuildable& row) { return breaks_alone(row, rule); }))
        missing.push_back(std::string(rule.names[0]) + " " + std::string(rule.must));
    EXPECT_THAT(missing, testing::IsEmpty());
  }

  void expect_the_same_words() const {
    for (const Unbuildable& row : table_) {
      const Parameters p = parameters_of(row);
      const std::string text = text_of_error([&] { check_build(p); });
      SCOPED_TRACE(text);
      EXPECT_THAT(text, testing::StartsWith(engine_ + "." + row.about + " = "));
      EXPECT_THAT(text, testing::HasSubstr(row.words));
      EXPECT_EQ(built(p), text);
      EXPECT_EQ(text_of_error([&] { resolve(row); }), text);
      expect_planned_like(row, text);
    }
  }

  // A value just outside the range of each integer. On the command line, the message about the
  // range comes first.
  void expect_ranges() const {
    for_each_end(true, [&](const Parameters& p, const EndSetter& set) {
      const std::string outside = " is outside " + set.range();
      const std::string text = text_of_error([&] { check_build(p); });
      EXPECT_THAT(text, testing::StartsWith(engine_ + "." + set.name() + " = " +
                                            std::to_string(set.value()) + outside));
      EXPECT_EQ(built(p), text);
      EXPECT_THAT(text_of_error([&] { resolve(given(set)); }), testing::HasSubstr(outside));
    });
  }

  // Both ends of each integer's range, with all other parameters at their defaults: either the
  // hardware can be built, or the same rule rejects it at every entry point.
  void expect_ends() const {
    std::size_t taken = 0, rejected = 0;
    for_each_end(false, [&](const Parameters& p, const EndSetter& set) {
      const std::string text = text_of_error([&] { check_build(p); });
      EXPECT_EQ(built(p), text) << set.name() << " = " << set.value();
      ++(text == "taken" ? taken : rejected);
      if (text == "taken") return;  // may have no effect without another parameter
      EXPECT_EQ(text_of_error([&] { resolve(given(set)); }), text);
    });
    EXPECT_GT(taken, rejected);
  }

  // No other reason prevents a build: neither a memory's shape nor an internal check.
  void expect_all_else_is_built(std::uint64_t draws) const {
    tb::Random random(1, engine_);
    std::size_t built_ones = 0, rejected = 0;
    for (std::uint64_t i = 0; i < draws; ++i) {
      Parameters p;
      AnyValue any(random);
      describe(p, any);
      if (text_of_error([&] { check_build(p); }) != "taken") {
        ++rejected;
        continue;
      }
      EXPECT_EQ(built(p), "taken") << "draw " << i;
      ++built_ones;
    }
    EXPECT_GT(built_ones, draws / 20);
    EXPECT_GT(rejected, draws / 20);
  }

 private:
  // Calls `visit` with the defaults, with one integer at an end of its range or just outside it.
  void for_each_end(bool beside,
                    const std::function<void(const Parameters&, const EndSetter&)>& visit) const {
    for (std::size_t number = 0;; ++number) {
      for (const bool above : {false, true}) {
        Parameters p;
        EndSetter set(number, above, beside);
        describe(p, set);
        if (set.name().empty()) {
          EXPECT_GT(number, 0u);
          return;
        }
        visit(p, set);
      }
    }
  }
  static Unbuildable given(const EndSetter& set) {
    return {{{set.name(), std::to_string(set.value())}}, "", ""};
  }

  Parameters parameters_of(const Unbuildable& row) const {
    Parameters p;
    tb::ParameterSet set;
    set.add_engine(engine_, p);
    for (const auto& [name, value] : row.settings) set.set(engine_ + "." + name, value, "table");
    for (const auto& [name, value] : implied_by_preset(row)) set.set(name, value, "preset");
    return p;
  }

  // Settings of the resolved configuration of the engine that were not given.
  std::vector<std::pair<std::string, std::string>> implied_by_preset(const Unbuildable& row) const {
    const std::unique_ptr<Engine> made = engine_named(engine_);
    BoundEngine bound(*made);
    give(bound, row);
    made->resolve(bound.set);
    std::vector<std::pair<std::string, std::string>> implied;
    for (const tb::Parameter& p : bound.set.all())
      if (p.name.starts_with(engine_ + ".") && !p.implied_by.empty() && !bound.set.given(p.name))
        implied.emplace_back(p.name, p.text());
    return implied;
  }

  void give(BoundEngine& bound, const Unbuildable& row) const {
    for (const auto& [name, value] : row.settings)
      bound.set.set(engine_ + "." + name, value, "table");
  }

  void resolve(const Unbuildable& row) const {
    const std::unique_ptr<Engine> made = engine_named(engine_);
    BoundEngine bound(*made);
    give(bound, row);
    bound.resolve();
  }

  bool breaks_alone(const Unbuildable& row, const spec::BuildRule<Parameters>& rule) const {
    const Parameters p = parameters_of(row);
    const std::span<const spec::BuildRule<Parameters>> all = build_rules(p);
    return !rule.holds(p) && std::count_if(all.begin(), all.end(),
                                           [&](const auto& each) { return !each.holds(p); }) == 1;
  }

  // The constructor's message. It runs in a separate process: a model that throws halfway leaves
  // SystemC's hierarchy in an invalid state.
  std::string built(const Parameters& p) const {
    return tb::forked_text([&]() -> std::string {
      try {
        rtl::ClockDomain clock("clock", sc_core::sc_time(4, sc_core::SC_NS));
        const Hardware hardware("hardware", clock, p);
      } catch (const std::exception& error) {
        return error.what();
      }
      return "taken";
    });
  }

  void expect_planned_like(const Unbuildable& row, const std::string& text) const {
    const std::filesystem::path folder =
        std::filesystem::path(testing::TempDir()) / ("deburr_check_build_" + engine_);
    std::filesystem::remove_all(folder);
    std::filesystem::create_directories(folder);
    for (const char* const rejected : {"error", "skip"}) {
      const std::filesystem::path file = folder / "sweep.yaml";
      std::ofstream out(file);
      out << "engine: " << engine_ << "\nbase:\n";
      for (const auto& [name, value] : row.settings)
        out << "  " << engine_ << "." << name << ": " << value << "\n";
      out << "axes: {run.seed: [1, 2], run.stall_seed: [1, 2, 3]}\nrefused: " << rejected
          << "\nmetrics: {cycles: cycles, bytes: memory.bytes_read}\n"
          << "objectives: {minimise: [cycles, bytes]}\n";
      out.close();
      const SweepDefinition sweep = read_sweep(file);
      EXPECT_THAT(text_of_error([&] { make_plan(sweep, place_of(folder, "plan")); }),
                  testing::HasSubstr(tb::headline(text)))
          << rejected;
      EXPECT_THAT(text_of_error([&] {
                    run_search(
                        sweep, search_place_of(folder, "search"), {.runs = 6, .population = 4},
                        [](const Plan&, const std::vector<PlannedPoint>&) { return 0; },
                        [](std::uint64_t) {});
                  }),
                  testing::HasSubstr(tb::headline(text)))
          << rejected;
    }
    std::filesystem::remove_all(folder);
  }

  std::string engine_;
  std::vector<Unbuildable> table_;
};

}  // namespace deburr::tool
