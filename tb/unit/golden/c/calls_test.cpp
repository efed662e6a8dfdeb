// SPDX-License-Identifier: MIT
// Functions that every engine of the C interface has: parameters as in the command, presets,
// counters by name, and errors that name the cause and change nothing.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "spec/geometric/check_build.h"
#include "spec/morphological/check_build.h"
#include "spec/texture/check_build.h"
#include "tb/fuzz/engine_parameters.h"
#include "tb/run/parameter_set.h"
#include "tb/unit/golden/c/support.h"

namespace deburr::calls_test {
namespace {

using tb::c::error_of;
using tb::c::expect_ok;
using tb::c::expect_rejected;
using tb::c::Handle;
using tb::c::names_of;
using tb::c::value_of;

// Valid and invalid texts for a parameter.
std::vector<std::string> texts_for(const tb::Parameter& parameter) {
  std::vector<std::string> texts = {parameter.default_value,
                                    "",
                                    "0",
                                    "1",
                                    "2",
                                    "4",
                                    "0x10",
                                    "-1",
                                    "0x-1",
                                    "16 ",
                                    "1.",
                                    "true",
                                    "no",
                                    "none",
                                    "99999",
                                    "x",
                                    "+1",
                                    "65536"};
  std::string word;
  for (const char letter : parameter.range + " ") {
    if (letter != ' ' && letter != '|' && letter != '.') {
      word += letter;
      continue;
    }
    if (!word.empty()) texts.push_back(word);
    word.clear();
  }
  texts.emplace_back("99999999999999999999");
  return texts;
}

TEST(Parameters, AcceptSameTextsAsCommand) {
  tb::EngineParameters parameters;
  tb::ParameterSet set;
  parameters.add_to(set);
  for (const golden::c::MakeHandle make : golden::c::kMakeHandle) {
    const Handle names(make());
    const std::string prefix = std::string(deburr_engine(names.get())) + ".";
    std::vector<std::string> expected;
    std::size_t accepted = 0, rejected = 0;
    for (const tb::Parameter& parameter : set.all()) {
      if (!parameter.name.starts_with(prefix)) continue;
      expected.push_back(parameter.name.substr(prefix.size()));
      for (const std::string& text : texts_for(parameter)) {
        const Handle handle(make());
        parameters = {};
        std::string message;
        try {
          set.set(parameter.name, text, "test");
        } catch (const spec::ConfigError& error) {
          message = error.what();
        }
        const std::string shown = parameter.name + " = '" + text + "'";
        const int status = deburr_set(handle.get(), parameter.name.c_str(), text.c_str());
        if (message.empty()) {
          ++accepted;
          EXPECT_EQ(status, DEBURR_OK) << shown << ": " << error_of(handle.get(), status);
          EXPECT_EQ(value_of(handle.get(), parameter.name), parameter.text()) << shown;
        } else {
          ++rejected;
          EXPECT_EQ(status, DEBURR_ARGUMENT) << shown << ": " << message;
          EXPECT_EQ(value_of(handle.get(), parameter.name), parameter.default_value) << shown;
        }
      }
    }
    EXPECT_FALSE(expected.empty()) << prefix;
    EXPECT_EQ(names_of(names.get()), expected);
    // On average at least two texts per parameter are accepted and three rejected.
    EXPECT_GE(accepted, 2 * expected.size()) << prefix;
    EXPECT_GE(rejected, 3 * expected.size()) << prefix;
  }
}

template <class Parameters>
void expect_values(deburr_golden* golden, const Parameters& expected) {
  for (const std::string& name : names_of(golden))
    EXPECT_EQ(value_of(golden, name), spec::value_text(expected, name)) << name;
}

TEST(Parameters, NamedValuesOverridePresetInAnyOrder) {
  for (std::size_t i = 0; i < spec::texture::kPresetNames.size(); ++i) {
    const Handle handle(deburr_texture_new());
    expect_ok(handle, deburr_set(handle.get(), "preset",
                                 std::string(spec::texture::kPresetNames[i]).c_str()));
    expect_values(handle.get(),
                  spec::texture::preset_parameters(static_cast<spec::texture::Preset>(i)));
  }
  for (std::size_t i = 0; i < spec::geometric::kPresetNames.size(); ++i) {
    const Handle handle(deburr_geometric_new());
    expect_ok(handle, deburr_set(handle.get(), "preset",
                                 std::string(spec::geometric::kPresetNames[i]).c_str()));
    expect_values(handle.get(),
                  spec::geometric::preset_parameters(static_cast<spec::geometric::Preset>(i)));
  }
  using spec::morphological::Preset;
  using spec::morphological::Quality;
  const std::array<std::array<const char*, 2>, 4> settings = {{{"quality", "ultra"},
                                                               {"edges.threshold", "777"},
                                                               {"preset", "smaa"},
                                                               {"search_steps", "5"}}};
  auto expected = spec::morphological::preset_parameters(Preset::kSmaa, Quality::kUltra);
  expected.threshold = 777;
  expected.search_steps = 5;
  for (std::size_t first = 0; first < settings.size(); ++first) {
    const Handle handle(deburr_morphological_new());
    // The last value of a parameter applies.
    expect_ok(handle, deburr_set(handle.get(), "preset", "mlaa-slope"));
    for (std::size_t i = 0; i < settings.size(); ++i) {
      const auto& [name, text] = settings[(first + i) % settings.size()];
      expect_ok(handle, deburr_set(handle.get(), name, text));
    }
    expect_values(handle.get(), expected);
  }
}

TEST(Parameters, CheckReportsSameBuildLimitsAsCommand) {
  const Handle handle(deburr_texture_new());
  expect_ok(handle, deburr_check(handle.get()));
  expect_ok(handle, deburr_set(handle.get(), "cache.ways", "3"));
  expect_rejected(handle, "deburr_check: texture.cache.ways = 3: must be a power of two",
                  deburr_check(handle.get()), DEBURR_CONFIGURATION);
  const std::int32_t s[4] = {};
  std::uint8_t rgba[16];
  expect_rejected(handle, "must be a power of two",
                  deburr_texture_quad(handle.get(), 0, 15, 0, s, s, rgba), DEBURR_CONFIGURATION);
  expect_ok(handle, deburr_set(handle.get(), "cache.ways", "4"));
  expect_ok(handle, deburr_texture_quad(handle.get(), 0, 15, 0, s, s, rgba));
}

TEST(Parameters, CheckCoversEveryEngine) {
  const Handle morphological(deburr_morphological_new()), geometric(deburr_geometric_new());
  expect_ok(morphological, deburr_set(morphological.get(), "window_rows", "11"));
  expect_rejected(morphological, "must be an even number of rows",
                  deburr_check(morphological.get()), DEBURR_CONFIGURATION);
  expect_ok(geometric, deburr_set(geometric.get(), "face_limit", "8193"));
  expect_rejected(geometric, "must be a multiple of 512", deburr_check(geometric.get()),
                  DEBURR_CONFIGURATION);
}

TEST(Calls, NullHandlesAreErrors) {
  char text[200];
  const std::uint8_t byte = 0;
  const std::uint32_t word = 0;
  std::uint8_t out[16];
  std::uint32_t number = 0;
  std::uint64_t large = 0;
  std::int64_t decided = 0;
  const std::int32_t s[4] = {};
  const std::vector<int> statuses = {
      deburr_set(nullptr, "axes", "two"),
      deburr_get(nullptr, "axes", text, sizeof text),
      deburr_check(nullptr),
      deburr_parameter_count(nullptr, &number),
      deburr_parameter_name(nullptr, 0, text, sizeof text),
      deburr_counter(nullptr, "pixels", &large),
      deburr_counter_count(nullptr, &number),
      deburr_counter_name(nullptr, 0, text, sizeof text),
      deburr_reset(nullptr),
      deburr_error_lines(nullptr, &word, 1),
      deburr_geometric_base(nullptr, "depth", 0),
      deburr_texture_memory(nullptr, 64),
      deburr_texture_write(nullptr, 0, &byte, 1),
      deburr_texture_read(nullptr, 0, out, 1),
      deburr_texture_register(nullptr, 0, 0, 0),
      deburr_texture_field(nullptr, 0, "width", "1"),
      deburr_texture_check(nullptr, 0),
      deburr_texture_place(nullptr, 0, 0, &large),
      deburr_texture_level(nullptr, 0, 0, &byte, 1, 0),
      deburr_texture_quad(nullptr, 0, 15, 0, s, s, out),
      deburr_texture_analyse(nullptr, 0, 0, s, s, "samples", &decided),
      deburr_texture_fills(nullptr, &number, 1, &number),
      deburr_texture_invalidate(nullptr),
      deburr_frame_begin(nullptr, 1, 1),
      deburr_frame_pixels(nullptr, &byte, 1, 0),
      deburr_frame_depth(nullptr, &word, 1, 0),
      deburr_frame_put(nullptr, 0, 0, 0, 0),
      deburr_frame_detail(nullptr, 1),
      deburr_frame_process(nullptr),
      deburr_plane_shape(nullptr, "pixels", &number, &number, &number),
      deburr_plane(nullptr, "pixels", out, 1, 0),
      deburr_plane_pixel(nullptr, "pixels", 0, 0, &number),
      deburr_morphological_edges(nullptr, &byte, 1, 0),
      deburr_geometric_vertices(nullptr, &word, 1),
      deburr_geometric_edges(nullptr, &word, 1),
      deburr_geometric_facing(nullptr, 1, &byte, 1),
      deburr_geometric_classes(nullptr, out, 1)};
  EXPECT_THAT(statuses, testing::Each(DEBURR_ARGUMENT));
  EXPECT_THAT(error_of(nullptr, DEBURR_ARGUMENT), testing::HasSubstr("the handle is NULL"));
  EXPECT_EQ(deburr_close(nullptr), DEBURR_OK);
  EXPECT_STREQ(deburr_engine(nullptr), "");
}

TEST(Calls, NullArgumentsAreErrors) {
  for (const golden::c::MakeHandle make : golden::c::kMakeHandle) {
    const Handle owner(make());
    deburr_golden* const golden = owner.get();
    const auto rejected = [&](const std::string& words, int status,
                              int expected = DEBURR_ARGUMENT) {
      expect_rejected(golden, words, status, expected);
    };
    char text[256];
    std::uint64_t value = 0;
    rejected("deburr_set: name is NULL", deburr_set(golden, nullptr, "1"));
    rejected("text is NULL", deburr_set(golden, "preset", nullptr));
    rejected("name is NULL", deburr_get(golden, nullptr, text, sizeof text));
    rejected("text is NULL", deburr_get(golden, "preset", nullptr, 10));
    rejected("count is NULL", deburr_parameter_count(golden, nullptr));
    rejected("lines is NULL", deburr_error_lines(golden, nullptr, 1));
    EXPECT_EQ(deburr_error_lines(golden, nullptr, 0), DEBURR_OK);
    rejected("text is NULL", deburr_parameter_name(golden, 0, nullptr, 10));
    rejected("count is NULL", deburr_counter_count(golden, nullptr));
    rejected("name is NULL", deburr_counter(golden, nullptr, &value));
    rejected("value is NULL", deburr_counter(golden, "pixels", nullptr));
  }
}

TEST(Calls, ShortTextBufferErrorGivesNeededSize) {
  const Handle handle(deburr_texture_new());
  char text[8] = "before";
  // "deburr" and its terminating zero.
  expect_rejected(handle, "the text needs 7 bytes; text_size is 6",
                  deburr_get(handle.get(), "preset", text, 6));
  EXPECT_STREQ(text, "before");
  expect_rejected(handle, "the text needs 7 bytes; text_size is 0",
                  deburr_get(handle.get(), "preset", text, 0));
  expect_ok(handle, deburr_get(handle.get(), "preset", text, 7));
  EXPECT_STREQ(text, "deburr");
}

TEST(Calls, UnknownNameErrorListsKnownNames) {
  for (const golden::c::MakeHandle make : golden::c::kMakeHandle) {
    const Handle handle(make());
    const std::string engine = deburr_engine(handle.get());
    std::uint64_t value = 0;
    expect_rejected(handle, "deburr_set: unknown parameter 'presets'; known: preset, ",
                    deburr_set(handle.get(), "presets", "deburr"));
    for (const char* name : {"", ".preset", "preset.", "frame.preset", "Preset"})
      EXPECT_EQ(deburr_set(handle.get(), name, "deburr"), DEBURR_ARGUMENT) << name;
    EXPECT_EQ(deburr_set(handle.get(), (engine + ".preset").c_str(), "deburr"), DEBURR_OK);
    char first[64];
    expect_ok(handle, deburr_counter_name(handle.get(), 0, first, sizeof first));
    expect_rejected(handle, "unknown counter 'pixel'; known: " + std::string(first) + ", ",
                    deburr_counter(handle.get(), "pixel", &value));
    std::uint32_t parameters = 0, counters = 0;
    expect_ok(handle, deburr_parameter_count(handle.get(), &parameters));
    expect_ok(handle, deburr_counter_count(handle.get(), &counters));
    EXPECT_GT(counters, 8u);
    char text[64];
    for (std::uint32_t i = 0; i < counters; ++i) {
      expect_ok(handle, deburr_counter_name(handle.get(), i, text, sizeof text));
      EXPECT_THAT(text, testing::MatchesRegex("[a-z_]+"));
      EXPECT_EQ(tb::c::counter_of(handle.get(), text), 0u) << text;
    }
    expect_rejected(handle, "is outside 0..",
                    deburr_counter_name(handle.get(), counters, text, sizeof text));
    expect_rejected(handle, "is outside 0..",
                    deburr_parameter_name(handle.get(), parameters, text, sizeof text));
  }
}

TEST(Calls, RejectHandleOfAnotherEngine) {
  const Handle texture(deburr_texture_new()), frames(deburr_morphological_new());
  expect_rejected(
      texture, "the handle belongs to the engine texture; expected an engine that smooths frames",
      deburr_frame_begin(texture.get(), 1, 1));
  expect_rejected(frames, "expected texture", deburr_texture_memory(frames.get(), 64));
  expect_rejected(frames, "expected geometric", deburr_geometric_edges(frames.get(), nullptr, 0));
}

TEST(Errors, TextIsKeptAndTruncatedToBuffer) {
  const Handle handle(deburr_texture_new());
  const int status = deburr_set(handle.get(), "axes", "three");
  EXPECT_EQ(status, DEBURR_ARGUMENT);
  const std::string whole = error_of(handle.get(), status);
  EXPECT_EQ(whole, "deburr_set: 'axes' = 'three' must be one of two, four, eight");
  expect_ok(handle, deburr_check(handle.get()));
  EXPECT_EQ(error_of(handle.get(), status), whole);
  EXPECT_EQ(error_of(handle.get(), DEBURR_OK), "");
  char text[12] = "before";
  EXPECT_EQ(deburr_error(handle.get(), DEBURR_OK, text, sizeof text), DEBURR_OK);
  EXPECT_STREQ(text, "");
  EXPECT_EQ(deburr_error(handle.get(), status, text, sizeof text), DEBURR_OK);
  EXPECT_EQ(std::string(text), whole.substr(0, 11));
  EXPECT_EQ(deburr_error(handle.get(), status, text, 1), DEBURR_OK);
  EXPECT_STREQ(text, "");
  EXPECT_EQ(deburr_error(handle.get(), status, text, 0), DEBURR_ARGUMENT);
  EXPECT_EQ(deburr_error(handle.get(), status, nullptr, 9), DEBURR_ARGUMENT);
}

TEST(Errors, TextIsEmptyExceptForOutOfMemory) {
  const Handle handle(deburr_texture_new());
  EXPECT_EQ(error_of(handle.get(), DEBURR_ARGUMENT), "");
  // Its text is fixed, since storing one could fail.
  EXPECT_THAT(error_of(handle.get(), DEBURR_MEMORY), testing::HasSubstr("out of memory"));
}

TEST(Version, ConsistsOfThreeNumbers) {
  EXPECT_THAT(deburr_version(), testing::MatchesRegex("[0-9]+\\.[0-9]+\\.[0-9]+"));
}

}  // namespace
}  // namespace deburr::calls_test
