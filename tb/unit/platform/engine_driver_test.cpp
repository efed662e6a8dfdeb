// SPDX-License-Identifier: MIT
// Common functions of all engine drivers, controlled by table rows: each engine defines the
// positions of ID, CONTROL, STATUS and MEMORY_ERRORS.
#include "rtl_model/platform/engine_driver.h"

#include <array>

#include "tb/unit/platform/fakes.h"

namespace deburr::tb::engine_driver_test {
namespace {

using spec::Access;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Pair;

constexpr spec::Field kClear{"clear_counters", 6, 6, Access::kCommand, ""},
    kIdle{"idle", 3, 3, Access::kReadOnly, ""};
constexpr std::array kId = spec::number(Access::kConstant, 0xDEB0007F);
constexpr std::array kControlFields = {kClear}, kStatusFields = {kIdle};
constexpr std::array<spec::RegisterInfo, 4> kRows = {{
    {0x10, "MEMORY_ERRORS", "Errors.", spec::kCounter},
    {0x14, "STATUS", "State.", kStatusFields},
    {0x18, "CONTROL", "Switch.", kControlFields},
    {0x1C, "ID", "Which.", kId},
}};
using Rows = std::span<const spec::RegisterInfo>;

struct Driver final : platform::EngineDriver {
  Driver(platform::RegisterBus& registers, Rows rows)
      : EngineDriver(registers, {"sample engine", rows}) {}
};

TEST(EngineDriver, UsesRegisterRowsOfItsEngine) {
  FakeRegisters registers;
  registers.values = {{0x10, 5}, {0x14, 0x80}, {0x18, 1}, {0x1C, 0xDEB0007F}};
  Driver driver(registers, kRows);
  driver.identify();
  EXPECT_FALSE(driver.idle());
  registers.values[0x14] = 0x88;
  EXPECT_TRUE(driver.idle());
  EXPECT_EQ(driver.memory_errors(), 5u);
  driver.clear_counters();
  EXPECT_THAT(registers.written, ElementsAre(Pair(0x18, 0x41)));
  registers.values[0x1C] = 3;
  EXPECT_THAT(error_of<spec::SimulationError>([&] { driver.identify(); }),
              HasSubstr("reads 0x3, expected 0xdeb0007f"));
}

TEST(EngineDriver, ReportsNoErrorsWithoutMemory) {
  FakeRegisters registers;
  registers.values = {{0x10, 5}, {0, 7}};
  Driver driver(registers, Rows(kRows).last(3));
  EXPECT_EQ(driver.memory_errors(), 0u);
}

TEST(EngineDriver, RequiresRowsCommonToAllEngines) {
  const auto said = [](Rows rows) {
    return error_of<spec::ConfigError>([&] { platform::DriverLayout("sample engine", rows); });
  };
  EXPECT_EQ(said(kRows), "");
  EXPECT_THAT(said(Rows(kRows).first(3)), HasSubstr("sample engine: unknown register ID"));
  EXPECT_THAT(said(Rows(kRows).last(2)), HasSubstr("unknown register STATUS"));
  auto fewer = kRows;
  fewer[1].fields = {};
  EXPECT_THAT(said(fewer), HasSubstr("STATUS has no field idle"));
}

}  // namespace
}  // namespace deburr::tb::engine_driver_test
