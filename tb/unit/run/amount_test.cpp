// SPDX-License-Identifier: MIT
#include "tb/run/amount.h"

#include <gtest/gtest.h>

namespace deburr::tb::amount_test {
namespace {

TEST(Amount, UsesOneFormForEveryNumber) {
  EXPECT_EQ(amount(0), "0");
  EXPECT_EQ(amount(86285), "86,285");
  EXPECT_EQ(amount(17634.5), "17,635") << "and not 1.763e+04";
  EXPECT_EQ(amount(1234567.25), "1,234,567");
  EXPECT_EQ(amount(-17634.25), "-17,634");
  EXPECT_EQ(amount(-3), "-3");
  EXPECT_EQ(amount(3.14159), "3.142");
  EXPECT_EQ(amount(0.0123456), "0.01235");
  EXPECT_EQ(amount(999.96), "1,000");
  EXPECT_EQ(amount(12345.67, 5), "12,346");
  EXPECT_EQ(amount(1234.567, 5), "1,234.6");
  EXPECT_EQ(amount(-9999.96, 5), "-10,000");
  EXPECT_EQ(amount(1000.5), "1,001") << "all digits are whole ones";
  EXPECT_EQ(amount(999.25), "999.2");
  EXPECT_EQ(amount(9999.5, 4), "10,000");
  EXPECT_EQ(amount(2e18), "2e+18");
}

TEST(Amount, ShowsRangeWithThreeDigits) {
  EXPECT_EQ(with_range(395'832, 402'166, 411'499), "402,000 (396,000 to 411,000)");
  EXPECT_EQ(with_range(3.64, 4.856, 6.07), "4.86 (3.64 to 6.07)");
  EXPECT_EQ(with_range(0.00974, 0.0125, 0.0161), "0.0125 (0.00974 to 0.0161)");
  EXPECT_EQ(with_range(7.462, 7.462, 7.462), "7.46") << "measured";
  EXPECT_EQ(with_range(100.25, 204, 1000.5), "204 (100 to 1,000)");
  EXPECT_EQ(with_range(0, 0, 0), "-");
}

}  // namespace
}  // namespace deburr::tb::amount_test
