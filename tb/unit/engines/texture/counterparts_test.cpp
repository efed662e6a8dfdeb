// SPDX-License-Identifier: MIT
// Selecting units in SystemVerilog, in a program built without them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "spec/error.h"
#include "tb/engines/texture/texture_counterparts.h"

namespace deburr::tb::counterparts_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

std::string rejection(const std::string& units) {
  try {
    return std::to_string(counterpart_units(units).size());
  } catch (const spec::ConfigError& error) {
    return error.what();
  }
}

TEST(TextureCounterparts, ErrorTellsHowToBuildThem) {
  EXPECT_EQ(rejection(""), "0");
  for (const char* units : {"all", "cache", "address,filter"})
    EXPECT_THAT(rejection(units), AllOf(HasSubstr("run.hdl"), HasSubstr("DEBURR_HDL=ON"),
                                        HasSubstr("cmake --preset hdl")));
}

TEST(TextureCounterparts, RejectUnknownUnits) {
  for (const char* units : {"rasteriser", "address;cache", "address,,cache", "All"})
    EXPECT_THAT(rejection(units), HasSubstr("address, cache or filter")) << units;
}

TEST(TextureCounterparts, UnavailableInProgramWithoutThem) {
  EXPECT_FALSE(texture_counterparts({}, {}, 1));
  EXPECT_FALSE(available_texture_counterparts({}, 1));
  EXPECT_THROW(texture_counterparts({"cache"}, {}, 1), spec::ConfigError);
}

TEST(TextureCounterparts, RejectWidthAbove1) {
  spec::texture::Parameters wide;
  wide.width = 2;
  EXPECT_FALSE(available_texture_counterparts(wide, 1));
  try {
    texture_counterparts({"filter"}, wide, 1);
    ADD_FAILURE() << "accepted";
  } catch (const spec::ConfigError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("run.hdl"), HasSubstr("texture.width is 2")));
  }
}

TEST(TextureCounterparts, RejectDecoders) {
  spec::texture::Parameters decoding;
  decoding.decode = spec::texture::Decode::kAfter;
  EXPECT_FALSE(available_texture_counterparts(decoding, 1));
  try {
    texture_counterparts({"filter"}, decoding, 1);
    ADD_FAILURE() << "accepted";
  } catch (const spec::ConfigError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("run.hdl"), HasSubstr("texture.decode = none")));
  }
}

}  // namespace
}  // namespace deburr::tb::counterparts_test
