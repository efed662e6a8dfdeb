// SPDX-License-Identifier: MIT
// Runs every fuzz target on its seeds, on a few thousand mutations of them, and on every input that
// a fuzzer found (tb/fuzz/found/TARGET-NAME): each must be accepted, or rejected by a named error.
// Does not need clang.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "tb/base/random.h"
#include "tb/fuzz/targets.h"
#include "tb/harness/test_paths.h"

namespace deburr::tb::replay_test {
namespace {

namespace fs = std::filesystem;

std::string content(const fs::path& file) {
  std::ostringstream bytes;
  bytes << std::ifstream(file, std::ios::binary).rdbuf();
  return bytes.str();
}

class Replay : public testing::TestWithParam<std::string> {
 protected:
  const FuzzTarget& target = fuzz_target(GetParam());
};

TEST_P(Replay, FoundInputsAreHandled) {
  std::size_t found = 0;
  for (const fs::directory_entry& entry :
       fs::directory_iterator(source_folder() / "tb/fuzz/found")) {
    if (!entry.path().filename().string().starts_with(std::string(target.name) + "-")) continue;
    ++found;
    EXPECT_NO_THROW(target.run(content(entry.path()))) << entry.path();
  }
  RecordProperty("inputs", static_cast<int>(found));
}

TEST_P(Replay, TruncatedSeedsAreHandled) {
  for (const std::string& seed : target.seeds())
    for (std::size_t length = 0; length <= seed.size();
         length += std::max<std::size_t>(1, seed.size() / 200))
      EXPECT_NO_THROW(target.run(std::string_view(seed).substr(0, length))) << length;
}

// Flipped bytes, moved blocks, large numbers: the same mutations on every machine.
TEST_P(Replay, MutatedSeedsAreHandled) {
  Random random(1, target.name);
  for (const std::string& seed : target.seeds()) {
    for (int i = 0; i < 400; ++i) {
      std::string spoilt = seed;
      const auto at = [&] { return random.below(static_cast<std::uint32_t>(spoilt.size())); };
      for (int change = random.between(1, 4); change > 0; --change) {
        switch (random.below(5)) {
          case 0:
            spoilt[at()] = static_cast<char>(random.below(256));
            break;
          case 1:
            spoilt.insert(at(), spoilt.substr(at(), random.below(20)));
            break;
          case 2:
            spoilt.erase(at(), 1 + random.below(8));
            break;
          case 3:
            spoilt.insert(at(), random.chance(500) ? "99999999999" : "-1");
            break;
          default:
            spoilt[at()] = static_cast<char>(random.chance(500) ? 0xFF : 0);
        }
        if (spoilt.empty()) break;
      }
      EXPECT_NO_THROW(target.run(spoilt)) << "seed spoilt in the way " << i << ":\n" << spoilt;
    }
  }
}

std::vector<std::string> names() {
  std::vector<std::string> all;
  for (const FuzzTarget& target : fuzz_targets()) all.emplace_back(target.name);
  return all;
}
INSTANTIATE_TEST_SUITE_P(Fuzz, Replay, testing::ValuesIn(names()),
                         [](const auto& p) { return p.param; });

TEST(FuzzTargets, EveryTargetHasSeeds) {
  for (const FuzzTarget& target : fuzz_targets()) EXPECT_FALSE(target.seeds().empty());
  EXPECT_THROW(fuzz_target("nothing"), std::invalid_argument);
}

}  // namespace
}  // namespace deburr::tb::replay_test
