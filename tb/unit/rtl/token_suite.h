// SPDX-License-Identifier: MIT
// Compares links, wires and memories of an engine with number formats and with the tables of its
// pages, and its figures with its module tree.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "rtl_model/fabric/clock_domain.h"
#include "tb/harness/unit_bench.h"
#include "tb/unit/rtl/figure.h"
#include "tb/unit/rtl/formats.h"
#include "tb/unit/rtl/page_table.h"

namespace deburr::tb {

template <class... Tokens>
struct TokenList {
  static int expect_widths() { return expect_widths_of_formats<Tokens...>(); }
};

// A build that a page shows.
template <class Parameters>
struct Drawn {
  std::string column;  // of the table of links; empty: none
  Parameters parameters;
  bool wires = false, memories = false;  // these tables show this build
  std::vector<std::string> units = {};   // that a figure must show; empty: no figure
};

template <class Kit>
struct TokenSuite {
  static void fields_have_the_bits_of_their_format() {
    EXPECT_GE(Kit::Tokens::expect_widths(), Kit::kFormats);
  }
  static void links_wires_and_memories_are_those_of_the_page() {
    each([](const auto& drawn, auto& engine) {
      const std::string page = Kit::kTables;
      if (!drawn.column.empty()) EnginePage(page, "link").expect_links(drawn.column, engine);
      if (drawn.wires) EnginePage(page, "wire").expect_wires(engine);
      if (drawn.memories) EnginePage(page, "memory").expect_memories(engine);
    });
  }
  static void figures_are_the_module_tree() {
    int figures = 0;
    each([&](const auto& drawn, auto& engine) {
      for (const std::string& unit : drawn.units) {
        expect_figure(Figure::of_header(Kit::kHeader), engine, Kit::kHeader, unit);
        if (*Kit::kFigure != 0)
          expect_figure(Figure::of_page(Kit::kFigure), engine, Kit::kHeader, unit, Kit::below());
        ++figures;
      }
    });
    EXPECT_GT(figures, 0);
  }

 private:
  template <class Check>
  static void each(Check&& check) {
    rtl::ClockDomain clock("clock", unit_bench::period());
    int number = 0;
    for (const auto& drawn : Kit::drawn_builds()) {
      typename Kit::Engine engine(("engine_" + std::to_string(number++)).c_str(), clock,
                                  drawn.parameters);
      check(drawn, engine);
    }
  }
};

}  // namespace deburr::tb
