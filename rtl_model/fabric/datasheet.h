// SPDX-License-Identifier: MIT
// The datasheet of a unit: what it does in which stage, in how many cycles, on which longest path,
// with which formats, at which cost. docs/reference/datasheets.md is made of them, and timing tests
// expect what they say of the simulated hardware, so no number of them is taken from the model's
// code.
//
//   Datasheet Halver::datasheet(const Parameters& p) {
//     return {.unit = "Halver",
//             .does = "Halves each token.",
//             .latency = {2},
//             .stages = {{"1", "table", "SRAM read"}, {"2", "shift"}}};
//   }
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace deburr::rtl {

// A number of cycles. `text` says what it depends on, and is printed in its place; the number is
// that of the build that the datasheet was asked for, and the least where tokens differ.
struct Cycles {
  std::uint64_t cycles = 0;
  std::string text{};
  std::string shown() const { return text.empty() ? std::to_string(cycles) : text; }
  friend bool operator==(const Cycles&, const Cycles&) = default;
};

struct Stage {
  std::string clock;  // "1", "5-17"
  std::string work;
  std::string path{};  // longest path, an estimate from the operators; empty: shorter than others
  friend bool operator==(const Stage&, const Stage&) = default;
};

struct Datasheet {
  std::string unit;       // its class
  std::string variant{};  // the build, or the kind of token, that it holds for; empty: all
  std::string does{};     // a sentence
  // From the clock in which a token is taken to the clock in which the next unit can take its
  // result; one token behind the other.
  Cycles latency{}, interval{1};
  std::vector<Stage> stages{};
  std::string formats{}, cost{};
  int megahertz = 250;  // the clock that it is made for
};

// "FootprintUnit, `footprint = exact`".
std::string title(const Datasheet& sheet);

// The datasheets of several builds as one list: each once, variants of a unit behind each other.
// Two that have one title must say the same.
std::vector<Datasheet> merged(std::span<const std::vector<Datasheet>> builds);

// A table of all, then each with its stages.
std::string datasheets_markdown(std::span<const Datasheet> sheets);

}  // namespace deburr::rtl
