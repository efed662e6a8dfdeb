// SPDX-License-Identifier: MIT
// The datasheet of a unit: its work per stage, latency, longest paths, formats and cost.
// docs/reference/datasheets.md is generated from them. Timing tests compare them with the simulated
// hardware, so no number is computed by the model's own code.
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

#include "rtl_model/fabric/operators.h"

namespace deburr::rtl {

// A number of cycles. `text` says what it depends on and is printed instead of it; the number is
// that of the given build, and the minimum where tokens differ.
struct Cycles {
  std::uint64_t cycles = 0;
  std::string text{};
  std::string shown() const { return text.empty() ? std::to_string(cycles) : text; }
  friend bool operator==(const Cycles&, const Cycles&) = default;
};

struct Stage {
  std::string clock;  // "1", "5-17"
  std::string work;
  std::string path{};  // text instead of `longest`; empty: not critical
  // Operators of each clock of the stage, in each copy of the unit; the ones in series on the
  // longest path; bits of flip-flops, with an enable, that end each clock.
  std::vector<Operator> operators{}, longest{};
  std::uint32_t registers = 0;
  // The counter of the unit that says in how many cycles the stage works; empty: busy.
  std::string on{};
  std::uint32_t clocks() const;  // "5-17": 13
  friend bool operator==(const Stage&, const Stage&) = default;
};

struct Datasheet {
  std::string unit;       // class name
  std::string variant{};  // build or kind of token that it describes; empty: all
  std::string does{};     // one sentence
  // latency: from the cycle in which a token is taken to the cycle in which the next unit can take
  // its result. interval: between consecutive tokens.
  Cycles latency{}, interval{1};
  std::vector<Stage> stages{};
  std::string formats{};
  // The operators and registers of the stages exist `copies` times, one per `per` ("lane"); those
  // of `shared` once. Functions of the build's parameters. Memories and links are not among them:
  // their shapes are declared where they are built.
  std::uint32_t copies = 1;
  std::string per{};
  std::vector<Operator> shared{};
  std::uint32_t shared_registers = 0;  // bits
  std::string cost{};                  // what the operators do not say
  int megahertz = 250;                 // target clock frequency
};

// The operators of all clocks and copies; the bits of flip-flops likewise.
std::vector<Operator> operators_of(const Datasheet& sheet);
std::uint64_t registers_of(const Datasheet& sheet);

// Of the class, in units and results: "TagStage", "WideTagStage" -> "tag_stage".
std::string instance_name(const Datasheet& sheet);

// "FootprintUnit, `footprint = exact`".
std::string title(const Datasheet& sheet);

// Merges the datasheets of several builds into one list without duplicates; variants of a unit
// follow each other. Datasheets with the same title must be equal.
std::vector<Datasheet> merged(std::span<const std::vector<Datasheet>> builds);

// A table of all units, then the stages of each.
std::string datasheets_markdown(std::span<const Datasheet> sheets);

}  // namespace deburr::rtl
