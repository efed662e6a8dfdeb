// SPDX-License-Identifier: MIT
// The reproduction report: for each figure that a paper prints, ours, computed here and now, and a
// verdict in one word. One file a paper (papers_004.cpp, ...); this one knows how to print them.
#pragma once

#include <filesystem>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "studies/papers/verdicts.h"
#include "tb/scene/image.h"

namespace deburr::tb {
class Waiting;
}  // namespace deburr::tb

namespace deburr::studies {

struct PaperTable {
  std::string title, note;
  // A column named "verdict" is shown as one (verdicts.h); "-": nothing is claimed of this row.
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;
};

struct PaperImage {
  std::string file;  // without extension
  std::string title, caption;
  tb::Image image;
  bool wide = false;  // a sheet: shown over the whole width
};

struct PaperFigure {
  std::string title, note;
  std::vector<PaperImage> images;
};

struct Paper {
  std::string id, title, source;
  std::vector<PaperTable> tables;
  std::vector<PaperFigure> figures;
};

struct PaperOptions {
  bool quick = false;  // leave out what takes more than a few seconds
  int size = 512;      // side of the pictures and of the scenes that are measured
  bool quiet = false;  // no progress
  std::function<bool()> interrupted = [] { return false; };  // asked now and then

  // Throws Interrupted when asked to: what was done of this paper is of no use.
  void go_on() const;
  // The same question of those who ask by themselves, and shows what is waited for meanwhile.
  std::function<bool()> watching(tb::Waiting& waiting) const;
};

// Builds one paper's part; shows progress on the error stream. May throw Interrupted.
using PaperBuilder = Paper (*)(const PaperOptions&);
struct PaperEntry {
  const char* id;
  PaperBuilder build;
};
const std::vector<PaperEntry>& papers();

// A number for a table: "identical" for the PSNR of identical pictures, which is infinite.
std::string decimals(double value, int digits);

// The tables as text, for the terminal.
std::string to_text(const Paper& paper);
// papers.json, the pictures and index.html. Returns what a manifest says of them.
nlohmann::ordered_json write_papers(const std::filesystem::path& directory,
                                    const std::vector<Paper>& papers);

namespace paper_000 {
Paper build(const PaperOptions& options);
}
namespace paper_002 {
Paper build(const PaperOptions& options);
}
namespace paper_003 {
Paper build(const PaperOptions& options);
}
namespace paper_004 {
Paper build(const PaperOptions& options);
}

}  // namespace deburr::studies
